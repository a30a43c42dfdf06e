"""What the wheels rolled: a place carried on by it, and a short memory of it.

`printing` prints all of it as part of ``wmr_drive.h``, as it does `trust`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, sin

from wmrlib.elementary import sinc, wrap

PAST = 8  # stretches of time that are kept


@dataclass(slots=True)
class Place:
    """A pose that odometry carries on."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0


@dataclass(slots=True)
class Stretch:
    """What the wheels rolled and turned by [m, rad] in some seconds."""

    seconds: float = 0.0
    ahead: float = 0.0
    turn: float = 0.0


@dataclass(slots=True)
class Past:
    """The last stretches, in a ring, and what they add up to since a fix was true."""

    stretches: list[Stretch] = field(default_factory=lambda: [Stretch() for _ in range(PAST)])
    newest: int = 0
    since: Stretch = field(default_factory=Stretch)


def carry(place: Place, ahead: float, turn: float) -> None:
    """Move a place on along the arc that the wheels rolled."""
    chord = ahead * sinc(0.5 * turn)
    place.x += chord * cos(place.heading + 0.5 * turn)
    place.y += chord * sin(place.heading + 0.5 * turn)
    place.heading = wrap(place.heading + turn)


def copy_place(place: Place, other: Place) -> None:
    """Make one place the other."""
    place.x, place.y, place.heading = other.x, other.y, other.heading


def remember(past: Past, ahead: float, turn: float, dt: float, longest: float) -> None:
    """Keep what the wheels rolled in a period, for the `longest` time and a little more."""
    if past.stretches[past.newest].seconds * (PAST - 2) >= longest:
        past.newest = (past.newest + 1) % PAST
        past.stretches[past.newest].seconds = 0.0
        past.stretches[past.newest].ahead = 0.0
        past.stretches[past.newest].turn = 0.0
    past.stretches[past.newest].seconds += dt
    past.stretches[past.newest].ahead += ahead
    past.stretches[past.newest].turn += turn


def lengthen(since: Stretch, stretch: Stretch, age: float) -> None:
    """Put before a stretch of time the next older one, or its share up to an age."""
    share = min((age - since.seconds) / max(stretch.seconds, 1e-9), 1.0)
    since.seconds += share * stretch.seconds
    since.ahead += share * stretch.ahead
    since.turn += share * stretch.turn


def look_back(past: Past, age: float) -> None:
    """Add up what the wheels rolled in the last `age` seconds."""
    past.since.seconds, past.since.ahead, past.since.turn = 0.0, 0.0, 0.0
    for k in range(PAST):
        if past.since.seconds < age:
            lengthen(past.since, past.stretches[(past.newest + PAST - k) % PAST], age)
