"""The modes against python-control's poles and against simulated runs; the gains against the modes they were asked for."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr

GAINS = [
    wmr.paper.OUTDOOR_GAINS,
    wmr.paper.CIRCLE_GAINS,
    wmr.Gains(0.2, 2.0, 2.0),
    wmr.Gains(0.2, 3.0, 0.5),
    wmr.Gains(0.5, 2.0, 0.9, 2.0),
]
rates = st.floats(0.01, 20.0)


def test_the_papers_gains_settle_the_heading_16_times_slower():
    modes = wmr.modes(wmr.paper.OUTDOOR_GAINS)
    assert modes.distance_rate == 8.0
    assert modes.natural_frequency == pytest.approx(4.382, abs=5e-4)
    assert modes.damping == pytest.approx(0.114, abs=5e-4)
    assert modes.slower == pytest.approx(16.0)
    assert modes.heading_rate == pytest.approx(0.5)


def linearised(gains, law):
    """The closed loop's matrix for the angles near the goal, and the distance's pole, by differences of wmrlib's own functions."""
    rho, size = 1e-9, 1e-5

    def rate(alpha, theta, distance=rho):
        return np.array(
            wmr.polar_rate(
                distance, alpha, *wmr.control_law(distance, alpha, theta, gains, law=law)
            )
        )

    along_alpha = (rate(size, 0.0) - rate(-size, 0.0)) / (2.0 * size)
    along_theta = (rate(0.0, size) - rate(0.0, -size)) / (2.0 * size)
    along_rho = rate(0.0, 0.0) / rho
    return np.column_stack([along_rho, along_alpha, along_theta])


@pytest.mark.parametrize("law", ["corrected", "aicardi"])
@pytest.mark.parametrize("gains", GAINS)
def test_poles_equal_those_python_control_finds(gains, law):
    control = pytest.importorskip("control")
    system = control.ss(linearised(gains, law), np.zeros((3, 1)), np.eye(3), np.zeros((3, 1)))
    frequencies, dampings, poles = control.damp(system, doprint=False)
    modes = wmr.modes(gains, law)
    np.testing.assert_allclose(
        np.sort_complex(modes.poles), np.sort_complex(poles), rtol=1e-6, atol=1e-6
    )
    oscillating = np.abs(np.imag(poles)) > 1e-3
    if oscillating.any():
        np.testing.assert_allclose(frequencies[oscillating], modes.natural_frequency, rtol=1e-6)
        np.testing.assert_allclose(dampings[oscillating], modes.damping, rtol=1e-6)
    slowest = min(-modes.poles[1].real, -modes.poles[2].real)
    assert modes.heading_rate == pytest.approx(slowest)
    assert modes.slower == pytest.approx(modes.distance_rate / slowest)


@pytest.mark.parametrize("gains", GAINS)
def test_simulated_runs_decay_as_the_modes_say(gains):
    """Near the goal theta[k+2] = (z1 + z2) theta[k+1] - z1 z2 theta[k] with z = exp(pole dt), whatever the model behind it."""
    dt = 0.05
    start = wmr.Pose(-1e-4, 0.0, 1e-4)
    run = wmr.simulate(
        start,
        wmr.Pose(0.0, 0.0, -2e-4),
        gains,
        method="continuous",
        dt=dt,
        duration=40 * dt,
        arrival_radius=0.0,
    )
    modes = wmr.modes(gains)
    far = run.rho > 1e-9
    slope = np.polyfit(run.t[far], np.log(run.rho[far]), 1)[0]
    assert slope == pytest.approx(-modes.distance_rate, rel=1e-3)
    ((total, product), *_) = np.linalg.lstsq(
        np.column_stack([run.theta[1:-1], -run.theta[:-2]]), run.theta[2:]
    )
    poles = np.log(np.roots([1.0, -total, product]).astype(complex)) / dt
    np.testing.assert_allclose(
        np.sort_complex(poles), np.sort_complex(modes.poles[1:]), rtol=1e-2, atol=1e-2
    )


def test_the_printed_law_has_no_such_modes():
    with pytest.raises(
        ValueError, match="law = 'printed' is not allowed: one of 'corrected', 'aicardi' is needed"
    ):
        wmr.modes(wmr.paper.OUTDOOR_GAINS, "printed")


