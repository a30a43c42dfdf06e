"""A robot's sheet: its settings from two points and a data sheet, and where it will park.

`kit/my_robot.js` says the same in a page, run by run; tests/browser/test_my_robot.py compares them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

import wmrlib as wmr
from wmrlib.checks import book_extra, instance, scalar
from wmrrobot.monitor import Rules
from wmrrobot.trials import Plan, Sensors, ends_of

with book_extra("wmrrobot.sheets"):
    from scipy.special import bdtr

SHAPE = {"kappa": 2.5, "h": 2.0}  # of the path: inside the window 2 < kappa < 1 + h
SPARE = 0.8  # share of the wheels' speed that the law may ask for: the rest is for turns
BRAKE = 0.3  # k_rho times the radius at most: it is slow before it stops
NEW = 5.0  # s: what is new of the receiver's error after that long sets the radius
NEAREST = 0.05  # m: no radius is smaller
MOVES = 1.25  # times the dead band a wheel surely turns
COARSE = 0.35  # rad: a last turn that is coarser is none
MARGIN = 0.2  # s: a fix may be so much older than usual
STEADY = 4.0  # sigmas: two fixes of a sound receiver differ by less
SCATTER = 0.02  # rad: the headings of two fixes differ by so much, whatever the compass error
SIDE = 3.0  # sigmas of the compass: few are farther off
LAG = 0.1  # s that the wheels of the certificate's robot lag
SWING = 2.0  # times a wrong compass moves the place on the antenna's arm: a last turn turns that
CLOSE = 0.1  # m: no jump that is smaller is refused
LEG = 1.0  # m: over less, a course says little; over more, a soft tyre turns the wheels' heading
SUREST = 0.1  # degrees: a filter is told of no better compass
FAR = 1000.0  # m
RUNS, SEED, SHARE = 400, 14, 0.95
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0  # spreads the first headings evenly


class Robot(NamedTuple):
    """Two points, a robot and its receiver; by default a small one with RTK on the paper's way.

    Parameters
    ----------
    start_lat, start_lon, goal_lat, goal_lon, bearing : float, degrees; where it faces at the goal,
        clockwise from north
    track_width, max_speed, acceleration, dead_band : float, m, m/s, m/s^2, m/s; of the wheels
    period, delay : float, s; of the control loop, and how old the pose is that it sees
    sigma, memory, fix_period, compass : float, m, s, s, degrees; of the receiver's error to the
        east and to the north, and of the compass, which errs by one angle in a drive. Far more than
        20 degrees, and the checks would take it for a fault.
    quality : float, the least that a fix must have, as NMEA counts: 1 GPS, 2 differential, 5 RTK
        float and, the best, 4 RTK fixed
    antenna_ahead, antenna_left : float, m from the middle between the wheels
    """

    start_lat: float = 33.273572
    start_lon: float = 44.373160
    goal_lat: float = 33.274087
    goal_lon: float = 44.373264
    bearing: float = 150.0
    track_width: float = 0.4
    max_speed: float = 1.0
    acceleration: float = 1.0
    dead_band: float = 0.05
    period: float = 0.05
    delay: float = 0.1
    sigma: float = 0.014
    memory: float = 10.0
    fix_period: float = 0.2
    compass: float = 3.0
    quality: float = 4.0
    antenna_ahead: float = 0.0
    antenna_left: float = 0.0


BOUNDS = {
    **dict.fromkeys(("start_lat", "goal_lat"), (-90.0, 90.0, "degrees")),
    **dict.fromkeys(("start_lon", "goal_lon"), (-180.0, 180.0, "degrees")),
    "bearing": (0.0, 360.0, "degrees"),
    "track_width": (0.05, 5.0, "m"),
    "max_speed": (0.05, 10.0, "m/s"),
    "acceleration": (0.05, 20.0, "m/s²"),
    "dead_band": (0.0, 5.0, "m/s"),
    "period": (0.01, 0.5, "s"),
    "delay": (0.0, 2.0, "s"),
    "sigma": (0.0, 10.0, "m"),
    "memory": (0.0, 10000.0, "s"),
    "fix_period": (0.01, 5.0, "s"),
    "compass": (0.0, 20.0, "degrees"),
    "quality": (1.0, 5.0, ""),
    **dict.fromkeys(("antenna_ahead", "antenna_left"), (-5.0, 5.0, "m")),
}
RECEIVERS = {
    "GPS alone": {"sigma": 1.5, "memory": 300.0, "quality": 1.0},
    "SBAS": {"sigma": 0.7, "memory": 300.0, "quality": 2.0},
    "RTK float": {"sigma": 0.2, "memory": 60.0, "quality": 5.0},
    "RTK fixed": {"sigma": 0.014, "memory": 10.0, "quality": 4.0},
}
"""Numbers to begin with, until a log at rest gives sigma and memory of one's own receiver."""


