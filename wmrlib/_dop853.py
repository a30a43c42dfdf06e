"""Dormand and Prince's method of order 8 with Hairer's two estimates of its error, and its events.

Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.5. Row j of `STAGES` holds
the weights of the slopes before for the place of stage j + 1.

A step may have to end on an event, and is tried again, shorter, until it does: arrival, a change
between forwards and backwards, and the largest |omega| so far.
"""

from __future__ import annotations

import numpy as np

from wmrlib.compilation import formula

TOLERANCE = 1e-10  # of a step: rad, and a share of the distance
SHARP = 1e-12  # so close to the arrival radius a run ends, as a share of it
SLACK = 1e-8  # what an event may miss of the metres rolled and of the largest |omega|

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
# As arrays, where a loop goes over them; the last row of the triangle is the weights.
TRIANGLE = np.array([[*row, *(0.0,) * (12 - len(row))] for row in ((), *STAGES, WEIGHTS)])
NODES = np.array([0.0, *map(sum, STAGES), 1.0])  # when each stage is, as a share of the step


@formula
def larger(one, other):
    return one if one > other else other  # `max` is not vectorised


@formula
def step_error(fine, coarse):
    """The error in tolerances, by Hairer's two estimates of it."""
    coarse = 0.1 * coarse
    return fine * fine / np.sqrt(fine * fine + coarse * coarse + 1e-300) / TOLERANCE


@formula
def growth(error):
    """How much longer the next step may be, by this one's error in tolerances."""
    longer = 0.9 / np.sqrt(np.sqrt(np.sqrt(error)))
    return (longer if longer < 5.0 else 5.0) if longer > 0.2 else 0.2  # 0.2 for NaN too


@formula
def until_turn(f0, rate0, f1, rate1, dt, slack):
    """How long f goes on before it turns round, if more than the slack of it is missed at the end.

    By the cubic with these values and rates at both ends.
    """
    middle = rate0 + rate1 - 3.0 * (f1 - f0) / dt
    root = np.sqrt(larger(middle * middle - rate0 * rate1, 0.0))
    root = root if rate1 > 0.0 else -root
    turn = dt - dt * (rate1 + root - middle) / (rate1 - rate0 + 2.0 * root)
    before, after = abs(rate0) * turn, abs(rate1) * (dt - turn)
    missed = before if before < after else after
    return turn if (rate0 * rate1 < 0.0) & (missed > slack) else dt


@formula
def until_arrival(rho0, rate0, rho1, rate1, dt, radius):
    """When rho passes the radius, by the cubic for the time as a function of rho."""
    fall = rho1 - rho0
    s = (radius - rho0) / fall
    ends = (1.0 - s) * (1.0 - s) * fall / rate0 - s * (1.0 - s) * fall / rate1
    time = s * (ends + s * (3.0 - 2.0 * s) * dt)
    time = time if (time > 0.0) & (time < dt) else s * dt
    return time if rho1 < radius * (1.0 - SHARP) else dt


@formula
def until_event(rho, rolled, omega, dt, radius, peak):
    """How much of a step to take, so that it ends on the first event in it.

    `rho`, `rolled` and `omega` are what each is before and after, and its rates there.
    """
    wanted = until_arrival(rho[0], rho[1], rho[2], rho[3], dt, radius)
    slack = SLACK * (1.0 + abs(rho[0]))
    turn = until_turn(rolled[0], rolled[1], rolled[2], rolled[3], dt, slack)
    wanted = turn if turn < wanted else wanted
    turn = until_turn(omega[0], omega[1], omega[2], omega[3], dt, SLACK * (1.0 + peak))
    highest = abs(omega[0] + omega[1] * turn) > peak + SLACK
    wanted = turn if highest & (turn < wanted) else wanted
    # with wheels that lag, rho may dip below the radius and out of it again
    turn = until_turn(rho[0], rho[1], rho[2], rho[3], dt, SLACK * abs(radius))
    passing = (radius > 0.0) & (rho[1] < 0.0) & (rho[2] > radius)
    return turn if passing & (turn < wanted) else wanted
