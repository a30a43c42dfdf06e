"""Routes: against legs that are simulated by hand, by symmetry, and out to a GPX file and back."""

import math
from datetime import UTC, datetime
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import wmrlib as wmr

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

metres = st.floats(-40.0, 40.0)
angles = st.floats(-3.1, 3.1)
lines = st.lists(st.tuples(metres, metres), min_size=2, max_size=5).map(np.array)


def far_apart(points):
    assume(np.hypot(*np.diff(points, axis=0).T).min() > 3.0)
    return points[:, 0], points[:, 1]


def turns(points):
    legs = np.diff(points, axis=0)
    return np.array([math.atan2(a[0] * b[1] - a[1] * b[0], a @ b) for a, b in pairwise(legs)])


def no_hairpin(points):
    assume(np.abs(turns(points)).max(initial=0.0) < 3.0)


# Headings -------------------------------------------------------------------------------------------------------------


def test_headings_of_a_corner_by_hand():
    degrees = np.degrees(wmr.headings_along([0, 10, 10, 0], [0, 0, 1, 1]))
    np.testing.assert_allclose(degrees, [0, 45, 135, 180])


@given(lines)
def test_a_heading_has_as_much_of_the_turn_before_it_as_after(points):
    x, y = far_apart(points)
    no_hairpin(points)
    headings = wmr.headings_along(x, y)
    direction = np.arctan2(np.diff(y), np.diff(x))
    np.testing.assert_allclose(
        wmr.wrap_angle(headings[[0, -1]] - direction[[0, -1]]), 0.0, atol=1e-12
    )
    before = wmr.wrap_angle(headings[1:-1] - direction[:-1])
    after = wmr.wrap_angle(direction[1:] - headings[1:-1])
    np.testing.assert_allclose(before, after, atol=1e-9)
    np.testing.assert_allclose(before + after, turns(points), atol=1e-9)


@given(lines)
def test_a_bisecting_heading_is_the_sum_of_the_unit_vectors(points):
    """A second way: no angle is halved, two unit vectors are added."""
    x, y = far_apart(points)
    no_hairpin(points)
    legs = np.diff(points, axis=0)
    units = legs / np.hypot(*legs.T)[:, None]
    middle = units[:-1] + units[1:]
    np.testing.assert_allclose(
        wmr.wrap_angle(wmr.headings_along(x, y)[1:-1] - np.arctan2(middle[:, 1], middle[:, 0])),
        0.0,
        atol=1e-7,
    )


@given(lines, st.data())
def test_points_that_repeat_change_no_heading(points, data):
    x, y = far_apart(points)
    count = np.array(data.draw(st.lists(st.integers(1, 3), min_size=len(x), max_size=len(x))))
    np.testing.assert_array_equal(
        wmr.headings_along(np.repeat(x, count), np.repeat(y, count)),
        np.repeat(wmr.headings_along(x, y), count),
    )


@pytest.mark.parametrize("angle", np.linspace(-3.0, 3.0, 7))
def test_a_hairpin_is_taken_to_the_left(angle):
    x, y = np.cos(angle) * np.array([1.0, 7.0, 1.0]), np.sin(angle) * np.array([1.0, 7.0, 1.0])
    np.testing.assert_allclose(
        np.cos(wmr.headings_along(x, y) - [angle, angle + math.pi / 2, angle + math.pi]), 1.0
    )


def test_without_a_leg_the_heading_is_east():
    assert wmr.headings_along(3.0, 4.0).tolist() == [0.0]
    assert wmr.headings_along([3.0] * 3, [4.0] * 3).tolist() == [0.0] * 3


# Driving --------------------------------------------------------------------------------------------------------------


def by_hand(way, radii, **options):
    """The legs, one `simulate` after the other."""
    pose, legs = way[0], []
    for goal, radius in zip(way[1:], radii, strict=True):
        legs.append(wmr.simulate(pose, goal, GENTLE, arrival_radius=radius, **options))
        pose = wmr.Pose(float(legs[-1].x[-1]), float(legs[-1].y[-1]), float(legs[-1].heading[-1]))
    return legs


