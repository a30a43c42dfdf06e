"""The paper's data, and the numbers that the project sets against the paper's."""

import math
import re

import numpy as np
import pytest

import wmrlib as wmr
from wmrbook.audit.published import PUBLISHED


def test_outdoor_in_both_readings_of_the_axes():
    east, north = wmr.paper.outdoor("east"), wmr.paper.outdoor("north")
    assert east.goal[:2] == pytest.approx((9.6684, 57.2654), abs=1e-4)
    assert (north.goal.x, north.goal.y) == (east.goal.y, east.goal.x)
    assert math.degrees(east.start.heading) == pytest.approx(72.0)
    assert math.degrees(east.goal.heading) == pytest.approx(-60.0)
    # Only x north has the paper's 57 m in x.
    assert north.goal.x == pytest.approx(PUBLISHED["x_error_at_start"].value, abs=0.5)


def test_circle_is_the_papers_and_its_twist_is_its_derivative():
    first = wmr.paper.circle(0.0)
    assert first[:3] == (0.0, 0.0, math.pi / 2)
    t, dt = np.linspace(0, 40, 9), 1e-6
    before, here, after = (wmr.paper.circle(t + shift) for shift in (-dt, 0.0, dt))
    velocity = np.hypot(after.x - before.x, after.y - before.y) / (2 * dt)
    assert velocity == pytest.approx(here.v, rel=1e-8)
    assert (after.heading - before.heading) / (2 * dt) == pytest.approx(here.omega, rel=1e-8)
    direction = np.arctan2(after.y - before.y, after.x - before.x)
    assert wmr.wrap_angle(direction - here.heading) == pytest.approx(np.zeros(9), abs=1e-7)


# The paper's words, with the name of each number.
QUOTED = """
the $y_error$, $x_error$ in LQR better by {lqr_y_advantage: 0.52}% and {lqr_x_advantage: 7.52} %
an error of about {sphere_error: 0.5}% in a large scale of 100 m
mean earth radius R = {earth_radius: 6371} km
an inside control loop that is faster {inner_loop: 10} times of the main loop [printed: ten]
x_r = {circle_radius: 4} cos(2 pi t/T) - 4, where T = {circle_period: 40} sec is the cyclic time
The initial error is {circle_x_error: 1} m in the x-direction and {circle_y_error: 2} m in the y
The initial reference starts at [0, 0, {circle_reference_heading: pi/2}]
the initial robot posture [1, 2, {circle_start_heading: 0}]
k_rho = {circle_k_rho: 1.9}, k_alpha = {circle_k_alpha: 1} and h = {circle_h: 0.05}
the total error converges to {circle_residual: 0.1} m at the end
GPS-point-1 = ({start_longitude: 44.373160}, {start_latitude: 33.273572})
GPS-point-2 = ({goal_longitude: 44.373264}, {goal_latitude: 33.274087})
The straight distance between these two points is {distance: 58.07} meters
the bearing angle calculated by Eq. (15) is {bearing: 9.4} degrees
an initial angle is {start_heading: 2*pi/5}, and the goal with angle {goal_heading: -2*pi/6}
The error at starting is {x_error_at_start: 57} meters in the x-direction
the error at y-direction is {y_error_at_start: 8} meter
k_rho = {outdoor_k_rho: 2}, k_alpha = {outdoor_k_alpha: 1}, h = {outdoor_h: 0.3}
time-stepping {time_step: 0.1} seconds. The linear speed is limited at {speed_limit: 4} m/s
"""


def quoted():
    quotes = re.findall(r"{(\w+): ([^}]+)}", QUOTED)
    return {name: float(eval(number, {"pi": math.pi})) for name, number in quotes}


def test_published_numbers_are_those_that_the_paper_prints():
    assert {name: number.value for name, number in PUBLISHED.items()} == quoted()


def test_scenarios_are_those_that_the_paper_prints():
    printed, paper = quoted(), wmr.paper
    circle = [printed[f"circle_{name}"] for name in ("k_rho", "k_alpha", "h")]
    outdoor = [printed[f"outdoor_{name}"] for name in ("k_rho", "k_alpha", "h")]
    assert wmr.Gains(*circle, v_max=printed["speed_limit"]) == paper.CIRCLE_GAINS
    assert wmr.Gains(*outdoor, v_max=printed["speed_limit"]) == paper.outdoor().gains
    assert printed["circle_radius"] == paper.CIRCLE_RADIUS
    assert printed["circle_period"] == paper.CIRCLE_PERIOD
    speed = 2.0 * math.pi * printed["circle_radius"] / printed["circle_period"]
    assert pytest.approx(speed) == paper.CIRCLE_SPEED
    start = printed["circle_x_error"], printed["circle_y_error"], printed["circle_start_heading"]
    assert start == paper.CIRCLE_START
    assert paper.circle(0.0).heading == printed["circle_reference_heading"]
    for end, point in (("start", paper.GPS_POINT_1), ("goal", paper.GPS_POINT_2)):
        assert (printed[f"{end}_latitude"], printed[f"{end}_longitude"]) == (point.lat, point.lon)
    case = paper.outdoor()
    headings = case.start.heading, case.goal.heading
    assert (*headings, case.dt) == (
        printed["start_heading"],
        printed["goal_heading"],
        printed["time_step"],
    )
    assert 1000.0 * printed["earth_radius"] == wmr.EARTH_RADIUS_M
