"""The latest fix of a receiver that gpsd serves, without ever waiting for it.

    python book/robot/live_receiver.py [--host 127.0.0.1] [--port 2947]  # prints it once a second

A thread listens, and connects again when gpsd is gone; the control loop asks what is known and how
old it is, and decides for itself from what age on it stops.
"""

from __future__ import annotations

import argparse
import math
import threading
import time
from contextlib import suppress
from typing import Any, NamedTuple

from gpsdclient import GPSDClient

from wmrlib import GeoPoint
from wmrlib.tracks.fixes import UNSAID, Said

_RETRY = 0.5  # s between two attempts to connect
# gpsd's status as the quality in GGA; it leaves out 1. Estimates and simulations are no fixes.
_QUALITY = {1: 1.0, 2: 2.0, 3: 4.0, 4: 5.0, 6: 1.0, 9: 3.0}


class Fix(NamedTuple):
    """A fix: where, what the receiver says of it, its time in UTC, and when it was received.

    `received` is of the clock `time.monotonic` (s), which no change of the time of day moves.
    """

    place: GeoPoint
    said: Said
    utc: str
    received: float

    @property
    def age(self) -> float:
        """Seconds since the fix was received; on the way to here it was under way as well."""
        return time.monotonic() - self.received


class LiveReceiver:
    """Listens to gpsd in a thread from the beginning on, until it is closed.

    Parameters
    ----------
    host, port : str and int, of gpsd
    patience : float, s. A connection that is silent for so long is given up and made again.
    """

    def __init__(self, host: str = "127.0.0.1", port: int = 2947, patience: float = 5.0) -> None:
        self._client = GPSDClient(host, port, timeout=patience)
        self._latest: Fix | None = None
        self._sky = UNSAID
        self._closed = threading.Event()
        self.trouble = "not connected yet"  # why nothing comes, or "" while something does
        self._thread = threading.Thread(target=self._listen, name="gpsd", daemon=True)
        self._thread.start()

    def latest(self) -> Fix | None:
        """The last fix, however old, or None before the first; at once."""
        return self._latest

    def close(self) -> None:
        """Stop listening; it takes as long as a read under way, a moment."""
        self._closed.set()
        if (sock := self._client.sock) is not None:
            with suppress(OSError):  # not connected any more
                sock.shutdown(2)  # which wakes the thread
        self._thread.join(timeout=self._client.timeout + 1.0)

    def __enter__(self) -> LiveReceiver:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _listen(self) -> None:
        while not self._closed.is_set():
            try:
                for report in self._client.dict_stream(convert_datetime=False):
                    self.trouble = ""
                    if self._closed.is_set():
                        break
                    self._hear(report)
                self.trouble = "gpsd has ended the connection"
            except Exception as error:  # whatever a stream may hold, the thread goes on
                self.trouble = str(error) or type(error).__name__
            with suppress(OSError):
                self._client.close()
            self._closed.wait(_RETRY)

    def _hear(self, report: Any) -> None:
        """Keep what a report says; one that says nothing new, or nonsense, changes nothing."""
        if not isinstance(report, dict):
            raise ValueError(f"gpsd sent {report!r}, not an object")
        if report.get("class") == "SKY":
            said = {"satellites": _number(report, "uSat"), "hdop": _number(report, "hdop")}
            news = {field: value for field, value in said.items() if not math.isnan(value)}
            self._sky = self._sky._replace(**news)  # gpsd may send each in a report of its own
        if report.get("class") != "TPV" or report.get("mode") not in (2, 3):
            return
        lat, lon = _number(report, "lat", low=-90.0, high=90.0), _number(report, "lon", low=-180.0)
        quality, utc = _QUALITY.get(report.get("status", 1), math.nan), str(report.get("time", ""))
        frozen = self._latest is not None and utc == self._latest.utc
        if frozen or not utc or math.isnan(lat + lon + quality) or lon > 180.0:
            return
        said = self._sky._replace(
            quality=quality,
            speed=_number(report, "speed"),
            course=math.radians(_number(report, "track")),
            accuracy=_number(report, "eph"),
        )
        self._latest = Fix(GeoPoint(lat=lat, lon=lon), said, utc, time.monotonic())


def _number(report: dict, name: str, low: float = 0.0, high: float = math.inf) -> float:
    value = report.get(name)
    good = isinstance(value, int | float) and not isinstance(value, bool) and low <= value <= high
    return float(value) if good and math.isfinite(value) else math.nan


def main() -> None:
    """Print the latest fix once a second, until Ctrl-C."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=2947)
    with LiveReceiver(**vars(parser.parse_args())) as receiver, suppress(KeyboardInterrupt):
        while True:
            fix = receiver.latest()
            print(f"{fix.age:.1f} s old: {fix}" if fix else receiver.trouble, flush=True)
            time.sleep(1.0)


if __name__ == "__main__":
    main()