@pytest.mark.parametrize("method", ["arc", "euler", "continuous"])
@pytest.mark.parametrize(
    ("stop", "radii"),
    [(True, [0.05] * 3), (False, [2.0, 2.0, 0.05]), ([True, False, False], [0.05, 2.0, 2.0])],
)
def test_a_route_is_its_legs_one_after_the_other(method, stop, radii):
    route = wmr.drive_route(SQUARE, GENTLE, stop=stop, method=method)
    legs = by_hand(
        [wmr.Pose(*map(float, each)) for each in zip(*SQUARE, strict=True)], radii, method=method
    )
    assert route.outcome is wmr.Outcome.ARRIVED
    assert route.reached == len(route.legs) == 3
    time = 0.0
    for k, (mine, theirs) in enumerate(zip(route.legs, legs, strict=True)):
        for name in ("x", "y", "heading", "v", "omega", "V", "t"):
            np.testing.assert_array_equal(getattr(mine, name), getattr(theirs, name))
        here, last = route.leg == k, k == 2
        np.testing.assert_array_equal(route.V[here], theirs.V if last else theirs.V[:-1])
        np.testing.assert_array_equal(
            route.omega[here], theirs.omega if last else theirs.omega[:-1]
        )
        np.testing.assert_allclose(route.t[here], time + (theirs.t if last else theirs.t[:-1]))
        time += theirs.t[-1]
    assert route.time == pytest.approx(time)
    assert route.length == pytest.approx(sum(map(wmr.path_length, legs)))
    assert all(leg.rho[-1] <= radius + 1e-9 for leg, radius in zip(route.legs, radii, strict=True))
    assert route.arrivals[1] == wmr.arrival(legs[1])


def test_the_joined_path_is_driven_by_the_joined_twist():
    """Each sample's command, held for 0.1 s, leads to the next sample: at a change of goal too."""
    route = wmr.drive_route(SQUARE, GENTLE, stop=False)
    there = wmr.advance(
        wmr.Pose(route.x[:-1], route.y[:-1], route.heading[:-1]),
        route.v[:-1],
        route.omega[:-1],
        0.1,
    )
    np.testing.assert_allclose(
        np.array(there), np.array([route.x, route.y, route.heading])[:, 1:], atol=1e-12
    )
    np.testing.assert_allclose(np.diff(route.t), 0.1)


@settings(max_examples=25)
@given(lines, angles, st.booleans())
def test_v_falls_in_each_leg_and_time_goes_on(points, heading, stop):
    x, y = far_apart(points)
    start = wmr.Pose(0.0, 0.0, heading)
    route = wmr.drive_route(
        wmr.Pose(x, y, wmr.headings_along(x, y)),
        GENTLE,
        start=start,
        stop=stop,
        method="continuous",
    )
    assert (np.diff(route.t) > 0).all()
    assert (np.diff(route.leg) >= 0).all()
    for k, leg in enumerate(route.legs):
        assert (np.diff(leg.V) <= 1e-9 * leg.V[0]).all()
        assert (np.diff(route.V[route.leg == k]) <= 1e-9 * leg.V[0]).all()


@settings(max_examples=50)
@given(lines, angles, st.booleans())
def test_a_mirrored_route_is_driven_in_mirror_image(points, heading, stop):
    x, y = far_apart(points)
    no_hairpin(points)
    gains = wmr.Gains(0.2, 2.0, 2.0, 3.0)
    one = wmr.drive_route(
        wmr.Pose(x, y, wmr.headings_along(x, y)), gains, start=wmr.Pose(0, 0, heading), stop=stop
    )
    other = wmr.drive_route(
        wmr.Pose(x, -y, wmr.headings_along(x, -y)), gains, start=wmr.Pose(0, 0, -heading), stop=stop
    )
    assume(
        all(np.abs(leg.alpha[:1]).max() < 3.1 and np.abs(leg.theta).max() < 3.1 for leg in one.legs)
    )  # at 180 deg rounding decides
    assert len(one) == len(other)
    np.testing.assert_allclose(one.x, other.x, atol=1e-6)
    np.testing.assert_allclose(one.y, -other.y, atol=1e-6)
    np.testing.assert_allclose(np.sin(one.heading + other.heading), 0.0, atol=1e-5)
    np.testing.assert_allclose(one.omega, -other.omega, atol=1e-5)