class Sheet(NamedTuple):
    """The settings of a robot; m, s, rad. x is east of the start, `duration` ample for a drive."""

    x: float
    y: float
    heading: float
    distance: float
    gains: wmr.Gains
    radius: float
    longest_step: float
    wheels: wmr.Wheels
    turn: wmr.LastTurn
    duration: float
    rules: Rules  # of a drive


class Certificate(NamedTuple):
    """The errors at the end of many runs: m, rad, s.

    The bounds hold for 95 % of drives, with 95 % confidence.
    """

    parked: int
    place_rms: float
    heading_rms: float
    place_bound: float
    heading_bound: float
    time: float  # median
    place: np.ndarray  # of each run
    heading: np.ndarray


def refused(name: str, value: float, needed: str, more: str = "") -> ValueError:
    """The error for a field that is out of its bounds."""
    return ValueError(f"{name} = {value:g} is not allowed: {needed} is needed{more}")


def place_of(robot: Robot) -> tuple[float, float]:
    """The goal, in m east and north of the start; ValueError if they are too far apart."""
    start = wmr.GeoPoint(lat=robot.start_lat, lon=robot.start_lon)
    goal = wmr.GeoPoint(lat=robot.goal_lat, lon=robot.goal_lon)
    if (apart := wmr.haversine_distance(start, goal)) <= FAR:
        return wmr.local_position(start, goal)
    message = f"the points are {apart / 1000:.0f} km apart: at most {FAR / 1000:g} km is allowed"
    swapped = wmr.GeoPoint(lat=min(goal.lon, 90.0), lon=goal.lat)
    if wmr.haversine_distance(start, swapped) <= FAR:
        message += "; are latitude and longitude of one of them swapped?"
    raise ValueError(message)


def arm_of(robot: Robot) -> float:
    """The distance of the antenna from the middle between the wheels, m."""
    return math.hypot(robot.antenna_ahead, robot.antenna_left)


def sheet(robot: Robot) -> Sheet:
    """Return the settings of a robot, by the rules above.

    Raises
    ------
    ValueError : another type, a field out of its bounds, or fields that don't go together; it is
        named
    """
    instance("robot", robot, Robot)
    for name, (low, high, unit) in BOUNDS.items():
        value = scalar(name, getattr(robot, name))
        if not low <= value <= high or (name == "quality" and value % 1):
            kind = "whole number" if name == "quality" else "number"
            swapped = ": are latitude and longitude swapped?" if name.endswith("_lat") else ""
            needed = f"a {kind} from {low:g} to {high:g} {unit}".rstrip()
            raise refused(name, value, needed, swapped)
    x, y = place_of(robot)
    speed, dead, late = robot.max_speed, robot.dead_band, robot.delay + robot.period
    if dead > speed / 2:
        raise refused("dead_band", dead, f"at most half of max_speed, {speed / 2:g},")
    keep = math.exp(-2 * NEW / robot.memory) if robot.memory else 0.0
    min_speed, v_max = MOVES * dead, SPARE * speed
    swing = arm_of(robot) * math.radians(robot.compass)  # m, of the place on the antenna's arm
    radius = max(
        NEAREST,
        robot.sigma * math.sqrt(1 - keep),
        min_speed * (late + robot.fix_period),
        SWING * swing,
    )
    if (apart := math.hypot(x, y)) < 4 * radius:
        raise ValueError(
            f"the points are {apart:.3g} m apart: at least {4 * radius:.3g} m, four times the "
            "arrival radius, is needed"
        )
    braking = 2 * robot.acceleration / robot.track_width  # rad/s^2
    step = wmr.longest_step(wmr.gains_for(1.0, **SHAPE))
    step /= max(5 * robot.period, 2 * late, robot.delay + robot.fix_period)
    agile = math.sqrt(braking / math.pi) / SHAPE["kappa"]  # it can slow a turn from behind
    rate = min(BRAKE * v_max / radius, robot.acceleration / v_max, step, agile)
    gains = wmr.gains_for(rate, **SHAPE, v_max=v_max)
    min_rate = max(0.1, 2 * MOVES * dead / robot.track_width)
    max_rate = max(min_rate, min(1.0, speed / robot.track_width))
    tolerance = max(0.02, min_rate * late + min_rate**2 / (2 * braking))
    if tolerance > COARSE:
        guilty = "delay" if min_rate * robot.delay > 0.5 * tolerance else "dead_band"
        others = {"delay": "dead band", "dead_band": "delay"}[guilty]
        coarse = f"a last turn within {math.degrees(COARSE):.0f} deg"
        comes = f"it is {math.degrees(tolerance):.0f} deg"
        more = f"; with this width, acceleration and {others} {comes}"
        raise refused(guilty, getattr(robot, guilty), coarse, more)
    k, far = gains.k_rho, math.log1p(-math.exp(-gains.k_rho * apart))
    travel = (k * (apart - radius) + far - math.log1p(-math.exp(-k * radius))) / rate
    gain = min(2.0, 0.5 / late, braking / max_rate)
    settle = late + max(min_rate, gain * tolerance) / braking  # it sees where it came to rest
    turn = wmr.LastTurn(tolerance, gain, min_rate, max_rate, settle=settle)
    heading, longest = wmr.wrap_angle(math.radians(90.0 - robot.bearing)), wmr.longest_step(gains)
    duration = math.ceil(60.0 + 2.0 * travel)
    oldest = robot.delay + MARGIN
    usual = Rules()
    wheels = wmr.Wheels(robot.track_width, speed, min_speed, robot.acceleration, dead_band=dead)
    # A wrong heading turns the antenna about the robot, and the way since a late fix about the fix;
    # a speed that changes shows a wrong age. A wrong compass leads the odometry astray until the
    # next fix, which the slip excuses in part.
    lost = max(0.0, SIDE * math.radians(robot.compass) - usual.slip) * v_max * robot.fix_period
    error = math.hypot(robot.sigma, swing, SCATTER * v_max * robot.delay)
    aged = MARGIN * min(robot.acceleration * robot.fix_period, speed)
    jump = max(CLOSE, STEADY * error + aged + lost)
    rules = usual._replace(
        arrival_radius=radius,
        patience=oldest + 2 * max(robot.fix_period, robot.period),
        oldest=oldest,
        largest_error=max(radius, 3 * robot.sigma),
        least=int(robot.quality),
        jump=jump,
        course=max(LEG, 3 * jump),  # over less, errors that are allowed turn a leg
        longest_period=max(usual.longest_period, 1.5 * robot.period),
        longest_drive=max(usual.longest_drive, duration),
        farthest=max(usual.farthest, 2 * apart),
    )
    fields = x, y, heading, apart, gains, radius, longest, wheels, turn, duration
    return Sheet(*fields, rules)


