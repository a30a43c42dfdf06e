"""Headlines of chapters 10 to 12 and of the README: the audit, real parts, logs and routes."""

from __future__ import annotations

import math

import numpy as np

import wmrlib as wmr
from wmrbook import audit
from wmrbook.headlines import ROUND, SEEDS, Before, headline
from wmrbook.published import PUBLISHED
from wmrlib import paper

GAINS, GENTLE = paper.OUTDOOR_GAINS, wmr.GENTLE_GAINS
DIGIT = (-0.5e-6, 0.5e-6)  # half a unit of a printed coordinate's last digit, deg


SWINGS = "swings from 52 deg at 30 cm to -59 deg at 1 cm (continuous time, x east)"
ENDS = {"at_least": -59.4, "at_most": 52.5}
TO_1_CM = Before("swings from 52 to -59 deg over the last 30 cm", {"stop": (0.005, 0.3)}, **ENDS)


@headline("README.md", SWINGS, unit="deg", stop=(0.01, 0.3), before=TO_1_CM, **ENDS)
def heading_at(stop):
    case = paper.outdoor("east")
    how = {"method": "continuous", "dt": 0.005, "arrival_radius": 0.004}
    run = wmr.simulate(case.start, case.goal, case.gains, **how)
    return math.degrees(np.interp(-stop, -run.rho, run.theta - run.alpha))


@headline(
    "README.md",
    "its bearing of 9.4 deg does not follow from its points, which give 9.58 deg",
    at_least=9.45,
    at_most=9.7,
    unit="deg",
    **dict.fromkeys(("lat_a", "lon_a", "lat_b", "lon_b"), DIGIT),
)
def bearing(lat_a, lon_a, lat_b, lon_b):
    a, b = paper.GPS_POINT_1, paper.GPS_POINT_2
    a = wmr.GeoPoint(lat=a.lat + lat_a, lon=a.lon + lon_a)
    return math.degrees(wmr.initial_bearing(a, wmr.GeoPoint(lat=b.lat + lat_b, lon=b.lon + lon_b)))


GAIN_RANGES = {"k_rho": (0.05, 5.0), "k_alpha": (0.05, 5.0), "h": (0.01, 10.0)}


@headline(
    "10",
    "rises near the goal **for all positive gains and every $L$**",
    **GAIN_RANGES,
    v_max=(0.1, 10.0),
    L=(0.01, 100.0),
    theta=(0.05, 3.0),
)
def rises_near_the_goal(k_rho, k_alpha, h, v_max, L, theta):
    gains = wmr.Gains(k_rho, k_alpha, h, v_max)
    alpha = 0.1 * v_max * k_rho * h * theta / (k_alpha + v_max * k_rho * (1.0 + h * theta))
    return wmr.lyapunov_rate(1e-9, min(alpha, 0.1), theta, gains, law="printed", L=L) > 0.0


@headline(
    "10",
    "From the paper's start, with 4 m/s, which it uses outdoors, only the corrected law fits; with "
    "8 m/s only the printed one",
    v_max=[4.0, 8.0],
    dt=(0.01, 0.1),
    duration=[40.0, 60.0, 80.0],
)
def law_of_the_circle(v_max, dt, duration):
    how = {"dt": dt, "duration": duration}
    gains = paper.CIRCLE_GAINS._replace(v_max=v_max)
    fits = {}
    for law in ("corrected", "printed"):
        run = wmr.track(paper.circle, paper.CIRCLE_START, gains, law=law, **how)
        fits[law] = audit.fits(wmr.residual(run), PUBLISHED["circle_residual"])
    return fits == {"corrected": v_max == 4.0, "printed": v_max == 8.0}


@headline(
    "11",
    '"Arrived within 5 cm" is what the robot believes. More than half the robots are further',
    at_least=0.05,
    unit="m",
    seed=SEEDS,
    memory=[0.0, 10.0, 300.0],
    x_axis=["east", "north"],
)
def believed(seed, memory, x_axis):
    case, runs = paper.outdoor(x_axis), np.zeros(200)
    starts = wmr.Pose(*(field + runs for field in case.start))
    sensor = wmr.Receiver(sigma=0.5, memory=memory)
    how = {"method": "arc", "dt": 0.05, "duration": 100.0, "arrival_radius": 0.05}
    end = wmr.sweep(starts, case.goal, GENTLE, receiver=sensor, seed=seed, progress=False, **how)
    return np.median(end.distance)


@headline(
    "11",
    "Row 8, the goal, and its heading too: zero",
    at_most=0.0,
    heading=[0.0],
    direction=ROUND,
    before=Before("Row 8, the goal: zero.", {"heading": ROUND, "direction": ROUND}, at_most=0.0),
)
def on_the_goal(heading, direction):
    goal = wmr.Pose(0.0, 0.0, direction)
    seen = wmr.polar_error(wmr.Pose(0.0, 0.0, direction + heading), goal)
    seen = seen._replace(alpha=wmr.wrap_angle(-heading), theta=0.0)  # the sight is the goal's
    return max(map(abs, wmr.control_law(*seen, GENTLE)))


@headline(
    "11",
    "0.42 m apart for degrees",
    at_least=0.42,
    at_most=0.43,
    unit="m",
    lon=(32.1, 63.9),
    radius=(6_357_000.0, 6_378_137.0),
)
def float_degrees(lon, radius):
    return math.radians(np.spacing(np.float32(lon))) * radius


@headline(
    "12",
    "Headings bisect the bends (12.1), unless they are given",
    at_most=1e-9,
    unit="rad",
    first=ROUND,
    bend=(-3.0, 3.0),
    length=(1.0, 100.0),
)
def off_the_bisector(first, bend, length):
    legs = [5.0 * np.exp(1j * first), length * np.exp(1j * (first + bend))]
    points = np.cumsum([0.0, *legs])
    chosen = wmr.headings_along(points.real, points.imag)[1]
    return abs(wmr.wrap_angle(chosen - first - bend / 2.0))
