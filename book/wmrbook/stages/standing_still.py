"""Chapter 12: the fixes of a receiver that stands still."""

from __future__ import annotations

import functools

import numpy as np

from wmrbook import data
from wmrbook.live.parts import Knob
from wmrbook.scatter import stationary_scatter
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import read_track

EVERY = 3  # s between two fixes of the picture
ASKED = 3, 30  # s


@functools.cache
def fixes() -> np.ndarray:
    """Return the fixes of a u-blox ZED-F9P at rest, east and north of their mean, (n, 2) in m."""
    rest = stationary_scatter(read_track(data.path("ublox-zed-f9p-standing.ubx")))
    places = np.column_stack([rest.east, rest.north])[::EVERY]
    return (places - places.mean(axis=0)).round(2)


def strays(seconds: float) -> float:
    """Return how far a mean over so many seconds comes from the mean of all fixes, in m."""
    n = round(seconds / EVERY)
    sums = np.cumsum(np.vstack([np.zeros(2), fixes()]), axis=0)
    return float(np.hypot(*((sums[n:] - sums[:-n]) / n).T).max())


def standing_still(scene: str = "whole") -> Stage:
    """Return the fixes of a receiver at rest, and their mean over some time, as one scene."""
    short, long = ASKED
    shares = {"a tenth": 0.1, "a third": 0.1**0.5, "more than half": 0.8}
    left = strays(long) / strays(short)
    ends = "They stray by {far}, their means over {seconds} by {left}."
    scenes = {
        "whole": Scene(
            "A receiver stands still for {lasts}. Why do its fixes move? " + ends,
            look="other",
            empty=True,
        ),
        "ask": Scene(
            ends,
            look="other",
            empty=True,
            still=True,
            to={"seconds": short},
            ask=Question(
                "The fixes stray by up to {far}. How much of that is left in their means over half "
                "a minute?",
                dict.fromkeys(
                    shares, "they stray by {left}. An error lasts, so fixes in a row err alike."
                ),
                min(shares, key=lambda answer: abs(shares[answer] - left)),
                {"seconds": long},
            ),
        ),
    }
    knobs = {
        "seconds": Knob(
            30.0, 3.0, 300.0, 3.0, "how long the mean is taken", "s", label="averaged over"
        )
    }
    rows = {"fixes": fixes().tolist(), "every": EVERY}
    return Stage("standing_still", knobs, scenes, scene, data=rows)