def sure(runs: int) -> int:
    """The rank of the run whose error bounds 95 % of drives with 95 % confidence."""
    at_most = bdtr(np.arange(runs + 1), runs, 1 - SHARE)  # the chance of so many beyond, or fewer
    return runs - int(np.argmax(at_most > 1 - SHARE)) + 1


def certificate(
    robot: Robot, runs: int = RUNS, seed: int = SEED, spread: float = 0.5
) -> Certificate:
    """Drive the robot of the sheet `runs` times, each with errors and a first heading of its own.

    It drives as `Drive` does, with its checks and by the same functions. It first faces the goal to
    within half of the `spread`, in turns. A drive that does not park in time, because its checks
    stop it or because it swings to and fro, counts as infinitely far off. The wheels lag by
    0.1 s and the compass scatters by 0.02 rad, neither of which the sheet knows. Times of the
    receiver are rounded up to whole periods.

    Raises
    ------
    ValueError : as `sheet`, and for a seed that is no whole number from 0 to 2**64 - 1
    """
    settings = sheet(robot)
    aside = 2 * math.pi * spread * (np.arange(runs) * GOLDEN % 1.0 - 0.5)
    goal = wmr.Pose(settings.x, settings.y, settings.heading)
    arm, dt = (robot.antenna_ahead, robot.antenna_left), robot.period
    every, late = (dt * math.ceil(time / dt - 1e-9) for time in (robot.fix_period, robot.delay))
    compass = math.radians(robot.compass)
    receiver = wmr.Receiver(robot.sigma, robot.memory, every, late, compass=compass)
    end = ends_of(
        math.atan2(settings.y, settings.x) + aside,
        Plan(goal, settings.gains, settings.wheels, settings.turn, settings.rules),
        LAG,
        Sensors(dt, SCATTER, *arm, settings.rules.least, robot.sigma),
        receiver,
        settings.rules.longest_drive + settings.rules.longest_wait,
        seed,
    )
    far = np.hypot(end.x - goal.x, end.y - goal.y)
    turned = wmr.wrap_angle(end.heading - goal.heading)
    place, heading = (np.where(end.parked, errors, np.inf) for errors in (far, abs(turned)))
    least = sure(runs)
    place_rms, heading_rms = (_rms(errors[end.parked]) for errors in (place, heading))
    bounds = (
        np.sort(errors)[least - 1] if least <= runs else np.inf for errors in (place, heading)
    )
    time = np.median(np.where(end.parked, end.time, np.inf))
    parked = int(end.parked.sum())
    return Certificate(parked, place_rms, heading_rms, *map(float, (*bounds, time)), place, heading)


def _rms(values: np.ndarray) -> float:
    return math.sqrt(np.mean(values**2)) if values.size else math.inf