def test_a_gain_of_zero_leaves_a_mode_that_does_not_settle():
    no_heading = wmr.modes(wmr.Gains(0.2, 2.0, 0.0))
    assert (no_heading.heading_rate, no_heading.damping, no_heading.slower) == (
        0.0,
        math.inf,
        math.inf,
    )
    no_distance = wmr.modes(wmr.Gains(0.0, 2.0, 1.0))
    assert no_distance.distance_rate == 0.0
    assert math.isnan(no_distance.slower)
    assert wmr.modes(wmr.Gains(0.2, 0.0, 1.0)).slower == math.inf


def test_arrays_of_gains_give_arrays_of_modes():
    k_alpha = np.array([0.5, 2.0, 8.0])
    modes = wmr.modes(wmr.Gains(0.2, k_alpha, 2.0))
    for k, value in enumerate(k_alpha):
        one = wmr.modes(wmr.Gains(0.2, value, 2.0))
        assert type(one.damping) is float
        assert modes.damping[k] == one.damping
        assert modes.slower[k] == one.slower
        assert [pole[k] if np.ndim(pole) else pole for pole in modes.poles] == list(one.poles)


@settings(deadline=None)
@given(distance_rate=rates, natural_frequency=rates, damping=st.floats(0.05, 5.0), v_max=rates)
def test_gains_for_a_natural_frequency_have_it(distance_rate, natural_frequency, damping, v_max):
    gains = wmr.gains_for(
        distance_rate, natural_frequency=natural_frequency, damping=damping, v_max=v_max
    )
    modes = wmr.modes(gains)
    expected = distance_rate, natural_frequency, damping
    assert (modes.distance_rate, modes.natural_frequency, modes.damping) == pytest.approx(
        expected, rel=1e-9
    )
    assert gains.v_max == v_max


@settings(deadline=None)
@given(
    distance_rate=rates,
    heading_rate=rates,
    damping=st.one_of(st.floats(0.05, 0.99), st.floats(1.01, 5.0)),
)
def test_gains_for_a_heading_rate_have_it(distance_rate, heading_rate, damping):
    modes = wmr.modes(wmr.gains_for(distance_rate, heading_rate=heading_rate, damping=damping))
    assert (modes.heading_rate, modes.damping) == pytest.approx((heading_rate, damping), rel=1e-9)
    assert modes.slower == pytest.approx(distance_rate / heading_rate, rel=1e-9)


def test_designed_gains_arrive_better_than_the_papers():
    case = wmr.paper.outdoor()
    designed = wmr.gains_for(0.8, heading_rate=1.0, damping=0.9)
    found, ours = (
        wmr.arrival(wmr.simulate(case.start, case.goal, gains)) for gains in (case.gains, designed)
    )
    assert ours.arrived
    assert abs(ours.heading_error) < abs(found.heading_error) / 5.0
    assert ours.peak_omega < found.peak_omega / 3.0


def test_arrays_of_specifications_give_arrays_of_gains():
    gains = wmr.gains_for(0.8, natural_frequency=np.array([0.5, 1.0]), damping=1.0)
    assert gains.h.shape == gains.k_alpha.shape == (2,)
    assert gains.k_rho == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {},
            "natural_frequency = None and heading_rate = None are not allowed together: one of the two is needed",
        ),
        ({"natural_frequency": 1.0, "heading_rate": 1.0}, "not allowed together"),
        (
            {"heading_rate": 0.0},
            "heading_rate = 0.0 is not allowed: a finite number above 0 is needed",
        ),
        ({"natural_frequency": -1.0}, "natural_frequency = -1.0 is not allowed"),
        ({"natural_frequency": 1.0, "damping": 0.0}, "damping = 0.0 is not allowed"),
        ({"natural_frequency": 1.0, "v_max": 0.0}, "v_max = 0.0 is not allowed"),
        ({"natural_frequency": math.nan}, "natural_frequency = nan is not allowed"),
        ({"natural_frequency": 1e-200}, "is not allowed: a finite number above 0 is needed"),
        ({"natural_frequency": 1e200}, "is not allowed: a finite number above 0 is needed"),
        ({"natural_frequency": np.ones(2), "damping": np.ones(3)}, "mismatched lengths"),
    ],
)
def test_an_impossible_specification_is_named(arguments, message):
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        wmr.gains_for(1.0, **arguments)


