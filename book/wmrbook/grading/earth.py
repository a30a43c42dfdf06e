"""Checks of formulas on the Earth: the distance and the bearing between two GPS points, and the local frame."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._hints import Passed, ask_number, ask_numbers, close, expect, own_work
from wmrlib.geodesy import (
    EARTH_RADIUS_M,
    GeoPoint,
    haversine_distance,
    initial_bearing,
    local_position,
    point_at,
)
from wmrlib.paper import GPS_POINT_1, GPS_POINT_2

Function = Callable[[float, float, float, float], float]
Pair = tuple[GeoPoint, GeoPoint]

_SWAPPED = "this is what comes out with latitude and longitude swapped: which one has the cosine?"
_DEGREES = "this is what comes out when degrees go into a sine: `math.radians` first."
_RADIUS = "this is nearly right, less than 1 % off: is your Earth a sphere of 6371 km?"
_MAP_TOLERANCE_M = (
    0.02  # between the flat map and the sphere's over 300 m, up to 60 deg of latitude
)


def distance_known(distance: Function) -> Passed:
    """distance(lat_1, lon_1, lat_2, lon_2): degrees in, metres out; right for the paper's points and for places all over the Earth."""
    own_work(distance)
    for a, b in [(GPS_POINT_1, GPS_POINT_2), *_places(20)]:
        right, value = haversine_distance(a, b), ask_number(distance, a.lat, a.lon, b.lat, b.lon)
        if not close(value, right, 1e-6, 1e-6):
            expect(not close(value, haversine_distance(*_swapped(a, b))), _SWAPPED)
            expect(not close(value, haversine_distance(*_in_degrees(a, b))), _DEGREES)
            expect(
                not close(value * 1000.0, right, 1e-3),
                "the result is in kilometres; metres are asked for.",
            )
            expect(
                not close(2.0 * value, right, 1e-3),
                "the result is half as long as it should be: look at the factor in (12).",
            )
            expect(
                close(value, right, 0.02),
                "the distance between two known places is wrong: compare your haversine with (11) to (13), term by term.",
            )
            expect(
                False,
                "the distance is nearly right: is the radius 6371 km, and is nothing rounded on the way?",
            )
    return Passed(
        f"{haversine_distance(GPS_POINT_1, GPS_POINT_2):.2f} m between the paper's two points, and right elsewhere."
    )


def distance_properties(distance: Function) -> Passed:
    """It is the same there and back, nothing from a point to itself, and does not change when the Earth is turned about its axis."""
    own_work(distance)
    for a, b in _places(20):
        there = ask_number(distance, a.lat, a.lon, b.lat, b.lon)
        expect(there > 1e-3, "the distance between two different places must be positive.")
        expect(
            close(there, ask_number(distance, b.lat, b.lon, a.lat, a.lon)),
            "the way back is not as long as the way there.",
        )
        expect(
            abs(ask_number(distance, a.lat, a.lon, a.lat, a.lon)) < 1e-6,
            "from a point to itself it must be 0 m.",
        )
        turned = ask_number(distance, a.lat, a.lon - 25.0, b.lat, b.lon - 25.0)
        expect(
            close(there, turned, 1e-6),
            "turn the Earth: if both longitudes change by the same, the distance must stay.",
        )
    return Passed("There is as far as back, and only the difference of the longitudes counts.")


def distance_close(distance: Function) -> Passed:
    """A centimetre is a centimetre: the haversine keeps the digits that an acos loses."""
    own_work(distance)
    for metres in (1.0, 0.1, 0.01):
        lat = GPS_POINT_1.lat + math.degrees(metres / EARTH_RADIUS_M)
        value = ask_number(distance, GPS_POINT_1.lat, GPS_POINT_1.lon, lat, GPS_POINT_1.lon)
        expect(
            metres < 1.0 or 0.9 < value < 1.1,
            f"two points 1 m apart come out {value:.4g} m apart: see to the checks above first.",
        )
        expect(
            close(value, metres, 1e-3),
            f"two points {metres:g} m apart come out {value:.4f} m apart: which function loses its digits near 0 m?",
        )
    return Passed("One centimetre comes out as one centimetre.")


