"""Steps with error control for runs side by side in a block, each with its own length of step.

Dormand and Prince's method of order 8 with Hairer's estimate of its error (Hairer, Norsett and
Wanner, Solving Ordinary Differential Equations I, II.5). A state is (rho, alpha, theta, rolled),
with rolled signed as v is. A step may have to end on an event, and is tried again, shorter, until
it does: arrival, a change between forwards and backwards, and the largest |omega| so far.
"""

from __future__ import annotations

from functools import reduce

import numpy as np

from wmrlib._compile import formula
from wmrlib._loops import polar
from wmrlib._loops.polar import closed_loop

TOLERANCE = 1e-10  # of a step: rad, and a share of the distance
MOST_TRIALS = 100_000.0
SHARP = 1e-12  # so close to the arrival radius a run ends, as a share of it
_SLACK = 1e-8  # what an event may miss of the metres rolled and of the largest |omega|
_GLIMPSE = 1e-6  # share of a step by which the law is evaluated again for the rate of omega

# fmt: off
_STAGES = (
    (0.05260015195876773,),
    (0.0197250569845379, 0.0591751709536137),
    (0.02958758547680685, 0, 0.08876275643042054),
    (0.2413651341592667, 0, -0.8845494793282861, 0.924834003261792),
    (0.037037037037037035, 0, 0, 0.17082860872947386, 0.12546768756682242),
    (0.037109375, 0, 0, 0.17025221101954405, 0.06021653898045596, -0.017578125),
    (0.03709200011850479, 0, 0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
        0.008273789163814023),
    (0.6241109587160757, 0, 0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
        20.154067550477894, -43.48988418106996),
    (0.47766253643826434, 0, 0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
        15.279233632882423, -33.28821096898486, -0.020331201708508627),
    (-0.9371424300859873, 0, 0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
        -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196),
    (2.273310147516538, 0, 0, -10.53449546673725, -2.0008720582248625, -17.9589318631188,
        27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303,
        0.6433927460157636),
)
_WEIGHTS = (0.054293734116568765, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003,
        -5.801203960010585, 0.3111643669578199, -0.1521609496625161, 0.20136540080403034,
        0.04471061572777259)
_FIFTH = (0.01312004499419488, 0, 0, 0, 0, -1.2251564463762044, -0.4957589496572502,
        1.6643771824549864, -0.35032884874997366, 0.3341791187130175, 0.08192320648511571,
        -0.022355307863886294)
_THIRD = (-0.18980075407240762, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003,
        -5.801203960010585, -0.4226823213237919, -0.1521609496625161, 0.20136540080403034,
        0.02265179219836082)

# fmt: on


def _moving(weights):
    """A formula for the state moved by dt times the weighted sum of the slopes k.

    Written out, because LLVM does not vectorise a loop that holds another.
    """
    kept = [(place, weight) for place, weight in enumerate(weights) if weight]
    sums = (" + ".join(f"{w!r} * k[{j}][{row}]" for j, w in kept) for row in range(4))
    moved = ", ".join(f"state[{row}] + dt * ({total})" for row, total in enumerate(sums))
    return formula(eval(f"lambda state, dt, k: ({moved})"), cache=False)


def _with_stage(before, weights):
    """The slopes of the stages before, and of one more: the rates there, and omega."""
    to_stage = _moving(weights)

    def slopes(state, dt, loop):
        known = before(state, dt, loop)
        return (*known, closed_loop(to_stage(state, dt, known)[:3], loop))

    return formula(slopes, cache=False)


_first_slope = formula(lambda state, dt, loop: (closed_loop(state[:3], loop),), cache=False)
_slopes = reduce(_with_stage, _STAGES, _first_slope)
_to_end, _fifth, _third = map(_moving, (_WEIGHTS, _FIFTH, _THIRD))


@formula
def larger(one, other):
    return one if one > other else other  # `max` is not vectorised


@formula
def _size(miss, rho):
    of_angles = larger(abs(miss[1]), abs(miss[2]))
    return larger(of_angles, larger(abs(miss[0]) / (abs(rho) + 1e-150), abs(miss[3]) / (1.0 + rho)))


