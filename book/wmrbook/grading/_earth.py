"""What a wrong distance or bearing on the Earth tells of its mistake."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._asking import ask_number
from wmrbook.grading._hints import Hint, close, drawn, expect, rule_out, slip
from wmrlib.geodesy import EARTH_RADIUS_M, GeoPoint, haversine_distance, initial_bearing

Function = Callable[[float, float, float, float], float]
Pair = tuple[GeoPoint, GeoPoint]

_SWAPPED = "this is what comes out with latitude and longitude swapped: which one has the cosine?"
_DEGREES = "this is what comes out when degrees go into a sine: `math.radians` first."
CONSTANT = "this is what you return for other places too: does your answer depend on them?"
CLEAR = GeoPoint(lat=20.0, lon=10.0), GeoPoint(lat=50.0, lon=60.0)  # here mistakes differ most


def places(count: int) -> list[Pair]:
    """Pairs of places, far enough from each other and from the poles for a mistake to show."""
    rows = drawn(1, count, *[(-70.0, 70.0), (-150.0, 150.0)] * 2)
    return [(GeoPoint(lat=row[0], lon=row[1]), GeoPoint(lat=row[2], lon=row[3])) for row in rows]


def between(function: Function, a: GeoPoint, b: GeoPoint) -> float:
    return ask_number(function, a.lat, a.lon, b.lat, b.lon)


def distance_right(distance: Function, a: GeoPoint, b: GeoPoint) -> bool:
    """Whether the student's distance is right; over 58 m an acos may lose 0.3 mm."""
    return close(between(distance, a, b), haversine_distance(a, b), 1e-6, 1e-3)


def explain_distance(distance: Function, a: GeoPoint, b: GeoPoint) -> None:
    """Raise Hint: the student's distance from a to b is wrong."""
    if not distance_right(distance, *CLEAR):
        a, b = CLEAR
    value, right = between(distance, a, b), haversine_distance(a, b)
    angles = np.radians([b.lat - a.lat, b.lon - a.lon])
    north, east = (math.sin(angle / 2.0) ** 2 for angle in angles)
    one, two = (math.cos(math.radians(point.lat)) for point in (a, b))
    sines = math.sqrt((1.0 - one**2) * (1.0 - two**2))
    mistaken = {_SWAPPED: _swapped(a, b), _DEGREES: in_degrees(a, b)}
    rule_out(value, {hint: haversine_distance(*pair) for hint, pair in mistaken.items()})
    for hint, *products in (
        ("(11) has the cosines of both latitudes; yours has only one.", one, two),
        ("(11) has the cosines of both latitudes; yours has one of them twice.", one**2, two**2),
        ("a degree of longitude is shorter away from the equator: look at (11).", 1.0),
        ("(11) has cosines where yours has sines.", sines),
        ("a cosine was given degrees: `math.radians` first.", math.cos(a.lat) * math.cos(b.lat)),
    ):
        for product in products:
            half = min(1.0, north + max(0.0, product) * east)
            rule_out(value, {hint: 2.0 * EARTH_RADIUS_M * math.asin(math.sqrt(half))})
    slip(value, right, within=0.0)
    share, there = value / right, places(1)[0]
    far = between(distance, *there)
    expect(not close(value, far), CONSTANT)
    expect(not close(share, 1e-3, 2e-3), "the result is in kilometres; metres are asked for.")
    if close(far / haversine_distance(*there), share, 1e-5):
        hint = "the result is half as long as it should be: look at the factor in (12)."
        expect(not close(share, 0.5, 2e-3), hint)
        hint = f"every distance is {share:.7g} times as long as it should be: is the radius "
        expect(False, f"{hint}6371 km, pi `math.pi`, the factor that of (12), the unit a metre?")
    hint = "the distance between two known places is wrong: compare your haversine with "
    expect(False, f"{hint}(11) to (13), term by term.")


def explain_bearing(bearing: Function, a: GeoPoint, b: GeoPoint, otherwise: str) -> None:
    """Raise Hint unless the student's bearing from a to b is right, up to full turns."""
    value, right = between(bearing, a, b), math.degrees(initial_bearing(a, b))
    if same_direction(value, right):
        return
    there, right_there = between(bearing, *CLEAR), math.degrees(initial_bearing(*CLEAR))
    expect(not close(value, there), CONSTANT)
    if not same_direction(there, right_there):
        _rule_out_bearings(there, *CLEAR)
        slip(there, right_there)
    _rule_out_bearings(value, a, b)
    off = abs(math.remainder(value - right, 360.0))
    near = f"this bearing is {off:.2g} deg off: which term of (15) to (17) counts for so little?"
    expect(off > 1.0, near)
    raise Hint(otherwise.format(value))


def _rule_out_bearings(value: float, a: GeoPoint, b: GeoPoint) -> None:
    right, east = math.degrees(initial_bearing(a, b)), b.lon - a.lon
    flat = math.atan2(east * math.cos(math.radians(a.lat)), b.lat - a.lat)
    final = math.degrees(initial_bearing(b, a)) + 180.0
    # the latitudes on Mercator's map
    low, high = (math.asinh(math.tan(math.radians(point.lat))) for point in (a, b))
    rhumb = math.degrees(math.atan2(math.radians(east), high - low))
    radians = "the result is in radians; degrees are asked for."
    expect(not same_direction(math.degrees(value), right), radians)
    swapped = math.degrees(initial_bearing(*_swapped(a, b))) + _flip(a.lon)
    degrees = math.degrees(initial_bearing(*in_degrees(a, b))) + _flip(math.degrees(a.lat))
    mistakes = {
        "this counts from east, as mathematicians do: "
        "which argument of atan2 comes first in (15)?": 90.0 - right,
        "east and west are mirrored: longitudes grow to the east.": -right,
        "this points the opposite way: "
        "is it the way back, or an atan, which can't tell the two?": right + 180.0,
        _SWAPPED: swapped,
        _DEGREES: degrees,
        "this is the direction on a flat map; (15) is that on the sphere.": math.degrees(flat),
        "a line of constant bearing begins so; (15) is how the shortest way begins.": rhumb,
        "the shortest way *ends* with this bearing; (15) is how it begins.": final,
    }
    rule_out(value, mistakes, same_direction)


def same_direction(value: float, right: float, tolerance: float = 1e-6) -> bool:
    """In degrees, up to full turns."""
    return math.isfinite(value) and abs(math.remainder(value - right, 360.0)) < tolerance


def _swapped(*points: GeoPoint) -> list[GeoPoint]:
    """Where someone ends who takes the latitude for the longitude and the other way round."""
    return [_anywhere(point.lon, point.lat) for point in points]


def in_degrees(*points: GeoPoint) -> list[GeoPoint]:
    """Where someone ends who takes the degrees for radians."""
    return [_anywhere(math.degrees(point.lat), math.degrees(point.lon)) for point in points]


def _anywhere(lat: float, lon: float) -> GeoPoint:
    """The place at any two angles in degrees; past a pole, (13) to (17) still hold."""
    lat_within = math.degrees(math.asin(math.sin(math.radians(lat))))
    return GeoPoint(lat=lat_within, lon=math.remainder(lon + _flip(lat), 360.0))


def _flip(lat: float) -> float:
    """Past a pole, the formulas' north (in degrees) points back."""
    return 180.0 if math.cos(math.radians(lat)) < 0.0 else 0.0