# Gain maps -------------------------------------------------------------------------------------------------------------


def test_a_gain_map_has_an_axis_for_each_gain_in_order():
    case = wmr.paper.outdoor()
    k_alpha, h = np.array([0.5, 2.0, 4.0]), np.array([0.3, 2.0])
    designed = wmr.Gains(k_rho=0.2, k_alpha=9.0, h=9.0)
    mapped = wmr.gain_map(case.start, case.goal, designed, {"k_alpha": k_alpha, "h": h})
    assert mapped.time.shape == (3, 2)
    for i in range(3):
        for j in range(2):
            alone = wmr.sweep(case.start, case.goal, wmr.Gains(0.2, float(k_alpha[i]), float(h[j])))
            assert tuple(field[i, j] for field in mapped) == pytest.approx(tuple(alone))
    assert (
        np.abs(mapped.heading_error).argmin() == 1 * 2 + 1
    )  # k_alpha 2, h 2: the gentle gains of chapter 0


def test_a_gain_map_hands_its_options_to_the_sweep():
    case = wmr.paper.outdoor()
    mapped = wmr.gain_map(
        case.start, case.goal, case.gains, {"k_rho": [1.0, 2.0]}, method="arc", duration=2.0
    )
    assert not mapped.arrived.any()


@pytest.mark.parametrize(
    ("over", "message"),
    [
        ({}, r"over = \{\} is not allowed: at least one gain"),
        (
            {"k_beta": [1.0]},
            r"over = 'k_beta' is not allowed: one of 'k_rho', 'k_alpha', 'h', 'v_max' is needed",
        ),
        ({"h": 1.0}, r"h has shape \(\), which is not allowed: a list of numbers is needed"),
        ({"h": [0.1, -0.1]}, r"h = .* is not allowed: a finite number at least 0 is needed"),
        ([("h", [1.0])], r"over = .* a Mapping is needed, not a list"),
    ],
)
def test_a_gain_map_refuses(over, message):
    with pytest.raises(ValueError, match=message):
        wmr.gain_map(wmr.Pose(0, 0, 0), wmr.Pose(1, 1, 0), wmr.Gains(1.0, 1.0, 1.0), over)


# The longest time step ------------------------------------------------------------------------------------------------

SAMPLED = ["polar_euler", "euler", "arc"]
STIFF = wmr.Gains(0.2, 9.0, 0.5)  # turns fast: an eigenvalue reaches -1 first
CROWDED = wmr.Gains(0.2, 0.9, 0.3)  # in polar coordinates the robot drives past the goal first


def one_step(gains, method, dt, law="corrected"):
    """The matrix of one step for (alpha, theta) near the goal, by differences of wmrlib's own step."""
    rho, size, goal = 1e-7, 1e-4, wmr.Pose(0.0, 0.0, 0.3)

    def after(alpha, theta):
        v, omega = wmr.control_law(rho, alpha, theta, gains, law=law)
        if method == "polar_euler":
            return np.array([alpha, theta]) + dt * np.array(
                wmr.polar_rate(rho, alpha, v, omega)[1:]
            )
        pose = wmr.pose_from_polar(wmr.PolarError(rho, alpha, theta), goal)
        return np.array(wmr.polar_error(wmr.advance(pose, v, omega, dt, method), goal)[1:])

    columns = [
        (after(*shift) - after(*(-each for each in shift))) / (2.0 * size)
        for shift in ((size, 0.0), (0.0, size))
    ]
    return np.column_stack(columns)


@pytest.mark.parametrize("law", ["corrected", "aicardi"])
@pytest.mark.parametrize("method", SAMPLED)
@pytest.mark.parametrize("gains", [*GAINS, STIFF])
def test_eigenvalues_of_a_step_leave_the_unit_circle_at_the_longest_step(gains, method, law):
    longest = wmr.longest_step(gains, method, law)
    assert np.abs(np.linalg.eigvals(one_step(gains, method, 0.999 * longest, law))).max() < 1.0
    if longest < 0.999 / wmr.modes(gains, law).distance_rate:
        assert np.abs(np.linalg.eigvals(one_step(gains, method, 1.001 * longest, law))).max() > 1.0


