"""A drive that parks: a law, a last turn, and a table that says when the robot may move.

`TABLE` holds every decision. Python runs it here, and `symbolic` prints it as ``wmr_drive.h``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from wmrlib import trust
from wmrlib._checks import choice, instance, refusal, scalar
from wmrlib._elementary import wrap
from wmrlib.body import LastTurn, Wheels, checked_wheels, hurry, sound_turn, turn_rate
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.laws import LAWS, saturation_scale
from wmrlib.motion import polar_from_pose, wheel_speeds
from wmrlib.trust import DRIVE, STATES, TURN, Memory, Rules, Seen


class Row(NamedTuple):
    """In one of the states `within`, where `condition` holds, go `to` a state; the reason why."""

    within: str
    condition: str
    to: str
    reason: str = ""


_GOING, _SILENT = "wait drive turn", "m.silence > rules.patience"
_KNOWN = "(m.good >= rules.settle or m.driven > 0.0)"
TABLE = (
    Row(_GOING, "m.low > rules.patience", "stopped", "battery low"),
    Row(_GOING, "seen.goal_inside == 0", "stopped", "goal outside the fence"),
    Row(_GOING, f"{_KNOWN} and m.outside != 0", "stopped", "robot outside the fence"),
    Row(_GOING, f"{_KNOWN} and m.rho > rules.farthest", "stopped", "goal too far"),
    Row(_GOING, "m.left.stuck != 0 or m.right.stuck != 0", "stopped", "wheel or encoder stuck"),
    Row(_GOING, "m.left.loose != 0 or m.right.loose != 0", "stopped", "wheel turns untold"),
    Row(_GOING, "m.turned >= rules.settle", "stopped", "heading disagrees with wheels"),
    Row(_GOING, "m.slipping != 0", "stopped", "wheels turn and robot stands"),
    Row(_GOING, "m.astray != 0", "stopped", "heading disagrees with course"),
    Row(_GOING, "m.driven > rules.longest_drive", "stopped", "drive too long"),
    Row(_GOING, "m.regular == 0", "wait", "clock jumped"),
    Row(_GOING, f"{_SILENT} and m.refused == BROKEN", "wait", "fix is no number"),
    Row(_GOING, f"{_SILENT} and m.refused == POOR", "wait", "fix of too low quality"),
    Row(_GOING, f"{_SILENT} and m.refused == LATE", "wait", "fix too old"),
    Row(_GOING, f"{_SILENT} and m.refused == STALE", "wait", "fix time stands or goes back"),
    Row(_GOING, f"{_SILENT} and m.refused == FROZEN", "wait", "position frozen"),
    Row(_GOING, f"{_SILENT} and m.refused == JUMPED", "wait", "position jumped"),
    Row(_GOING, _SILENT, "wait", "no fix"),
    Row("wait", "m.good >= rules.settle", "drive"),
    Row("drive", "m.rho <= rules.arrival_radius and end.tolerance > 0.0", "turn"),
    Row("drive", "m.rho <= rules.arrival_radius", "parked"),
    Row("turn", "m.rho > end.leave * rules.arrival_radius", "drive"),
    Row("turn", "m.facing >= rules.settle and m.faced >= end.settle", "parked"),
)
"""Every decision, in the order of priority: the first row that fits is taken, if one does."""
REASONS = tuple(dict.fromkeys(["", *(row.reason for row in TABLE)]))


_PLACES = "m", "seen", "rules", "end"
_TEXT = "lambda {}: {}"
_ROWS: list[tuple[set[int], Callable, int, int]] = [
    (
        {STATES.index(state) for state in row.within.split()},
        eval(_TEXT.format(", ".join(_PLACES), row.condition), vars(trust)),
        STATES.index(row.to),
        REASONS.index(row.reason),
    )
    for row in TABLE
]


def decide(m: Memory, seen: Seen, rules: Rules, end: LastTurn) -> None:
    """Take the first row of `TABLE` that fits."""
    for within, condition, to, reason in _ROWS:
        if m.state in within and condition(m, seen, rules, end):
            m.state, m.reason = to, reason
            return


class Drive:
    """One drive to a goal: give `step` what the sensors say in each period, and obey it.

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
    >>> goal, wheels = wmr.Pose(3.0, 0.0, math.pi / 2), wmr.Wheels(0.5, max_speed=1.0)
    >>> drive = wmr.Drive(goal, wmr.GENTLE_GAINS, wheels)
    >>> pose, left, right = wmr.Pose(0.0, 0.0, 0.0), 0.0, 0.0
    >>> while drive.state != "parked":
    ...     seen = wmr.Seen(0.05, 0.05 * left, 0.05 * right, fresh=1, **pose._asdict())
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
        self.law = choice("law", law, [name for name, row in LAWS.items() if row.gains is Gains])
        self.end = LastTurn(tolerance=0.0)
        if last_turn is not None:
            self.end = sound_turn(last_turn, self.rules.longest_period)
            least = 2.0 * self.wheels.dead_band / self.wheels.track_width
            if self.end.min_rate <= least:
                needed = f"more than {least:g}, the dead band's,"
                raise refusal("last_turn.min_rate", self.end.min_rate, needed)
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
        """Why it waits or has stopped; empty otherwise."""
        return REASONS[self.memory.reason]

    def step(self, seen: Seen) -> tuple[float, float]:
        """The speeds of the left and the right wheel [m/s] for the next period."""
        m, end, v, omega = self.memory, self.end, 0.0, 0.0
        trust.look(m, seen, self.rules, self.wheels)
        state = polar_from_pose(m.pose.x, m.pose.y, m.pose.heading, *self.goal)
        m.rho, m.off = state[0], wrap(state[1] - state[2])
        faces = m.state == TURN and abs(m.off) <= end.tolerance
        m.facing, m.faced = (m.facing + 1, m.faced + seen.seconds) if faces else (0, 0.0)
        decide(m, seen, self.rules, end)
        if m.state == DRIVE:
            v_over_rho, omega = LAWS[self.law].formula(*state, self.gains)
            more = hurry(v_over_rho * m.rho, state[1], self.wheels.min_speed)
            v, omega = v_over_rho * m.rho * more, omega * more
        elif m.state == TURN and abs(m.off) > end.tolerance:
            omega = turn_rate(m.off, end.gain, end.min_rate, end.max_rate)
        scale = saturation_scale(v, omega, self.wheels)
        speeds = wheel_speeds(v * scale, omega * scale, self.wheels.track_width)
        m.left.told, m.right.told = speeds
        return speeds
