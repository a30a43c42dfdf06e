"""Geodesy against published vectors, against the WGS84 ellipsoid, and by property."""

import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from geographiclib.geodesic import Geodesic
from hypothesis import given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook.ellipsoid import sphere_error

HALF_TURN_M = math.pi * wmr.EARTH_RADIUS_M
latitudes = st.floats(-90.0, 90.0)
longitudes = st.floats(-180.0, 180.0)
points = st.builds(lambda lat, lon: wmr.GeoPoint(lat=lat, lon=lon), latitudes, longitudes)


def bearing_deg(a, b):
    return math.degrees(wmr.initial_bearing(a, b))


# Published vectors: https://www.movable-type.co.uk/scripts/latlong.html, sphere of 6371 km


def test_distances_bearings_and_destination_as_published():
    cambridge, paris = wmr.GeoPoint(lat=52.205, lon=0.119), wmr.GeoPoint(lat=48.857, lon=2.351)
    assert wmr.haversine_distance(cambridge, paris) == pytest.approx(404_279, abs=0.5)
    assert bearing_deg(cambridge, paris) == pytest.approx(156.2, abs=0.05)
    assert bearing_deg(paris, cambridge) == pytest.approx(337.9, abs=0.05)
    greenwich = wmr.GeoPoint(lat=51.47788, lon=-0.00147)
    there = wmr.destination_point(greenwich, 7794.0, math.radians(300.7))
    assert (there.lat, there.lon) == pytest.approx((51.5136, -0.0983), abs=5e-5)


# The ellipsoid, a second truth


def test_hundred_metres_anywhere_have_the_spheres_error():
    """The extremes, -0.45 % and +0.56 %, were worked out beforehand; the grid reaches them."""
    errors = []
    for lat in np.linspace(-89.0, 89.0, 90):
        for azimuth in np.arange(0.0, 360.0, 15.0):
            end = Geodesic.WGS84.Direct(lat, 20.0, azimuth, 100.0)
            a, b = wmr.GeoPoint(lat=lat, lon=20.0), wmr.GeoPoint(lat=end["lat2"], lon=end["lon2"])
            errors.append(wmr.haversine_distance(a, b) / 100.0 - 1.0)
            assert sphere_error(lat, math.radians(azimuth)) == pytest.approx(errors[-1], abs=1e-7)
            turn = wmr.wrap_angle(wmr.initial_bearing(a, b) - math.radians(azimuth))
            assert abs(turn) < math.radians(0.2)  # half of 1 - b^2/a^2
    assert (min(errors), max(errors)) == pytest.approx((-0.0045, 0.0056), abs=1e-4)


# Properties


@given(points, points)
def test_distance_is_the_angle_between_the_vectors(a, b):
    """A second method: the angle between the two directions in space, |a x b| against a . b."""
    first, second = (
        np.array([math.cos(p) * math.cos(q), math.cos(p) * math.sin(q), math.sin(p)])
        for p, q in ((math.radians(g.lat), math.radians(g.lon)) for g in (a, b))
    )
    angle = math.atan2(np.linalg.norm(np.cross(first, second)), first @ second)
    assert wmr.haversine_distance(a, b) == pytest.approx(wmr.EARTH_RADIUS_M * angle, abs=2e-8)


def test_all_digits_at_both_ends():
    """Against 50 digits, for the very points passed: rounding costs nanometres at most."""
    a = wmr.GeoPoint(lat=33.273572, lon=44.373160)
    antipode = wmr.GeoPoint(lat=-a.lat, lon=a.lon - 180.0)
    sin, cos, sqrt = mpmath.sin, mpmath.cos, mpmath.sqrt
    for gap in (1e-6, 1e-3, 1.0, 1e3, 1e6):
        for centre, tolerance in ((a, 0.0), (antipode, 1e-8)):
            b = wmr.destination_point(centre, gap, 0.4)
            with mpmath.workdps(50):
                lat1, lon1, lat2, lon2 = (
                    mpmath.radians(mpmath.mpf(angle)) for angle in (a.lat, a.lon, b.lat, b.lon)
                )
                across = cos(lat1) * cos(lat2) * sin((lon2 - lon1) / 2) ** 2
                e = sin((lat2 - lat1) / 2) ** 2 + across
                truth = 2 * wmr.EARTH_RADIUS_M * mpmath.atan2(sqrt(e), sqrt(1 - e))
                error = abs(float(wmr.haversine_distance(a, b) - truth))
            assert error <= max(1e-15 * float(truth), tolerance)