@settings(max_examples=50)
@given(lines, angles, metres, metres)
def test_a_route_that_is_turned_and_moved_is_driven_the_same(points, angle, east, north):
    x, y = far_apart(points)
    no_hairpin(points)
    gains = wmr.Gains(0.2, 2.0, 2.0, 3.0)

    def moved(x, y):
        return math.cos(angle) * x - math.sin(angle) * y + east, math.sin(angle) * x + math.cos(
            angle
        ) * y + north

    one = wmr.drive_route(wmr.Pose(x, y, wmr.headings_along(x, y)), gains, stop=False)
    u, v = moved(x, y)
    other = wmr.drive_route(wmr.Pose(u, v, wmr.headings_along(u, v)), gains, stop=False)
    assume(
        all(np.abs(leg.alpha[:1]).max() < 3.1 and np.abs(leg.theta).max() < 3.1 for leg in one.legs)
    )
    assert len(one) == len(other)
    np.testing.assert_allclose(
        np.array(moved(one.x, one.y)), np.array([other.x, other.y]), atol=1e-6
    )
    np.testing.assert_allclose(one.omega, other.omega, atol=1e-5)
    np.testing.assert_allclose(one.V, other.V, atol=1e-5)


def test_on_a_straight_line_passing_is_faster_and_as_long():
    line = wmr.Pose(np.array([0.0, 15.0, 30.0, 45.0]), 0.0, 0.0)
    stops, passes = wmr.drive_route(line, GENTLE), wmr.drive_route(line, GENTLE, stop=False)
    assert passes.time < stops.time - 5.0
    assert passes.length == pytest.approx(stops.length, abs=0.1)
    assert stops.v[stops.leg == 0].min() < 0.1 < 1.0 < passes.v[passes.leg == 0].min()


def test_a_leg_that_fails_is_the_last():
    far = wmr.Pose(np.array([0.0, 5.0, 500.0, 505.0]), 0.0, 0.0)
    route = wmr.drive_route(far, GENTLE, duration=30.0)
    assert (route.outcome, route.reached, len(route.legs)) == (wmr.Outcome.TIMED_OUT, 1, 2)
    assert route.time == math.inf
    assert [arrival.arrived for arrival in route.arrivals] == [True, False]
    assert route.waypoints.x.tolist() == [5.0, 500.0, 505.0]
    assert 30.0 < route.t[-1] < 60.0
    assert repr(route).startswith(
        "<Route: 1 of 3 waypoints reached; leg 2 did not arrive within the duration, "
    )
    assert "m from its waypoint>" in repr(route)


def test_a_leg_that_leaves_the_range_of_numbers():
    wild = wmr.Gains(1e308, 1e308, 1e308, 1e308)
    poses = wmr.Pose(np.array([0.0, 0.0, 9.0]), np.array([0.0, 0.0, 9.0]), 0.0)
    route = wmr.drive_route(poses, wild)
    assert (route.outcome, len(route), route.length) == (wmr.Outcome.DIVERGED, 0, 0.0)
    route = wmr.drive_route(poses, wild, start=wmr.Pose(0.0, 0.0, 0.0), arrival_radius=20.0)
    assert route.outcome is wmr.Outcome.DIVERGED
    assert "left the range of numbers>" in repr(route)


# Legal and odd --------------------------------------------------------------------------------------------------------


def test_a_start_on_the_first_waypoint_reaches_it_at_once():
    on_it = wmr.drive_route(SQUARE, GENTLE, start=wmr.Pose(0.0, 0.0, 0.0))
    without = wmr.drive_route(SQUARE, GENTLE)
    assert [len(leg) for leg in on_it.legs[:1]] == [1]
    assert on_it.reached == 4
    assert on_it.leg[0] == 1
    np.testing.assert_array_equal(on_it.x, without.x)
    np.testing.assert_array_equal(on_it.t, without.t)


