"""The tuning challenge, a game for a class: who finds the gains with the fewest points?

Everyone gets the same starts and goals. A case costs time [s] + 0.5 |heading error at arrival|
[deg] + 4 peak |omega| [rad/s]; the score is the mean over the cases, and less is better. The
corrected law drives, its command held for dt as on a real robot (method "arc"), under wheel limits.
A case that is not reached costs `Challenge.penalty`, what the worst possible arrival would.

The score follows from the gains alone, on every machine: they count with 3 decimals, it has 2.
Computers differ in their last digits, and an unstable run makes such a difference large. So each
case is driven five times, as it is and from a micrometre further east, west, north and south,
millions of times what rounding does: if one of them arrives more than one dt earlier or later, or
with points that differ by more than 1, the case hangs on rounding and counts as not reached. What
remains is luck: a mean within about 1e-8 of the edge between two roundings may be shown as either,
and of a chaotic run all five may end alike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from wmrbook.tables import table
from wmrlib.body import Wheels, checked_wheels
from wmrlib.checks import instance, scalar
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.runs import Trajectory, sample_count, single_pose
from wmrlib.simulation import simulate
from wmrlib.sweeping import sweep

SEED = 2026
"""The seed of the published challenge."""
_HEADING_WEIGHT, _OMEGA_WEIGHT = 0.5, 4.0  # points a degree, points a rad/s
_ASIDE = 1e-6 * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])  # m
_TIPPED = 1.0  # points
_HEAD = "case", "kind", "distance [m]", "time [s]", "heading [deg]", "omega [rad/s]", "points"
_WHEELS = Wheels(track_width=0.5, max_speed=2.0)  # m, m/s
_SHOWN = ".1f", ".1f", ".1f", ".2f", ".2f"
_KINDS = (  # name, distance in m from, to, |alpha| in deg from, to
    ("ahead", 5.0, 15.0, 0.0, 30.0),
    ("ahead", 20.0, 40.0, 10.0, 60.0),
    ("far ahead", 50.0, 60.0, 0.0, 45.0),
    ("close beside", 2.0, 5.0, 80.0, 100.0),
    ("beside", 10.0, 25.0, 80.0, 100.0),
    ("half behind", 5.0, 12.0, 120.0, 150.0),
    ("straight behind", 3.0, 6.0, 165.0, 175.0),
    ("straight behind", 20.0, 40.0, 165.0, 175.0),
    ("near", 1.0, 2.0, 0.0, 60.0),
    ("near behind", 1.0, 2.0, 100.0, 140.0),
    ("across", 8.0, 20.0, 30.0, 60.0),
    ("far behind", 50.0, 60.0, 150.0, 170.0),
)


class Case(NamedTuple):
    """One drive of the challenge: what is awkward about it, the start's Pose and the goal's."""

    kind: str
    start: Pose
    goal: Pose


@dataclass(frozen=True, slots=True, repr=False)
class Challenge:
    """What everyone is given: the cases, and how they are driven.

    seed: from which `from_seed` drew it; cases: tuple of Case, each a text and two single poses;
    wheels: Wheels with a finite speed; dt: s, for which a command is held; arrival_radius: m;
    duration: s, within which the goal has to be reached. Raises ValueError for anything else.
    """

    seed: int
    cases: tuple[Case, ...]
    wheels: Wheels = _WHEELS
    dt: float = 0.1
    arrival_radius: float = 0.05
    duration: float = 60.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "seed", _whole(self.seed))
        if not isinstance(self.cases, tuple) or not self.cases:
            raise ValueError(
                f"cases = {self.cases!r} is not allowed: a tuple of at least one Case is needed"
            )
        for k, case in enumerate(self.cases):
            kind, start, goal = instance(f"cases[{k}]", case, Case)
            instance(f"cases[{k}].kind", kind, str)
            single_pose(f"cases[{k}].start", start)
            single_pose(f"cases[{k}].goal", goal)
        wheels = checked_wheels(instance("wheels", self.wheels, Wheels))
        scalar("wheels.max_speed", wheels.max_speed)
        sample_count(self.dt, self.duration)
        scalar("arrival_radius", self.arrival_radius, low=0.0)

    def __repr__(self) -> str:
        rows = [
            f"<Challenge: seed {self.seed}, {len(self.cases)} cases, "
            f"wheels up to {self.wheels.max_speed:g} m/s, {self.duration:g} s each>"
        ]
        columns = (f"{end}: x, y [m], heading [deg]" for end in ("start", "goal"))
        rows.append("{:>4}  {:<16}{:>32}{:>32}".format("case", "kind", *columns))
        for k, case in enumerate(self.cases, start=1):
            start, goal = (
                f"{pose.x:9.2f}{pose.y:9.2f}{math.degrees(pose.heading):9.1f}" for pose in case[1:]
            )
            rows.append(f"{k:>4}  {case.kind:<16}{start:>32}{goal:>32}")
        return "\n".join(rows)

    @property
    def penalty(self) -> float:
        """The points of a case not reached: all the time, 180 deg and the wheels' fastest turn."""
        fastest_turn = 2.0 * self.wheels.max_speed / self.wheels.track_width  # rad/s, on the spot
        return self.duration + _HEADING_WEIGHT * 180.0 + _OMEGA_WEIGHT * fastest_turn

    @property
    def limits(self) -> dict[str, Any]:
        """The options of `simulate` and `sweep`."""
        names = "dt", "duration", "arrival_radius", "wheels"
        return {name: getattr(self, name) for name in names}


