"""Angles that are not wrapped, for a law of the library."""

from __future__ import annotations

import math
from collections.abc import Callable

from wmrlib.checks import choice
from wmrlib.control import control_law
from wmrlib.gains import Gains


def unwrapped(law: str, *angles: str) -> Callable[[float, float, float, Gains], tuple]:
    """Return a law for one run of `track`, in arcs or Euler's steps, that lets angles count on.

    angles: "alpha", "theta", both or none. A named angle is not wrapped: of all values that differ
    by full turns, it takes the one nearest to its last value. The law remembers this value, so that
    a second run needs a new one.
    Raises ValueError for another law or angle.
    """
    names = [choice("angle", name, ("alpha", "theta")) for name in angles]
    last: dict[str, float] = {}

    def steer(rho, alpha, theta, gains):
        now = {"alpha": alpha, "theta": theta}
        for name in names:
            before = last.get(name, now[name])
            now[name] = last[name] = before + math.remainder(now[name] - before, math.tau)
        return control_law(rho, now["alpha"], now["theta"], gains, law=law)

    return steer
