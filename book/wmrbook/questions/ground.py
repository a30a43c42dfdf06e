"""Concept questions on chapters 0 to 3: arrival, GPS points, wheels, and the angles' signs."""

from __future__ import annotations

import math

import numpy as np

import wmrlib as wmr
from wmrbook.questions._asking import Option, cases, numbers, question, sign

_East = wmr.Pose(0.0, 0.0, 0.0)


@question(0, "How does it end?", "Where does it face its goal's heading best?")
def arrived_parked() -> tuple[str, list[Option], str]:
    case = wmr.paper.outdoor()
    fine = {"method": "continuous", "dt": 0.02, "arrival_radius": 0.009}
    run = wmr.simulate(case.start, case.goal, case.gains, **fine)
    radii = 0.3, 0.1, 0.05, 0.01
    errors = np.degrees(np.interp(radii, run.rho[::-1], run.heading_error[::-1])).tolist()
    sizes = [abs(error) for error in errors]
    best, even = radii[sizes.index(min(sizes))], max(sizes) - min(sizes) < 5.0
    through = errors[0] > 50.0 > -50.0 > errors[-1]
    ask = """The paper's robot ($k_\\rho$ 2, $k_\\alpha$ 1, $h$ 0.3, $v_{\\max}$ 4) looks at its
        goal all the time. It is stopped 30, 10, 5 or 1 cm before the goal. Where does it face
        most nearly the right way?"""
    options = {
        0.3: ("at 30 cm", "a heading that swings taken for one that only gets worse"),
        0.1: ("at 10 cm", ""),
        0.05: ("at 5 cm", "a usual tolerance taken for the best"),
        0.01: ("at 1 cm", "the heading error taken to fade with the distance"),
        "even": ("equally well at all four", "a robot that has arrived taken to be parked"),
    }
    why = """On this drive the heading swings from 50 deg on one side to 50 on the other over the
        last 30 cm, and passes through zero near 10 cm. So the number depends on where we stop."""
    return ask, cases("even" if even else best if through else None, options), why


@question(1, "How long is a degree?", "Latitude and longitude swapped")
def swapped_points() -> tuple[str, list[Option], str]:
    lat, apart = 60.0, 100.0
    start = wmr.GeoPoint(lat=lat, lon=11.0)
    end = wmr.point_at(start, apart, 0.0)
    swapped = [wmr.GeoPoint(lat=point.lon, lon=point.lat) for point in (start, end)]
    slope = math.radians(lat)
    mistaken = {
        "a distance taken not to depend on which number is which": apart,
        "the cosine of the latitude, the wrong way round": apart * math.cos(slope),
        "a sine in place of the cosine": apart / math.sin(slope),
        "a tangent in place of the cosine": apart * math.tan(slope),
    }
    ask = """Two points near Oslo (60 deg north, 11 deg east) are 100 m apart, one due east of
        the other. A program swaps latitude and longitude. What distance does it report?"""
    why = """The points differ in longitude only, and a degree of it is half as long at 60 deg as
        a degree of latitude."""
    return ask, numbers(wmr.haversine_distance(*swapped), mistaken, "{:.0f} m"), why


@question(1, "Which way is the goal?", "From a bearing to a heading")
def bearing_and_heading() -> tuple[str, list[Option], str]:
    bearing_deg = 120.0
    here = wmr.GeoPoint(lat=33.0, lon=44.0)
    there = wmr.destination_point(here, 10.0, math.radians(bearing_deg))
    east, north = wmr.local_position(here, there)
    right = math.degrees(math.atan2(north, east))
    mistaken = {
        "the bearing taken for a heading": bearing_deg,
        "from east, but still clockwise": bearing_deg - 90.0,
        "counter-clockwise, but still from north": -bearing_deg,
        "the line of sight taken from the goal back": 270.0 - bearing_deg,
    }
    ask = """The goal's bearing is 120 deg, clockwise from north. Which heading,
        counter-clockwise from east, looks at it?"""
    why = "The heading is 90 deg minus the bearing: it starts in the east and turns the other way."
    return ask, numbers(right, mistaken, "{:.0f} deg"), why