@given(st.floats(-89.9, 89.9), longitudes, st.floats(1e-3, 0.99 * HALF_TURN_M), st.floats(0.0, 6.2))
def test_destination_undoes_distance_and_bearing(lat, lon, distance, bearing):
    here = wmr.GeoPoint(lat=lat, lon=lon)
    there = wmr.destination_point(here, distance, bearing)
    assert wmr.haversine_distance(here, there) == pytest.approx(distance, rel=1e-9, abs=1e-7)
    off = abs(wmr.wrap_angle(wmr.initial_bearing(here, there) - bearing))
    across = off * wmr.EARTH_RADIUS_M * math.sin(distance / wmr.EARTH_RADIUS_M)
    assert across < 1e-5  # metres to the side of the wanted line


@given(st.floats(-89.0, 89.0), longitudes, st.floats(-1e5, 1e5), st.floats(-1e5, 1e5))
def test_point_at_undoes_local_position(lat, lon, east, north):
    origin = wmr.GeoPoint(lat=lat, lon=lon)
    back = wmr.local_position(origin, wmr.point_at(origin, east, north))
    assert back == pytest.approx((east, north), abs=1e-5)


# The odd but legal


def test_same_point_and_antipodes():
    a = wmr.GeoPoint(lat=33.0, lon=44.0)
    assert (wmr.haversine_distance(a, a), wmr.initial_bearing(a, a)) == (0.0, 0.0)
    assert wmr.local_position(a, a) == (0.0, 0.0)
    for lat in (0.0, 33.3, -90.0, 90.0):
        pair = wmr.GeoPoint(lat=lat, lon=20.0), wmr.GeoPoint(lat=-lat, lon=-160.0)
        assert wmr.haversine_distance(*pair) == pytest.approx(HALF_TURN_M, rel=1e-12)


def test_across_the_date_line_and_over_the_pole():
    west, east = wmr.GeoPoint(lat=0.0, lon=179.9999), wmr.GeoPoint(lat=0.0, lon=-179.9999)
    expected = pytest.approx(22.239, abs=1e-3), pytest.approx(0.0, abs=1e-9)
    assert wmr.local_position(west, east) == expected
    there = wmr.destination_point(west, 22.239, math.pi / 2)
    assert there.lon == pytest.approx(-179.9999, abs=1e-8)
    over = wmr.destination_point(wmr.GeoPoint(lat=89.999, lon=0.0), 1000.0, 0.0)
    assert (over.lat < 90.0, abs(over.lon)) == (True, pytest.approx(180.0))
    pole = wmr.GeoPoint(lat=90.0, lon=0.0)
    there = wmr.destination_point(pole, 1000.0, 0.5)
    assert wmr.haversine_distance(pole, there) == pytest.approx(1000.0)


offsets = st.sampled_from([0.0]) | st.floats(1e-13, 1e-3)


@given(latitudes, offsets, offsets, st.booleans())
def test_the_date_line_costs_no_digit(lat, west, east, swapped):
    """Close to it distance and bearing are those of the exact difference of longitudes."""
    lons = [180.0 - west, -180.0 + east]
    step = float(Fraction(lons[1]) + 360 - Fraction(lons[0]))
    a, b = (wmr.GeoPoint(lat=lat, lon=lon) for lon in (lons[::-1] if swapped else lons))
    zero, there = wmr.GeoPoint(lat=lat, lon=0.0), wmr.GeoPoint(lat=lat, lon=step)
    expected = [wmr.haversine_distance(zero, there), wmr.initial_bearing(zero, there)]
    if swapped:
        expected[1] = (2 * math.pi - expected[1]) % (2 * math.pi)
    computed = wmr.haversine_distance(a, b), wmr.initial_bearing(a, b)
    assert computed == pytest.approx(expected, rel=1e-12, abs=0.0)
    if west == east == 0.0:
        assert computed == (0.0, 0.0)


# Bad input


def test_points_of_other_lengths_are_refused_and_their_order_cannot_be_mixed_up():
    two, three = wmr.GeoPoint(lat=[1.0] * 2, lon=0.0), wmr.GeoPoint(lat=[1.0] * 3, lon=0.0)
    with pytest.raises(ValueError, match=r"a\.lat has shape \(2,\), b\.lat has shape \(3,\)"):
        wmr.haversine_distance(two, three)
    by_keyword = (
        r"GeoPoint\(44\.37, 33\.27\) is not .*: GeoPoint\(lat=\.\.\., lon=\.\.\.\), by keyword"
    )
    with pytest.raises(TypeError, match=by_keyword):
        wmr.GeoPoint(44.37, 33.27)