def bearing_known(bearing: Function) -> Passed:
    """bearing(lat_1, lon_1, lat_2, lon_2) in degrees clockwise from north, up to full turns: the four directions, and places."""
    own_work(bearing)
    home = GeoPoint(lat=10.0, lon=20.0)
    compass = [("north", 0.0, 1.0), ("south", 0.0, -1.0), ("east", 1.0, 0.0), ("west", -1.0, 0.0)]
    for name, east, north in compass:
        a, b = home, point_at(home, 1000.0 * east, 1000.0 * north)
        value = ask_number(bearing, a.lat, a.lon, b.lat, b.lon)
        _explain_bearing(
            value,
            a,
            b,
            f"to a point 1 km {name} of you the bearing comes out as {value:.4g}: where does it count from?",
        )
    for a, b in [(GPS_POINT_1, GPS_POINT_2), *_places(20)]:
        value = ask_number(bearing, a.lat, a.lon, b.lat, b.lon)
        _explain_bearing(
            value,
            a,
            b,
            "the bearing between two known places is wrong: compare with (15) to (17), term by term.",
        )
    paper = math.degrees(initial_bearing(GPS_POINT_1, GPS_POINT_2))
    return Passed(f"{paper:.2f} deg for the paper's two points, and right elsewhere.")


def bearing_range(bearing: Function) -> Passed:
    """It is in [0, 360) everywhere: just west of north is nearly 360, and not a little less than 0."""
    own_work(bearing)
    west_of_north = (GPS_POINT_1, point_at(GPS_POINT_1, -0.1, 57.0))
    for a, b in [west_of_north, *_places(40)]:
        value = ask_number(bearing, a.lat, a.lon, b.lat, b.lon)
        expect(
            value >= 0.0,
            f"the bearing comes out as {value:.4g} deg for a goal in the west; the compass goes on from 270 to 360.",
        )
        expect(value < 360.0, f"the bearing comes out as {value:.4g} deg: a full turn is 0 again.")
    back = (west_of_north[1], west_of_north[0])
    there, home = (
        ask_number(bearing, a.lat, a.lon, b.lat, b.lon) for a, b in (west_of_north, back)
    )
    expect(
        _same_direction(there, home + 180.0, 1e-3),
        "over 57 m the way back must point the opposite way, to a thousandth of a degree.",
    )
    return Passed(
        f"A goal 10 cm west of north is at {there:.1f} deg, the way back at {home:.1f} deg."
    )


def local_known(local: Callable[[float, float, float, float], tuple[float, float]]) -> Passed:
    """local(lat_0, lon_0, lat, lon): (east, north) in metres of points within 300 m, to 2 cm."""
    own_work(local)
    for origin, point in [(GPS_POINT_1, GPS_POINT_2), *_walks(30)]:
        right = local_position(origin, point)
        value = ask_numbers(local, 2, origin.lat, origin.lon, point.lat, point.lon)
        if not _on_the_spot(value, right):
            narrow = math.cos(math.radians(origin.lat))
            wide = (right[0] / narrow, right[1])
            expect(
                not _on_the_spot(value[::-1], right),
                "east and north have changed places: x is east and comes first.",
            )
            expect(
                not _on_the_spot((-value[0], -value[1]), right),
                "both signs are wrong: is it the origin as seen from the point?",
            )
            expect(
                not _on_the_spot((-value[0], value[1]), right),
                "the map is mirrored: longitudes grow to the east, and so does x.",
            )
            expect(
                not _on_the_spot((value[0], -value[1]), right),
                "the map is upside down: latitudes grow to the north, and so does y.",
            )
            expect(
                not _on_the_spot(value, wide),
                "north is right and east too long: a degree of longitude is shorter away from the equator.",
            )
            expect(
                not _on_the_spot(value, (wide[0] * math.cos(origin.lat), right[1])),
                "north is right and east is not: a cosine of degrees?",
            )
            expect(
                not _on_the_spot((value[0] * 1000.0, value[1] * 1000.0), right),
                "the result is in kilometres; metres are asked for.",
            )
            expect(
                not _on_the_spot((math.radians(value[0]), math.radians(value[1])), right),
                "57 times too long: metres for each *radian*.",
            )
            expect(math.dist(value, right) > 0.01 * math.hypot(*right), _RADIUS)
            expect(
                False,
                f"a point comes out at ({value[0]:.5g}, {value[1]:.5g}) m, and is not there: try points due north, then due east.",
            )
    east, north = local_position(GPS_POINT_1, GPS_POINT_2)
    return Passed(f"The paper's goal lies {east:.2f} m east and {north:.2f} m north of its start.")


