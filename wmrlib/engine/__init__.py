"""Sweeps with ideal wheels, as fast as C: many runs side by side in the lanes of a processor."""
