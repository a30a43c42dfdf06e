"""Some figures grow: what such a scene shows, idea by idea, and where its knobs go for that."""

from __future__ import annotations

from typing import NamedTuple


class Step(NamedTuple):
    """An idea of a scene that grows: on its chip, in a sentence, and in knobs that do not stand as
    at first.
    """

    title: str
    says: str
    to: dict[str, float | str] = {}  # noqa: RUF012


SCENES = {
    "flat_map": (
        Step("100 m", "Over 100 m a flat map is as good as a round one."),
        Step("10 km", "A hundred times as far, it is 10,000 times as wrong.", {"km": 10.0}),
        Step(
            "farther north",
            "Farther north the meridians close in faster.",
            {"km": 10.0, "lat": 66.0},
        ),
        Step("on the equator", "On the equator they run side by side.", {"km": 10.0, "lat": 0.0}),
    ),
    "polar_angles": (
        Step("rho", "How far? rho, along the line of sight."),
        Step("alpha", "Where does it lie? alpha, from the robot's heading."),
        Step("theta", "How should one come? theta, from the goal's heading."),
        Step(
            "turn the robot", "Turn the robot: of the three only alpha changes.", {"heading": 0.0}
        ),
        Step(
            "turn the goal",
            "Turn the goal: of the three only theta changes.",
            {"heading": 0.0, "goal_heading": 90.0},
        ),
    ),
    "bowl": (
        Step("gentle gains", "Gentle gains: V falls, and not by the steepest way."),
        Step(
            "the paper's gains",
            "The paper's gains: a flatter bowl, for h is less, and another way down.",
            {"choice": "paper"},
        ),
        Step(
            "from above",
            "From above, the bowl is a map of two angles.",
            {"choice": "paper", "tilt": 60.0, "yaw": 0.0},
        ),
    ),
    "window": (
        Step(
            "it swings",
            "Two numbers are left. With little steering, a small kappa, the heading still swings.",
            {"kappa": 0.15, "h": 0.3},
        ),
        Step(
            "it lags", "Enough of it, but h is small: the heading lags.", {"kappa": 4.0, "h": 0.3}
        ),
        Step("inside", "Inside the window the heading settles first.", {"kappa": 4.0, "h": 4.0}),
    ),
    "corners": (
        Step("passed", "A corner that is passed."),
        Step("with a stop", "A corner where the robot stops takes longer.", {"stop": "stop"}),
        Step("sharper", "A sharper corner takes a faster turn.", {"x": 30.0, "y": -20.0}),
        Step("hardly a corner", "Hardly a corner, hardly a turn.", {"x": 4.0, "y": 12.0}),
    ),
}
"""Of each figure that grows, its ideas."""
