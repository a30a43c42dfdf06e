"""Chapter 5: the paper's drive beside one of your own, and where both are stopped."""

from __future__ import annotations

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import (
    PAPER,
    Question,
    Scene,
    Stage,
    gain_knobs,
    off_heading,
    paper_drive,
)
from wmrlib import GENTLE_GAINS, paper, simulate

RADIUS, WIDER = 0.05, 0.1  # m
TRIED = 0.7  # 1/m, a gain that looks best at RADIUS
PLACES = "at its start", "on the way", "in the last metre"
CAME = "With the paper's gains (grey) it {theirs}; with yours (blue) it {yours}."


def two_drives(scene: str = "whole") -> Stage:
    """Return the paper's drive outdoors beside one with other gains, as one of its scenes."""
    theirs, yours = (_left(k_rho, RADIUS) for k_rho in (PAPER["k_rho"], TRIED))
    nearer = "grey" if _left(PAPER["k_rho"], WIDER) < _left(TRIED, WIDER) else "blue"
    verdict = (
        "the grey robot {theirs}, and the blue one {yours}. Which gain is the better one? Move "
        "the distance."
    )
    sharp = (
        "it turns at up to {sharpest}, with {close} to go. The paper says that its turning rate "
        "goes to zero."
    )
    scenes = {
        "whole": Scene(f"Both arrive. Which one parks? {CAME}", moved=CAME),
        "given": Scene(
            "All that the paper gives: a start that faces {from} from east, a goal {distance} away "
            "that should be reached facing {to}, a speed limit, three gains and a time step.",
            moved="A start that faces {from} from east, and a goal {distance} away that should be "
            "reached facing {to}.",
            still=True,
        ),
        "drives": Scene(
            "The paper's gains (grey): *v* stays below 4 m/s by itself. Look at the numbers beside "
            "the grey robot.",
            shows=("twist",),
        ),
        "turn": Scene(
            "The robot with the paper's gains (grey) turns at up to {sharpest}, with {close} to "
            "go.",
            still=True,
            ask=Question(
                "Where does the robot with the paper's gains (grey) turn fastest?",
                dict.fromkeys(PLACES, sharp),
                _where_it_turns_fastest(),
            ),
        ),
        "errors": Scene(
            "The goal lies {east} east and {north} north. Both errors of the grey robot shrink to "
            "nearly nothing. So what is missing?",
            moved="From the start the goal lies {east} east and {north} north.",
            shows=("legs",),
        ),
        "near": Scene(CAME, look="near"),
        "ask": Scene(
            CAME,
            look="near",
            to=PAPER | {"k_rho": TRIED},
            still=True,
            ask=Question(
                f"At {100 * RADIUS:.0f} cm *k_rho* = {TRIED} (blue) leaves {yours:.0f}° and the "
                f"paper's {PAPER['k_rho']:g} (grey) {theirs:.0f}°. Which robot is nearer to its "
                f"heading if we stop both at {100 * WIDER:.0f} cm?",
                dict.fromkeys(("blue", "grey"), verdict),
                nearer,
                {"radius": WIDER},
            ),
        ),
    }
    stops = Knob(RADIUS, 0.01, 0.3, 0.01, "how far from the goal they stop", "m", label="stop at")
    knobs = gain_knobs(GENTLE_GAINS) | {"radius": stops}
    data = {"v_max": GENTLE_GAINS.v_max, "gains": paper.OUTDOOR_GAINS._asdict()}
    return Stage("two_drives", knobs, scenes, scene, **paper_drive(), data=data)


def _left(k_rho: float, radius: float) -> float:
    """Return the heading that the paper's gains with this k_rho leave, in degrees."""
    start, goal, gains, _ = paper.outdoor()
    options = {"method": "continuous", "arrival_radius": radius}
    return off_heading(simulate(start, goal, gains._replace(k_rho=k_rho), **options))


def _where_it_turns_fastest() -> str:
    """Return the part of the paper's drive in which the robot turns fastest."""
    start, goal, gains, _ = paper.outdoor()
    run = simulate(start, goal, gains, method="continuous", arrival_radius=RADIUS)
    rho = run.rho[abs(run.omega).argmax()]
    return PLACES[0 if rho > 0.9 * run.rho[0] else 1 if rho > 1.0 else 2]
