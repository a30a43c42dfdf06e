"""Many drives of a simulated robot, in compiled code: by the functions and the table of a `Drive`.

numba compiles them as they are, with a record of numpy in the place of the `Memory`.
"""

from __future__ import annotations

import math
from functools import reduce
from typing import Any, NamedTuple, get_origin, get_type_hints

import numpy as np

from wmrlib.body import LastTurn, Wheels, at_rest, roll
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import wrap
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.laws import CORRECTED
from wmrlib.motion import arc_step, polar_from_pose, wheel_speeds
from wmrlib.receiver import (
    BEFORE_THE_FIRST_FIX,
    Receiver,
    SampledReceiver,
    in_samples,
    key_of,
    normals,
    received,
)
from wmrlib.runs import sample_count
from wmrrobot import monitor, odometry, sensing
from wmrrobot.drive import REASONS, TABLE, Row, aim
from wmrrobot.monitor import PARKED, STATES, Memory, Rules, Seen
from wmrrobot.steering import commanded

SCATTER = 6.0  # the stream of random numbers by which headings scatter: a receiver has those before


class Plan(NamedTuple):
    """All that a drive is told; m, s, rad."""

    goal: Pose
    gains: Gains
    wheels: Wheels
    end: LastTurn
    rules: Rules


class Sensors(NamedTuple):
    """The period of the loop [s], the scatter of the compass [rad], and what a `Seen` has too."""

    period: float
    scatter: float
    antenna_ahead: float
    antenna_left: float
    quality: int
    error: float


def _record_of(kind: type) -> np.dtype:
    """The numpy record with the fields of a dataclass, for compiled code."""
    plain: dict[Any, Any] = {float: "f8", int: "i8"}
    fields: list[tuple] = []
    for name, hint in get_type_hints(kind).items():
        if get_origin(hint):
            fields.append((name, _record_of(odometry.Stretch), (odometry.PAST,)))
        else:
            fields.append((name, plain.get(hint) or _record_of(hint)))
    return np.dtype((np.record, fields))


_MEMORY = _record_of(Memory)


def _before(rest, row: Row):
    """The decisions of the table from this row on, of which `rest` makes the later ones."""
    states = [STATES.index(name) for name in row.within.split()]
    first, last = min(states), max(states)
    condition, to, reason = formula(row.condition), STATES.index(row.to), REASONS.index(row.reason)

    @formula
    def decide(m, seen, rules, end):
        if first <= m.state <= last and condition(m, seen, rules, end):
            m.state, m.reason = to, reason
        else:
            rest(m, seen, rules, end)

    return decide


@formula
def _as_it_was(m, seen, rules, end):
    """No row of the table fits."""


decide = reduce(_before, reversed(TABLE), _as_it_was)


@compiled
def trial(m, record, heading, plan, real, sensors, receiver):
    """Drive from (0, 0) until the robot stands, parked or stopped: (parked, x, y, heading, time).

    `record` has room for the antenna's place and the heading in each period. `real` are the wheels
    that follow the commands, and a SampledReceiver is the `receiver`.
    """
    goal, gains, wheels, end, rules = plan
    dt, scatter, ahead, left, quality, error = sensors
    place = goal.x, goal.y, goal.heading
    x, y, heading = 0.0, 0.0, wrap(heading)
    body, rolled, reception = (0.0, 0.0, 0.0, 0.0), (0.0, 0.0), BEFORE_THE_FIRST_FIX
    for k in range(record.shape[1]):
        record[0, k], record[1, k] = sensing.antenna(x, y, heading, ahead, left)
        record[2, k] = heading
        before, reception = reception.fix, received(reception, record, k, receiver)
        fix, fresh = int(reception.fix), int(reception.fix > before)
        shaken = scatter * normals(receiver.run, fix, SCATTER, receiver.key)[0] if fresh else 0.0
        seen = Seen(
            dt,
            rolled[0],
            rolled[1],
            math.inf,
            1,
            1,
            fresh,
            reception.x,
            reception.y,
            wrap(record[2, fix] + reception.compass + shaken),
            ahead,
            left,
            quality,
            error,
            dt * (fix - before),
            dt * (k - fix),
        )
        monitor.observe(m, seen, rules, wheels)
        rho, alpha, theta = polar_from_pose(m.pose.x, m.pose.y, m.pose.heading, *place)
        aim(m, seen, rho, alpha, theta, end)
        decide(m, seen, rules, end)
        speeds = commanded(m, rho, alpha, theta, gains, CORRECTED, wheels, end)
        m.left.commanded, m.right.commanded = speeds
        if m.state >= PARKED and at_rest(body):
            return m.state == PARKED, x, y, heading, k * dt
        v, omega = 0.5 * (speeds[0] + speeds[1]), (speeds[1] - speeds[0]) / wheels.track_width
        v, omega, body = roll(v, omega, body, real, dt)
        rolled = wheel_speeds(dt * v, dt * omega, wheels.track_width)
        x, y, heading = arc_step(x, y, heading, v, omega, dt)
    return False, x, y, heading, math.inf


class Ends(NamedTuple):
    """The ends of many drives: m, rad, s; those that have not parked in time stand somewhere."""

    parked: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    time: np.ndarray


def ends_of(
    headings: np.ndarray,
    plan: Plan,
    lag: float,
    sensors: Sensors,
    receiver: Receiver,
    duration: float,
    seed: int,
) -> Ends:
    """Drive once with each of these first headings and with errors of its own; the wheels `lag`."""
    samples, key = sample_count(sensors.period, duration), key_of(seed)
    fields = in_samples(np.array([receiver]).T, sensors.period, samples)[:, 0].tolist()
    record, rows, real = np.empty((3, samples)), [], plan.wheels._replace(lag=lag)
    for run, heading in enumerate(headings):
        memory = np.zeros((), _MEMORY)[()]
        sensor = SampledReceiver._make((*fields, run, key))
        rows.append(trial(memory, record, heading, plan, real, sensors, sensor))
    return Ends(*map(np.array, zip(*rows, strict=True)))