@pytest.mark.parametrize("method", ["arc", "continuous"])
def test_a_start_that_has_turned_more_than_once_has_a_heading_as_all_others(method):
    turned, plain = (
        wmr.drive_route(ONE, GENTLE, start=wmr.Pose(0.0, 0.0, heading), method=method)
        for heading in (7.0, 7.0 - 2 * math.pi)
    )
    assert turned.start.heading == 7.0
    assert turned.heading[0] == pytest.approx(7.0 - 2 * math.pi, abs=1e-12)
    np.testing.assert_allclose(turned.heading, plain.heading, atol=1e-6)


def test_two_equal_waypoints_and_one_straight_behind():
    way = wmr.Pose(np.array([0.0, -10.0, -10.0, 6.0]), 0.0, np.array([0.0, 0.5, 0.5, 0.0]))
    route = wmr.drive_route(way, GENTLE)
    assert route.outcome is wmr.Outcome.ARRIVED
    assert len(route.legs[1]) == 1
    assert (np.diff(route.t) > 0).all()
    assert set(route.leg.tolist()) == {0, 2}


def test_a_last_leg_of_one_sample_keeps_it():
    way = wmr.Pose(np.array([0.0, 8.0, 8.0]), 0.0, 0.0)
    route = wmr.drive_route(way, GENTLE)
    assert route.leg[-1] == 1
    assert route.x[-1] == route.legs[0].x[-1]
    assert route.time == pytest.approx(route.legs[0].t[-1])


def test_arrays_cannot_be_written_to():
    route = wmr.drive_route(SQUARE, GENTLE)
    with pytest.raises(ValueError, match="read-only"):
        route.V[0] = 1.0


def test_what_it_says():
    route = wmr.drive_route(SQUARE, GENTLE, stop=False)
    assert (
        repr(route)
        == f"<Route: 3 of 3 waypoints reached in {route.time:.4g} s, {route.length:.4g} m long>"
    )


# GPS points -----------------------------------------------------------------------------------------------------------


def test_poses_of_gps_points():
    poses = wmr.route_poses(CAMPUS)
    first, second = (wmr.GeoPoint(lat=CAMPUS.lat[k], lon=CAMPUS.lon[k]) for k in (0, 1))
    assert (poses.x[0], poses.y[0]) == (0.0, 0.0)
    assert (poses.x[1], poses.y[1]) == pytest.approx(wmr.local_position(first, second))
    assert poses.heading[0] == pytest.approx(
        math.pi / 2 - wmr.initial_bearing(first, second)
    )  # from east, against from north
    np.testing.assert_array_equal(poses.heading, wmr.headings_along(poses.x, poses.y))


@pytest.mark.parametrize(
    ("lat", "lon", "degrees"),
    [
        ([10.0] * 4, [179.999, 180.0, -180.0, -179.999], 0),
        ([10.0] * 4, [-179.999, -180.0, 180.0, 179.999], 180),
        ([89.999, 90.0, 90.0, 89.999], [0.0, 0.0, 90.0, 180.0], 90),
        ([-89.999, -90.0, -90.0, -90.0, -89.999], [0.0, 0.0, 120.0, -77.0, 180.0], -90),
    ],
    ids=["eastward", "westward", "north pole", "south pole"],
)
def test_a_point_that_repeats_under_another_longitude_is_one(lat, lon, degrees):
    """Straight on over the date line and over the poles, where 180 and -180, or all longitudes, are one."""
    poses = wmr.route_poses(wmr.GeoPoint(lat=lat, lon=lon))
    np.testing.assert_allclose(np.cos(poses.heading - np.radians(degrees)), 1.0, atol=1e-12)
    assert (poses.x[1], poses.y[1]) == (poses.x[2], poses.y[2])