class CaseScore(NamedTuple):
    """A case's row.

    distance: m, from start to goal; time: s, infinite if the goal was not reached;
    heading_error_deg: its size at the end; peak_omega: rad/s; note: why the penalty was given, or
    nothing.
    """

    kind: str
    distance: float
    time: float
    heading_error_deg: float
    peak_omega: float
    points: float
    note: str


@dataclass(frozen=True, slots=True, repr=False)
class Score:
    """What gains are worth.

    total: the mean of the cases' points with 2 decimals; gains: as they counted, with 3 decimals.
    """

    total: float
    cases: tuple[CaseScore, ...]
    gains: Gains
    game: Challenge

    def __repr__(self) -> str:
        gains = ", ".join(f"{name} {value:g}" for name, value in self.gains._asdict().items())
        reached = f"{self.reached} of {len(self.cases)} reached"
        columns = "{:>4}  {:<16}{:>13}{:>10}{:>15}{:>15}{:>9}  {}"
        rows = [f"<Score: {self.total:.2f} points, {reached}; {gains}; seed {self.game.seed}>"]
        rows += (columns.format(*row).rstrip() for row in ((*_HEAD, ""), *self._rows()))
        return "\n".join(rows)

    def _rows(self) -> Iterator[tuple[str, ...]]:
        for k, (kind, *numbers, note) in enumerate(self.cases, 1):
            yield str(k), kind, *map(format, numbers, _SHOWN), note

    def _repr_html_(self) -> str:
        *values, notes = zip(*self.cases, strict=True)
        rows = range(1, len(notes) + 1)
        columns = dict(zip(_HEAD, (rows, *values), strict=True))
        if any(notes):
            columns["reached"] = [note or "yes" for note in notes]
        caption = repr(self).splitlines()[0][1:-1]
        return table(columns, dict(zip(_HEAD[2:], _SHOWN, strict=True)), caption)._repr_html_()

    @property
    def reached(self) -> int:
        """How many cases count as reached."""
        return sum(not case.note for case in self.cases)


def from_seed(seed: int = SEED) -> Challenge:
    """The challenge of a seed: twelve cases, the same on every machine and with every numpy.

    Seven numbers r0 to r6 in [0, 1) are drawn for each case, (k >> 11) 2^-53 with the raw 64-bit
    numbers k of PCG64(SeedSequence(seed)), whose stream numpy guarantees.
    start = (40 r0 - 20, 40 r1 - 20) m, heading 360 r2 - 180 deg; the goal's distance and |alpha|
    lie as far into the ranges of the case's kind as r3 and r4 say, to the left for r5 < 1/2; the
    goal's theta is 300 r6 - 150 deg. Positions are rounded to a centimetre, headings to 0.1 deg.
    "straight behind" stays 5 deg off, where left and right do not depend on rounding. Raises
    ValueError for anything but a whole number from 0 to 2^63 - 1.
    """
    return _drawn(_whole(seed))


