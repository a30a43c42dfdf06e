"""Shared by all tests: hypothesis draws the same examples on every machine, so that a red build can be repeated."""

from hypothesis import settings

settings.register_profile("repeatable", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("repeatable")