@pytest.mark.parametrize(("gains", "method"), [(CROWDED, "polar_euler"), (GAINS[2], "polar_euler")])
def test_a_longer_step_drives_past_the_goal(gains, method):
    longest = wmr.longest_step(gains, method)
    speed = wmr.control_law(1e-6, 0.0, 0.0, gains)[0]
    assert speed * longest == pytest.approx(1e-6, rel=1e-5)


def test_the_papers_time_step_is_too_long_for_its_gains():
    limits = [wmr.longest_step(wmr.paper.OUTDOOR_GAINS, method) for method in SAMPLED]
    assert limits == pytest.approx([1 / 19.2, 1 / 91.2, 2 / 91.2])
    assert max(limits) < wmr.paper.TIME_STEP
    assert wmr.longest_step(wmr.Gains(0.2, 2.0, 2.0)) == pytest.approx(2 / 2.8)
    assert wmr.longest_step(STIFF, "polar_euler") == pytest.approx(
        4.0 / (9.0 + math.sqrt(81.0 - 4.0 * 0.5 * 0.64))
    )


@pytest.mark.parametrize("method", ["euler", "arc"])
@pytest.mark.parametrize("gains", [GAINS[0], GAINS[2]])
def test_simulated_runs_settle_up_to_the_longest_step_and_no_further(gains, method):
    def late_over_first(dt):
        start, goal = (
            wmr.Pose(-1e-3, -1e-6, 2e-3),
            wmr.Pose(0.0, 0.0, 0.0),
        )  # at the origin, where a tiny rho keeps its digits
        run = wmr.simulate(
            start, goal, gains, method=method, dt=dt, duration=3000 * dt, arrival_radius=0.0
        )
        size = np.hypot(run.alpha, run.theta)[run.rho > 1e-290]
        return size[-size.size // 4 :].max() / size[0]

    longest = wmr.longest_step(gains, method)
    assert late_over_first(0.95 * longest) < 0.9
    assert late_over_first(1.05 * longest) > 2.0


def test_arrays_of_gains_give_arrays_of_longest_steps():
    k_alpha = np.array([1.0, 2.0, 9.0])
    for method in SAMPLED:
        singly = [wmr.longest_step(wmr.Gains(0.2, each, 0.5), method) for each in k_alpha.tolist()]
        np.testing.assert_allclose(
            wmr.longest_step(wmr.Gains(0.2, k_alpha, 0.5), method), singly, rtol=1e-12
        )


def test_longest_step_of_gains_of_zero():
    assert wmr.longest_step(wmr.Gains(2.0, 0.0, 0.3), "euler") == 0.0
    assert [wmr.longest_step(wmr.Gains(0.0, 4.0, 0.3), method) for method in SAMPLED] == [
        0.5,
        0.5,
        0.5,
    ]  # it only turns: 2/k_alpha


def test_longest_step_refuses():
    with pytest.raises(
        ValueError,
        match=r"method = 'rk4' is not allowed: one of 'polar_euler', 'euler', 'arc' is needed",
    ):
        wmr.longest_step(GAINS[0], "rk4")
    with pytest.raises(ValueError, match=r"law = 'printed' is not allowed"):
        wmr.longest_step(GAINS[0], "arc", "printed")
    with pytest.raises(ValueError, match="a Gains is needed"):
        wmr.longest_step((1.0, 1.0, 1.0, 1.0))


def test_pareto_against_a_double_loop():
    costs = np.random.default_rng(7).integers(0, 6, (3, 5, 8)).astype(float)
    costs[0, 0, 0], costs[1, 0, 1] = np.inf, np.nan
    points = costs.reshape(3, -1).T
    slow = [
        bool(np.isfinite(p).all())
        and not any(np.isfinite(q).all() and (q <= p).all() and (q != p).any() for q in points)
        for p in points
    ]
    chosen = wmr.pareto(*costs)
    assert chosen.shape == (5, 8)
    assert 0 < chosen.sum() < chosen.size
    np.testing.assert_array_equal(chosen.ravel(), slow)


@pytest.mark.parametrize("costs", [(), (np.zeros(2), np.zeros(3))])
def test_pareto_refuses_what_cannot_be_compared(costs):
    with pytest.raises(ValueError, match="all of one shape, is needed"):
        wmr.pareto(*costs)
