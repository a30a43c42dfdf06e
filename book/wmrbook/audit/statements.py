"""What the paper says in words only."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.audit.figures import AXES, MISSING, chase, comparison, drive
from wmrbook.audit.proof import rising, slope
from wmrbook.audit.rows import Row, Verdict, depends, printed
from wmrlib import paper, symbolic
from wmrlib.metrics import arrival
from wmrlib.simulation import simulate

_PARKED = math.radians(5.0)


def _row(
    name: str, title: str, says: str, holds: str, so: bool, why: str, verdict: Verdict | None = None
) -> Row:
    return Row(
        f"claim-{name}",
        title,
        says,
        holds,
        verdict or (Verdict.HOLDS if so else Verdict.WRONG),
        why,
    )


def growth(law: str) -> float:
    """The largest real part of the eigenvalues of the law's closed loop at the goal, 1/s, with the paper's outdoor gains."""
    state = symbolic.rho, symbolic.alpha, symbolic.theta
    gains = paper.OUTDOOR_GAINS
    values = {
        symbolic.k_rho: gains.k_rho,
        symbolic.k_alpha: gains.k_alpha,
        symbolic.h: gains.h,
        symbolic.v_max: gains.v_max,
    }
    matrix = np.empty((3, 3))
    for i, rate in enumerate(symbolic.closed_loop(law)):
        for j, each in enumerate(state):
            others = dict.fromkeys((other for other in state if other is not each), 0)
            matrix[i, j] = float(rate.subs(others).subs(values).diff(each).subs(each, 1e-9).evalf())
    return float(np.linalg.eigvals(matrix).real.max())


def rows() -> list[Row]:
    """A row for each statement."""
    return [_stable(), _better(), _still(), _smooth(), _pose(), _figure_5()]


def _stable() -> Row:
    printed_rate, corrected_rate = growth("printed"), growth("corrected")
    up = rising(slope(printed(24)))
    text = (
        (
            f"With (24) as printed $\\dot V$ reaches {up[3]:+.1f} and an error near the goal grows at {printed_rate:+.1f} 1/s. "
            if up
            else f"$\\dot V$ is positive nowhere; an error near the goal changes at {printed_rate:+.1f} 1/s. "
        )
        + f"Corrected, the slowest mode is {corrected_rate:+.1f} 1/s; but $\\dot V \\le 0$ alone "
        "proves no convergence: that takes LaSalle or Barbalat."
    )
    so = up is None and printed_rate < 0.0
    why = (
        "the proof holds"
        if so
        else "the proof fails for the law as printed, and stops short for the corrected one"
    )
    return _row(
        "stable", "Stability", "The globally asymptotic stability has been proved.", text, so, why
    )


def _better() -> Row:
    text, nearer = comparison()
    verdict = depends(nearer)
    why = MISSING if verdict is Verdict.OPEN else "the same with every rival tried"
    return _row(
        "cornejo",
        "Comparison",
        "Better than the controller of Cornejo et al.",
        text,
        all(nearer),
        why,
        verdict,
    )


def _still() -> Row:
    """The reason given is that the path is straight: then the turning rate would be small wherever the path is near the goal."""
    runs = [drive(axis) for axis in AXES]
    peaks, when = (
        [abs(run.omega).max() for run in runs],
        [run.t[-1] - run.t[np.argmax(abs(run.omega))] for run in runs],
    )
    text = "$\\omega$ peaks at {:.1f} rad/s (x east) and {:.1f} (x north), within {:.1f} s of the arrival.".format(
        *peaks, max(when) + 0.05
    )
    late = max(when) < 1.0 and min(peaks) > 1.0
    why = (
        "it turns fastest at the end of the line"
        if late
        else "it turns no more at the end of the line"
    )
    return _row(
        "omega",
        "Turning rate",
        "It converges to zero because of the linear tracking path.",
        text,
        not late,
        why,
    )


def _smooth() -> Row:
    """Smooth for a robot at rest: no jump of the commands above a tenth of their range, with the paper's gains and time step."""
    case = paper.outdoor()
    run = simulate(case.start, case.goal, case.gains, method="euler", dt=case.dt)
    first, jump = float(run.v[0]), float(abs(np.diff(run.omega)).max())
    smooth = first < 0.1 * case.gains.v_max and jump < 0.1 * float(np.ptp(run.omega))
    text = f"A robot at rest is commanded {first:.2f} m/s at once; in one step of {case.dt} s $\\omega$ jumps by up to {jump:.1f} rad/s."
    why = "no jump above a tenth of the range" if smooth else "jumps above a tenth of the range"
    return _row(
        "smooth",
        "Smoothness",
        "The controller produces smooth linear and angular velocities.",
        text,
        smooth,
        why,
    )


def _pose() -> Row:
    off = [abs(float(arrival(drive(axis)).heading_error)) for axis in AXES]
    parked = max(off) < _PARKED
    text = "At 5 cm from the goal the heading is {:.1f} deg off with x east and {:.1f} deg with x north.".format(
        *map(math.degrees, off)
    )
    why = "within 5 deg" if parked else "more than 5 deg off: from position to position"
    return _row("pose", "Pose to pose", "The robot moves from pose to pose.", text, parked, why)


def _figure_5() -> Row:
    fastest = {figure: float(run.v.max()) for figure, run in ((5, chase()), (9, drive("east")))}
    limit = paper.PUBLISHED["speed_limit"].value
    reached = {figure: abs(speed - limit) < 0.01 * limit for figure, speed in fastest.items()}
    text = f"The run of Fig. 5 reaches {fastest[5]:.2f} m/s, that of Fig. 9 {fastest[9]:.2f} m/s."
    verdict = Verdict.HOLDS if reached[5] else Verdict.TYPO if reached[9] else Verdict.WRONG
    return _row(
        "limit",
        "The limit",
        "Limited to 4 m/s, as indicated in Fig. 5.",
        text,
        reached[5],
        "Fig. 9 is meant" if not reached[5] else "so it is",
        verdict,
    )
