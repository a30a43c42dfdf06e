"""Chapter 14: a receiver tells where a robot is, and a drive tells which way it faces."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage
from wmrlib import Pose, advance, polar_error

SIGMA, FAR, PAIRS, SEED = 0.5, 3.0, 60, 14  # m, m
HEADING, ROBOTS, ARM, LONG_ARM, RTK = 0.4, 8, 0.3, 0.6, 0.02  # rad, m
TURN, FIT = math.pi, 3.0  # rad; as many standard deviations from the fix still fit it
PLAIN = "sigma", "far"


def off(sigma: float, far: float) -> float:
    """Return how far off the bearing between two fixes is, in degrees, as a root mean square."""
    x, y, to_x, to_y = np.random.default_rng(SEED).normal(0.0, sigma, (4, 10_000))
    bearing = polar_error(Pose(x, y, 0.0), Pose(far + to_x, to_y, 0.0)).alpha
    return math.degrees(np.sqrt(np.mean(bearing**2)))


def fitting(arm: float, v: float, omega: float) -> int:
    """Return how many of the robots with one fix in common have the next one in common, too.

    They differ in their heading, drive for a second and have their antenna ahead by `arm`.
    """

    def antenna(pose: Pose) -> complex:
        return complex(pose.x, pose.y) + arm * np.exp(1j * pose.heading)

    headings = HEADING + 2 * math.pi * np.arange(ROBOTS) / ROBOTS
    begins = [Pose(-arm * math.cos(it), -arm * math.sin(it), it) for it in headings]
    ends = [antenna(advance(pose, v, omega, 1.0)) for pose in begins]
    return sum(abs(end - ends[0]) <= FIT * RTK for end in ends)


def course_from_gps(scene: str = "whole") -> Stage:
    """Return a robot with a receiver, and the headings that its fixes allow, as one scene."""
    before, after = off(SIGMA, FAR), off(SIGMA, 2 * FAR)
    shares = {"a quarter of it": 0.25, "half of it": 0.5, "as much": 1.0}
    counts = {"all of them": ROBOTS, "half of them": ROBOTS // 2, "only its own": 1}
    left = fitting(0.0, 0.0, TURN)
    ends = "Two fixes that err by {sigma}, {far} apart, {tell}."
    fit = "the fixes allow {fits} of {robots} headings"
    scenes = {
        "whole": Scene(
            "A receiver says where the robot is. Who says where it faces? " + ends,
            look="other",
            handles=PLAIN,
        ),
        "ask": Scene(
            ends,
            look="other",
            still=True,
            handles=PLAIN,
            ask=Question(
                "{far} apart, two fixes leave its heading uncertain by {off}. How much uncertainty "
                "is left at twice the distance?",
                dict.fromkeys(shares, "two fixes {far} apart leave it uncertain by {off}."),
                min(shares, key=lambda answer: abs(shares[answer] - after / before)),
                {"far": 2 * FAR},
            ),
        ),
        "one": Scene(
            "Grey: a guess, 0° within {guess}. Purple: a reading, 30° within {reading}. Blue: "
            "both together, {mean} within {both}.",
            look="other",
            handles=("guess_deg", "reading_deg"),
            still=True,
        ),
        "two": Scene(
            "Grey: a guess within {guess}. Blue: what is left of it after two fixes of {sigma} "
            "that are {far} apart, {both}. In the corner: errors of place (to the side) and "
            "heading, before and after the second fix.",
            look="other",
            to={"far": 5.0, "guess_deg": 11.5},
            handles=("guess_deg", *PLAIN),
        ),
        "rest": Scene(
            "Eight robots whose antennas share one spot. They stand, and " + fit + ".",
            look="other",
            to={"sigma": RTK, "arm": LONG_ARM},
            handles=("arm",),
            still=True,
        ),
        "straight": Scene(
            "The eight drive {far} straight ahead. Now a fix that errs by {sigma} allows {fits} of "
            "{robots} headings.",
            look="other",
            to={"sigma": RTK},
            handles=PLAIN,
        ),
        "turn": Scene(
            "The eight turn on the spot by half a turn. Now " + fit + ".",
            look="other",
            to={"sigma": RTK, "arm": LONG_ARM},
            handles=("arm",),
            still=True,
            ask=Question(
                "After half a turn the fixes allow {fits} of {robots} headings. If the antenna "
                "stood above the middle of the wheels, how many would they allow?",
                dict.fromkeys(
                    counts, "the antenna stays where it is, and the fixes allow {fits} of {robots}."
                ),
                min(counts, key=lambda answer: abs(counts[answer] - left)),
                {"arm": 0.0},
            ),
        ),
        "lean": Scene(
            "It faces north and leans to its side by {lean}, where the field dips by {dip}. Its "
            "compass is {crooked} off.",
            look="other",
            handles=("lean_deg", "dip_deg"),
            still=True,
        ),
    }
    knobs = {
        "sigma": Knob(
            SIGMA, 0.01, 3.0, None, "the standard deviation of a fix", "m", label="fixes err by"
        ),
        "far": Knob(FAR, 0.5, 20.0, 0.5, "the way between two fixes", "m", label="apart"),
        "guess_deg": Knob(20.0, 1.0, 40.0, 0.5, "the guess's deviation", "°", label="guess"),
        "reading_deg": Knob(
            10.0, 1.0, 40.0, 0.5, "the reading's standard deviation", "°", label="reading"
        ),
        "arm": Knob(
            ARM, 0.0, 0.6, 0.05, "how far ahead the antenna stands", "m", label="antenna ahead"
        ),
        "lean_deg": Knob(3.0, 0.0, 20.0, 1.0, "how far it leans", "°", label="lean"),
        "dip_deg": Knob(68.0, 0.0, 80.0, 1.0, "how steep the field is", "°", label="dip"),
    }
    data = {"pairs": PAIRS, "seed": SEED, "heading": HEADING, "robots": ROBOTS, "turn": TURN}
    return Stage("course_from_gps", knobs, scenes, scene, data=data | {"fit": FIT})
