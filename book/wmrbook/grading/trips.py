"""Checks of a whole trip: poses from GPS points and a compass, whether a run has parked, and gains for the way home."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from wmrbook.grading._hints import Passed, ask, expect, number, ordered
from wmrlib.gains import Gains
from wmrlib.geodesy import GeoPoint, initial_bearing, local_position, point_at
from wmrlib.kinematics import Pose, polar_error, wrap_angle
from wmrlib.metrics import arrival
from wmrlib.paper import GPS_POINT_1, GPS_POINT_2, OUTDOOR_GAINS, outdoor
from wmrlib.runs import Arrival, Trajectory
from wmrlib.simulation import simulate

Poses = Callable[[GeoPoint, GeoPoint, float, float], tuple[Pose, Pose]]
HOME_TIME, HOME_HEADING_DEG, HOME_OMEGA = 22.0, 5.0, 1.6  # s, deg, rad/s
_GENTLE = Gains(k_rho=0.3, k_alpha=2.0, h=1.5, v_max=4.0)


def poses_known(poses: Poses) -> Passed:
    """poses(start_point, goal_point, start_course, goal_course): start and goal Pose on the map of the start, courses as on a compass."""
    for a, b, course, goal_course in _trips(20):
        start, goal = _asked(poses, a, b, course, goal_course)
        east, north = local_position(a, b)
        expect(
            math.hypot(start.x, start.y) < 1e-6,
            "the start is not at (0, 0): the map has its origin there.",
        )
        expect(
            not _near(goal, (-east, -north)),
            "the goal lies on the opposite side: it is the start as seen from the goal.",
        )
        expect(
            not _near(goal, (north, east)),
            "x is north on your map; it is asked for with x east and y north.",
        )
        expect(
            _near(goal, (east, north)),
            "the goal is not where it should be on the map: `wmr.local_position` gives metres east and north.",
        )
        for name, pose, degrees in (("start", start, course), ("goal", goal, goal_course)):
            right = math.radians(90.0 - degrees)
            if not _same(pose.heading, right):
                expect(
                    not _same(math.radians(pose.heading), right),
                    f"the {name}'s heading is in degrees; a Pose has radians.",
                )
                expect(
                    not _same(pose.heading, math.radians(degrees)),
                    f"the {name}'s heading is the compass course in radians: but a compass counts from north, and a heading from where?",
                )
                expect(
                    not _same(pose.heading, degrees),
                    f"the {name}'s heading is the course as it stands on the compass.",
                )
                expect(
                    not _same(pose.heading, right + math.pi),
                    f"the {name} looks backwards: try a course of 0, north, and one of 90, east.",
                )
                expect(
                    False,
                    f"the {name}'s heading is wrong: try a course of 0, north, and one of 90, east.",
                )
    return Passed("Twenty trips start and end where they should, and look the right way.")


def poses_facing(poses: Poses) -> Passed:
    """Who steers by the bearing has the goal straight ahead, and with the same course at the goal the approach is straight."""
    for a, b, _, _ in _trips(20):
        bearing = math.degrees(initial_bearing(a, b))
        start, goal = _asked(poses, a, b, bearing, bearing)
        rho, alpha, theta = polar_error(start, goal)
        expect(rho > 1.0, "start and goal are at the same place.")
        expect(
            abs(alpha) < 1e-6,
            f"a robot whose compass shows the bearing of its goal must see it straight ahead, not {math.degrees(alpha):.0f} deg off.",
        )
        expect(
            abs(theta) < 1e-6,
            f"with the bearing as the goal's course too theta must be 0, not {math.degrees(theta):.0f} deg.",
        )
        right = polar_error(*_asked(poses, a, b, bearing - 30.0, bearing)).alpha
        expect(
            right < 0.0,
            "a course of 30 deg less is further left on a compass, so the goal must be on the right: alpha < 0.",
        )
    return Passed(
        "With the goal's bearing as both courses the goal is straight ahead: alpha = theta = 0."
    )


def parked_runs(parked: Callable[[Trajectory], bool]) -> Passed:
    """parked(run): whether the last sample is within 0.1 m of the goal and within 5 deg of its heading."""
    cases = _runs()
    for run, right, hint in cases:
        expect(_verdict(parked, run) is right, hint)
    return Passed(
        f"All {len(cases)} runs are judged as they should be; {sum(right for _, right, _ in cases)} of them have parked."
    )


def parked_wrapped(parked: Callable[[Trajectory], bool]) -> Passed:
    """The same where headings jump from 180 to -180 deg."""
    runs = _western_runs()
    for run in runs:
        looks, wanted = math.degrees(run.heading[-1]), math.degrees(run.goal.heading)
        expect(
            _verdict(parked, run),
            f"a robot that looks {looks:.1f} deg at a goal that looks {wanted:.1f} deg has parked: how far apart are these directions?",
        )
    away = simulate(
        Pose(30.0, 0.5, -0.1),
        Pose(0.0, 0.0, -0.1),
        _GENTLE,
        method="continuous",
        arrival_radius=0.0,
        duration=6.0,
    )
    expect(not _verdict(parked, away), "every run counts as parked.")
    return Passed(f"{len(runs)} robots that look west have parked, on either side of 180 deg.")


def home_time(my_gains: Any) -> Passed:
    """The way home, from GPS point 2 to point 1 with the headings exchanged, takes less than 22 s."""
    result = _home(my_gains)
    expect(
        result.time < HOME_TIME,
        f"it takes {result.time:.1f} s. Which gain decides how far from the goal the robot begins to slow down?",
    )
    return Passed(f"Home after {result.time:.1f} s.")


def home_heading(my_gains: Any) -> Passed:
    """It ends less than 5 deg off."""
    result = _home(my_gains)
    off = abs(math.degrees(result.heading_error))
    expect(
        off < HOME_HEADING_DEG,
        f"it arrives with {off:.1f} deg left over. The heading must settle before the distance: brake earlier, or give it more weight.",
    )
    return Passed(f"Parked, with {off:.1f} deg left over.")


def home_omega(my_gains: Any) -> Passed:
    """It never turns faster than 1.6 rad/s."""
    result = _home(my_gains)
    expect(
        result.peak_omega < HOME_OMEGA,
        f"it turns with up to {result.peak_omega:.2f} rad/s. At the start, by k_alpha, or in the last bend? `plots.twist` shows it.",
    )
    return Passed(f"Never faster than {result.peak_omega:.2f} rad/s.")


def _asked(poses: Poses, a: GeoPoint, b: GeoPoint, course: float, goal_course: float) -> list[Pose]:
    answer = ask(poses, a, b, course, goal_course)
    expect(
        ordered(answer, 2) and all(ordered(each, 3) for each in answer),
        "two poses are needed: `return start, goal`.",
    )
    return [
        Pose(
            *(
                number(f"the {name}'s {field}", each)
                for field, each in zip(Pose._fields, pose, strict=True)
            )
        )
        for name, pose in zip(("start", "goal"), answer, strict=True)
    ]


def _verdict(parked: Callable[[Trajectory], bool], run: Trajectory) -> bool:
    answer = ask(parked, run)
    expect(answer is not None, "`parked` returns nothing: does it end in `return`?")
    expect(
        isinstance(answer, (bool, np.bool_)),
        f"`parked` returns a {type(answer).__name__}; True or False is needed.",
    )
    return bool(answer)


def _home(my_gains: Any) -> Arrival:
    expect(my_gains is not None and my_gains is not ..., "`my_gains` has no value yet.")
    expect(
        isinstance(my_gains, Gains),
        "`my_gains` has to be a `wmr.Gains(k_rho=..., k_alpha=..., h=..., v_max=4.0)`.",
    )
    for name, each in zip(Gains._fields, my_gains, strict=True):
        number(f"`my_gains.{name}`", each)
    expect(
        my_gains.v_max <= OUTDOOR_GAINS.v_max,
        f"v_max = {my_gains.v_max:g} m/s: the robot can do no more than {OUTDOOR_GAINS.v_max:g} m/s.",
    )
    case = outdoor()
    run = simulate(case.goal, case.start, my_gains, method="continuous")
    expect(
        arrival(run).arrived,
        f"it does not come home within a minute: after {run.t[-1]:.0f} s it is {run.rho[-1]:.2f} m away.",
    )
    return arrival(run)


@cache
def _runs() -> tuple[tuple[Trajectory, bool, str], ...]:
    """Runs, whether they have parked, and what to say if they are judged wrongly."""
    case, here = outdoor(), Pose(0.0, 0.0, 0.0)
    there = simulate(case.start, case.goal, case.gains, method="continuous")
    home = simulate(case.goal, case.start, case.gains, method="continuous")
    good = simulate(case.start, case.goal, _GENTLE, method="continuous")
    far = simulate(Pose(-50.0, 0.0, 0.0), here, _GENTLE, duration=5.0)
    early = simulate(Pose(-50.0, 0.0, 0.0), here, _GENTLE, arrival_radius=0.5)
    late = simulate(
        case.start, case.goal, _GENTLE, method="continuous", arrival_radius=0.0, duration=40.0
    )
    beside = simulate(Pose(0.06, 0.0, 0.0), here, _GENTLE, arrival_radius=0.1)
    askew = simulate(Pose(-0.06, 0.0, math.radians(8.0)), here, _GENTLE, arrival_radius=0.1)
    short = simulate(Pose(-0.15, 0.0, 0.0), here, _GENTLE, arrival_radius=0.2)
    opposite = simulate(
        Pose(-0.06, 0.0, math.pi / 2.0), Pose(0.0, 0.0, -math.pi / 2.0), _GENTLE, arrival_radius=0.1
    )
    return (
        (
            good,
            True,
            "a run that ends 5 cm and less than 1 deg from its goal has parked, and is said not to have.",
        ),
        (
            home,
            False,
            "a run that ends 32 deg off to the left counts as parked: does it look at the heading, and in which unit?",
        ),
        (
            there,
            False,
            "a run that ends 27 deg off to the right counts as parked: its heading error is negative.",
        ),
        (
            far,
            False,
            "a run that is still far away when the time is up counts as parked: does it look at the distance?",
        ),
        (
            early,
            False,
            "a run counts as parked because it has arrived, but its arrival radius was 0.5 m: look at the distance at the end.",
        ),
        (
            late,
            True,
            "a run that stands on its goal and looks the right way has parked, though it went on until the time was up.",
        ),
        (
            beside,
            True,
            "a robot 6 cm past its goal that looks exactly the goal's way has parked: "
            "alpha and theta are 180 deg there, and neither is the error of the heading.",
        ),
        (askew, False, "a run that ends 8 deg off counts as parked: 5 deg are asked for."),
        (
            short,
            False,
            "a run that ends 15 cm from its goal counts as parked: 0.1 m are asked for.",
        ),
        (
            opposite,
            False,
            "a robot that looks 90 deg at a goal that looks -90 deg counts as parked: they are opposite directions.",
        ),
    )


@cache
def _western_runs() -> tuple[Trajectory, ...]:
    """Parked runs whose heading and goal's heading are on different sides of 180 deg."""
    runs = [
        simulate(
            Pose(40.0, north, math.pi),
            Pose(0.0, 0.0, side * (math.pi - 0.004)),
            _GENTLE,
            method="arc",
            dt=0.02,
        )
        for side in (-1.0, 1.0)
        for north in (-9.0, -6.0, -3.0, 3.0, 6.0, 9.0)
    ]
    return tuple(
        run
        for run in runs
        if abs(run.heading_error[-1]) < math.radians(4.0)
        and run.rho[-1] < 0.09
        and abs(run.heading[-1] - run.goal.heading) > math.pi
    )


def _near(pose: Pose, place: tuple[float, float]) -> bool:
    return math.dist(pose[:2], place) < 0.02


def _same(one: float, other: float) -> bool:
    return abs(wrap_angle(one - other)) < 1e-6


def _trips(count: int) -> list[tuple[GeoPoint, GeoPoint, float, float]]:
    """The paper's points and others up to 200 m apart, with courses in degrees clockwise from north."""
    random = np.random.default_rng(10)
    rows = random.uniform(
        [-60.0, -170.0, 20.0, -math.pi, 0.0, 0.0],
        [60.0, 170.0, 200.0, math.pi, 360.0, 360.0],
        (count - 1, 6),
    ).tolist()
    trips = [(GPS_POINT_1, GPS_POINT_2, 18.0, 150.0)]
    for lat, lon, length, angle, course, goal_course in rows:
        origin = GeoPoint(lat=lat, lon=lon)
        trips.append(
            (
                origin,
                point_at(origin, length * math.cos(angle), length * math.sin(angle)),
                course,
                goal_course,
            )
        )
    return trips
