"""Concept questions on chapters 11, 12 and 14: a real robot, logs and routes, a filter."""

from __future__ import annotations

import math

import numpy as np

import wmrlib as wmr
from wmrbook.chapters import routes
from wmrbook.questions._asking import Option, cases, numbers, question, sign
from wmrrobot import estimation


@question(11, "On the bench", "Swapped motor cables")
def swapped_cables() -> tuple[str, list[Option], str]:
    error = wmr.polar_error(wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(10.0, 6.0, 0.0))
    wheels = wmr.twist_to_wheels(*wmr.control_law(*error, wmr.GENTLE_GAINS), 0.5)
    v, omega = wmr.wheels_to_twist(wheels[1], wheels[0], 0.5)
    ask = """The left motor's cable is in the right motor's plug; all else is right. The goal
        lies ahead, to the left. What does the robot do at once?"""
    options = {
        (1, -1): ("drives ahead, turns right", ""),
        (1, 1): ("drives ahead, turns left", "the swap taken to change nothing"),
        (-1, 1): ("backs up, turns left", "swapped taken for reversed"),
        (-1, -1): ("backs up, turns right", "a swap taken to turn everything round"),
        (0, -1): ("turns right on the spot", "the mean taken to vanish"),
    }
    why = """The swap keeps the wheels' mean, $v$, and changes the sign of their difference, and
        so of $\\omega$."""
    return ask, cases((sign(v, 0.05), sign(omega, 0.05)), options), why


@question(11, "On the bench", "A bearing for a heading")
def bearing_for_heading() -> tuple[str, list[Option], str]:
    bearing = math.radians(90.0)  # of a robot that looks east, at a goal in the east
    error = wmr.polar_error(wmr.Pose(0.0, 0.0, bearing), wmr.Pose(10.0, 0.0, 0.0))
    v, omega = wmr.control_law(*error, wmr.GENTLE_GAINS)
    ask = """Robot and goal look east, and the goal lies 10 m ahead. The program takes the
        compass's bearing, 90 deg, for the heading. What does the robot do at once?"""
    options = {
        (0, -1): ("turns right on the spot", ""),
        (0, 1): ("turns left on the spot", "$\\alpha$ from the line of sight to the heading"),
        (1, 0): ("drives straight ahead", "90 deg taken for east"),
        (-1, 0): ("backs straight up", "90 deg taken for half a turn"),
        (1, -1): ("drives a right bend", "the cosine of 90 deg overlooked"),
    }
    why = """It believes it looks north, with the goal abeam on its right: $\\cos\\alpha = 0$
        leaves no speed, $k_\\alpha\\alpha$ turns it right."""
    return ask, cases((sign(v, 0.05), sign(omega, 0.05)), options), why


@question(12, "Which way did it go?", "A course from two fixes")
def course_from_fixes() -> tuple[str, list[Option], str]:
    north, east, lat = 1.0, 3.0, 60.0  # ten-thousandths of a minute, and degrees
    a = wmr.GeoPoint(lat=lat, lon=10.0)
    b = wmr.GeoPoint(lat=lat + north * 1e-4 / 60.0, lon=10.0 + east * 1e-4 / 60.0)
    course = math.degrees(wmr.initial_bearing(a, b))
    shorter = math.cos(math.radians(lat))
    mistaken = {
        "a minute of longitude taken to be as long as one of latitude": (north, east),
        "counted from east": (east * shorter, north),
        "longitude divided by the cosine": (north, east / shorter),
        "the cosine of 60 radians": (north, east * math.cos(lat)),
    }
    wrong = {why: math.degrees(math.atan2(y, x)) % 360.0 for why, (x, y) in mistaken.items()}
    ask = """At a latitude of 60 deg a receiver goes 0.0001 minutes of latitude to the north and
        0.0003 minutes of longitude to the east. What is its course, clockwise from north?"""
    why = """At 60 deg a minute of longitude is half as long as one of latitude: 1.5 parts to the
        east for 1 to the north."""
    return ask, numbers(course, wrong, "{:.0f} deg"), why


