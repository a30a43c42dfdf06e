"""Checks of formulas on the Earth: distance and bearing of two GPS points, and the local frame."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading import _earth
from wmrbook.grading._asking import ask_number, ask_numbers
from wmrbook.grading._hints import close, drawn, expect, own_work, rule_out, slip, spread
from wmrlib.geodesy import (
    GeoPoint,
    haversine_distance,
    initial_bearing,
    local_position,
    point_at,
)
from wmrlib.paper import GPS_POINT_1, GPS_POINT_2

Local = Callable[[float, float, float, float], tuple[float, float]]

_RADIUS = "this is less than 1 % off: is your Earth a sphere of 6371 km, and pi `math.pi`?"
_MAP_TOLERANCE_M = 0.02  # flat map against sphere, over 300 m and up to 60 deg of latitude


def distance_known(distance: _earth.Function) -> str:
    """distance(lat_1, lon_1, lat_2, lon_2): degrees in, metres out, all over the Earth."""
    own_work(distance)
    for a, b in [(GPS_POINT_1, GPS_POINT_2), *_earth.places(20)]:
        if not _earth.distance_right(distance, a, b):
            _earth.explain_distance(distance, a, b)
    metres = haversine_distance(GPS_POINT_1, GPS_POINT_2)
    return f"{metres:.2f} m between the paper's two points, and right elsewhere."


def distance_properties(distance: _earth.Function) -> str:
    """The same there and back, 0 from a point to itself, unchanged when the Earth is turned."""
    own_work(distance)
    for a, b in _earth.places(20):
        there = _earth.between(distance, a, b)
        expect(there > 1e-3, "the distance between two different places must be positive.")
        back = _earth.between(distance, b, a)
        expect(close(there, back), "the way back is not as long as the way there.")
        still = abs(_earth.between(distance, a, a))
        expect(still < 1e-6, "from a point to itself it must be 0 m.")
        turned = ask_number(distance, a.lat, a.lon - 25.0, b.lat, b.lon - 25.0)
        hint = "turn the Earth: if both longitudes change by the same, the distance must stay."
        expect(close(there, turned, 1e-6), hint)
    return "There is as far as back, and only the difference of the longitudes counts."


def distance_close(distance: _earth.Function) -> str:
    """A centimetre is a centimetre: the haversine keeps the digits that an acos loses."""
    own_work(distance)
    random = np.random.default_rng(3)
    for metres in spread(0.01, 1e4, 60):
        way = random.uniform(-math.pi, math.pi)
        there = point_at(GPS_POINT_1, metres * math.cos(way), metres * math.sin(way))
        value = _earth.between(distance, GPS_POINT_1, there)
        slip(value, metres, within=0.0)
        away = f"two points {metres:.8g} m apart come out {value:.8g} m apart: "
        hint = f"{away}see to the checks above first."
        expect(metres < 100.0 or close(value, metres, 1e-5), hint)
        lost = f"{away}which function loses its digits near 0 m?"
        expect(close(value, metres, 1e-5, 1e-6), lost)  # an acos is 20 times worse at 5 m
    return "One centimetre comes out as one centimetre."


def bearing_known(bearing: _earth.Function) -> str:
    """bearing(lat_1, lon_1, lat_2, lon_2): degrees clockwise from north, up to full turns."""
    own_work(bearing)
    home = GeoPoint(lat=10.0, lon=20.0)
    compass = {"north": (0.0, 1.0), "south": (0.0, -1.0), "east": (1.0, 0.0), "west": (-1.0, 0.0)}
    for name, (east, north) in compass.items():
        there = point_at(home, 1000.0 * east, 1000.0 * north)
        hint = f"to a point 1 km {name} of you the bearing comes out as {{:.4g}}: "
        _earth.explain_bearing(bearing, home, there, hint + "where does it count from?")
    for a, b in [(GPS_POINT_1, GPS_POINT_2), *_earth.places(20)]:
        hint = "the bearing between two known places is wrong: "
        hint += "compare with (15) to (17), term by term."
        _earth.explain_bearing(bearing, a, b, hint)
    paper = math.degrees(initial_bearing(GPS_POINT_1, GPS_POINT_2))
    return f"{paper:.2f} deg for the paper's two points, and right elsewhere."


def bearing_range(bearing: _earth.Function) -> str:
    """It is in [0, 360): just west of north is nearly 360, not a little less than 0."""
    own_work(bearing)
    west_of_north = (GPS_POINT_1, point_at(GPS_POINT_1, -0.1, 57.0))
    north = GeoPoint(lat=GPS_POINT_1.lat + 0.001, lon=GPS_POINT_1.lon)
    for a, b in [west_of_north, *_earth.places(40), (GPS_POINT_1, north)]:
        value = _earth.between(bearing, a, b)
        hint = f"the bearing comes out as {value:.4g} deg"
        west = f"{hint} for a goal in the west; the compass goes on from 270 to 360."
        expect(value >= 0.0, west)
        expect(value < 360.0, f"{hint}: a full turn is 0 again.")
    ways = west_of_north, west_of_north[::-1]
    there, home = (_earth.between(bearing, *pair) for pair in ways)
    hint = "over 57 m the way back must point the opposite way, to a thousandth of a degree."
    expect(_earth.same_direction(there, home + 180.0, 1e-3), hint)
    where = f"A goal 10 cm west of north is at {there:.1f} deg"
    return f"{where}, the way back at {home:.1f} deg."


def local_known(local: Local) -> str:
    """local(lat_0, lon_0, lat, lon): (east, north) in metres of points within 300 m, to 2 cm."""
    own_work(local)
    for origin, point in [(GPS_POINT_1, GPS_POINT_2), *_walks(2, 30, 300.0)]:
        east, north = right = local_position(origin, point)
        value = ask_numbers(local, 2, origin.lat, origin.lon, point.lat, point.lon)
        if _on_the_spot(value, right):
            continue
        wide = east / math.cos(math.radians(origin.lat))
        skew = wide * math.cos(origin.lat)
        mistakes = {
            "east and north have changed places: x is east and comes first.": (north, east),
            "both signs are wrong: is it the origin as seen from the point?": (-east, -north),
            "the map is mirrored: longitudes grow to the east, and so does x.": (-east, north),
            "the map is upside down: latitudes grow to the north, and so does y.": (east, -north),
            "north is right and east too long: "
            "a degree of longitude is shorter away from the equator.": (wide, north),
            "north is right and east is not: a cosine of degrees?": (skew, north),
        }
        rule_out(value, mistakes, _on_the_spot)
        slip(value, right, within=0.0)
        there = ask_numbers(local, 2, 10.0, 20.0, 10.001, 20.002)
        expect(not all(map(close, value, there)), _earth.CONSTANT)
        far = not _on_the_spot([1000.0 * coordinate for coordinate in value], right)
        expect(far, "the result is in kilometres; metres are asked for.")
        far = not _on_the_spot([math.radians(coordinate) for coordinate in value], right)
        expect(far, "57 times too long: metres for each *radian*.")
        expect(math.dist(value, right) > 0.01 * math.hypot(*right), _RADIUS)
        hint = "north is right and east is not: which angle's cosine does it take?"
        expect(abs(value[1] - north) > _MAP_TOLERANCE_M, hint)
        place = f"a point comes out at ({value[0]:.5g}, {value[1]:.5g}) m, and is not there: "
        expect(False, place + "try points due north, then due east.")
    east, north = local_position(GPS_POINT_1, GPS_POINT_2)
    return f"The paper's goal lies {east:.2f} m east and {north:.2f} m north of its start."


def local_properties(local: Local) -> str:
    """East mirrors west, the length is the distance, and nothing jumps at the date line."""
    own_work(local)
    for origin, point in _walks(2, 20, 300.0):
        offset = point.lon - origin.lon
        east, north = ask_numbers(local, 2, origin.lat, origin.lon, point.lat, point.lon)
        west, level = ask_numbers(local, 2, origin.lat, origin.lon, point.lat, origin.lon - offset)
        mirrored = close(east, -west, 1e-6, 1e-6) and close(north, level, 1e-6, 1e-6)
        expect(mirrored, "a point mirrored from east to west must only change x.")
        apart, length = haversine_distance(origin, point), math.hypot(east, north)
        exact = close(length, apart, 0.0, _MAP_TOLERANCE_M)
        expect(exact or not close(length, apart, 0.01), _RADIUS)
        expect(exact, "x and y together must be as long as the distance.")
    for lat in (0.0, -17.0, 52.0):
        for lon, other in ((179.9995, -179.9995), (-179.9995, 179.9995)):
            right = local_position(GeoPoint(lat=lat, lon=lon), GeoPoint(lat=lat, lon=other))
            value = ask_numbers(local, 2, lat, lon, lat, other)
            far = f"from longitude {lon:g} to {other:g} deg it is a short walk, "
            far += f"not {abs(value[0]) / 1000.0:.0f} km: full turns of a longitude don't count."
            expect(_on_the_spot(value, right), far)
    east = "East mirrors west, the length is the distance, "
    return f"{east}and the date line is a line like any other."


def _on_the_spot(value: tuple[float, float], right: tuple[float, float]) -> bool:
    return math.dist(value, right) < _MAP_TOLERANCE_M


def _walks(seed: int, count: int, farthest: float) -> list[_earth.Pair]:
    """Places up to 60 deg from the equator, and points 20 m to `farthest` from them."""
    walks, way = [], ((20.0, farthest), (-math.pi, math.pi))
    for lat, lon, length, angle in drawn(seed, count, (-60.0, 60.0), (-170.0, 170.0), *way):
        origin = GeoPoint(lat=lat, lon=lon)
        point = point_at(origin, length * math.cos(angle), length * math.sin(angle))
        walks.append((origin, point))
    return walks
