"""Chapter 7: behind a goal that drives round a circle."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Knob, Live, choose
from wmrlib import paper, residual, track

WEIGHTS = 1.0, 100.0  # q, between which the prediction compares; the commands' is 1
TURNING = 2 * math.pi / paper.CIRCLE_PERIOD  # rad/s, of the goal
A = np.array([[0.0, TURNING, 0.0], [-TURNING, 0.0, paper.CIRCLE_SPEED], [0.0, 0.0, 0.0]])
B = np.array([[-1.0, 0.0], [0.0, 0.0], [0.0, -1.0]])


def lag() -> Live:
    """The distance that is left behind a moving goal, in the picture and over time."""
    gains = paper.CIRCLE_GAINS
    once, twice = (
        residual(track(paper.circle, paper.CIRCLE_START, tried, duration=40.0))
        for tried in (gains, gains._replace(k_rho=2 * gains.k_rho))
    )
    left = {
        "it vanishes": twice < once / 10,
        "it is halved": 0.4 < twice / once < 0.6,
        "it stays": 0.9 < twice / once < 1.1,
        "it grows": twice > 1.1 * once,
    }
    return Live(
        "lag",
        f"For *k_rho* and *v_max* (7.2) below says [-ln(1 - {paper.CIRCLE_SPEED:.3f} / {{v_max!}}) "
        "/ {k_rho!} = {predicted}]; the robot stays {residual} behind.",
        {
            "k_rho": Knob(gains.k_rho, 1.0, 8.0, 0.1, "pull of the goal, k_rho", "1/m", "k_rho"),
            "v_max": Knob(gains.v_max, 2.0, 8.0, 0.1, "top speed, v_max", "m/s", "v_max"),
            "time": Knob(1.0, 0.0, 1.0, 0.005, "how far round", label="driven", plays=16.0),
        },
        data={
            "start": list(paper.CIRCLE_START),
            "gains": gains._asdict(),
            "speed": paper.CIRCLE_SPEED,
        },
        ask=choose(
            f"The robot stays {once:.2f} m behind its goal. What becomes of this distance if k_rho "
            "is doubled?",
            "On the goal the law commands no speed, so the robot keeps the distance that commands "
            "the goal's. It goes as 1/k_rho.",
            answers=left,
            wrong=(
                "On the goal the law commands no speed, so a robot that keeps up must stay behind.",
                "",
                "The speed hangs on k_rho times the distance: with twice the one, half the other "
                "is enough.",
                "With a larger k_rho the goal's speed is commanded from nearer.",
            ),
            asked=({"k_rho": 3.8},),
        ),
    )


def lqr() -> Live:
    """The weight of the error in an LQR: its poles, and the drive behind the goal."""
    import control  # here, because it takes a second to load, and one chapter needs it

    tried = np.geomspace(0.01, WEIGHTS[1], 41)
    fades = [-max(control.lqr(A, B, q * np.eye(3), np.eye(2))[2].real) for q in (*WEIGHTS, *tried)]
    ratio, heavier, fastest = fades[1] / fades[0], WEIGHTS[1], tried[np.argmax(fades[2:])]
    return Live(
        "lqr",
        "With the error weighted by {q} its slowest part fades at {slowest}. The robot turns at "
        "{peak} at most, and keeps within 10 cm of its goal from {seconds} on.",
        {
            "q": Knob(1.0, 0.01, 100.0, None, "weight of the error, q", "", "q"),
            "time": Knob(1.0, 0.0, 1.0, 0.005, "how far round", label="driven", plays=8.0),
        },
        data={"A": A.tolist(), "B": B.tolist(), "start": list(paper.CIRCLE_START)},
        ask=choose(
            f"Now all errors are weighted {heavier:.0f} times as heavily, with q = {heavier:.0f}. "
            "How much faster does the slowest part fade?",
            f"It fades fastest at q = {fastest:.0f}. Beyond, the error to the side is the limit: "
            "the wheels never push sideways.",
            answers={
                f"{heavier:.0f} times faster": ratio > heavier / 2,
                f"{math.sqrt(heavier):.0f} times faster": heavier / 20 < ratio < heavier / 5,
                "no faster": ratio < 1.1,
            },
            wrong=(
                "A weight says what is worth most, not what the wheels can do: they never push "
                "sideways.",
                "That would be so if the wheels could push in each direction.",
                "",
            ),
            asked=({"q": 100.0},),
        ),
    )
