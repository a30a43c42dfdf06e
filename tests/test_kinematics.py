"""Wheels, polar error and motion: against WPILib, a second method, and by property."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import wmrlib as wmr

metres = st.floats(-1e3, 1e3)
angles = st.floats(-math.pi, math.pi, exclude_min=True)
poses = st.builds(wmr.Pose, metres, metres, angles)


def test_wheels_as_in_wpilib():
    """WPILib, DifferentialDriveKinematicsTest: a track of 0.381 m times 2."""
    radius, turn = 0.381, math.pi
    for v, omega, left, right in (
        (0.0, turn, -radius * turn, radius * turn),
        (1.0, 0.0, 1.0, 1.0),
        (radius * turn, turn, 0.0, 2 * radius * turn),
    ):
        assert wmr.twist_to_wheels(v, omega, 0.762) == pytest.approx((left, right))
        assert wmr.wheels_to_twist(left, right, 0.762) == pytest.approx((v, omega))


def test_wrap_angle_gives_plus_pi_for_half_turns_and_keeps_shapes():
    half_turns = math.pi * np.array([-3, -1, 1, 3])
    assert wmr.wrap_angle(half_turns) == pytest.approx(np.full(4, math.pi), abs=1e-15)
    assert wmr.wrap_angle(np.zeros((2, 0, 3))).shape == (2, 0, 3)
    assert wmr.wrap_angle([[4.0], [1.0]]).tolist() == [[4.0 - 2 * math.pi], [1.0]]


@given(poses, poses)
def test_polar_error_against_its_definition(pose, goal):
    """By complex numbers: the phase of a product is the sum of the phases."""
    line = complex(goal.x - pose.x, goal.y - pose.y)
    rho, alpha, theta = wmr.polar_error(pose, goal)
    assert rho == pytest.approx(abs(line), rel=1e-12)
    for angle, heading in ((alpha, pose.heading), (theta, goal.heading)):
        assert -math.pi < angle <= math.pi
        turned = line * complex(math.cos(heading), -math.sin(heading))
        assert rho * math.cos(angle) == pytest.approx(turned.real, abs=1e-9)
        assert rho * math.sin(angle) == pytest.approx(turned.imag, abs=1e-9)


def test_polar_error_behind_and_on_the_goal():
    assert wmr.polar_error(wmr.Pose(0, 0, 0), wmr.Pose(-1, 0, 0)).alpha == math.pi
    assert wmr.polar_error(wmr.Pose(1, 2, 0.5), wmr.Pose(1, 2, 0.25)) == (0.0, -0.5, -0.25)


@given(poses, poses)
def test_pose_from_polar_undoes_polar_error(pose, goal):
    back = wmr.pose_from_polar(wmr.polar_error(pose, goal), goal)
    assert back[:2] == pytest.approx(pose[:2], abs=1e-9)
    assert abs(wmr.wrap_angle(back.heading - pose.heading)) < 1e-12
    assert -math.pi < back.heading <= math.pi


@given(st.floats(0.5, 100), angles, angles, st.floats(-3, 3), st.floats(-3, 3))
def test_polar_rate_is_the_slope_of_polar_error(rho, alpha, heading, v, omega):
    """Along the true motion, by central differences: (7) to (9), and the sign (10) has wrong."""
    goal = wmr.Pose(0.0, 0.0, 0.3)
    pose = wmr.Pose(-rho * math.cos(heading + alpha), -rho * math.sin(heading + alpha), heading)
    dt, twist = 1e-5, np.array([v, omega])
    before, after = (wmr.polar_error(wmr.advance(pose, *way, dt), goal) for way in (-twist, twist))
    change = np.subtract(after, before)
    change[1:] = wmr.wrap_angle(change[1:])
    assert wmr.polar_rate(rho, alpha, v, omega) == pytest.approx(change / (2 * dt), abs=1e-6)


@given(poses, st.floats(-3, 3), st.floats(-3, 3), st.floats(0.0, 2.0))
def test_arc_is_the_exact_motion(pose, v, omega, dt):
    def rate(_, state):
        return wmr.pose_rate(state[2], v, omega)

    truth = solve_ivp(rate, (0, max(dt, 1e-9)), pose, rtol=1e-11, atol=1e-11).y[:, -1]
    there = wmr.advance(pose, v, omega, dt)
    assert there[:2] == pytest.approx(truth[:2], abs=1e-7)
    assert abs(wmr.wrap_angle(there.heading - truth[2])) < 1e-7
    assert -math.pi < there.heading <= math.pi


def test_poses_of_other_lengths_are_refused_with_their_shapes():
    two, three = wmr.Pose(np.ones(2), 0, 0), wmr.Pose(np.ones(3), 0, 0)
    with pytest.raises(ValueError, match=r"lengths: pose\.x .* goal\.x"):
        wmr.polar_error(two, three)
