"""Checks of a whole trip: poses from GPS and compass, whether a run has parked, the way home."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from wmrbook.grading._asking import ask, ask_truth, number, ordered
from wmrbook.grading._hints import angle_equal, drawn, expect, explain, rule_out, spread
from wmrbook.grading._specification import Limits, drive, driveable
from wmrbook.grading.earth import _on_the_spot, _walks
from wmrlib.gains import Gains
from wmrlib.geodesy import GeoPoint, initial_bearing, local_position
from wmrlib.kinematics import Pose, polar_error
from wmrlib.paper import GPS_POINT_1, GPS_POINT_2, outdoor
from wmrlib.runs import Arrival, Trajectory
from wmrlib.simulation import simulate

Poses = Callable[[GeoPoint, GeoPoint, float, float], tuple[Pose, Pose]]
_FLAT = 1e-3  # rad: a flat map's direction against the great circle's, over 200 m
_HERE = Pose(0.0, 0.0, 0.0)
_HOME = Limits(time=22.0, heading_deg=5.0, omega=1.6)
_GAINS = Gains(k_rho=0.3, k_alpha=2.0, h=1.5, v_max=4.0)


def poses_known(poses: Poses) -> str:
    """poses(start_point, goal_point, start_course, goal_course): on the map of the start."""
    for a, b, course, goal_course in _trips(20):
        start, goal = _asked(poses, a, b, course, goal_course)
        at_origin = math.hypot(start.x, start.y) < 1e-6
        changed = not at_origin and math.hypot(goal.x, goal.y) < 1e-6
        expect(not changed, "the poses have changed places: the start comes first.")
        expect(at_origin, "the start is not at (0, 0): the map has its origin there.")
        east, north = local_position(a, b)
        mistakes = {
            "the goal is on the opposite side, as the start is seen from it.": (-east, -north),
            "x is north on your map; it is asked for with x east and y north.": (north, east),
        }
        rule_out(goal[:2], mistakes, _on_the_spot)
        hint = "the goal is not where it should be on the map: "
        hint += "`wmr.local_position` gives metres east and north."
        expect(_on_the_spot(goal[:2], (east, north)), hint)
        for name, pose, degrees in (("start", start, course), ("goal", goal, goal_course)):
            right = math.radians(90.0 - degrees)
            if angle_equal(pose.heading, right):
                continue
            in_degrees = angle_equal(math.radians(pose.heading), right)
            expect(not in_degrees, f"the {name}'s heading is in degrees; a Pose has radians.")
            courses = "try a course of 0, north, and one of 90, east."
            mistakes = {
                f"the {name}'s heading is the compass course in radians: but a compass counts "
                "from north, and a heading from where?": math.radians(degrees),
                f"the {name}'s heading is the course as it stands on the compass.": degrees,
                f"the {name} looks backwards: {courses}": right + math.pi,
            }
            hint = f"the {name}'s heading is wrong: {courses}"
            right += math.tau * round((pose.heading - right) / math.tau)
            explain(pose.heading, mistakes, hint, angle_equal, right)
    return "Twenty trips start and end where they should, and look the right way."


def poses_facing(poses: Poses) -> str:
    """A robot that steers by the bearing has the goal straight ahead."""
    for a, b, _, _ in _trips(20):
        bearing = math.degrees(initial_bearing(a, b))
        rho, alpha, theta = polar_error(*_asked(poses, a, b, bearing, bearing))
        expect(rho > 1.0, "start and goal are at the same place.")
        hint = "a robot whose compass shows the bearing of its goal must see it straight ahead, "
        expect(abs(alpha) < _FLAT, f"{hint}not {math.degrees(alpha):.2g} deg off.")
        hint = "with the bearing as the goal's course too theta must be 0, "
        expect(abs(theta) < _FLAT, f"{hint}not {math.degrees(theta):.2g} deg.")
        right = polar_error(*_asked(poses, a, b, bearing - 30.0, bearing)).alpha
        hint = "a course of 30 deg less is further left on a compass, "
        expect(right < 0.0, f"{hint}so the goal must be on the right: alpha < 0.")
    bearing = "With the goal's bearing as both courses"
    return f"{bearing} the goal is straight ahead: alpha = theta = 0."


def parked_runs(parked: Callable[[Trajectory], bool]) -> str:
    """parked(run): whether it ends within 0.1 m of the goal and 5 deg of its heading."""
    cases = _runs()
    for run, right, hint in cases:
        expect(ask_truth(parked, run) is right, hint)
    well = sum(right for _, right, _ in cases)
    return f"All {len(cases)} runs are judged as they should be; {well} of them have parked."


def parked_wrapped(parked: Callable[[Trajectory], bool]) -> str:
    """The same where headings jump from 180 to -180 deg."""
    pairs = (179.9, -179.9), (-179.0, 178.0), (-177.0, 180.0), (178.5, -178.0)
    for heading_deg, goal_deg in pairs:
        run = _stop(
            Pose(0.05, 0.0, math.radians(heading_deg)), Pose(0.0, 0.0, math.radians(goal_deg))
        )
        hint = f"a robot that looks {heading_deg:.1f} deg at a goal that looks {goal_deg:.1f} deg "
        expect(ask_truth(parked, run), f"{hint}has parked: how far apart are these directions?")
    away = _stop(Pose(30.0, 0.5, -0.1), radius=0.05, duration=6.0)
    expect(not ask_truth(parked, away), "every run counts as parked.")
    return f"{len(pairs)} robots that look west have parked, on either side of 180 deg."


def home_time(my_gains: Any) -> str:
    """From GPS point 2 back to 1, with the headings exchanged, in time."""
    end = _home(my_gains)
    hint = f"it takes {end.time:.1f} s. "
    hint += "Which gain decides how far from the goal the robot begins to slow down?"
    expect(end.time < _HOME.time, hint)
    return f"Home after {end.time:.1f} s."


def home_heading(my_gains: Any) -> str:
    """It ends less than 5 deg off."""
    off = abs(math.degrees(_home(my_gains).heading_error))
    hint = f"it arrives with {off:.1f} deg left over. The heading must settle before the distance: "
    expect(off < _HOME.heading_deg, f"{hint}brake earlier, or give it more weight.")
    return f"Parked, with {off:.1f} deg left over."


def home_omega(my_gains: Any) -> str:
    """It never turns too fast."""
    fastest = _home(my_gains).peak_omega
    hint = f"it turns with up to {fastest:.2f} rad/s. "
    hint += "At the start, by k_alpha, or in the last bend? `wmrbook.figures.twist` shows it."
    expect(fastest < _HOME.omega, hint)
    return f"Never faster than {fastest:.2f} rad/s."


def _asked(poses: Poses, a: GeoPoint, b: GeoPoint, course: float, goal_course: float) -> list[Pose]:
    answer = ask(poses, a, b, course, goal_course)
    two = ordered(answer, 2) and all(isinstance(pose, Pose) for pose in answer)
    expect(two, "two poses are needed: `return start, goal`, each a `wmr.Pose(x, y, heading)`.")
    return [
        Pose(*(number(f"the {name}'s {field}", pose[k]) for k, field in enumerate(Pose._fields)))
        for name, pose in zip(("start", "goal"), answer, strict=True)
    ]


def _home(my_gains: Any) -> Arrival:
    gains, case = driveable("`my_gains`", my_gains), outdoor()
    run, end = drive(case.goal, case.start, gains, method="continuous")
    hint = f"it does not come home: after {run.t[-1]:.0f} s "
    expect(end.arrived, f"{hint}it is {run.rho[-1]:.2f} m away.")
    return end


@cache
def _runs() -> tuple[tuple[Trajectory, bool, str], ...]:
    """Runs, whether they have parked, and what to say if they are judged wrongly."""
    case = outdoor()
    north, south = (Pose(0.0, 0.0, side * math.pi / 2.0) for side in (1.0, -1.0))
    late = {"method": "continuous", "arrival_radius": 0.0, "duration": 40.0}

    def drive(gains: Gains, start: Pose, goal: Pose) -> Trajectory:
        return simulate(start, goal, gains, method="continuous")

    counts, home = "counts as parked", drive(_GAINS, case.start, case.goal)
    backwards = ("x", "y", "heading", "rho", "alpha", "theta", "v", "omega")
    away = replace(home, **{name: getattr(home, name)[::-1] for name in backwards})
    past = _stop(Pose(0.06, 0.0, 0.0))
    right = {
        "a run that ends 5 cm and less than 1 deg from its goal has parked, "
        "and is said not to have.": home,
        "a run that stands on its goal and looks the right way has parked, "
        "though it went on until the time was up.": simulate(case.start, case.goal, _GAINS, **late),
        "a robot 6 cm past its goal that looks exactly the goal's way has parked: "
        "alpha and theta are 180 deg there, and neither is the error of the heading.": past,
    }
    wrong = {
        f"a run that ends 32 deg off to the left {counts}: "
        "does it look at the heading, and in which unit?": drive(case.gains, case.goal, case.start),
        f"a run that ends 27 deg off to the right {counts}: its heading error is negative.": drive(
            case.gains, case.start, case.goal
        ),
        f"a run that is still far away when the time is up {counts}: "
        "does it look at the distance?": _stop(Pose(-50.0, 0.0, 0.0), radius=0.05, duration=5.0),
        f"a run {counts} because it has arrived, but its arrival radius was 0.5 m: "
        "look at the distance at the end.": _stop(Pose(-50.0, 0.0, 0.0), radius=0.5),
        f"a run that was on its goal, and drove away again, {counts}: "
        "look at the last sample.": away,
        f"a robot that looks 90 deg at a goal that looks -90 deg {counts}: "
        "they are opposite directions.": _stop(north._replace(x=-0.06), south),
    }
    return (
        *((run, False, hint) for hint, run in wrong.items()),
        *((run, True, hint) for hint, run in right.items()),
        *_borders(),
    )


def _stop(start: Pose, goal: Pose = _HERE, radius: float = 1.0, **options) -> Trajectory:
    return simulate(start, goal, _GAINS, arrival_radius=radius, **options)


def _borders() -> Iterator[tuple[Trajectory, bool, str]]:
    """Runs that end just within the limits and just beyond, in any direction."""
    random = np.random.default_rng(11)
    for near in spread(0.01, 2.0, 24):
        for share in (1.0 + near, 1.0 / (1.0 + near)):
            way, side = random.uniform(-math.pi, math.pi), random.choice([-1.0, 1.0])
            far, off = random.permutation([share, random.uniform(0.0, 0.9)]) * (0.1, 5.0)
            end = Pose(far * math.cos(way), far * math.sin(way), side * math.radians(off))
            parked = bool(far < 0.1 and off < 5.0)
            hint = f"a run that ends {100.0 * far:.1f} cm and {off:.1f} deg off "
            hint += "has parked, and is said not to have: " if parked else "counts as parked: "
            hint += "0.1 m are asked for, all round, " if far > 0.1 else "0.1 m and "
            yield _stop(end), parked, hint + "5 deg are asked for, to both sides."


def _trips(count: int) -> list[tuple[GeoPoint, GeoPoint, float, float]]:
    """The paper's points and others up to 200 m apart, with courses in degrees."""
    courses = drawn(10, count - 1, (0.0, 360.0), (0.0, 360.0))
    pairs = _walks(10, count - 1, 200.0)
    trips = [(*pair, *course) for pair, course in zip(pairs, courses, strict=True)]
    return [(GPS_POINT_1, GPS_POINT_2, 18.0, 150.0), *trips]
