"""The filter at its limits: gates, slip, courses, angles, bad input, and its covariance."""

import math

import numpy as np
import pytest
from driven import ARM, DT, FIRST, NOISE, seen
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chi2

import wmrlib as wmr
from wmrrobot import estimation
from wmrrobot.estimation import Noise

# What each measurement does ----------------------------------------------------------------------


def test_a_jump_is_refused_and_its_surprise_told():
    jump = estimation.use_position(FIRST, 31.0, -2.0, 0.5)
    assert jump.surprise == pytest.approx(30.0**2 / 0.5)
    assert (jump.state == FIRST.state).all()
    assert (jump.covariance == FIRST.covariance).all()
    assert estimation.use_position(FIRST, 31.0, -2.0, 0.5, gate=math.inf).pose.x == 16.0
    edge = math.sqrt(estimation.GATE_1 * (0.2**2 + 0.1**2))
    assert estimation.use_heading(FIRST, 0.4 + 0.999 * edge, 0.1).pose.heading != 0.4
    assert estimation.use_heading(FIRST, 0.4 + 1.001 * edge, 0.1).pose.heading == 0.4


def test_a_robot_that_was_carried_is_found_once_the_filter_doubts_itself():
    """Its gate refuses the new place for an hour; doubt lets it in."""
    now = FIRST
    for _ in range(50):
        now = estimation.use_position(now, 1.0, -2.0, 0.02)
    carried, refused = 0.5, now
    for _ in range(3600):
        refused = estimation.predict(refused, 0.0, 0.0, math.nan, 1.0, NOISE)
        refused = estimation.use_position(refused, 1.0 + carried, -2.0, 0.02)
    assert refused.pose.x == pytest.approx(1.0, abs=0.02)
    estimate, used = refused, 0
    for _ in range(40):
        estimate = estimation.use_position(estimate, 1.0 + carried, -2.0, 0.02)
        used += estimate.surprise <= estimation.GATE_2
        estimate = estimate if used else estimation.doubt(estimate, 4.0)
    assert used > 25
    assert estimate.pose.x == pytest.approx(1.0 + carried, abs=3.0 * estimate.sigma[0])


def test_wheels_that_slip_leave_the_turn_to_the_gyro():
    still = estimation.predict(FIRST, 0.0, 0.0, 0.0, 5.0, NOISE)
    slipped = estimation.predict(still, 0.5, 2.0, 0.1, DT, NOISE)
    assert slipped.surprise > estimation.GATE_1
    assert slipped.pose.heading == pytest.approx(0.4 + 0.1 * DT, abs=1e-6)


def test_a_course_counts_backwards_and_beside_the_middle_but_not_at_a_crawl():
    for v, omega in ((1.0, 0.0), (-1.0, 0.0), (0.5, 0.8), (-0.5, 0.8), (0.0, 1.0)):
        before = seen((0.0, 0.0, 0.4, 0, 0))
        then = seen((*wmr.advance(wmr.Pose(0.0, 0.0, 0.4), v, omega, 1e-6), 0, 0))
        course = math.atan2(*(then - before)[::-1])
        used = estimation.use_course(FIRST, course, 1e-3, v, omega, **ARM, slowest=0.1)
        assert used.pose.heading == pytest.approx(0.4, abs=1e-5)
        assert used.sigma[2] < 2e-3
        slow = estimation.use_course(FIRST, course, 1e-3, 0.29 * v, 0.0, slowest=0.3)
        assert slow is FIRST
    for v, omega in ((0.2, 1.0), (-0.3, -1.5)):  # about an antenna that stands
        assert estimation.use_course(FIRST, 0.4, 1e-3, v, omega, left=0.2, slowest=0.1) is FIRST


def test_a_heading_goes_the_short_way_round():
    near = estimation.start(wmr.Pose(0.0, 0.0, 3.1), 1.0, 0.1)
    used = estimation.use_heading(near, -3.1, 0.1)
    assert used.pose.heading == pytest.approx(math.pi)
    pushed = estimation.use_heading(near, -3.0, 0.01)
    assert pushed.pose.heading == pytest.approx(-3.0, abs=0.01)


# Whatever comes, the covariance is one -----------------------------------------------------------

STEP = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(-3, 3) | st.just(math.nan))
SIGHT = st.tuples(
    st.sampled_from("phc"), st.floats(-50, 50), st.floats(-50, 50), st.floats(1e-3, 9)
)


@given(st.lists(st.tuples(STEP, SIGHT), max_size=30), st.sampled_from([math.inf, 10.0]))
def test_the_covariance_stays_symmetric_and_positive_definite(steps, gate):
    now = FIRST
    for (v, omega, gyro), (kind, a, b, sigma) in steps:
        now = estimation.predict(now, v, omega, gyro, DT, NOISE, gate)
        if kind == "p":
            now = estimation.use_position(now, a, b, sigma, **ARM, gate=gate)
        elif kind == "h":
            now = estimation.use_heading(now, a, sigma, gate)
        else:
            now = estimation.use_course(now, a, sigma, v, omega, **ARM, gate=gate)
        assert (now.covariance == now.covariance.T).all()
        scaled = now.covariance / np.outer(now.sigma, now.sigma)
        assert np.linalg.eigvalsh(scaled)[0] > 0.0
        assert -math.pi < now.state[2] <= math.pi


# Bad input ---------------------------------------------------------------------------------------

STEP_OF = {"v": 1.0, "omega": 0.1, "gyro": 0.1, "dt": 0.1, "noise": NOISE, "gate": 9.0}
FIX = {"x": 1.0, "y": 1.0, "sigma": 0.1, **ARM, "gate": 9.0}
COURSE = {"course": 1.0, "sigma": 0.1, "v": 1.0, "omega": 0.0, **ARM, "slowest": 0.3, "gate": 9.0}
CASES = {
    estimation.start: {"pose": wmr.Pose(0.0, 0.0, 0.0), "position_sigma": 1.0, "heading_sigma": 1.0}
    | {"bias_sigma": 1.0, "scale_sigma": 1.0},
    estimation.predict: {"estimate": FIRST} | STEP_OF,
    estimation.use_position: {"estimate": FIRST} | FIX,
    estimation.use_heading: {"estimate": FIRST, "heading": 1.0, "sigma": 0.1, "gate": 9.0},
    estimation.use_course: {"estimate": FIRST} | COURSE,
    estimation.doubt: {"estimate": FIRST, "factor": 2.0},
    Noise: NOISE._asdict(),
}


@pytest.mark.parametrize("function", CASES, ids=lambda function: function.__name__)
def test_odd_arguments_are_refused_by_name(function):
    for name in CASES[function]:
        positive = name in ("dt", "track_width") or name.endswith("sigma")
        for odd in ("north", -math.inf, *([0.0] if positive else [])):
            with pytest.raises(ValueError, match=f"^{name} = "):
                function(**(CASES[function] | {name: odd}))


@pytest.mark.parametrize(("gate", "numbers"), [(estimation.GATE_1, 1), (estimation.GATE_2, 2)])
def test_a_gate_lets_999_of_1000_sound_measurements_pass(gate, numbers):
    assert chi2.cdf(gate, numbers) == pytest.approx(0.999, abs=1e-5)


def test_doubt_has_an_end():
    """However often a measurement without a number is refused, the next good one is used."""
    estimate = FIRST
    for _ in range(600):
        estimate = estimation.doubt(estimate, 4.0)
    assert 100.0 < estimate.sigma[0] < 300.0
    assert estimation.use_position(estimate, 3.0, 4.0, 0.02).pose[:2] == pytest.approx((3.0, 4.0))
