"""The checks of distance, bearing and local map: other right answers pass, and what is no answer gets a clear hint."""

import math

import numpy as np
import pytest
from geographiclib.geodesic import Geodesic

import wmrlib as wmr
from wmrbook.grading import Hint, earth

RADIUS = 6_371_000.0


def unit(lat, lon):
    lat, lon = math.radians(lat), math.radians(lon)
    return np.array([math.cos(lat) * math.cos(lon), math.cos(lat) * math.sin(lon), math.sin(lat)])


def distance(lat_1, lon_1, lat_2, lon_2):
    p, q = unit(lat_1, lon_1), unit(lat_2, lon_2)
    return RADIUS * np.arctan2(np.linalg.norm(np.cross(p, q)), p @ q)


def bearing(lat_1, lon_1, lat_2, lon_2):
    """By the geodesic of a sphere: another library's formula."""
    return Geodesic(RADIUS, 0.0).Inverse(lat_1, lon_1, lat_2, lon_2)["azi1"] % 360.0


def local(lat_0, lon_0, lat, lon):
    length, angle = distance(lat_0, lon_0, lat, lon), math.radians(bearing(lat_0, lon_0, lat, lon))
    return np.array([length * math.sin(angle), length * math.cos(angle)])


def test_other_formulas_pass():
    for check in (earth.distance_known, earth.distance_properties, earth.distance_close):
        assert check(distance)
    for check in (earth.bearing_known, earth.bearing_range):
        assert check(bearing)
    for check in (earth.local_known, earth.local_properties):
        assert check(local)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda a, b, c, d: 58.0758, "wrong"),
        (lambda a, b, c, d: distance(a, b, c, d) / 1000, "kilometres"),
        (lambda a, b, c, d: distance(a, b, c, d) / 2, "half as long"),
        (lambda a, b, c, d: distance(a, b, c, d) * 1.001, "nearly right"),
        (lambda a, b, c, d: None, "returns nothing"),
        (lambda a, b, c, d: [1.0, 2.0], "one number is needed"),
        (
            lambda a, b, c, d: wmr.haversine_distance(
                wmr.GeoPoint(lat=a, lon=b), wmr.GeoPoint(lat=c, lon=d)
            ),
            "of wmrlib",
        ),
    ],
)
def test_distance_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        earth.distance_known(answer)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda a, b, c, d: math.radians(bearing(a, b, c, d)), "in radians"),
        (lambda a, b, c, d: 90.0 - bearing(a, b, c, d), "counts from east"),
        (lambda a, b, c, d: bearing(c, d, a, b), "is it the way back"),
        (lambda a, b, c, d: -bearing(a, b, c, d), "mirrored"),
        (lambda a, b, c, d: bearing(a, b, c, d) % 180.0, "opposite way"),
        (
            lambda a, b, c, d: bearing(b, a, d, c) if max(abs(b), abs(d)) < 90 else 0.0,
            "opposite way|counts from|swapped|wrong",
        ),
        (lambda a, b, c, d: 12.0, "where does it count from"),
        (lambda a, b, c, d: 1e308, "where does it count from"),
    ],
)
def test_bearing_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        earth.bearing_known(answer)


def test_bearing_needs_the_compass_range():
    earth.bearing_known(lambda *each: bearing(*each) - 360.0)
    with pytest.raises(Hint, match="goes on from 270 to 360"):
        earth.bearing_range(lambda *each: math.remainder(bearing(*each), 360.0))
    with pytest.raises(Hint, match="a full turn is 0 again"):
        earth.bearing_range(lambda *each: bearing(*each) + 360.0)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda *each: local(*each)[::-1], "changed places"),
        (lambda *each: -local(*each), "both signs"),
        (lambda *each: local(*each) * [-1, 1], "mirrored"),
        (lambda *each: local(*each) * [1, -1], "upside down"),
        (lambda *each: local(*each) / [math.cos(math.radians(each[0])), 1], "east too long"),
        (
            lambda *each: local(*each) / [math.cos(math.radians(each[0])) / math.cos(each[0]), 1],
            "cosine of degrees",
        ),
        (lambda *each: local(*each) / 1000, "kilometres"),
        (lambda *each: np.degrees(local(*each)), "radian"),
        (lambda *each: local(*each) * 1.02, "is not there"),
        (lambda *each: local(*each) * 6378.137 / 6371.0, "a sphere of 6371 km"),
        (lambda *each: local(*each) * [111320 / 111195, 110574 / 111195], "a sphere of 6371 km"),
        (lambda *each: (1e308, 1e308), r"comes out at \(1e\+308, 1e\+308\) m"),
        (lambda *each: {5.0, 6.0}, "2 numbers"),
        (lambda *each: 5.0, "2 numbers"),
    ],
)
def test_local_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        earth.local_known(answer)


def test_a_map_of_another_earth():
    with pytest.raises(Hint, match="a sphere of 6371 km"):
        earth.local_properties(lambda *each: local(*each) * 6378.137 / 6371.0)
    with pytest.raises(Hint, match="as long as the distance"):
        earth.local_properties(lambda *each: local(*each) * 1.02)


def test_lost_digits_are_blamed_for_lost_digits_only():
    def by_acos(a, b, c, d):
        return RADIUS * math.acos(min(1.0, unit(a, b) @ unit(c, d)))

    with pytest.raises(Hint, match="loses its digits near 0 m"):
        earth.distance_close(by_acos)
    with pytest.raises(
        Hint, match=r"two points 1 m apart come out 0.001 m apart: see to the checks above"
    ):
        earth.distance_close(lambda *each: distance(*each) / 1000)


def test_a_distance_that_is_next_to_nothing():
    with pytest.raises(Hint, match="must be positive"):
        earth.distance_properties(lambda *each: 1e-308)
