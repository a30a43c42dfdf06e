"""A drive that parks: a law, a last turn, and a table that says when the robot may move.

`TABLE` holds every decision, by the conditions above it. Python runs them here, and `printing`
prints them as part of ``wmr_drive.h``, so they are written in the Python that C has too.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from wmrlib.body import LastTurn, Wheels, checked_wheels, sound_turn
from wmrlib.checks import choice, instance, refusal, scalar
from wmrlib.compilation import formula
from wmrlib.elementary import wrap
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.laws import POSE_LAWS
from wmrlib.motion import polar_from_pose
from wmrrobot import monitor
from wmrrobot.monitor import (
    BROKEN,
    FROZEN,
    JUMPED,
    LATE,
    POOR,
    STALE,
    STATES,
    TURN,
    Memory,
    Rules,
    Seen,
)
from wmrrobot.steering import commanded


@formula
def placed(m: Memory, rules: Rules) -> int:
    """Whether there were enough good fixes to know the pose."""
    return m.good >= rules.settle or m.driven > 0.0


@formula
def outside(m: Memory, rules: Rules) -> int:
    """Whether the robot is outside its fence."""
    return placed(m, rules) and m.outside != 0


@formula
def too_far(m: Memory, rules: Rules) -> int:
    """Whether the goal is too far away to be intended."""
    return placed(m, rules) and m.rho > rules.farthest


@formula
def stuck(m: Memory) -> int:
    """Whether a wheel, or its encoder, stands although it was commanded to roll."""
    return m.left.stuck != 0 or m.right.stuck != 0


@formula
def loose(m: Memory) -> int:
    """Whether a wheel rolls although it was not commanded to."""
    return m.left.loose != 0 or m.right.loose != 0


@formula
def turned(m: Memory, rules: Rules) -> int:
    """Whether several fixes in a row have another heading than the wheels."""
    return m.turned >= rules.settle


@formula
def silent(m: Memory, rules: Rules) -> int:
    """Whether the last usable fix is too long ago."""
    return m.silence > rules.patience


@formula
def silent_by(m: Memory, rules: Rules, reason: int) -> int:
    """Whether it is, and the last fix was refused for this reason."""
    return silent(m, rules) and m.refused == reason


@formula
def aim(m: Memory, seen: Seen, rho: float, alpha: float, theta: float, end: LastTurn) -> None:
    """Note where the goal is, and how long the last turn has been within its tolerance."""
    m.rho, m.remaining_turn = rho, wrap(alpha - theta)
    faces = m.state == TURN and abs(m.remaining_turn) <= end.tolerance
    m.facing = m.facing + 1 if faces else 0
    m.faced = m.faced + seen.seconds if faces else 0.0


class Row(NamedTuple):
    """In one of the states `within`, where `condition` holds, go `to` a state; the reason why.

    A condition asks the memory m, the sensors s, the rules r and the last turn e. `printing` prints
    its source for C.
    """

    within: str
    condition: Callable[[Memory, Seen, Rules, LastTurn], int]
    to: str
    reason: str = ""


_GOING = "wait drive turn"
TABLE = (
    Row(_GOING, lambda m, s, r, e: m.low > r.patience, "stopped", "battery low"),
    Row(_GOING, lambda m, s, r, e: s.goal_inside == 0, "stopped", "goal outside the fence"),
    Row(_GOING, lambda m, s, r, e: outside(m, r), "stopped", "robot outside the fence"),
    Row(_GOING, lambda m, s, r, e: too_far(m, r), "stopped", "goal too far"),
    Row(_GOING, lambda m, s, r, e: stuck(m), "stopped", "wheel or encoder stuck"),
    Row(_GOING, lambda m, s, r, e: loose(m), "stopped", "wheel turns untold"),
    Row(_GOING, lambda m, s, r, e: turned(m, r), "stopped", "heading disagrees with wheels"),
    Row(_GOING, lambda m, s, r, e: m.slipping != 0, "stopped", "wheels turn and robot stands"),
    Row(_GOING, lambda m, s, r, e: m.astray != 0, "stopped", "heading disagrees with course"),
    Row(_GOING, lambda m, s, r, e: m.outran != 0, "stopped", "position outruns the wheels"),
    Row(_GOING, lambda m, s, r, e: m.driven > r.longest_drive, "stopped", "drive too long"),
    Row("wait", lambda m, s, r, e: m.waited > r.longest_wait, "stopped", "waited too long"),
    Row(_GOING, lambda m, s, r, e: m.regular == 0, "wait", "clock jumped"),
    Row(_GOING, lambda m, s, r, e: silent_by(m, r, BROKEN), "wait", "fix is no number"),
    Row(_GOING, lambda m, s, r, e: silent_by(m, r, POOR), "wait", "fix of too low quality"),
    Row(_GOING, lambda m, s, r, e: silent_by(m, r, LATE), "wait", "fix too old"),
    Row(_GOING, lambda m, s, r, e: silent_by(m, r, STALE), "wait", "fix time stands or goes back"),
    Row(_GOING, lambda m, s, r, e: silent_by(m, r, FROZEN), "wait", "position frozen"),
    Row(_GOING, lambda m, s, r, e: silent_by(m, r, JUMPED), "wait", "position jumped"),
    Row(_GOING, lambda m, s, r, e: silent(m, r), "wait", "no fix"),
    Row("wait", lambda m, s, r, e: m.good >= r.settle, "drive"),
    Row("wait", lambda m, s, r, e: m.good < r.settle, "wait", "too few good fixes"),
    Row("drive", lambda m, s, r, e: m.rho <= r.arrival_radius and e.tolerance > 0.0, "turn"),
    Row("drive", lambda m, s, r, e: m.rho <= r.arrival_radius, "parked"),
    Row("turn", lambda m, s, r, e: m.rho > e.leave * r.arrival_radius, "drive"),
    Row("turn", lambda m, s, r, e: m.facing >= r.settle and m.faced >= e.settle, "parked"),
)
"""Every decision, in the order of priority: the first row that fits is taken, if one does."""
REASONS = tuple(dict.fromkeys(["", *(row.reason for row in TABLE)]))


class Drive:
    """One drive to a goal: give `step` the readings of each period, and command its wheel speeds.

    Parameters
    ----------
    goal, gains, law : Pose, Gains, and a law of `control_law` with such gains
    wheels : Wheels. Limits of the commands; `acceleration` and `dead_band` also say how a wheel
        that is not stuck follows them.
    last_turn : LastTurn, or None if the robot parks as it arrives
    rules : Rules

    Raises
    ------
    ValueError : another type, an unknown law, or a last turn that is too slow for the dead band or
        whose gain swings in periods of `rules.longest_period`

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> import wmrrobot as wr
    >>> goal, wheels = wmr.Pose(3.0, 0.0, math.pi / 2), wmr.Wheels(0.5, max_speed=1.0)
    >>> drive = wr.Drive(goal, wmr.GENTLE_GAINS, wheels)
    >>> pose, left, right = wmr.Pose(0.0, 0.0, 0.0), 0.0, 0.0
    >>> while drive.state != "parked":
    ...     seen = wr.Seen(0.05, 0.05 * left, 0.05 * right, fresh=1, **pose._asdict())
    ...     left, right = drive.step(seen)
    ...     pose = wmr.advance(pose, *wmr.wheels_to_twist(left, right, 0.5), 0.05)
    >>> print(f"{pose.x:.2f} m, {pose.y:.2f} m, {math.degrees(pose.heading):.0f} deg")
    2.96 m, -0.20 m, 89 deg
    """

    def __init__(
        self,
        goal: Pose,
        gains: Gains,
        wheels: Wheels,
        last_turn: LastTurn | None = LastTurn(),  # noqa: B008 (it can't change)
        rules: Rules = Rules(),  # noqa: B008
        law: str = "corrected",
    ) -> None:
        self.goal = Pose(*map(float, instance("goal", goal, Pose)))
        fields = instance("gains", gains, Gains)._asdict()
        self.gains = Gains(*(scalar(f"gains.{name}", value) for name, value in fields.items()))
        self.wheels = checked_wheels(instance("wheels", wheels, Wheels))
        self.rules = instance("rules", rules, Rules)
        self.law = choice("law", law, POSE_LAWS)
        self.end = LastTurn(tolerance=0.0)
        if last_turn is not None:
            self.end = sound_turn(last_turn, self.rules.longest_period)
            least = 2.0 * self.wheels.dead_band / self.wheels.track_width
            if self.end.min_rate <= least:
                needed = f"more than {least:g}, the dead band's,"
                raise refusal("last_turn.min_rate", self.end.min_rate, needed)
        for name in "settle", "least":
            if (count := getattr(self.rules, name)) % 1:
                raise refusal(f"rules.{name}", count, "a whole number")
        if not monitor.rank(self.rules.least):
            raise refusal("rules.least", self.rules.least, "a quality from 1 to 5")
        self.reset()

    def reset(self) -> None:
        """Forget everything, as only a person may decide after a stop."""
        self.memory = Memory()

    @property
    def state(self) -> str:
        """One of "wait", "drive", "turn", "parked" and "stopped"."""
        return STATES[self.memory.state]

    @property
    def reason(self) -> str:
        """The reason why it waits or has stopped; empty otherwise."""
        return REASONS[self.memory.reason]

    def step(self, seen: Seen) -> tuple[float, float]:
        """The speeds of the left and the right wheel [m/s] for the next period."""
        m, end = self.memory, self.end
        monitor.observe(m, seen, self.rules, self.wheels)
        polar = polar_from_pose(m.pose.x, m.pose.y, m.pose.heading, *self.goal)
        aim(m, seen, *polar, end)
        self._decide(seen)
        speeds = commanded(m, *polar, self.gains, POSE_LAWS[self.law], self.wheels, end)
        m.left.commanded, m.right.commanded = speeds
        return speeds

    def _decide(self, seen: Seen) -> None:
        """Take the first row of `TABLE` that fits."""
        m = self.memory
        for row in TABLE:
            applies = STATES[m.state] in row.within.split()
            if applies and row.condition(m, seen, self.rules, self.end):
                m.state, m.reason = STATES.index(row.to), REASONS.index(row.reason)
                return
