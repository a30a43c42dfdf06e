"""Stands in for wmrlib.tracks in the page's Python, which reads no files."""


class Track:
    """None is read."""
