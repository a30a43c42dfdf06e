"""The compiled loops over time: sampled in the plane, in fixed polar steps, and continuous."""
