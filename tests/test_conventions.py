"""Other authors' signs: against their own definitions, and their law near the goal."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook.conventions import CONVENTIONS, gains_near_goal, translate

metres = st.floats(-1e3, 1e3)
angles = st.floats(-math.pi, math.pi, exclude_min=True)
poses = st.builds(wmr.Pose, metres, metres, angles)
GAINS = wmr.Gains(k_rho=0.5, k_alpha=2.0, h=0.7, v_max=3.0)


@given(poses, poses)
def test_beta_as_its_authors_define_it(pose, goal):
    """Corke, Siegwart, PythonRobotics: beta = goal heading - heading - alpha."""
    rho, alpha, theta = wmr.polar_error(pose, goal)
    for name in ("corke", "siegwart", "pythonrobotics"):
        there = translate((rho, alpha, theta), "aicardi", name)
        assert there[:2] == (rho, alpha)
        assert abs(wmr.wrap_angle(there[2] - (goal.heading - pose.heading - alpha))) < 1e-9
        assert translate(there, name, "aicardi") == (rho, alpha, theta)
        assert translate(there, name, "corke") == there


@pytest.mark.parametrize(("name", "sign"), list(zip(CONVENTIONS, (1, -1, -1, 1), strict=True)))
def test_the_linear_law_is_the_corrected_one_near_the_goal(name, sign):
    """k_beta < 0 for Corke and Siegwart, > 0 for PythonRobotics, which subtracts it."""
    rho, alpha, theta = np.random.default_rng(1).uniform([[0], [-1], [-1]], 1, (3, 50)) * 1e-6
    v, omega = wmr.control_law(rho, alpha, theta, GAINS)
    k_rho, k_alpha, k_beta = gains_near_goal(GAINS, name)
    assert math.copysign(1.0, k_beta) == sign
    assert k_alpha > k_rho > 0
    distance, nose, third = translate((rho, alpha, theta), "aicardi", name)
    turning = k_alpha * nose + CONVENTIONS[name].gain * k_beta * third
    np.testing.assert_allclose(v, k_rho * distance, rtol=1e-5)
    np.testing.assert_allclose(omega, turning, atol=1e-11)
