"""Chapter 1: a direction in two counts, and a flat map's error."""

from __future__ import annotations

import math

import numpy as np

from wmrbook.live.parts import Ask, Knob, Live, choose, nearest
from wmrlib import EARTH_RADIUS_M, GeoPoint, paper
from wmrlib.geodesy import destination_point, initial_bearing, local_position, point_at

EAST, NORTH = 40.0, -24.0  # m, of point 2
DISTANCES = 100.0, 10_000.0  # m, known and asked for


def bearing() -> Live:
    """A point to drag on a map: its bearing, its angle from east, and the two swapped."""
    here = paper.GPS_POINT_1
    there = point_at(here, EAST, NORTH)
    clockwise = math.degrees(initial_bearing(here, there)) % 360
    east, north = local_position(here, there)
    return Live(
        "bearing",
        "A point {east} east and {north} north lies at a bearing of {bearing}, clockwise from "
        "north. Counter-clockwise from east that is {angle}. With the bearing taken for it, the "
        "robot looks {off} past the point.",
        {
            "east": Knob(EAST, -60.0, 60.0, 1.0, "point 2 to the east", "m", label="east"),
            "north": Knob(NORTH, -60.0, 60.0, 1.0, "point 2 to the north", "m", label="north"),
        },
        ask=Ask(
            "turn",
            f"Point 2 lies at a bearing of {clockwise:.0f} deg from point 1. Where is it? "
            "Turn the arrow.",
            "A bearing starts at north and turns clockwise; a heading starts at east and turns "
            "the other way.",
            key=math.atan2(north, east),
            pane="map",
            at=(0.0, 0.0),
        ),
    )


def flat_map() -> Live:
    """How far off a flat map is, over the distance and at any latitude."""
    here = GeoPoint(lat=round(paper.GPS_POINT_1.lat), lon=0.0)  # as the sliders say it
    known, asked = (_flat_error(here, distance) for distance in DISTANCES)
    times = DISTANCES[1] / DISTANCES[0]
    distances = {
        "as much": known,
        f"{times:.0f} times": known * times,
        f"{times**2:,.0f} times": known * times**2,
        f"{times**3:,.0f} times": known * times**3,
    }
    return Live(
        "flat_map",
        "At latitude {lat} a flat map puts a point {km} to the north-east {off} from where "
        "distance and bearing put it. True north leans {leans} there from the map's.",
        {
            "km": Knob(DISTANCES[0] / 1000, 0.01, 1000.0, None, "distance", "km", label="distance"),
            "lat": Knob(here.lat, 0.0, 75.0, 1.0, "latitude", "°", label="latitude"),
        },
        data={
            "radius": EARTH_RADIUS_M,
            "asked": {"km": DISTANCES[0] / 1000, "lat": here.lat},
        },
        ask=choose(
            f"Over {DISTANCES[0]:.0f} m the flat map is {1000 * known:.1f} mm off. How much over "
            f"{DISTANCES[1] / 1000:.0f} km, {times:.0f} times as far?",
            f"It is {asked:.1f} m off: the meridians close in along the way, and that costs the "
            "square of the distance.",
            answers=nearest(asked, distances),
            wrong=(
                "The meridians close in along the way: the farther, the more.",
                "Twice the way closes the meridians in twice as much, and over twice the way: that "
                "is a square.",
                "",
                "That would be the cube of the distance, and so it is only near the equator.",
            ),
            asked=({"km": 10.0},),
        ),
    )


def _flat_error(origin: GeoPoint, distance: float) -> float:
    """How far the flat map is off for a point to the north-east, m."""
    point = destination_point(origin, distance, math.pi / 4)
    north, east = EARTH_RADIUS_M * np.radians(
        [point.lat - origin.lat, (point.lon - origin.lon) * math.cos(math.radians(origin.lat))]
    )
    return math.dist((east, north), local_position(origin, point))
