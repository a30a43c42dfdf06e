"""The values of a robot's sheet that a log gives, and the files that are made from the sheet.

`kit/nmea.js` and `kit/sheet.js` do the same in a page.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

import wmrlib as wmr
from wmrlib.tracks import Track
from wmrlib.tracks.neighbours import strays
from wmrrobot.sheets import SUREST, Robot, sheet

TEMPLATES = Path(__file__).with_name("templates")


def along(robot: Robot, track: Track) -> Robot:
    """The robot, from the first to the last fix of a drive, or of a walk with its receiver."""
    (start_lat, goal_lat), (start_lon, goal_lon) = (
        map(float, degrees[[0, -1]]) for degrees in (track.points.lat, track.points.lon)
    )
    return robot._replace(
        start_lat=start_lat, start_lon=start_lon, goal_lat=goal_lat, goal_lon=goal_lon
    )


def at_rest(robot: Robot, track: Track) -> Robot:
    """The robot with the scatter of a log at rest as its receiver's sigma.

    Positions far outside the scatter of the others are left out. It is too small unless the log is
    much longer than the memory: what errs by the same amount all the time does not scatter.

    Raises
    ------
    ValueError : a track of one position, which has no scatter
    """
    if len(track) < 2:
        raise ValueError(f"track = {track!r} is not allowed: at least 2 positions are needed")
    near = ~strays(track.points)
    points = wmr.GeoPoint(lat=track.points.lat[near], lon=track.points.lon[near])
    first = wmr.GeoPoint(lat=float(points.lat[0]), lon=float(points.lon[0]))
    places = wmr.local_position(first, points)
    return robot._replace(sigma=math.sqrt(float(np.mean(np.var(places, axis=1)))))


def number(value: float) -> str:
    """Six digits, and a point: C and YAML take 2 for a whole number."""
    text = f"{float(f'{value:.6g}'):.10f}".rstrip("0")
    return text + "0" if text.endswith(".") else text


def templates() -> dict[str, str]:
    """The texts of the files, by name, in which @part.name@ stands for a number."""
    return {path.name: path.read_text(encoding="utf-8") for path in sorted(TEMPLATES.iterdir())}


def files(robot: Robot) -> dict[str, str]:
    """The files for the robot, by name: for C and Arduino, and parameters for ROS 2."""
    settings = sheet(robot)
    parts = {"robot": robot, "sheet": settings}  # each has names of its own: two say "settle"
    parts |= {name: getattr(settings, name) for name in ("gains", "wheels", "turn", "rules")}
    words = {
        f"{part}.{name}": number(value)
        for part, values in parts.items()
        for name, value in values._asdict().items()
        if np.isscalar(value)
    }
    for name in ("start_lat", "start_lon", "goal_lat", "goal_lon"):
        degrees = getattr(robot, name)
        words[f"robot.{name}_e7"] = f"{math.floor(1e7 * degrees + 0.5)}"
        words[f"robot.{name}"] = f"{degrees:.7f}"
    words["robot.compass_sigma"] = number(math.radians(max(robot.compass, SUREST)))
    return {
        name: re.sub("@([a-z0-9_.]+)@", lambda match: words[match[1]], text)
        for name, text in templates().items()
    }
