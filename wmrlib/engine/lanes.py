"""The lanes in which runs are computed side by side, and the law in them.

A loop computes many runs at once, each in its lane, because a processor takes four or eight numbers
with one instruction. Runs end at different times: one that has ended gives its lane to the next.
"""

from __future__ import annotations

from wmrlib import laws
from wmrlib.compilation import chosen_by_type, compiled, formula
from wmrlib.engine.vectors import vectorised


def law_tuple(law: int) -> tuple[int, ...]:
    """The number of a law as the length of a tuple.

    A tuple's length is part of its type, so numba knows the law when it compiles, and each law has
    a loop of its own. With all five in one loop, sweeps of the corrected law take 1.3 times as long
    by Euler's steps and 1.5 times in continuous time: a lane has to compute all of them.
    """
    return (0,) * law


def pose_law(rho, alpha, theta, gains, law):
    """(v/rho, omega) of a pose law, which is given by `law_tuple`.

    Compiled loops have the formula of this law alone: with `laws.pose_law` numba would compile all
    of them, in 0.4 s, for LLVM to remove all but one.
    """
    return _formula(law)(rho, alpha, theta, gains)


@chosen_by_type(pose_law)
def _(rho, alpha, theta, gains, law):
    chosen = _formula(law)
    return lambda rho, alpha, theta, gains, law: chosen(rho, alpha, theta, gains)


def _formula(law):
    """The formula of a law, given by `law_tuple` or by numba's type of that."""
    return vectorised([*laws.LAWS.values()][len(law)].formula)


@formula
def steered(polar, gains, law, limits):
    """(v/rho, omega) under a pose law and the limits of the wheels."""
    v_over_rho, omega = pose_law(polar[0], polar[1], polar[2], gains, law)
    share = laws.saturation_scale(v_over_rho * polar[0], omega, limits)
    return share * v_over_rho, share * omega


@formula
def copy_column(target, i, source, k):
    """Copy column k of the source into column i of the target."""
    for row in range(source.shape[0]):
        target[row, i] = source[row, k]


@compiled
def refill_lanes(states, lanes, inside, counts, left, over):
    """Replace each run that has ended by one that waits; return the number of lanes in use.

    A run has ended when its row `left` has come down to `over`. `inside` holds the number of the
    run in each lane. `counts` holds the number of lanes in use, which are the first ones, and the
    number of runs that have begun.
    """
    i = 0
    while i < counts[0]:
        if lanes[left, i] <= over:
            counts[0] -= 1
            copy_column(states, inside[i], lanes, i)
            copy_column(lanes, i, lanes, counts[0])
            inside[i] = inside[counts[0]]
        else:
            i += 1
    while counts[0] < lanes.shape[1] and counts[1] < states.shape[1]:
        inside[counts[0]] = counts[1]
        copy_column(lanes, counts[0], states, counts[1])
        counts[0] += 1
        counts[1] += 1
    return counts[0]
