"""The tuning challenge: a game for a class. Everyone gets the same starts and goals; who finds the gains with the fewest points?

The points of a case are time [s] + 0.5 |heading error at arrival| [deg] + 4 peak |omega| [rad/s], the score is their mean over the
cases, and less is better. The corrected law drives, its command held for dt as on a real robot (method "arc"), under wheel limits.
A case that is not reached costs `Challenge.penalty`, which is what the worst possible arrival would.

The score follows from the gains alone, on every machine: they count with 3 decimals, it has 2. Computers differ in their last digits,
and an unstable run makes such a difference large. So each case is driven five times, as it is and from a micrometre further east, west,
north and south, which is millions of times what rounding does: if one of them arrives more than one dt earlier or later, or with points
that differ by more than 1, the case hangs on rounding and counts as not reached. What remains is luck: a mean within about 1e-8 of the
edge between two roundings may be shown as either of both, and of a chaotic run all five may end alike.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from wmrlib._checks import instance, scalar
from wmrlib.gains import Gains, WheelLimits, checked_wheels
from wmrlib.kinematics import Pose
from wmrlib.runs import Trajectory, sample_count, single_pose
from wmrlib.simulation import simulate
from wmrlib.sweeping import sweep

__all__ = [
    "SEED",
    "Case",
    "CaseScore",
    "Challenge",
    "Score",
    "drive",
    "from_seed",
    "rounded",
    "score",
]

SEED = 2026
"""The seed of the published challenge."""
_HEADING_WEIGHT, _OMEGA_WEIGHT = 0.5, 4.0  # points a degree, points a rad/s
_ASIDE, _TIPPED = 1e-6, 1.0  # m, points
_WHEELS = WheelLimits(track_width=0.5, max_speed=2.0)  # m, m/s
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

    seed: from which `from_seed` drew it; cases: tuple of Case, each a text and two single poses; wheels: WheelLimits with a finite speed;
    dt: s, for which a command is held; arrival_radius: m; duration: s, within which the goal has to be reached. Raises ValueError for
    anything else.
    """

    seed: int
    cases: tuple[Case, ...]
    wheels: WheelLimits = _WHEELS
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
        scalar(
            "wheels.max_speed",
            checked_wheels(instance("wheels", self.wheels, WheelLimits)).max_speed,
        )
        sample_count(self.dt, self.duration)
        scalar("arrival_radius", self.arrival_radius, low=0.0)

    def __repr__(self) -> str:
        head = f"<Challenge: seed {self.seed}, {len(self.cases)} cases, wheels up to {self.wheels.max_speed:g} m/s, {self.duration:g} s each>"
        rows = [
            f"{'case':>4}  {'kind':<16}{'start: x, y [m], heading [deg]':>32}{'goal: x, y [m], heading [deg]':>32}"
        ]
        for k, case in enumerate(self.cases, start=1):
            start, goal = (
                f"{pose.x:9.2f}{pose.y:9.2f}{math.degrees(pose.heading):9.1f}" for pose in case[1:]
            )
            rows.append(f"{k:>4}  {case.kind:<16}{start:>32}{goal:>32}")
        return "\n".join([head, *rows])

    @property
    def penalty(self) -> float:
        """The points of a case that is not reached: the whole duration, a heading error of 180 deg and the fastest turn of the wheels."""
        fastest_turn = 2.0 * self.wheels.max_speed / self.wheels.track_width  # rad/s, on the spot
        return self.duration + _HEADING_WEIGHT * 180.0 + _OMEGA_WEIGHT * fastest_turn


