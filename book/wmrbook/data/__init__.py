"""The files that the chapters read: two receivers' logs, and the stored search of chapter 13."""

from __future__ import annotations

from pathlib import Path

from wmrlib.checks import choice

_FOLDER = Path(__file__).parent
NAMES = tuple(
    sorted(path.name for path in _FOLDER.iterdir() if path.suffix in (".json", ".nmea", ".ubx"))
)
"""The names of the files."""


def path(name: str) -> Path:
    """Return where a file is, so that a chapter finds it from any folder.

    Raises ValueError, which lists `NAMES`, for any other name.
    """
    return _FOLDER / choice("name", name, NAMES)
