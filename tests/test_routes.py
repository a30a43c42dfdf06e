"""Routes against legs simulated by hand, anywhere on Earth, and out to a GPX file and back."""

import math
import re
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook.chapters import routes

GENTLE = wmr.Gains(k_rho=0.4, k_alpha=2.0, h=1.0, v_max=3.0)
SQUARE = wmr.Pose(
    np.array([0.0, 20.0, 20.0, 0.0]),
    np.array([0.0, 0.0, 20.0, 20.0]),
    np.array([0.0, 0.8, 2.3, math.pi]),
)
CAMPUS = wmr.GeoPoint(
    lat=[33.273572, 33.2738, 33.2742, 33.274087], lon=[44.373160, 44.3734, 44.3733, 44.373264]
)
START = wmr.Pose(0.0, 0.0, 0.3)
ONE = wmr.Pose(1.0, 2.0, 0.0)

metres = st.floats(-40.0, 40.0)
lines = st.lists(st.tuples(metres, metres), min_size=2, max_size=5).map(np.array)


# Headings


def test_headings_by_hand():
    degrees = np.degrees(routes.headings_along([0, 10, 10, 0], [0, 0, 1, 1]))
    np.testing.assert_allclose(degrees, [0, 45, 135, 180])
    for angle in np.linspace(-3.0, 3.0, 7):  # a hairpin is taken to the left
        x, y = np.cos(angle) * np.array([1, 7, 1]), np.sin(angle) * np.array([1, 7, 1])
        expected = [angle, angle + math.pi / 2, angle + math.pi]
        np.testing.assert_allclose(np.cos(routes.headings_along(x, y) - expected), 1.0)
    assert routes.headings_along(3.0, 4.0).tolist() == [0.0]
    assert routes.headings_along([3.0] * 3, [4.0] * 3).tolist() == [0.0] * 3


@given(lines, st.data())
def test_headings_bisect_the_turns(points, data):
    """As much of each turn before its point as after it; and a second way, adding unit vectors."""
    legs, (x, y) = np.diff(points, axis=0), points.T
    assume(np.hypot(*legs.T).min() > 3.0)
    turns = [math.atan2(a[0] * b[1] - a[1] * b[0], a @ b) for a, b in pairwise(legs)]
    assume(np.abs(turns).max(initial=0.0) < 3.0)  # no hairpin
    headings = routes.headings_along(x, y)
    direction = np.arctan2(np.diff(y), np.diff(x))
    ends = wmr.wrap_angle(headings[[0, -1]] - direction[[0, -1]])
    np.testing.assert_allclose(ends, 0.0, atol=1e-12)
    before = wmr.wrap_angle(headings[1:-1] - direction[:-1])
    after = wmr.wrap_angle(direction[1:] - headings[1:-1])
    np.testing.assert_allclose(before, after, atol=1e-9)
    np.testing.assert_allclose(before + after, turns, atol=1e-9)
    units = legs / np.hypot(*legs.T)[:, None]
    east, north = (units[:-1] + units[1:]).T
    summed = wmr.wrap_angle(headings[1:-1] - np.arctan2(north, east))
    np.testing.assert_allclose(summed, 0.0, atol=1e-7)
    # points that repeat change nothing
    count = np.array(data.draw(st.lists(st.integers(1, 3), min_size=len(x), max_size=len(x))))
    repeated = routes.headings_along(np.repeat(x, count), np.repeat(y, count))
    np.testing.assert_array_equal(repeated, np.repeat(headings, count))


# Driving


def test_a_route_is_its_legs_one_after_the_other():
    way = [wmr.Pose(*map(float, corner)) for corner in zip(*SQUARE, strict=True)]
    for method, stop, radii in [
        ("arc", True, [0.05] * 3),
        ("euler", False, [2.0, 2.0, 0.05]),
        ("continuous", [True, False, False], [0.05, 2.0, 2.0]),
    ]:
        route = routes.drive_route(SQUARE, GENTLE, stop=stop, method=method)
        assert route.outcome is wmr.Outcome.ARRIVED
        assert route.reached == len(route.legs) == 3
        pose, time, length = way[0], 0.0, 0.0
        for k, (mine, goal) in enumerate(zip(route.legs, way[1:], strict=True)):
            theirs = wmr.simulate(pose, goal, GENTLE, method=method, arrival_radius=radii[k])
            pose = wmr.Pose(*(float(getattr(theirs, name)[-1]) for name in wmr.Pose._fields))
            here, counted = route.leg == k, slice(None if k == 2 else -1)
            for name in ("x", "y", "heading", "v", "omega", "V"):
                np.testing.assert_array_equal(getattr(mine, name), getattr(theirs, name))
                joined = getattr(route, name)[here]
                np.testing.assert_array_equal(joined, getattr(theirs, name)[counted])
            np.testing.assert_allclose(route.t[here], time + theirs.t[counted])
            time, length = time + theirs.t[-1], length + theirs.path_length
            assert mine.rho[-1] <= radii[k] + 1e-9
            assert route.arrivals[k] == wmr.arrival(theirs)
        assert route.time == pytest.approx(time)
        assert route.length == pytest.approx(length)
        time, length = f"{route.time:.4g} s", f"{route.length:.4g} m"
        assert repr(route) == f"<Route: 3 of 3 waypoints reached in {time}, {length} long>"
    # one waypoint with a start is a run
    route = routes.drive_route(ONE, GENTLE, start=START)
    run = wmr.simulate(START, ONE, GENTLE, duration=120.0)
    np.testing.assert_array_equal(route.x, run.x)
    assert route.stops == (True,)


