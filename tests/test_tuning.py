"""Modes against their equation, steps against wmrlib's own, gains against the modes asked for."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr

PAPER = wmr.paper.OUTDOOR_GAINS
GENTLE = wmr.GENTLE_GAINS
GAINS = [PAPER, wmr.paper.CIRCLE_GAINS, GENTLE]
GAINS += [wmr.Gains(0.2, 3.0, 0.5), wmr.Gains(0.5, 2.0, 0.9, 2.0)]
STIFF = wmr.Gains(0.2, 9.0, 0.5)  # turns fast: an eigenvalue reaches -1 first
CROWDED = wmr.Gains(0.2, 0.9, 0.3)  # in polar coordinates the robot drives past the goal first
LAWS = ["corrected", "aicardi"]
SAMPLED = ["polar_euler", "euler", "arc"]
rates, decades = st.floats(0.01, 20.0), st.floats(-2.0, 1.3).map(lambda x: 10.0**x)


def refuses(cases, function):
    for arguments, message in cases:
        with pytest.raises(ValueError, match=message):
            function(arguments)


# Modes


@given(st.builds(wmr.Gains, *[decades] * 4), st.sampled_from(LAWS))
def test_modes_solve_the_characteristic_equation(gains, law):
    """The law's own, of which test_symbolic.py finds the coefficients."""
    modes, rate = wmr.modes(gains, law), gains.k_rho * (1.0 if law == "aicardi" else gains.v_max)
    distance, one, other = modes.poles
    assert -distance == modes.distance_rate == pytest.approx(rate)
    assert one + other == pytest.approx(-gains.k_alpha)
    assert one * other == pytest.approx(gains.h * rate**2) == modes.natural_frequency**2
    assert modes.heading_rate == pytest.approx(min(-one.real, -other.real))
    assert 2.0 * modes.damping * modes.natural_frequency == pytest.approx(gains.k_alpha)
    assert modes.slower == pytest.approx(rate / modes.heading_rate)
    assert modes.kappa * rate == pytest.approx(gains.k_alpha)


# Gains from a specification


@settings(deadline=None)
@given(rates, rates, st.one_of(st.floats(0.05, 0.99), st.floats(1.01, 5.0)), rates)
def test_gains_for_a_specification_have_it(distance_rate, rate, damping, v_max):
    gains = wmr.gains_for(distance_rate, natural_frequency=rate, damping=damping, v_max=v_max)
    modes = wmr.modes(gains)
    reached = modes.distance_rate, modes.natural_frequency, modes.damping
    assert reached == pytest.approx((distance_rate, rate, damping), rel=1e-9)
    assert gains.v_max == v_max
    modes = wmr.modes(wmr.gains_for(distance_rate, heading_rate=rate, damping=damping))
    reached = modes.distance_rate, modes.heading_rate, modes.damping
    assert reached == pytest.approx((distance_rate, rate, damping), rel=1e-9)
    assert modes.slower == pytest.approx(distance_rate / rate, rel=1e-9)
    critical = wmr.gains_for(distance_rate, heading_rate=rate)
    assert critical == wmr.gains_for(distance_rate, heading_rate=rate, damping=1.0)


@given(st.floats(0.05, 30.0), st.floats(0.05, 30.0), rates, rates)
def test_gains_for_a_point_are_given_exactly_where_the_heading_settles_first(kappa, h, rate, v_max):
    gains = wmr.Gains(rate / v_max, kappa * rate, h, v_max)
    slower = wmr.modes(gains).slower
    if abs(slower - 1.0) < 1e-9:
        return  # on the border rounding decides
    if slower < 1.0:
        assert wmr.gains_for(rate, kappa=kappa, h=h, v_max=v_max) == gains
    else:
        with pytest.raises(ValueError, match=f"kappa = {kappa!r} is not allowed: .* with h = "):
            wmr.gains_for(rate, kappa=kappa, h=h)


def in_units_of_the_gains(gains, start):
    """The drive in lengths of 1/k_rho and times of 1/(v_max k_rho), 20 of them."""
    rate = gains.k_rho * gains.v_max
    pose = wmr.Pose(start.x / gains.k_rho, start.y / gains.k_rho, start.heading)
    options = {"method": "continuous", "arrival_radius": 0.0, "dt": 0.25 / rate}
    run = wmr.simulate(pose, wmr.Pose(0.0, 0.0, 0.0), gains, duration=20.0 / rate, **options)
    return np.array([run.x * gains.k_rho, run.y * gains.k_rho, run.heading])


@settings(deadline=None, max_examples=20)
@given(st.floats(0.2, 8.0), st.floats(0.1, 8.0), st.floats(0.05, 5.0), st.floats(0.2, 8.0))
def test_kappa_and_h_alone_shape_the_path(kappa, h, k_rho, v_max):
    start = wmr.Pose(-3.0, 1.0, 2.0)
    ours, theirs = (
        in_units_of_the_gains(wmr.Gains(a, kappa * a * b, h, b), start)
        for a, b in ((k_rho, v_max), (1.0, 1.0))
    )
    assert np.abs(ours[:2] - theirs[:2]).max() < 1e-6
    assert np.abs(wmr.wrap_angle(ours[2] - theirs[2])).max() < 1e-5
    other = in_units_of_the_gains(wmr.Gains(k_rho, 1.1 * kappa * k_rho * v_max, h, v_max), start)
    assert np.abs(ours[:2] - other[:2]).max() > 1e-4


# Gain maps