class CaseScore(NamedTuple):
    """A case's row: kind; distance: m, from start to goal; time: s, infinite if the goal was not reached; heading_error_deg: |heading -
    goal.heading| at the end; peak_omega: rad/s; points; note: why the penalty was given, or nothing.
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
    """What gains are worth: total, the mean of the cases' points with 2 decimals, less is better; cases: tuple of CaseScore; gains: as
    they counted, with 3 decimals; game: the Challenge.
    """

    total: float
    cases: tuple[CaseScore, ...]
    gains: Gains
    game: Challenge

    def __repr__(self) -> str:
        gains = ", ".join(f"{name} {value:g}" for name, value in self.gains._asdict().items())
        rows = [
            f"<Score: {self.total:.2f} points, {self.reached} of {len(self.cases)} reached; {gains}; seed {self.game.seed}>"
        ]
        rows.append(
            f"{'case':>4}  {'kind':<16}{'distance [m]':>13}{'time [s]':>10}{'heading [deg]':>15}{'omega [rad/s]':>15}{'points':>9}"
        )
        for k, (kind, distance, time, heading, omega, points, note) in enumerate(
            self.cases, start=1
        ):
            rows.append(
                f"{k:>4}  {kind:<16}{distance:13.1f}{time:10.1f}{heading:15.1f}{omega:15.2f}{points:9.2f}  {note}".rstrip()
            )
        return "\n".join(rows)

    @property
    def reached(self) -> int:
        """How many cases count as reached."""
        return sum(not case.note for case in self.cases)


def from_seed(seed: int = SEED) -> Challenge:
    """The challenge of a seed, a whole number from 0 to 2^63 - 1: twelve cases, the same on every machine and with every numpy.

    Seven numbers r0 to r6 in [0, 1) are drawn for each case, (k >> 11) 2^-53 with the raw 64-bit numbers k of PCG64(SeedSequence(seed)),
    whose stream numpy guarantees. start = (40 r0 - 20, 40 r1 - 20) m, heading 360 r2 - 180 deg; the goal's distance and |alpha| lie as
    far into the ranges of the case's kind as r3 and r4 say, to the left for r5 < 1/2; the goal's theta is 300 r6 - 150 deg. Positions are
    then rounded to a centimetre and headings to 0.1 deg. "straight behind" stays 5 deg off, where left and right are no matter of
    rounding. Raises ValueError for anything but such a number.
    """
    return _drawn(_whole(seed))


def rounded(gains: Gains) -> Gains:
    """The gains as they count: single numbers with 3 decimals. Raises ValueError for arrays, or a v_max that rounds to 0."""
    fields = instance("gains", gains, Gains)._asdict()
    return Gains(
        *(round(scalar(name, value), 3) + 0.0 for name, value in fields.items())
    )  # 0.0, where -0.0 would be another text


def score(gains: Gains, game: Challenge | None = None) -> Score:
    """What the gains are worth in the challenge (the published one for None); see the module for the formula. Takes milliseconds.

    Raises ValueError for anything but Gains of single numbers, or another type of game.
    """
    game, gains = _game(game), rounded(gains)
    x, y, heading = (
        np.array(column) for column in zip(*(case.start for case in game.cases), strict=True)
    )
    starts = Pose(
        x + _ASIDE * np.array([[0], [1], [-1], [0], [0]]),
        y + _ASIDE * np.array([[0], [0], [0], [1], [-1]]),
        heading,
    )
    goals = Pose(
        *(np.array(column) for column in zip(*(case.goal for case in game.cases), strict=True))
    )
    limits = {
        "dt": game.dt,
        "duration": game.duration,
        "arrival_radius": game.arrival_radius,
        "wheels": game.wheels,
    }
    ends = sweep(starts, goals, gains, method="arc", progress=False, **limits)
    error = np.abs(np.degrees(ends.heading_error))
    points = np.where(
        ends.arrived,
        ends.time + _HEADING_WEIGHT * error + _OMEGA_WEIGHT * ends.peak_omega,
        game.penalty,
    )
    distance = np.hypot(goals.x - x, goals.y - y)
    rows = []
    for k, case in enumerate(game.cases):
        note = (
            "not reached"
            if not ends.arrived[0, k]
            else "hangs on rounding"
            if _tipped(points[:, k], ends.time[:, k], game.dt)
            else ""
        )
        values = (
            distance[k],
            ends.time[0, k],
            error[0, k],
            ends.peak_omega[0, k],
            game.penalty if note else points[0, k],
        )
        rows.append(CaseScore(case.kind, *map(float, values), note))
    return Score(
        round(math.fsum(row.points for row in rows) / len(rows), 2), tuple(rows), gains, game
    )


def drive(gains: Gains, game: Challenge | None = None) -> tuple[Trajectory, ...]:
    """The runs that `score` counts, one Trajectory a case, to look at. Raises ValueError as `score`."""
    game, gains = _game(game), rounded(gains)
    limits = {
        "dt": game.dt,
        "duration": game.duration,
        "arrival_radius": game.arrival_radius,
        "wheels": game.wheels,
    }
    return tuple(simulate(case.start, case.goal, gains, **limits) for case in game.cases)


def _whole(seed: int) -> int:
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed < 2**63:
        raise ValueError(
            f"seed = {seed!r} is not allowed: a whole number from 0 to 2^63 - 1 is needed"
        )
    return int(seed)


def _tipped(points: np.ndarray, time: np.ndarray, dt: float) -> bool:
    """Whether one of the four that started a micrometre aside ended otherwise than the first."""
    return bool(
        np.any(np.abs(points - points[0]) > _TIPPED) or np.any(np.abs(time - time[0]) > 1.5 * dt)
    )


def _game(game: Challenge | None) -> Challenge:
    return from_seed() if game is None else instance("game", game, Challenge)


@lru_cache(maxsize=64)
def _drawn(seed: int) -> Challenge:
    raw = np.random.PCG64(np.random.SeedSequence(seed)).random_raw(7 * len(_KINDS))
    rows = ((raw >> np.uint64(11)) * 2.0**-53).reshape(-1, 7).tolist()
    return Challenge(
        seed, tuple(_case(*kind, *row) for kind, row in zip(_KINDS, rows, strict=True))
    )


def _case(kind: str, near: float, far: float, least: float, most: float, *draws: float) -> Case:
    r0, r1, r2, r3, r4, r5, r6 = draws
    x, y, heading_deg = (
        round(40.0 * r0 - 20.0, 2),
        round(40.0 * r1 - 20.0, 2),
        round(360.0 * r2 - 180.0, 1),
    )
    distance, alpha_deg = (
        near + (far - near) * r3,
        math.copysign(least + (most - least) * r4, 0.5 - r5),
    )
    sight_deg = heading_deg + alpha_deg
    goal_x, goal_y = (
        x + distance * math.cos(math.radians(sight_deg)),
        y + distance * math.sin(math.radians(sight_deg)),
    )
    goal_deg = round((sight_deg - (300.0 * r6 - 150.0) + 180.0) % 360.0 - 180.0, 1)
    return Case(
        kind,
        Pose(x, y, math.radians(heading_deg)),
        Pose(round(goal_x, 2), round(goal_y, 2), math.radians(goal_deg)),
    )
