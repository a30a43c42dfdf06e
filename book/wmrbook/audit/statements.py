"""What the paper says in words only."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.audit.figures import AXES, MISSING, circle_run, comparison, outdoor_run
from wmrbook.audit.proof import rising, slope
from wmrbook.audit.row import Row, Verdict, at, depends, printed
from wmrbook.published import PUBLISHED
from wmrlib import paper, symbolic
from wmrlib.metrics import arrival
from wmrlib.simulation import simulate

_PARKED = math.radians(5.0)


def _row(name: str, title: str, says: str, holds: str, verdict: Verdict | bool, why: str) -> Row:
    if isinstance(verdict, bool):
        verdict = Verdict.HOLDS if verdict else Verdict.WRONG
    return Row(f"claim-{name}", title, says, holds, verdict, why)


def growth(law: str) -> float:
    """The largest real part [1/s] of the closed loop's eigenvalues at the goal, outdoor gains."""
    state = symbolic.rho, symbolic.alpha, symbolic.theta
    matrix = np.empty((3, 3))
    for i, rate in enumerate(symbolic.closed_loop(law)):
        for j, each in enumerate(state):
            others = dict.fromkeys((other for other in state if other is not each), 0)
            along = rate.subs(others).subs(at(paper.OUTDOOR_GAINS))
            matrix[i, j] = float(along.diff(each).subs(each, 1e-9).evalf())
    return float(np.linalg.eigvals(matrix).real.max())


def rows() -> list[Row]:
    """A row for each statement."""
    return [_stable(), _better(), _still(), _smooth(), _pose(), _figure_5()]


def _stable() -> Row:
    printed_rate, corrected_rate = growth("printed"), growth("corrected")
    up = rising(slope(printed(24)))
    if up:
        text = (
            f"With (24) as printed $\\dot V$ reaches {up[3]:+.1f} and an error near the goal grows"
        )
    else:
        text = "$\\dot V$ is positive nowhere; an error near the goal changes"
    text += (
        f" at {printed_rate:+.1f} 1/s. Corrected, the slowest mode is {corrected_rate:+.1f} 1/s; "
        "but $\\dot V \\le 0$ alone proves no convergence: that takes LaSalle or Barbalat."
    )
    so = up is None and printed_rate < 0.0
    fails = "the proof fails for the law as printed, and stops short for the corrected one"
    says = "The globally asymptotic stability has been proved."
    return _row("stable", "Stability", says, text, so, "the proof holds" if so else fails)


def _better() -> Row:
    text, nearer = comparison()
    verdict = depends(nearer)
    why = MISSING if verdict is Verdict.OPEN else "the same with every rival tried"
    says = "Better than the controller of Cornejo et al."
    return _row("cornejo", "Comparison", says, text, verdict, why)


def _still() -> Row:
    """The reason given is a straight path: omega would then be small wherever it nears the goal."""
    runs = [outdoor_run(axis) for axis in AXES]
    peaks = [abs(run.omega).max() for run in runs]
    before = max(run.t[-1] - run.t[np.argmax(abs(run.omega))] for run in runs)
    text = (
        f"$\\omega$ peaks at {peaks[0]:.1f} rad/s (x east) and {peaks[1]:.1f} (x north), "
        f"within {before + 0.05:.1f} s of the arrival."
    )
    late = before < 1.0 and min(peaks) > 1.0
    says = "It converges to zero because of the linear tracking path."
    why = f"it turns {'fastest' if late else 'no more'} at the end of the line"
    return _row("omega", "Turning rate", says, text, not late, why)


def _smooth() -> Row:
    """Smooth for a robot at rest: no jump of the commands above a tenth of their range."""
    case = paper.outdoor()
    run = simulate(case.start, case.goal, case.gains, method="euler", dt=case.dt)
    first, jump = float(run.v[0]), float(abs(np.diff(run.omega)).max())
    smooth = first < 0.1 * case.gains.v_max and jump < 0.1 * float(np.ptp(run.omega))
    text = (
        f"A robot at rest is commanded {first:.2f} m/s at once; "
        f"in one step of {case.dt} s $\\omega$ jumps by up to {jump:.1f} rad/s."
    )
    says = "The controller produces smooth linear and angular velocities."
    why = f"{'no jump' if smooth else 'jumps'} above a tenth of the range"
    return _row("smooth", "Smoothness", says, text, smooth, why)


def _pose() -> Row:
    off = [abs(float(arrival(outdoor_run(axis)).heading_error)) for axis in AXES]
    parked = max(off) < _PARKED
    east, north = map(math.degrees, off)
    text = (
        f"At 5 cm from the goal the heading is {east:.1f} deg off with x east "
        f"and {north:.1f} deg with x north."
    )
    why = "within 5 deg" if parked else "more than 5 deg off: from position to position"
    return _row("pose", "Pose to pose", "The robot moves from pose to pose.", text, parked, why)


def _figure_5() -> Row:
    circle, outdoor = (float(run.v.max()) for run in (circle_run(), outdoor_run("east")))
    limit = PUBLISHED["speed_limit"].value
    reached, meant = (abs(speed - limit) < 0.01 * limit for speed in (circle, outdoor))
    text = f"The run of Fig. 5 reaches {circle:.2f} m/s, that of Fig. 9 {outdoor:.2f} m/s."
    says = "Limited to 4 m/s, as indicated in Fig. 5."
    if reached:
        return _row("limit", "The limit", says, text, True, "so it is")
    verdict = Verdict.TYPO if meant else Verdict.WRONG
    return _row("limit", "The limit", says, text, verdict, "Fig. 9 is meant")