def test_a_gain_map_has_an_axis_for_each_gain_in_order():
    start, goal, *_ = wmr.paper.outdoor()
    k_alpha, h = [0.5, 2.0, 4.0], [0.3, 2.0]
    over = {"k_alpha": k_alpha, "h": h}
    mapped = wmr.gain_map(start, goal, wmr.Gains(k_rho=0.2, k_alpha=9.0, h=9.0), over)
    assert mapped.time.shape == (3, 2)
    for i, j in np.ndindex(3, 2):
        alone = wmr.sweep(start, goal, wmr.Gains(0.2, k_alpha[i], h[j]))
        assert tuple(field[i, j] for field in mapped) == pytest.approx(tuple(alone))
    best = np.unravel_index(np.abs(mapped.heading_error).argmin(), (3, 2))
    assert best == (1, 1)  # k_alpha 2, h 2: the gentle gains
    options = {"method": "arc", "duration": 2.0}  # go to sweep
    assert not wmr.gain_map(start, goal, PAPER, {"k_rho": [1.0, 2.0]}, **options).arrived.any()


# The longest time step


def one_step(gains, method, dt, law="corrected"):
    """The matrix of one step for (alpha, theta), by differences of wmrlib's own step."""
    rho, size, goal = 1e-7, 1e-4, wmr.Pose(0.0, 0.0, 0.3)

    def after(alpha, theta):
        v, omega = wmr.control_law(rho, alpha, theta, gains, law=law)
        if method == "polar_euler":
            return [alpha, theta] + dt * np.array(wmr.polar_rate(rho, alpha, v, omega)[1:])
        pose = wmr.pose_from_polar(wmr.PolarError(rho, alpha, theta), goal)
        return np.array(wmr.polar_error(wmr.advance(pose, v, omega, dt, method), goal)[1:])

    along_alpha = after(size, 0.0) - after(-size, 0.0)
    along_theta = after(0.0, size) - after(0.0, -size)
    return np.column_stack([along_alpha, along_theta]) / (2.0 * size)


def test_eigenvalues_of_a_step_leave_the_unit_circle_at_the_longest_step():
    for gains in [*GAINS, STIFF]:
        for method in SAMPLED:
            for law in LAWS:
                longest = wmr.longest_step(gains, method, law)
                below, above = (
                    np.abs(np.linalg.eigvals(one_step(gains, method, share * longest, law))).max()
                    for share in (0.999, 1.001)
                )
                assert below < 1.0
                if longest < 0.999 / wmr.modes(gains, law).distance_rate:
                    assert above > 1.0
    for gains in (CROWDED, GENTLE):  # a longer step drives past the goal
        longest = wmr.longest_step(gains, "polar_euler")
        speed = wmr.control_law(1e-6, 0.0, 0.0, gains)[0]
        assert speed * longest == pytest.approx(1e-6, rel=1e-5)


def test_longest_steps_without_a_gain_and_in_continuous_time():
    assert wmr.longest_step(wmr.Gains(2.0, 0.0, 0.3), "euler") == 0.0
    assert wmr.longest_step(PAPER, "continuous") == math.inf
    only_turns = wmr.Gains(0.0, 4.0, 0.3)  # 2/k_alpha
    assert [wmr.longest_step(only_turns, method) for method in SAMPLED] == [0.5] * 3


def test_bad_input():
    pair, point = {"natural_frequency": 1.0, "heading_rate": 1.0}, {"kappa": 2.5, "h": 2.0}
    positive = "is not allowed: a finite number above 0 is needed"
    specifications = [
        ({}, "natural_frequency = None, heading_rate = None, kappa = None, h = None, damping = "),
        (pair, "heading_rate = 1.0, .* not allowed together: one of the three is needed"),
        (point | {"damping": 1.0}, "not allowed together: .* kappa with h and the others"),
        ({"kappa": 2.5}, "h = None, .* not allowed together"),
        (point | {"kappa": 2.0}, "kappa = 2.0 is not allowed: a number between 2 and 1 \\+ h is"),
        (point | {"h": -1.0}, "h = -1.0 " + positive),
        ({"heading_rate": 0.0}, "heading_rate = 0.0 " + positive),
        ({"natural_frequency": 1.0, "damping": 0.0}, "damping = 0.0 is not allowed"),
        ({"natural_frequency": 1.0, "v_max": 0.0}, "v_max = 0.0 is not allowed"),
        ({"natural_frequency": np.ones(2), "damping": np.ones(3)}, "mismatched lengths"),
    ]
    refuses(specifications, lambda arguments: wmr.gains_for(1.0, **arguments))
    start, goal = wmr.Pose(0, 0, 0), wmr.Pose(1, 1, 0)
    names = "one of 'k_rho', 'k_alpha', 'h', 'v_max' is needed"
    maps = [
        ({}, r"over = \{\} is not allowed: at least one gain"),
        ({"k_beta": [1.0]}, f"over = 'k_beta' is not allowed: {names}"),
        ({"h": 1.0}, r"h has shape \(\), which is not allowed: a list of numbers is needed"),
        ({"h": [0.1, -0.1]}, "h = .* is not allowed: a finite number at least 0 is needed"),
        ([("h", [1.0])], "over = .* a Mapping is needed, not a list"),
    ]
    refuses(maps, lambda over: wmr.gain_map(start, goal, PAPER, over))
    method = "method = 'heun' .*: one of 'continuous', 'polar_euler', 'euler', 'arc' is needed"
    law = "law = 'printed' is not allowed: one of 'corrected', 'aicardi' is needed"
    steps = [((PAPER, "heun"), method), ((PAPER, "arc", "printed"), law)]
    refuses(
        [*steps, (((1.0,) * 4,), "a Gains is needed")], lambda inputs: wmr.longest_step(*inputs)
    )
    refuses([((PAPER, "printed"), law)], lambda inputs: wmr.modes(*inputs))