def test_a_leg_that_fails_is_the_last():
    far = wmr.Pose(np.array([0.0, 5.0, 500.0, 505.0]), 0.0, 0.0)
    route = routes.drive_route(far, GENTLE, duration=30.0)
    assert (route.outcome, route.reached, len(route.legs)) == (wmr.Outcome.TIMED_OUT, 1, 2)
    assert route.time == math.inf
    assert [arrival.arrived for arrival in route.arrivals] == [True, False]
    assert route.waypoints.x.tolist() == [5.0, 500.0, 505.0]
    assert 30.0 < route.t[-1] < 60.0
    ended = "reached; leg 2 did not arrive within the duration, .* m from its waypoint>"
    assert re.fullmatch(f"<Route: 1 of 3 waypoints {ended}", repr(route))
    assert routes.drive_route(far, GENTLE).legs[1].t[-1] == pytest.approx(120.0)


# GPS points


def test_poses_of_gps_points():
    poses = routes.route_poses(CAMPUS)
    first, second = (wmr.GeoPoint(lat=CAMPUS.lat[k], lon=CAMPUS.lon[k]) for k in (0, 1))
    assert (poses.x[0], poses.y[0]) == (0.0, 0.0)
    assert (poses.x[1], poses.y[1]) == pytest.approx(wmr.local_position(first, second))
    # from east, against from north
    assert poses.heading[0] == pytest.approx(math.pi / 2 - wmr.initial_bearing(first, second))
    np.testing.assert_array_equal(poses.heading, routes.headings_along(poses.x, poses.y))
    own = [1.0, 2.0, 3.0, -1.0]
    for given_headings, expected in [
        (own, own),
        (np.array(own), own),
        ([math.nan, math.nan, 0.5, math.nan], [*poses.heading[:2], 0.5, poses.heading[3]]),
    ]:
        headings = routes.route_poses(CAMPUS, given_headings).heading
        np.testing.assert_array_equal(headings, expected)
    # another origin moves the frame
    origin = wmr.GeoPoint(lat=33.2730, lon=44.3730)
    there, shift = routes.route_poses(CAMPUS, origin=origin), wmr.local_position(origin, first)
    np.testing.assert_allclose(there.x - poses.x, shift[0], atol=1e-3)
    np.testing.assert_allclose(there.y - poses.y, shift[1], atol=1e-3)


def test_a_square_anywhere_on_earth_is_driven_as_in_the_plane():
    plane = routes.drive_route(SQUARE, GENTLE, stop=False)
    poles = (89.9999, 10.0), (90.0, 0.0), (-90.0, 0.0)
    for lat, lon in [(33.27, 44.37), (-17.0, 179.9999), (0.0, -180.0), *poles]:
        home = wmr.GeoPoint(lat=lat, lon=lon)
        poses = routes.route_poses(
            wmr.point_at(home, SQUARE.x, SQUARE.y), SQUARE.heading, origin=home
        )
        route = routes.drive_route(poses, GENTLE, stop=False)
        np.testing.assert_allclose(route.x, plane.x, atol=1e-5)
        np.testing.assert_allclose(route.y, plane.y, atol=1e-5)


def test_out_to_gpx_and_back(tmp_path):
    route = routes.drive_route(routes.route_poses(CAMPUS), GENTLE, stop=False)
    file, begin = tmp_path / "route.gpx", datetime(2026, 3, 1, tzinfo=UTC)
    wmr.write_gpx(file, routes.route_points(route, CAMPUS), t=route.t, begin=begin)
    track = wmr.read_track(file)
    assert len(track) == len(route)
    np.testing.assert_allclose(track.t, route.t, rtol=0.0, atol=1e-6)
    assert not track.report.skipped
    x, y = wmr.local_position(wmr.GeoPoint(lat=CAMPUS.lat[0], lon=CAMPUS.lon[0]), track.points)
    assert np.hypot(x - route.x, y - route.y).max() < 0.01  # 7 decimals of a degree
    goal = wmr.GeoPoint(lat=CAMPUS.lat[-1], lon=CAMPUS.lon[-1])
    last = wmr.GeoPoint(lat=track.points.lat[-1], lon=track.points.lon[-1])
    assert wmr.haversine_distance(last, goal) < 0.06


def test_bad_input():
    drive, poses, along = routes.drive_route, routes.route_poses, routes.headings_along
    none, square = wmr.Pose([], [], []), wmr.Pose(np.ones((2, 2)), 0.0, 0.0)
    for make, message in [
        (lambda: along([1, 2], [1]), r"mismatched lengths: x has shape \(2,\), y has shape \(1,\)"),
        (lambda: along([], []), "at least one number"),
        (lambda: poses(CAMPUS, [1]), r"headings have shape \(1,\), points have shape \(4,\)"),
        (lambda: poses(CAMPUS, origin=CAMPUS), "origin = .* a single point is needed"),
        (lambda: drive(ONE, GENTLE), r"poses have shape \(1,\), .* at least one waypoint besides"),
        (lambda: drive(none, GENTLE, start=ONE), r"poses have shape \(0,\)"),
        (lambda: drive(square, GENTLE), r"poses have shape \(2, 2\)"),
        (lambda: drive(SQUARE, GENTLE, start=SQUARE), r"start\.x = .* one number is needed"),
        (lambda: drive(SQUARE, GENTLE, stop=[True]), r"stop = \[True\] .* a list of 3, one a way"),
    ]:
        with pytest.raises(ValueError, match=message):
            make()
