"""Stands in for wmrbook's own, which asks for packages that only its figures need."""