def test_points_a_centimetre_apart_are_two():
    near = wmr.point_at(
        wmr.GeoPoint(lat=33.3, lon=44.4), np.array([0.0, 0.01, 0.01]), np.array([0.0, 0.0, 0.01])
    )
    np.testing.assert_allclose(np.degrees(wmr.route_poses(near).heading), [0, 45, 90], atol=1e-4)


def test_headings_that_are_given():
    chosen = wmr.route_poses(CAMPUS).heading
    np.testing.assert_array_equal(
        wmr.route_poses(CAMPUS, [1.0, 2.0, 3.0, -1.0]).heading, [1.0, 2.0, 3.0, -1.0]
    )
    np.testing.assert_array_equal(
        wmr.route_poses(CAMPUS, [math.nan, None, 0.5, math.nan]).heading,
        [chosen[0], chosen[1], 0.5, chosen[3]],
    )


def test_another_origin_moves_the_frame():
    origin = wmr.GeoPoint(lat=33.2730, lon=44.3730)
    here, there = wmr.route_poses(CAMPUS), wmr.route_poses(CAMPUS, origin=origin)
    east, north = wmr.local_position(origin, wmr.GeoPoint(lat=CAMPUS.lat[0], lon=CAMPUS.lon[0]))
    np.testing.assert_allclose(there.x - here.x, east, atol=1e-3)
    np.testing.assert_allclose(there.y - here.y, north, atol=1e-3)


@pytest.mark.parametrize(
    "corner",
    [(33.27, 44.37), (-17.0, 179.9999), (89.9999, 10.0), (90.0, 0.0), (-90.0, 0.0), (0.0, -180.0)],
    ids=["campus", "date line", "near the pole", "pole", "south pole", "equator"],
)
def test_a_square_anywhere_on_earth_is_driven_as_in_the_plane(corner):
    home = wmr.GeoPoint(lat=corner[0], lon=corner[1])
    points = wmr.point_at(home, SQUARE.x, SQUARE.y)
    route = wmr.drive_route(
        wmr.route_poses(points, SQUARE.heading, origin=home), GENTLE, stop=False
    )
    plane = wmr.drive_route(SQUARE, GENTLE, stop=False)
    np.testing.assert_allclose(route.x, plane.x, atol=1e-5)
    np.testing.assert_allclose(route.y, plane.y, atol=1e-5)


def test_out_to_gpx_and_back(tmp_path):
    route = wmr.drive_route(wmr.route_poses(CAMPUS), GENTLE, stop=False)
    wmr.write_gpx(
        tmp_path / "route.gpx",
        wmr.route_points(route, CAMPUS),
        t=route.t,
        begin=datetime(2026, 3, 1, tzinfo=UTC),
    )
    track = wmr.read_track(tmp_path / "route.gpx")
    assert len(track) == len(route)
    np.testing.assert_allclose(track.t, route.t, atol=1e-3)
    x, y = wmr.local_position(wmr.GeoPoint(lat=CAMPUS.lat[0], lon=CAMPUS.lon[0]), track.points)
    assert np.hypot(x - route.x, y - route.y).max() < 0.01  # 7 decimals of a degree
    goal = wmr.GeoPoint(lat=CAMPUS.lat[-1], lon=CAMPUS.lon[-1])
    last = wmr.GeoPoint(lat=track.points.lat[-1], lon=track.points.lon[-1])
    assert wmr.haversine_distance(last, goal) < 0.06


def test_a_route_that_was_read_is_driven(tmp_path):
    wmr.write_geojson(tmp_path / "way.geojson", CAMPUS)
    route = wmr.drive_route(
        wmr.route_poses(wmr.read_track(tmp_path / "way.geojson").points), GENTLE
    )
    assert route.outcome is wmr.Outcome.ARRIVED


# Bad input ------------------------------------------------------------------------------------------------------------

