"""A receiver's bytes, through a pty and the real gpsd, to positions; and the same without it."""

from __future__ import annotations

import os
import pty
import queue
import shutil
import socket
import subprocess
import threading
import time
import tty
from contextlib import suppress
from functools import reduce
from operator import xor
from typing import Any, NamedTuple

import pyubx2


class Position(NamedTuple):
    """A fix as it is sent and read: s since noon, degrees, m, and quality as NMEA counts."""

    time: float
    lat: float
    lon: float
    error: float = 1.0
    quality: int = 1


def ubx(fix: Position) -> bytes:
    """The fix as UBX: NAV-PVT, and the end of the epoch."""
    seconds, ms = divmod(round(1000.0 * fix.time), 1000)
    itow = 129_600_000 + round(1000.0 * fix.time)  # ms of the week at noon of a Monday
    clock = {"year": 2026, "month": 6, "day": 1, "hour": 12 + seconds // 3600}
    clock |= {"min": seconds // 60 % 60, "second": seconds % 60, "nano": 1_000_000 * ms}
    valid = dict.fromkeys(("validDate", "validTime", "fullyResolved", "gnssFixOk"), 1)
    solution = {
        "fixType": 3,
        "diffSoln": int(fix.quality > 1),
        "carrSoln": {5: 1, 4: 2}.get(fix.quality, 0),
        "numSV": 20,
        "pDOP": 1,
    }
    place = {"lat": round(fix.lat, 7), "lon": round(fix.lon, 7), "hAcc": round(1000 * fix.error)}
    made: Any = pyubx2.UBXMessage(
        "NAV", "NAV-PVT", pyubx2.GET, iTOW=itow, **clock, **valid, **solution, **place
    )
    end: Any = pyubx2.UBXMessage("NAV", "NAV-EOE", pyubx2.GET, iTOW=itow)
    return made.serialize() + end.serialize()


def nmea(fix: Position) -> bytes:
    """The fix as NMEA: RMC and GGA."""
    seconds, ms = divmod(round(1000.0 * fix.time), 1000)
    clock = f"{12 + seconds // 3600:02}{seconds // 60 % 60:02}{seconds % 60:02}.{ms // 10:02}"
    place = []
    for value, width, signs in ((fix.lat, 2, "NS"), (fix.lon, 3, "EW")):
        degrees, minutes = divmod(round(abs(value) * 60e7), 60 * 10**7)
        place.append(f"{degrees:0{width}}{minutes / 1e7:010.7f},{signs[value < 0]}")
    where = ",".join(place)
    bodies = (
        f"GPRMC,{clock},A,{where},,,010626,,,A",
        f"GPGGA,{clock},{where},{fix.quality},20,0.6,30.0,M,0.0,M,,",
    )
    lines = (f"${body}*{reduce(xor, body.encode()):02X}\r\n" for body in bodies)
    return "".join(lines).encode()


FORMATS = {"ubx": ubx, "nmea": nmea}


def rounded(fix: Position, form: str) -> Position:
    """A fix as it arrives, rounded: UBX has 1e-7 degrees, NMEA 1e-7 minutes."""
    if form == "ubx":
        return fix._replace(lat=round(fix.lat, 7), lon=round(fix.lon, 7))
    lat, lon = (round(value * 60e7) / 60e7 for value in fix[1:3])
    return fix._replace(lat=lat, lon=lon)


def _milliseconds(clock: str) -> int:
    """Since noon, of a time such as 2026-06-01T12:00:01.200Z."""
    hours, minutes, seconds = map(float, clock.partition("T")[2].rstrip("Z").split(":"))
    return round(1000.0 * (3600.0 * (hours - 12.0) + 60.0 * minutes + seconds))


class Gpsd:
    """The real gpsd on a pty: `pass_on` writes a fix there, and reads what gpsd says of it."""

    def __init__(self, form: str) -> None:
        self.write_fix = FORMATS[form]
        try:
            from gpsdclient import GPSDClient
        except ModuleNotFoundError:
            text = 'this needs gpsdclient: pip install ".[robot]" in the repository'
            raise RuntimeError(text) from None
        command = shutil.which("gpsd", path=os.environ["PATH"] + ":/usr/sbin")
        if not command:
            raise RuntimeError("this needs gpsd (Debian: apt install gpsd)")
        self.client = GPSDClient
        self.end, other = pty.openpty()
        tty.setraw(other)
        os.chmod(os.ttyname(other), 0o666)  # gpsd gives up root's rights
        with socket.create_server(("127.0.0.1", 0)) as free:
            port = free.getsockname()[1]
        options = ["-N", "-n", "-b", "-S", str(port), os.ttyname(other)]
        self.daemon = subprocess.Popen([command, *options], stderr=subprocess.DEVNULL)
        self.port, self.reports = port, queue.SimpleQueue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        """Keep what gpsd says, and connect again until it is ended."""
        while self.daemon.poll() is None:
            with suppress(OSError), self.client(port=self.port) as client:
                for report in client.dict_stream(convert_datetime=False, filter={"TPV"}):
                    if report.get("mode", 0) >= 2 and "lat" in report and "time" in report:
                        self.reports.put(report)
            time.sleep(0.05)

    def pass_on(self, fix: Position) -> Position:
        """The fix as gpsd gives it; at first it needs some to know the format."""
        milliseconds, tries = round(1000.0 * fix.time), 40
        for _ in range(tries):
            os.write(self.end, self.write_fix(fix))
            with suppress(queue.Empty):
                while True:
                    report = self.reports.get(timeout=0.25)
                    if _milliseconds(report["time"]) == milliseconds:
                        return fix._replace(lat=report["lat"], lon=report["lon"])
        raise TimeoutError(f"gpsd says nothing of the fix at {fix.time:.1f} s")

    def close(self) -> None:
        """End gpsd."""
        self.daemon.terminate()
        self.daemon.wait(timeout=10)
        os.close(self.end)
