"""Chapter 12: the fixes of a receiver that stands still, their means and their courses."""

from __future__ import annotations

import functools
import json
import math

import numpy as np

from wmrbook import data
from wmrbook.live.parts import Knob
from wmrbook.scatter import stationary_scatter
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import read_track

EVERY = 1  # s between two fixes of the log
ASKED = 3, 30  # s
WALKS = 1.0  # m/s, eastwards


@functools.cache
def fixes() -> np.ndarray:
    """Return the fixes of a u-blox ZED-F9P at rest, east and north of their mean, (n, 2) in m."""
    rest = stationary_scatter(read_track(data.path("ublox-zed-f9p-standing.ubx")))
    return np.column_stack([rest.east, rest.north]).round(3)


def strays(seconds: float) -> float:
    """Return how far a mean over so many seconds comes from the mean of all fixes, in m."""
    n = round(seconds / EVERY)
    sums = np.cumsum(np.vstack([np.zeros(2), fixes()]), axis=0)
    return float(np.hypot(*((sums[n:] - sums[:-n]) / n).T).max())


def courses(speed: float) -> np.ndarray:
    """Return the courses from fix to fix if the receiver went east, in rad from east."""
    east, north = np.diff(fixes(), axis=0).T
    return np.arctan2(north, east + speed * EVERY)


def standing_still(scene: str = "whole") -> Stage:
    """Return the fixes of a receiver at rest, and what follows from them, as one of its scenes."""
    short, long = ASKED
    shares = {"a tenth": 0.1, "a third": 0.1**0.5, "more than half": 0.8}
    left = strays(long) / strays(short)
    ends = "They stray by {far}, their means over {seconds} by {left}."
    mean = {"look": "other", "empty": True, "handles": ("seconds",)}
    course = {"look": "other", "empty": True, "handles": ("speed",), "shows": ("course",)}
    at_rest = np.abs(courses(0.0)).max() > math.pi / 2.0
    answers = {"they point east, as before": not at_rest, "they point anywhere": at_rest}
    rose = "At {speed} to the east, the courses from fix to fix are up to {turned} off."
    scenes = {
        "whole": Scene(
            "A receiver stands still for {lasts}. Why do its fixes move? " + ends, **mean
        ),
        "path": Scene(
            "Joined by lines, the fixes make a walk of {walk}. The receiver lay still.",
            **mean | {"handles": (), "shows": ("path",)},
        ),
        "minute": Scene(
            "The circle is the scatter of one minute, {spread} on average. But the minutes' "
            "means stray by {left}.",
            to={"seconds": 60.0},
            moved="The circle is the scatter of the fixes in {seconds}, {spread} on average. Their "
            "means stray by {left}.",
            **mean | {"shows": ("scatter",)},
        ),
        "ask": Scene(
            ends,
            still=True,
            to={"seconds": float(short)},
            ask=Question(
                "The fixes stray by up to {far}. How much of that is left in their means over half "
                "a minute?",
                dict.fromkeys(
                    shares, "they stray by {left}. An error lasts, so fixes in a row err alike."
                ),
                min(shares, key=lambda answer: abs(shares[answer] - left)),
                {"seconds": float(long)},
            ),
            **mean,
        ),
        "course": Scene("A line for each second's course. " + rose, **course),
        "stop": Scene(
            rose,
            still=True,
            ask=Question(
                "The receiver walks east, and its courses point east. Now it stops, and its fixes "
                "go on. Where do the courses point?",
                dict.fromkeys(
                    answers,
                    "they are up to {turned} off: only the error moves now, and it moves anywhere.",
                ),
                next(answer for answer, right in answers.items() if right),
                {"speed": 0.0},
            ),
            **course,
        ),
    }
    knobs = {
        "seconds": Knob(
            30.0, 1.0, 300.0, 1.0, "how long the mean is taken", "s", label="averaged over"
        ),
        "speed": Knob(
            WALKS,
            0.0,
            2.0,
            0.05,
            "how fast it is carried to the east",
            "m/s",
            label="walks",
        ),
    }
    rows = {"fixes": json.dumps(fixes().tolist()), "every": EVERY}
    return Stage("standing_still", knobs, scenes, scene, data=rows)