@question(12, "A route is a chain of goals", "Which way at the corner?")
def at_the_corner() -> tuple[str, list[Option], str]:
    come, leave = 160.0, -100.0
    legs = np.radians([[come], [leave]])
    x, y = np.cumsum([[[0.0], [0.0]], *([np.cos(leg), np.sin(leg)] for leg in legs)], axis=0).T[0]
    heading = math.degrees(routes.headings_along(x, y)[1])
    bend = (leave - come + 180.0) % 360.0 - 180.0
    mistaken = {
        "the plain mean of 160 and -100": (come + leave) / 2.0,
        "the heading in which it arrives": come,
        "the heading in which it sets off": leave,
        "the bend taken to the other side": come - bend / 2.0,
    }
    ask = """A leg leads at 160 deg to a waypoint, the next one at -100 deg away from it. Which
        heading shares the bend between the two legs?"""
    why = "The bend, wrapped, is 100 deg to the left; half of it from 160 deg is 210, that is -150."
    return ask, numbers(heading, mistaken, "{:.0f} deg"), why


@question(12, "Stop, or pass?", "V along a route")
def along_a_route() -> tuple[str, list[Option], str]:
    x, y = np.array([20.0, 40.0, 60.0]), np.array([0.0, 15.0, 0.0])
    poses = wmr.Pose(x, y, routes.headings_along(x, y))
    stops = [False, False, True]
    route = routes.drive_route(
        poses, wmr.GENTLE_GAINS, start=wmr.Pose(0.0, 0.0, 0.0), stop=stops, method="continuous"
    )
    steps, change = np.diff(route.V), np.diff(route.leg) != 0
    computed = bool((steps[~change] > 1e-9).any()), sign(steps[change].min(), 1e-6)
    ask = """A route of three goals, the first two only passed, is driven by the corrected law in
        continuous time. What does $V$, counted to the present goal, do?"""
    options = {
        (False, 1): ("falls, but jumps up between legs", ""),
        (False, 0): ("falls from first to last", "one proof taken for the whole route"),
        (True, 1): ("rises before each corner too", "braking taken for a rise of $V$"),
        (False, -1): ("falls, and jumps down between legs", "a goal passed taken for a gain"),
        (True, 0): ("rises on each leg", "a longer way taken for a larger $V$"),
    }
    why = """The law makes $V$ fall to the goal of the moment. A new goal is a new error, further
        off."""
    return ask, cases(computed, options), why


@question(14, "Steady, and wrong", "In the dock")
def in_the_dock() -> tuple[str, list[Option], str]:
    arm, bias = 0.6, math.radians(5.0)
    now = estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.2)
    places = []
    for _ in range(300):
        now = estimation.use_position(now, arm, 0.0, 0.001, ahead=arm)
        now = estimation.use_heading(now, bias, math.radians(1.0))
        places.append((round(100.0 * now.pose.x), round(100.0 * now.pose.y)))
    computed = places[-1] if len({*places[-50:]}) == 1 else "wanders"
    ask = """An antenna sits 0.6 m ahead of a robot's middle; its fixes are exact. The compass
        always reads 5 deg too far to the left. The robot stands still. Where does a filter
        believe its middle to be?"""
    options = {
        (0, -5): ("5 cm to the right of it", ""),
        (0, 5): ("5 cm to the left of it", "the antenna's side taken for the robot's"),
        (0, 0): ("where it is", "exact fixes taken for an exact place"),
        (60, 0): ("60 cm ahead of it", "the arm forgotten"),
        "wanders": ("now here, now there", "a constant error taken for noise"),
    }
    why = """By its compass the antenna is 5 cm to the left of its middle. It knows where the
        antenna is, so its middle must be 5 cm to the right of where it is, and nothing
        disagrees."""
    return ask, cases(computed, options), why
