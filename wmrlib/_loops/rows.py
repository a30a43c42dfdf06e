"""The rows and codes that the compiled loops share, and how a run is read and summed up."""

from __future__ import annotations

import math

from wmrlib._compile import compiled, formula

# How a run ends, in the order of `Outcome`; the last is a sweep's that ran out of steps.
ARRIVED, TIMED_OUT, DIVERGED, COMPLETED, UNFINISHED = range(5)
X, Y, HEADING, RHO, ALPHA, THETA, V, OMEGA, LYAPUNOV = range(9)  # the rows of a recorded run
GOAL_V, GOAL_OMEGA = 3, 4  # the rows of a reference after X, Y and HEADING
# What many runs, one a column, amount to, in the order of `Arrival`.
OUTCOME, TIME, HEADING_ERROR, PEAK_OMEGA, PATH_LENGTH, DISTANCE = range(6)


@formula
def run_of(runs, i):
    """The start, the goal and the gains of the run in column i."""
    x, y, heading, goal_x, goal_y, goal_heading, k_rho, k_alpha, h, v_max = runs[:, i]
    return (x, y, heading), (goal_x, goal_y, goal_heading), (k_rho, k_alpha, h, v_max)


@formula
def write(record, k, pose, seen, v, omega):
    """Write down a sample, one number at a time: to set a column at once takes long to compile."""
    record[X, k], record[Y, k], record[HEADING, k] = pose
    record[RHO, k], record[ALPHA, k], record[THETA, k] = seen
    record[V, k], record[OMEGA, k] = v, omega


@formula
def summarise(summary, i, outcome, time, heading_error, peak_omega, path_length, distance):
    """Write down what run i amounts to; who does not arrive takes forever."""
    time = time if outcome == ARRIVED else math.inf
    sums = float(outcome), time, heading_error, peak_omega, path_length, distance
    for row, value in enumerate(sums):
        summary[row, i] = value


@compiled
def sit(seats, i, states, k):
    """Seat the run of column k in place i."""
    for row in range(states.shape[0]):
        seats[row, i] = states[row, k]


@compiled
def exchange(states, seats, inside, width, waiting, left):
    """Write down the runs with nothing `left`, and seat others: how many sit, and who is next."""
    i = 0
    while i < width:
        if seats[left, i] <= 0.0:
            width -= 1
            sit(states, inside[i], seats[: states.shape[0]], i)
            sit(seats, i, seats[: states.shape[0]], width)
            inside[i] = inside[width]
        else:
            i += 1
    while width < seats.shape[1] and waiting < states.shape[1]:
        inside[width] = waiting
        sit(seats, width, states, waiting)
        width, waiting = width + 1, waiting + 1
    return width, waiting
