"""The scatter of a receiver that does not move, against the ellipsoid and by property."""

import math

import numpy as np
import pytest
from geographiclib.geodesic import Geodesic
from logs import STANDING

import wmrlib as wmr
from wmrbook.scatter import stationary_scatter


def test_scatter_of_the_log_against_the_ellipsoid():
    track = wmr.read_track(STANDING)
    scatter = stationary_scatter(track)
    lines = [
        Geodesic.WGS84.Inverse(scatter.mean.lat, scatter.mean.lon, lat, lon)
        for lat, lon in zip(track.points.lat, track.points.lon, strict=True)
    ]
    distance = np.array([line["s12"] for line in lines])
    bearing = np.radians([line["azi1"] for line in lines])
    east, north = distance * np.sin(bearing), distance * np.cos(bearing)
    np.testing.assert_allclose(scatter.east, east, rtol=0.0057, atol=1e-3)
    np.testing.assert_allclose(scatter.north, north, rtol=0.0057, atol=1e-3)
    assert scatter.std_east == pytest.approx(east.std(ddof=1), rel=0.0057)
    assert scatter.std_north == pytest.approx(north.std(ddof=1), rel=0.0057)
    assert scatter.covariance[0, 1] == pytest.approx(np.cov(east, north)[0, 1], rel=0.012)
    assert scatter.cep == pytest.approx(np.median(distance), rel=0.0057)
    assert scatter.two_drms == pytest.approx(2 * math.hypot(scatter.std_east, scatter.std_north))
    assert repr(scatter).startswith(
        "<StationaryScatter: 9 positions about 54.0934728 deg N, 10.8247669 deg E; "
        "std 3.55 m east, 0.444 m north"
    )


def test_mean_and_scatter_anywhere():
    """Positions laid about a centre with a known scatter, over the date line and over the poles."""
    rng = np.random.default_rng(9)
    east, north = rng.normal(0, 3, 400), rng.normal(0, 1, 400)
    east, north = east - east.mean(), north - north.mean()
    std_east, std_north = east.std(ddof=1), north.std(ddof=1)
    for lat, lon in [(33.27, 44.37), (10.0, 180.0), (-40.0, -180.0), (90.0, 0.0), (-90.0, 70.0)]:
        centre = wmr.GeoPoint(lat=lat, lon=lon)
        scatter = stationary_scatter(wmr.point_at(centre, east, north))
        assert wmr.haversine_distance(scatter.mean, centre) < 1e-6
        size = math.hypot(scatter.std_east, scatter.std_north)
        assert size == pytest.approx(math.hypot(std_east, std_north), rel=1e-6)
        if abs(lat) < 90.0:  # at a pole east depends on the longitude of the mean
            assert scatter.std_east == pytest.approx(std_east, rel=1e-6)
            assert scatter.covariance[0, 1] == pytest.approx(np.cov(east, north)[0, 1], abs=1e-6)
        assert (scatter.east.mean(), scatter.north.mean()) == pytest.approx((0, 0), abs=1e-6)
    # far apart, the mean is still the middle of its frame
    far = wmr.GeoPoint(lat=[60.0, 62.0, 40.0], lon=[170.0, -165.0, 179.0])
    east, north = wmr.local_position(stationary_scatter(far).mean, far)
    assert (east.mean(), north.mean()) == pytest.approx((0, 0), abs=1e-6)
    assert np.ptp(east) > 1e6


def test_positions_without_a_scatter_are_refused():
    with pytest.raises(ValueError, match="track has 1 position"):
        stationary_scatter(wmr.GeoPoint(lat=[1.0], lon=[2.0]))
    with pytest.raises(ValueError, match="all over the Earth"):
        stationary_scatter(wmr.GeoPoint(lat=[0.0, 0.0], lon=[0.0, 180.0]))
    with pytest.raises(ValueError, match="a GeoPoint is needed, not a list"):
        stationary_scatter([1.0, 2.0])
