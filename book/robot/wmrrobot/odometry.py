"""Odometry: a pose carried on by the rolled metres, and a short history of them.

`printing` prints all of it as part of ``wmr_drive.h``, as it does `monitor`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, sin

from wmrlib.compilation import formula
from wmrlib.elementary import sinc, wrap

PAST = 8  # stretches in the ring buffer


@dataclass(slots=True)
class Place:
    """A pose that odometry carries on; m, m, rad."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0


@dataclass(slots=True)
class Stretch:
    """The distance [m] and the turn [rad] that the wheels rolled in a time [s]."""

    seconds: float = 0.0
    ahead: float = 0.0
    turn: float = 0.0


@dataclass(slots=True)
class Past:
    """A ring buffer of the last stretches, and their sum since the newest fix was measured."""

    stretches: list[Stretch] = field(default_factory=lambda: [Stretch() for _ in range(PAST)])
    newest: int = 0
    since: Stretch = field(default_factory=Stretch)


@formula
def carry(place: Place, ahead: float, turn: float) -> None:
    """Move a pose along the arc that the wheels rolled."""
    chord = ahead * sinc(0.5 * turn)
    place.x += chord * cos(place.heading + 0.5 * turn)
    place.y += chord * sin(place.heading + 0.5 * turn)
    place.heading = wrap(place.heading + turn)


@formula
def shift(place: Place, ahead: float, left: float) -> None:
    """Move a pose ahead and to the left, without a turn."""
    east, north = cos(place.heading), sin(place.heading)
    place.x += ahead * east - left * north
    place.y += ahead * north + left * east


@formula
def copy_place(place: Place, other: Place) -> None:
    """Copy the other pose into the first."""
    place.x, place.y, place.heading = other.x, other.y, other.heading


@formula
def remember(past: Past, ahead: float, turn: float, dt: float, longest: float) -> None:
    """Add a period to the history, which reaches back a little over `longest` s."""
    if past.stretches[past.newest].seconds * (PAST - 2) >= longest:
        past.newest = (past.newest + 1) % PAST
        past.stretches[past.newest].seconds = 0.0
        past.stretches[past.newest].ahead = 0.0
        past.stretches[past.newest].turn = 0.0
    past.stretches[past.newest].seconds += dt
    past.stretches[past.newest].ahead += ahead
    past.stretches[past.newest].turn += turn


@formula
def lengthen(since: Stretch, stretch: Stretch, age: float) -> None:
    """Add the next older stretch to a sum, or its share up to an age [s]."""
    share = min((age - since.seconds) / max(stretch.seconds, 1e-9), 1.0)
    since.seconds += share * stretch.seconds
    since.ahead += share * stretch.ahead
    since.turn += share * stretch.turn


@formula
def look_back(past: Past, age: float) -> None:
    """Add up the distance and the turn of the last `age` s."""
    past.since.seconds, past.since.ahead, past.since.turn = 0.0, 0.0, 0.0
    for k in range(PAST):
        if past.since.seconds < age:
            lengthen(past.since, past.stretches[(past.newest + PAST - k) % PAST], age)
