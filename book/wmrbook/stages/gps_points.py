"""Chapter 1: two GPS points on a lawn, and how many digits a centimetre needs."""

from __future__ import annotations

import math

from wmrbook.ellipsoid import sphere_error
from wmrbook.live.parts import Knob
from wmrbook.stages.parts import Question, Scene, Stage, paper_drive
from wmrlib import GENTLE_GAINS, GeoPoint, Pose, local_position, paper

FEWEST, MOST, FIRST = 3, 8, 4  # digits after the point
CENTIMETRE = 0.01  # m
GOAL = Pose(9.7, 57.25, paper.GOAL_HEADING)  # with six digits it is the paper's
PRINTED = {"digits": 6}  # as the paper has them
TOLD = "{digits} digits after the point lead the robot to a place {miss} from its goal"


def gps_points(scene: str = "whole") -> Stage:
    """Return the paper's two points with as many digits as a reader leaves them, as a scene."""
    origin = paper.GPS_POINT_1
    enough = next(n for n in range(FEWEST, MOST + 1) if _worst(origin, n) < CENTIMETRE)
    most = math.ceil(1000 * _worst(origin, enough))  # mm
    less = math.floor(1000 * _worst(origin, enough - 1))  # mm
    verdict = (
        f"wherever the goal is, {enough} digits miss it by less than {most} mm, and {enough - 1} "
        f"may miss it by {less} mm. Here {{digits}} digits miss it by {{miss}}."
    )
    scenes = {
        "whole": Scene(
            "Two GPS points, {distance} apart: the goal lies at {bearing} from north, clockwise. "
            f"{TOLD}."
        ),
        "degrees": Scene(
            "With {digits} digits the latitudes differ by {dlat}, which is {north}, and the "
            "longitudes by {dlon}, which is {east}.",
            shows=("legs",),
            to=PRINTED,
            still=True,
        ),
        "ask": Scene(
            f"{TOLD}.",
            look="near",
            still=True,
            to={"digits": 5},
            ask=Question(
                "How many digits does a centimetre need?",
                {f"{n}": verdict for n in range(MOST - 3, MOST + 1)},
                f"{enough}",
                {"digits": enough},
            ),
        ),
        "line": Scene(
            "With {digits} digits the line to the goal is {rho} long, and it begins at {course} "
            "from north, clockwise.",
            shows=("line",),
            to=PRINTED,
            still=True,
        ),
        "ellipsoid": Scene(
            "On the ellipsoid the goal lies {gap} from where the sphere puts it, and {nearer} the "
            "start.",
            look="near",
            shows=("ellipsoid",),
            to={"digits": MOST},
            still=True,
        ),
    }
    digits = Knob(FIRST, FEWEST, MOST, 1, "digits of the coordinates", label="digits")
    east, _ = local_position(origin, GeoPoint(lat=origin.lat, lon=origin.lon + 0.001))
    _, north = local_position(origin, GeoPoint(lat=origin.lat + 0.001, lon=origin.lon))
    data = {
        "origin": [origin.lat, origin.lon],
        "metres": [1000 * north, 1000 * east],  # a degree of latitude, of longitude
        "curved": [1 / (1 + sphere_error(origin.lat, br)) for br in (math.pi / 2, 0.0)],
        "gains": GENTLE_GAINS._asdict(),
    }
    hands = ("goal",)
    places = paper_drive() | {"goal": GOAL}
    return Stage("gps_points", {"digits": digits}, scenes, scene, **places, hands=hands, data=data)


def _worst(point: GeoPoint, digits: int) -> float:
    """Return how far rounding to so many digits can move a point, m."""
    half = 0.5 * 10.0**-digits
    away = GeoPoint(lat=point.lat + half, lon=point.lon + half)
    return math.hypot(*local_position(point, away))