def local_properties(local: Callable[[float, float, float, float], tuple[float, float]]) -> Passed:
    """As far to the east as to the west, as long as the distance, and no jump where longitudes go from 180 to -180."""
    own_work(local)
    for origin, point in _walks(20):
        offset = point.lon - origin.lon
        east, north = ask_numbers(local, 2, origin.lat, origin.lon, point.lat, point.lon)
        west, same = ask_numbers(local, 2, origin.lat, origin.lon, point.lat, origin.lon - offset)
        expect(
            close(east, -west, 1e-6, 1e-6) and close(north, same, 1e-6, 1e-6),
            "a point mirrored from east to west must only change x.",
        )
        apart = haversine_distance(origin, point)
        length = math.hypot(east, north)
        expect(
            close(length, apart, 0.0, _MAP_TOLERANCE_M) or not close(length, apart, 0.01), _RADIUS
        )
        expect(
            close(length, apart, 0.0, _MAP_TOLERANCE_M),
            "x and y together must be as long as the distance.",
        )
    for lat in (0.0, -17.0, 52.0):
        for lon, other in ((179.9995, -179.9995), (-179.9995, 179.9995)):
            right = local_position(GeoPoint(lat=lat, lon=lon), GeoPoint(lat=lat, lon=other))
            east, north = ask_numbers(local, 2, lat, lon, lat, other)
            far = f"from longitude {lon:g} to {other:g} deg it is a short walk, not {abs(east) / 1000.0:.0f} km"
            expect(
                _on_the_spot((east, north), right), f"{far}: full turns of a longitude don't count."
            )
    return Passed(
        "East mirrors west, the length is the distance, and the date line is a line like any other."
    )


def _explain_bearing(value: float, a: GeoPoint, b: GeoPoint, otherwise: str) -> None:
    """Raises Hint unless the value is the bearing from a to b, up to full turns."""
    right = math.degrees(initial_bearing(a, b))
    if _same_direction(value, right):
        return
    expect(
        not _same_direction(math.degrees(value), right),
        "the result is in radians; degrees are asked for.",
    )
    expect(
        not _same_direction(90.0 - value, right),
        "this counts from east, as mathematicians do: which argument of atan2 comes first in (15)?",
    )
    expect(
        not _same_direction(-value, right),
        "east and west are mirrored: longitudes grow to the east.",
    )
    expect(
        not _same_direction(value + 180.0, right),
        "this points the opposite way: is it the way back, or an atan, which can't tell the two?",
    )
    expect(
        not _same_direction(value, math.degrees(initial_bearing(*_swapped(a, b))) + _flip(a.lon)),
        _SWAPPED,
    )
    lat_as_radians = math.degrees(a.lat)
    expect(
        not _same_direction(
            value, math.degrees(initial_bearing(*_in_degrees(a, b))) + _flip(lat_as_radians)
        ),
        _DEGREES,
    )
    expect(False, otherwise)


def _same_direction(value: float, right: float, tolerance: float = 1e-6) -> bool:
    """In degrees, up to full turns."""
    return math.isfinite(value) and abs(math.remainder(value - right, 360.0)) < tolerance


def _on_the_spot(value: tuple[float, float], right: tuple[float, float]) -> bool:
    return math.dist(value, right) < _MAP_TOLERANCE_M


def _swapped(*points: GeoPoint) -> list[GeoPoint]:
    """Where someone ends who takes the latitude for the longitude and the other way round."""
    return [_anywhere(each.lon, each.lat) for each in points]


def _in_degrees(*points: GeoPoint) -> list[GeoPoint]:
    """Where someone ends who takes the degrees for radians."""
    return [_anywhere(math.degrees(each.lat), math.degrees(each.lon)) for each in points]


def _anywhere(lat: float, lon: float) -> GeoPoint:
    """The place with any two angles in degrees: who goes past a pole comes down on the other side, where (13) to (17) hold as well."""
    lat_within = math.degrees(math.asin(math.sin(math.radians(lat))))
    return GeoPoint(lat=lat_within, lon=math.remainder(lon + _flip(lat), 360.0))


def _flip(lat: float) -> float:
    """Past a pole, the formulas' north (in degrees) points back."""
    return 180.0 if math.cos(math.radians(lat)) < 0.0 else 0.0


def _places(count: int) -> list[Pair]:
    """Pairs of places that are the same each time, far enough from each other and from the poles for a mistake to show."""
    random = np.random.default_rng(1)
    lats, lons = random.uniform(-70.0, 70.0, (count, 2)), random.uniform(-150.0, 150.0, (count, 2))
    return [
        (GeoPoint(lat=lat[0], lon=lon[0]), GeoPoint(lat=lat[1], lon=lon[1]))
        for lat, lon in zip(lats.tolist(), lons.tolist(), strict=True)
    ]


def _walks(count: int) -> list[Pair]:
    """Places up to 60 deg from the equator, and points 20 m to 300 m from them in all directions."""
    random = np.random.default_rng(2)
    rows = random.uniform(
        [-60.0, -170.0, 20.0, -math.pi], [60.0, 170.0, 300.0, math.pi], (count, 4)
    ).tolist()
    origins = [(GeoPoint(lat=lat, lon=lon), length, angle) for lat, lon, length, angle in rows]
    return [
        (origin, point_at(origin, length * math.cos(angle), length * math.sin(angle)))
        for origin, length, angle in origins
    ]
