"""Chapter 10: a verdict that rests on a threshold, and where V rises under (24) as printed."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Choice, Knob, Live, choose
from wmrlib import lyapunov_rate, paper, simulate
from wmrlib.gains import GENTLE_GAINS, Gains

RADIUS, MOST = 0.05, 5.0  # m and deg, the audit's
SCALES = 0.5, 1.0, 2.0
_FAR, _STEP = 0.4, 0.0025  # m
VERDICTS = {
    "never": "never: it is not parked, wherever one draws the lines",
    "depends": "in some of these cases",
    "always": "always: it is parked, wherever one draws the lines",
}


def heading_left(gains: Gains, axis: str) -> tuple[np.ndarray, np.ndarray]:
    """Distances from the outdoor goal [m], and the errors [deg] of a heading that stops there."""
    start, goal, *_ = paper.outdoor(axis)
    run = simulate(start, goal, gains, method="continuous", dt=0.002, arrival_radius=_STEP)
    rho = np.arange(1, round(_FAR / _STEP) + 1) * _STEP
    off = np.interp(-rho, -run.rho, np.unwrap(run.heading_error))
    return rho, np.abs(np.degrees(off))


def parked(curves: list[np.ndarray], radius: float, most: float) -> str:
    """Which of VERDICTS holds with both thresholds halved, as they are, and doubled."""
    rho = np.arange(1, curves[0].size + 1) * _STEP
    found = {
        bool(np.interp(scale * radius, rho, off) < other * most)
        for off in curves
        for scale in SCALES
        for other in SCALES
    }
    return "depends" if len(found) > 1 else "always" if True in found else "never"


def threshold() -> Live:
    """Is it parked? The heading left where one stops, and both thresholds halved and doubled."""
    tunings = {"paper": paper.OUTDOOR_GAINS, "gentle": GENTLE_GAINS}
    curves = {
        name: [heading_left(gains, axis)[1] for axis in ("east", "north")]
        for name, gains in tunings.items()
    }
    found = parked(curves["paper"], RADIUS, MOST)
    return Live(
        "threshold",
        "With {gains} the robot stops at {radius}, or at half or twice that, and counts as parked "
        "if it is less than {most} off, or half or twice that; with x east, and with x north. "
        "Parked: {yes}. So the verdict "
        "{verdict}.",
        {
            "radius": Knob(100 * RADIUS, 1.0, 20.0, 0.5, "the arrival radius", "cm", "R"),
            "most": Knob(MOST, 0.5, 25.0, 0.5, "the heading error that still counts", "°", "phi"),
            "gains": Choice(
                "paper", {"paper": "the paper's gains", "gentle": "gentle gains"}, "the gains"
            ),
        },
        data={
            "step": 100 * _STEP,
            "curves": {name: np.round(each, 4).tolist() for name, each in curves.items()},
        },
        ask=choose(
            "The paper's outdoor drive, in both readings of its axes: the robot stops 2.5, 5 or 10 "
            "cm before the goal, and a heading is right within 2.5°, 5° or 10°. Is it parked?",
            "A heading that still swings while the last metre is driven has any value where one "
            "happens to stop. A verdict that hangs on such a line of ours is not decided.",
            answers={words: verdict == found for verdict, words in VERDICTS.items()},
            wrong=(
                "At 10 cm, x east, the heading happens to swing through zero: there it is parked.",
                "",
                "At 5 cm, x east, it is 27° off.",
            ),
            asked=(
                {"radius": 2.5},
                {"radius": 10.0},
            ),
        ),
    )


def rising() -> Live:
    """Where V rises under (24) as printed, at a distance and with a weight of the distance in V."""
    gains, (alpha, theta) = paper.OUTDOOR_GAINS, (45.0, 0.0)

    def rises(rho: float, L: float) -> bool:
        here = rho, math.radians(alpha), math.radians(theta)
        return bool(lyapunov_rate(*here, gains, law="printed", L=L) > 0.0)

    heavy, away = 1e-3, 0.35  # m^2, m
    return Live(
        "rising",
        "At {rho} from the goal, {alpha} and {theta}, with {L}, V changes at {rate} under (24) "
        "as printed: it {fate}. It rises in {share} of the angles at this distance.",
        {
            "alpha": Knob(alpha, -180.0, 180.0, 5.0, "alpha, degrees", "°", "alpha"),
            "theta": Knob(theta, -180.0, 180.0, 5.0, "theta, degrees", "°", "theta"),
            "rho": Knob(away, 0.001, 1.0, None, "the distance, rho", "m", "rho"),
            "L": Knob(1.0, 0.001, 10.0, None, "L: a small one lets the distance count", "m²", "L"),
        },
        data={
            "gains": gains._asdict(),
            "asked": {"alpha": alpha, "theta": theta, "rho": away},
        },
        ask=choose(
            "With L = 1 m², V rises under (24) as printed 0.35 m from the goal, which lies 45° to "
            "the left, with theta = 0. Now let the distance count a thousand times as much in V: "
            "L = 0.001 m². What does V do?",
            "The distance's part of V' fades with the square of the distance, whatever its weight. "
            "So with every L the angles decide, near enough to the goal.",
            answers={
                "It rises here too, and so nothing is mended.": rises(away, heavy),
                "It falls here, and everywhere nearer to the goal.": not rises(away, heavy)
                and not rises(1e-6, heavy),
                "It falls here, and rises nearer to the goal.": not rises(away, heavy)
                and rises(1e-6, heavy),
            },
            wrong=(
                "Here the distance now outweighs the angles, and V falls.",
                "The distance's part fades with the square of the distance, so nearer to the "
                "goal the angles win again.",
                "",
            ),
            asked=({"L": 0.001},),
        )
        if rises(away, 1.0)
        else None,
    )