@question(2, "About which point does it turn?", "About which point does it turn?")
def turning_centre() -> tuple[str, list[Option], str]:
    left, right, width = 0.6, 0.2, 0.5
    v, omega = wmr.wheels_to_twist(left, right, width)
    mistaken = {
        "$\\omega$ counted clockwise": (left + right) / 2.0 / ((left - right) / width),
        "the slower wheel taken for the centre": -width / 2.0,
        "the middle of the axle taken for the centre": 0.0,
        "the sum of the wheels' speeds, not the mean": -width * (left + right) / (left - right),
    }
    ask = """Two wheels, 0.5 m apart, roll at 0.6 m/s (left) and 0.2 m/s (right). How far to the
        left of the axle's middle is the point about which the robot turns?"""
    why = "It lies $v/\\omega$ to the left: 0.4 m/s over -0.8 rad/s is half a metre to the right."
    return ask, numbers(v / omega, mistaken, "{:.2f} m"), why


@question(2, "Four moves, and little room", "Four short moves")
def four_moves() -> tuple[str, list[Option], str]:
    drive, turn, pose = 0.5, math.radians(30.0), _East
    for v, omega in ((drive, 0.0), (0.0, turn), (-drive, 0.0), (0.0, -turn)):
        pose = wmr.advance(pose, v, omega, 1.0)
    ahead, left = (sign(value, 0.1) for value in pose[:2])
    ask = """A robot drives 0.5 m ahead, turns 30 deg left, drives 0.5 m back, and turns 30 deg
        right. Where is it then, mainly, seen from where it began?"""
    options = {
        (0, -1): ("to the right", ""),
        (0, 1): ("to the left", "the side of the first turn taken for the side of the drive"),
        (0, 0): ("where it began", "each move taken to be undone by a later one"),
        (1, 0): ("ahead", "no velocity to the side taken for no way to the side"),
        (-1, 0): ("behind", "the drive back taken for the longer one"),
    }
    why = """It backs along a line that is turned left, so to the right. The wheels forbid a
        velocity, not a place."""
    return ask, cases((ahead, left), options), why


@question(3, "Three numbers and their signs", "Which angles does it see?")
def two_angles() -> tuple[str, list[Option], str]:
    goal = wmr.Pose(-10.0, 0.0, math.radians(-90.0))
    robot = wmr.Pose(0.0, 0.0, math.radians(135.0))
    error = wmr.polar_error(robot, goal)
    alpha, theta = (round(math.degrees(angle)) for angle in error[1:])
    right = {"alpha": 180 - 135, "theta": (180 + 90 + 180) % 360 - 180}
    a, b = right["alpha"], right["theta"]

    def pair(one: int, two: int) -> str:
        return f"$\\alpha$ {one} deg, $\\theta$ {two} deg"

    options = {
        (a, b): (pair(a, b), ""),
        (-a, -b): (pair(-a, -b), "both from the line of sight to the heading"),
        (a, b + 360): (pair(a, b + 360), "$\\theta$ left unwrapped"),
        (a, -b): (pair(a, -b), "$\\theta$ turned from the line of sight to the heading"),
        (b, a): (pair(b, a), "$\\alpha$ and $\\theta$ in each other's place"),
    }
    ask = """The robot faces north-west. Its goal lies due west and looks south. Which angles
        does the law get?"""
    why = "Each turns from a heading to the line of sight, positive to the left, and is wrapped."
    return ask, cases((alpha, theta), options), why


@question(3, "One angle, two signs", "The wrong sign of the third angle")
def beta_or_theta() -> tuple[str, list[Option], str]:
    k_rho, k_alpha, k_beta, pose = 3.0, 8.0, -1.5, wmr.Pose(-3.0, 0.5, -0.3)
    for _ in range(1200):
        error = wmr.polar_error(pose, _East)
        if error.rho < 0.01:
            break
        omega = k_alpha * error.alpha + k_beta * error.theta
        pose = wmr.advance(pose, k_rho * error.rho, omega, 0.005)
    there, parked = error.rho < 0.01, abs(pose.heading) < 0.1
    ask = """A law from a book is $v = 3\\rho$, $\\omega = 8\\alpha - 1.5\\beta$, with $\\beta =
        -\\theta$ and all angles wrapped to $\\pm$180 deg. A program puts $\\theta$ where
        $\\beta$ belongs. What does the robot do?"""
    options = {
        (True, False): ("reaches the place, looks another way", ""),
        (True, True): ("parks as before", "a sign taken for a matter of names"),
        (False, False): ("never comes near the place", "the speed taken to need the third angle"),
        "mirror": ("parks on the mirrored path", "both angles taken for mirrored"),
        "spin": ("spins on the spot", "the sign of $\\alpha$ taken for wrong"),
    }
    why = """The distance falls whatever the third angle is; with the wrong sign the heading
        error grows, wrapped or not, until the robot is there. Siegwart counts $\\beta$, we
        $\\theta$."""
    return ask, cases((there, parked), options), why