def rounded(gains: Gains) -> Gains:
    """The gains as they count: single numbers with 3 decimals, or a ValueError."""
    fields = instance("gains", gains, Gains)._asdict()
    # + 0.0, because -0.0 would be another text
    return Gains(*(round(scalar(name, value), 3) + 0.0 for name, value in fields.items()))


def score(gains: Gains, game: Challenge | None = None) -> Score:
    """What the gains are worth in the challenge, the published one for None; takes milliseconds.

    Raises ValueError for anything but Gains of single numbers, or another type of game.
    """
    game, gains = _game(game), rounded(gains)
    starts, goals = (
        Pose(*np.array([case[end] for case in game.cases], dtype=float).T) for end in (1, 2)
    )
    pushed = Pose(starts.x + _ASIDE[:, :1], starts.y + _ASIDE[:, 1:], starts.heading)
    ends = sweep(pushed, goals, gains, method="arc", progress=False, **game.limits)
    error = np.abs(np.degrees(ends.heading_error))
    points = ends.time + _HEADING_WEIGHT * error + _OMEGA_WEIGHT * ends.peak_omega
    points = np.where(ends.arrived, points, game.penalty)
    distance = np.hypot(goals.x - starts.x, goals.y - starts.y)
    rows = []
    for k, case in enumerate(game.cases):
        note = ""
        if not ends.arrived[0, k]:
            note = "not reached"
        elif _tipped(points[:, k], ends.time[:, k], game.dt):
            note = "hangs on rounding"
        values = distance[k], ends.time[0, k], error[0, k], ends.peak_omega[0, k]
        counted = game.penalty if note else points[0, k]
        rows.append(CaseScore(case.kind, *map(float, (*values, counted)), note))
    total = round(math.fsum(row.points for row in rows) / len(rows), 2)
    return Score(total, tuple(rows), gains, game)


def drive_cases(gains: Gains, game: Challenge | None = None) -> tuple[Trajectory, ...]:
    """The runs that `score` counts, one for each case."""
    game, gains = _game(game), rounded(gains)
    return tuple(simulate(case.start, case.goal, gains, **game.limits) for case in game.cases)


def _whole(seed: int) -> int:
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed < 2**63:
        raise ValueError(
            f"seed = {seed!r} is not allowed: a whole number from 0 to 2^63 - 1 is needed"
        )
    return int(seed)


def _tipped(points: np.ndarray, time: np.ndarray, dt: float) -> bool:
    """Whether one of the four that started a micrometre aside ended otherwise than the first."""
    other_points = np.any(np.abs(points - points[0]) > _TIPPED)
    return bool(other_points or np.any(np.abs(time - time[0]) > 1.5 * dt))


def _game(game: Challenge | None) -> Challenge:
    return from_seed() if game is None else instance("game", game, Challenge)


@lru_cache(maxsize=64)
def _drawn(seed: int) -> Challenge:
    raw = np.random.PCG64(np.random.SeedSequence(seed)).random_raw(7 * len(_KINDS))
    rows = ((raw >> np.uint64(11)) * 2.0**-53).reshape(-1, 7).tolist()
    return Challenge(seed, tuple(map(_case, _KINDS, rows)))


def _case(kind: tuple[str, float, float, float, float], draws: list[float]) -> Case:
    name, near, far, least, most = kind
    r0, r1, r2, r3, r4, r5, r6 = draws
    x, y = round(40.0 * r0 - 20.0, 2), round(40.0 * r1 - 20.0, 2)
    heading_deg = round(360.0 * r2 - 180.0, 1)
    distance = near + (far - near) * r3
    sight_deg = heading_deg + math.copysign(least + (most - least) * r4, 0.5 - r5)
    sight = math.radians(sight_deg)
    goal_x = round(x + distance * math.cos(sight), 2)
    goal_y = round(y + distance * math.sin(sight), 2)
    goal_deg = round((sight_deg - (300.0 * r6 - 150.0) + 180.0) % 360.0 - 180.0, 1)
    start = Pose(x, y, math.radians(heading_deg))
    return Case(name, start, Pose(goal_x, goal_y, math.radians(goal_deg)))
