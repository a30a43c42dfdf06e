"""Headlines of chapters 6 to 9: the circle, gains, sampling, noise."""