@formula
def _trial(state, dt, loop):
    """The state after a step, the rates at both ends, and the error in units of the tolerance."""
    slopes, nothing = _slopes(state, dt, loop), (0.0, 0.0, 0.0, 0.0)
    new = _to_end(state, dt, slopes)
    fifth, third = _fifth(nothing, dt, slopes), _third(nothing, dt, slopes)
    fine, coarse = _size(fifth, new[0]), 0.1 * _size(third, new[0])
    error = fine * fine / np.sqrt(fine * fine + coarse * coarse + 1e-300)
    return new, slopes[0], closed_loop(new[:3], loop), error / TOLERANCE


@formula
def swing(state, rates, little, loop):
    """The rate of omega."""
    ahead = polar.moved(state, rates, little)
    return (closed_loop(ahead, loop)[4] - rates[4]) / little


@formula
def _until_turn(f0, rate0, f1, rate1, dt, slack):
    """How long f goes on before it turns round, if more than the slack of it is missed at the end.

    By the cubic with these values and rates at both ends.
    """
    middle = rate0 + rate1 - 3.0 * (f1 - f0) / dt
    root = np.sqrt(middle * middle - rate0 * rate1)
    root = root if rate1 > 0.0 else -root
    turn = dt - dt * (rate1 + root - middle) / (rate1 - rate0 + 2.0 * root)
    before, after = abs(rate0) * turn, abs(rate1) * (dt - turn)
    missed = before if before < after else after
    return turn if (rate0 * rate1 < 0.0) & (missed > slack) else dt


@formula
def _until_arrival(rho0, rate0, rho1, rate1, dt, radius):
    """When rho passes the radius, by the cubic for the time as a function of rho."""
    fall = rho1 - rho0
    s = (radius - rho0) / fall
    ends = (1.0 - s) * (1.0 - s) * fall / rate0 - s * (1.0 - s) * fall / rate1
    time = s * (ends + s * (3.0 - 2.0 * s) * dt)
    time = time if (time > 0.0) & (time < dt) else s * dt
    return time if rho1 < radius * (1.0 - SHARP) else dt


@formula
def advance(block, i, law, wheels, radius):
    """Try a step of the run in place i, and take it if it is accurate and ends at its events."""
    at, left, peak, length, gains = polar.read(block, i)
    step, swing0, loop = block[polar.STEP, i], block[polar.SWING, i], (gains, law, wheels)
    dt = step if step < left else left
    new, first, last, error = _trial((*at, 0.0), dt, loop)
    swing1, turning = swing(new[:3], last, _GLIMPSE * dt, loop), abs(last[4])

    wanted = _until_arrival(at[0], first[0], new[0], last[0], dt, radius)
    turn = _until_turn(0.0, first[3], new[3], last[3], dt, _SLACK * (1.0 + at[0]))
    wanted = turn if turn < wanted else wanted
    turn = _until_turn(first[4], swing0, last[4], swing1, dt, _SLACK * (1.0 + peak))
    top = abs(first[4]) + abs(swing0) * turn
    highest = (first[4] * swing0 > 0.0) & (top > peak + _SLACK)
    wanted = turn if highest & (turn < wanted) else wanted

    growth = 0.9 / np.sqrt(np.sqrt(np.sqrt(error)))
    growth = (growth if growth < 5.0 else 5.0) if growth > 0.2 else 0.2  # 0.2 for NaN too
    going, accurate = left > 0.0, error <= 1.0
    taken = going & accurate & (wanted >= dt)
    block[polar.RHO, i] = new[0] if taken else at[0]
    block[polar.ALPHA, i] = new[1] if taken else at[1]
    block[polar.THETA, i] = new[2] if taken else at[2]
    block[polar.PEAK, i] = turning if taken & (turning > peak) else peak
    block[polar.LENGTH, i] = length + abs(new[3]) if taken else length
    block[polar.SWING, i] = swing1 if taken else swing0
    again = wanted if accurate & (wanted < dt) else growth * dt
    block[polar.STEP, i] = again if going else step
    block[polar.TRIALS, i] -= 1.0
    arrived = (radius > 0.0) & (new[0] <= radius * (1.0 + SHARP))
    rest = left - dt if taken else left
    over = going & ((taken & arrived) | (block[polar.TRIALS, i] <= 0.0) & (rest > 0.0))
    block[polar.LEFT, i] = -rest if over else rest
