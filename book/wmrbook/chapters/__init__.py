"""Helpers that one chapter alone needs."""
