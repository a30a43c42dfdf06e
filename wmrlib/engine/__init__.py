"""The compiled loops over time: sampled in the plane, and continuous."""
