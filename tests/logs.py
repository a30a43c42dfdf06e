"""The receivers' logs of the chapters."""

from pathlib import Path

LOGS = Path(__file__).parents[1] / "book" / "wmrbook" / "data"
STANDING, TEN_MINUTES = LOGS / "ublox5-standing.nmea", LOGS / "ublox-zed-f9p-standing.ubx"
