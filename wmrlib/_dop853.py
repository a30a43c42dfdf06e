"""Dormand and Prince's method of order 8 with Hairer's two estimates of its error, and its events.

Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.5. Row j of `STAGES` holds
the weights by which stage j + 1 adds up the slopes of the stages before it.

Three events end a step: the arrival, a change between driving forwards and backwards, and a new
maximum of |omega|. A step that passes an event is tried again, shorter, until it ends on it.
"""

from __future__ import annotations

import numpy as np

from wmrlib.compilation import formula

TOLERANCE = 1e-10  # of a step: rad, and a share of the distance
ARRIVAL_TOLERANCE = 1e-12  # of rho at the arrival, as a share of the arrival radius
EVENT_TOLERANCE = 1e-8  # error that an event may leave in the metres rolled and the largest |omega|

# fmt: off
STAGES = (
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
WEIGHTS = (0.054293734116568765, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003,
        -5.801203960010585, 0.3111643669578199, -0.1521609496625161, 0.20136540080403034,
        0.04471061572777259)
FIFTH = np.array([0.01312004499419488, 0, 0, 0, 0, -1.2251564463762044, -0.4957589496572502,
        1.6643771824549864, -0.35032884874997366, 0.3341791187130175, 0.08192320648511571,
        -0.022355307863886294])
# fmt: on
_EMBEDDED = {0: 0.2440944881889764, 8: 0.7338466882816119, 11: 0.022058823529411766}  # order 3
THIRD = np.array([w - _EMBEDDED.get(j, 0.0) for j, w in enumerate(WEIGHTS)])
# The same numbers as an array, for loops over the stages. Its last row is the weights of the step.
TRIANGLE = np.array([[*row, *(0.0,) * (12 - len(row))] for row in ((), *STAGES, WEIGHTS)])
NODES = np.array([0.0, *map(sum, STAGES), 1.0])  # the time of each stage, as a share of the step


@formula
def larger(one, other):
    """The larger of two numbers; LLVM does not vectorise `max`."""
    return one if one > other else other


@formula
def step_error(fine, coarse):
    """The error of a step in tolerances, from Hairer's two estimates of it."""
    coarse = 0.1 * coarse
    return fine * fine / np.sqrt(fine * fine + coarse * coarse + 1e-300) / TOLERANCE


@formula
def growth(error):
    """The factor from this step to the next, by this step's error in tolerances."""
    longer = 0.9 / np.sqrt(np.sqrt(np.sqrt(error)))
    return (longer if longer < 5.0 else 5.0) if longer > 0.2 else 0.2  # 0.2 for NaN too


@formula
def until_turn(f0, rate0, f1, rate1, dt, tolerance):
    """The time at which f turns round within a step of dt, or dt if it does not.

    f is taken as the cubic with these values and rates at the two ends of the step. A turn so close
    to an end that f changes by less than the tolerance between them does not count.
    """
    middle = rate0 + rate1 - 3.0 * (f1 - f0) / dt
    root = np.sqrt(larger(middle * middle - rate0 * rate1, 0.0))
    root = root if rate1 > 0.0 else -root
    turn = dt - dt * (rate1 + root - middle) / (rate1 - rate0 + 2.0 * root)
    before, after = abs(rate0) * turn, abs(rate1) * (dt - turn)
    missed = before if before < after else after
    return turn if (rate0 * rate1 < 0.0) & (missed > tolerance) else dt


@formula
def until_arrival(rho0, rate0, rho1, rate1, dt, radius):
    """The time at which rho reaches the radius, by the cubic for the time as a function of rho."""
    fall = rho1 - rho0
    s = (radius - rho0) / fall
    ends = (1.0 - s) * (1.0 - s) * fall / rate0 - s * (1.0 - s) * fall / rate1
    time = s * (ends + s * (3.0 - 2.0 * s) * dt)
    time = time if (time > 0.0) & (time < dt) else s * dt
    return time if rho1 < radius * (1.0 - ARRIVAL_TOLERANCE) else dt


@formula
def until_event(rho, rolled, omega, dt, radius, peak):
    """The time from the beginning of a step of dt to the first event in it, or dt without one.

    `rho`, `rolled` (the metres rolled) and `omega` are four numbers each: value and rate at the
    beginning of the step, value and rate at its end. `peak` is the largest |omega| so far.
    """
    event_time = until_arrival(rho[0], rho[1], rho[2], rho[3], dt, radius)
    tolerance = EVENT_TOLERANCE * (1.0 + abs(rho[0]))
    turn = until_turn(rolled[0], rolled[1], rolled[2], rolled[3], dt, tolerance)
    event_time = turn if turn < event_time else event_time
    turn = until_turn(omega[0], omega[1], omega[2], omega[3], dt, EVENT_TOLERANCE * (1.0 + peak))
    highest = abs(omega[0] + omega[1] * turn) > peak + EVENT_TOLERANCE
    event_time = turn if highest & (turn < event_time) else event_time
    # with wheels that lag, rho may dip below the radius and out of it again
    turn = until_turn(rho[0], rho[1], rho[2], rho[3], dt, EVENT_TOLERANCE * abs(radius))
    passing = (radius > 0.0) & (rho[1] < 0.0) & (rho[2] > radius)
    return turn if passing & (turn < event_time) else event_time
