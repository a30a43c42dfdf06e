"""The rows of runs, one a column, and how they take turns in the lanes of a loop."""

from __future__ import annotations

import math

from wmrlib import body, laws
from wmrlib.compilation import compiled, formula
from wmrlib.engine.vectors import vectorised
from wmrlib.runs import ARRIVED

# What many runs, one a column, amount to, in the order of `Arrival`.
OUTCOME, TIME, HEADING_ERROR, PEAK_OMEGA, PATH_LENGTH, DISTANCE = range(6)


_pose_law, _hurry = vectorised(laws.pose_law), vectorised(body.hurry)


def as_type(law: int) -> tuple[int, ...]:
    """A law as the loops take it: by the length of a tuple, which numba knows when it compiles.

    So each law has a loop of its own, compiled when it is wanted. With all five in one loop,
    sweeps of the corrected law take 1.3 times as long by Euler's steps, and 1.5 in continuous time.
    """
    return (0,) * law


@formula
def steered(polar, gains, law, wheels):
    """(v/rho, omega) under a pose law and the limits of the wheels."""
    v_over_rho, omega = _pose_law(polar[0], polar[1], polar[2], gains, len(law))
    more = _hurry(v_over_rho * polar[0], polar[1], wheels.min_speed)
    v_over_rho, omega = more * v_over_rho, more * omega
    share = laws.saturation_scale(v_over_rho * polar[0], omega, wheels)
    return share * v_over_rho, share * omega


@formula
def run_of(runs, i):
    """The start, the goal and the gains of the run in column i."""
    x, y, heading, goal_x, goal_y, goal_heading, k_rho, k_alpha, h, v_max = runs[:, i]
    return (x, y, heading), (goal_x, goal_y, goal_heading), (k_rho, k_alpha, h, v_max)


@formula
def summarise(summary, i, outcome, time, heading_error, peak_omega, path_length, distance):
    """Write down what run i amounts to; who does not arrive takes forever."""
    time = time if outcome == ARRIVED else math.inf
    sums = float(outcome), time, heading_error, peak_omega, path_length, distance
    for row, value in enumerate(sums):
        summary[row, i] = value


@compiled
def copy_column(target, i, source, k):
    """Copy column k into column i, as far down as both go."""
    for row in range(min(target.shape[0], source.shape[0])):
        target[row, i] = source[row, k]


@compiled
def refill_lanes(states, lanes, inside, width, waiting, left, over=0.0):
    """Put back the runs with nothing `left`, and take others in: how many are in, who is next.

    Nothing is `over` or less: where 0 has a last sample to come, less than 0.
    """
    i = 0
    while i < width:
        if lanes[left, i] <= over:
            width -= 1
            copy_column(states, inside[i], lanes, i)
            copy_column(lanes, i, lanes, width)
            inside[i] = inside[width]
        else:
            i += 1
    while width < lanes.shape[1] and waiting < states.shape[1]:
        inside[width] = waiting
        copy_column(lanes, width, states, waiting)
        width, waiting = width + 1, waiting + 1
    return width, waiting