ONE = wmr.Pose(1.0, 2.0, 0.0)
MANY = wmr.GeoPoint(lat=[[1.0, 2.0]], lon=[[1.0, 2.0]])


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: wmr.headings_along([1.0, 2.0], [1.0]),
            r"mismatched lengths: x has shape \(2,\), y has shape \(1,\)",
        ),
        (lambda: wmr.headings_along([], []), "at least one number"),
        (lambda: wmr.headings_along([1.0, math.nan], [1.0, 2.0]), r"x = .*nan.* is not allowed"),
        (lambda: wmr.route_poses([(1, 2)]), "a GeoPoint is needed, not a list"),
        (lambda: wmr.route_poses(MANY), "a list of at least one position is needed"),
        (
            lambda: wmr.route_poses(CAMPUS, [1.0]),
            r"headings have shape \(1,\), points have shape \(4,\)",
        ),
        (
            lambda: wmr.route_poses(CAMPUS, [1.0, math.inf, 0, 0]),
            r"headings = .*inf.* is not allowed",
        ),
        (
            lambda: wmr.route_poses(CAMPUS, ["n", "s", "e", "w"]),
            r"headings = \['n', 's', 'e', 'w'\] is not allowed: a list of finite numbers",
        ),
        (
            lambda: wmr.route_poses(CAMPUS, [True, False, True, True]),
            r"headings = \[True, .* is not allowed",
        ),
        (
            lambda: wmr.route_poses(CAMPUS, [[1.0], [1.0, 2.0]]),
            r"headings = \[\[1\.0\], .* is not allowed",
        ),
        (lambda: wmr.route_poses(CAMPUS, 1.0), r"headings = 1\.0 is not allowed"),
        (
            lambda: wmr.route_poses(CAMPUS, origin=CAMPUS),
            "origin = .* is not allowed: a single point is needed",
        ),
        (lambda: wmr.route_poses(CAMPUS, origin=(1, 2)), "a GeoPoint is needed, not a tuple"),
        (lambda: wmr.route_points(SQUARE, CAMPUS), "a Route is needed, not a Pose"),
        (
            lambda: wmr.drive_route(ONE, GENTLE),
            "poses has 1 entries, which is not allowed: a waypoint besides the start is needed",
        ),
        (lambda: wmr.drive_route(wmr.Pose([], [], []), GENTLE, start=ONE), "poses has 0 entries"),
        (lambda: wmr.drive_route([ONE], GENTLE), "a Pose is needed, not a list"),
        (
            lambda: wmr.drive_route(wmr.Pose(np.ones((2, 2)), 0.0, 0.0), GENTLE),
            r"poses have shape \(2, 2\)",
        ),
        (
            lambda: wmr.drive_route(SQUARE, GENTLE, start=SQUARE),
            r"start\.x = .* is not allowed: one number is needed",
        ),
        (
            lambda: wmr.drive_route(SQUARE, GENTLE, stop=[True]),
            r"stop = \[True\] is not allowed: True, False or a list of 3, one a waypoint",
        ),
        (
            lambda: wmr.drive_route(SQUARE, GENTLE, stop=[[True], [True, False]]),
            r"stop = \[\[True\], \[True, False\]\] is not allowed",
        ),
        (lambda: wmr.drive_route(SQUARE, GENTLE, stop=1), "stop = 1 is not allowed"),
        (
            lambda: wmr.drive_route(SQUARE, GENTLE, pass_radius=-1.0),
            r"pass_radius = -1\.0 is not allowed",
        ),
        (
            lambda: wmr.drive_route(SQUARE, GENTLE, arrival_radius=-1.0, stop=False),
            r"arrival_radius = -1\.0 is not allowed",
        ),
        (lambda: wmr.drive_route(SQUARE, GENTLE, law="prited"), "law = 'prited' is not allowed"),
        (lambda: wmr.drive_route(SQUARE, (1, 2, 3)), "a Gains is needed"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_one_waypoint_with_a_start_is_a_run():
    route = wmr.drive_route(ONE, GENTLE, start=START)
    run = wmr.simulate(START, ONE, GENTLE, duration=120.0)
    np.testing.assert_array_equal(route.x, run.x)
    assert route.stops == (True,)
