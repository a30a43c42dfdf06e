"""The compiled loops over time: in the plane, in polar coordinates, and continuous."""
