"""The rows and codes that the compiled loops share, and how a run is read and summed up."""

from __future__ import annotations

import math

from wmrlib._compile import formula
from wmrlib.gains import GainsFields

# How a run ends, in the order of `Outcome`; the last is a sweep's that ran out of steps.
ARRIVED, TIMED_OUT, DIVERGED, COMPLETED, UNFINISHED = range(5)
X, Y, HEADING, RHO, ALPHA, THETA, V, OMEGA, LYAPUNOV = range(9)  # the rows of a recorded run
GOAL_V, GOAL_OMEGA = 3, 4  # the rows of a reference after X, Y and HEADING
# Many runs, one a column: what each is given, and what it amounts to (in the order of `Arrival`).
START_X, START_Y, START_HEADING, GOAL_X, GOAL_Y, GOAL_HEADING, K_RHO, K_ALPHA, H, V_MAX = range(10)
OUTCOME, TIME, HEADING_ERROR, PEAK_OMEGA, PATH_LENGTH, DISTANCE = range(6)


@formula
def run_of(runs, i):
    """The start, the goal and the gains of run i."""
    start = runs[START_X, i], runs[START_Y, i], runs[START_HEADING, i]
    goal = runs[GOAL_X, i], runs[GOAL_Y, i], runs[GOAL_HEADING, i]
    return start, goal, GainsFields(runs[K_RHO, i], runs[K_ALPHA, i], runs[H, i], runs[V_MAX, i])


@formula
def summarise(summary, i, outcome, time, heading_error, peak_omega, path_length, distance):
    """Write down what run i amounts to; who does not arrive takes forever."""
    summary[OUTCOME, i] = outcome
    summary[TIME, i] = time if outcome == ARRIVED else math.inf
    summary[HEADING_ERROR, i] = heading_error
    summary[PEAK_OMEGA, i] = peak_omega
    summary[PATH_LENGTH, i] = path_length
    summary[DISTANCE, i] = distance
