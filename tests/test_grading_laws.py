"""The checks of the control law: another right form passes, and what is no law gets a clear hint."""

import math

import numpy as np
import pytest

import wmrlib as wmr
from wmrbook.grading import Hint, laws


def law(rho, alpha, theta, k_rho, k_alpha, h, v_max):
    """With a mean slope where the textbook divides: (1 - exp(-x))/x = exp(-x/2) sinh(x/2)/(x/2); arrays of numpy come back."""
    half = k_rho * rho / 2
    decay = k_rho * math.exp(-half) * (math.sinh(half) / half if half > 1e-9 else 1.0)
    return np.array([1.0, 0.0]) * v_max * decay * rho * math.cos(alpha) + [
        0.0,
        k_alpha * alpha
        + v_max * decay * math.cos(alpha) * np.sinc(alpha / math.pi) * (alpha + h * theta),
    ]


def changed(v=lambda v, *_: v, omega=lambda w, *_: w):
    def answer(*numbers):
        first, second = law(*numbers)
        return v(first, *numbers), omega(second, *numbers)

    return answer


def test_other_form_passes():
    for check in (laws.law_known, laws.law_goal, laws.law_properties):
        assert check(law)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (changed(v=lambda v, r, a, *_: v / math.cos(a)), "v lacks its cosine"),
        (
            changed(v=lambda v, r, a, t, kr, ka, h, vm: vm * math.cos(a)),
            "does not fall near the goal",
        ),
        (
            changed(v=lambda v, r, a, *_: v / math.cos(a) * math.cos(math.radians(a))),
            "radians for degrees",
        ),
        (changed(v=lambda v, *_: 1.01 * v), "not that of"),
        (changed(omega=lambda w, r, a, t, kr, ka, h, vm: w - ka * a), "k_alpha alpha is missing"),
        (lambda r, a, t, *gains: law(r, a, 0.0, *gains), "theta plays no role"),
        (
            changed(omega=lambda w, r, a, t, kr, ka, h, vm: ka * a + r * (w - ka * a)),
            "not divided by rho",
        ),
        (
            changed(omega=lambda w, r, a, t, kr, ka, h, vm: ka * a + a * (w - ka * a)),
            "not divided by alpha",
        ),
        (
            changed(omega=lambda w, r, a, t, kr, ka, h, vm: ka * a + math.cos(a) * (w - ka * a)),
            "a cosine too many",
        ),
        (
            changed(omega=lambda w, r, a, t, kr, ka, h, vm: ka * a + (w - ka * a) / math.cos(a)),
            "lacks a cosine",
        ),
        (changed(omega=lambda w, *_: 1.01 * w), "factor by factor"),
        (lambda *_: (0.0, 0.0), "not that of"),
        (lambda r, a, t, *gains: wmr.control_law(r, a, t, wmr.Gains(*gains)), "of wmrlib"),
    ],
)
def test_law_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        laws.law_known(answer)


def test_a_small_distance_in_the_place_of_none_passes():
    assert laws.law_goal(lambda r, *rest: law(max(r, 1e-6), *rest))


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (changed(omega=lambda w, r, a, *_: w if r > 1e-6 else 0.0), "omega jumps"),
        (
            changed(v=lambda v, r, *_: v if r else 4.0),
            "v is 4 at rho = 0, alpha = 0.5: put that distance",
        ),
        (
            lambda r, *rest: law(max(r, 1e-3), *rest),
            "v is 0.007.* at rho = 0, alpha = 0.5: put that distance",
        ),
        (lambda r, a, *rest: law(r, a, *rest) / (r > 0), "not a finite number"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*encountered in divide")
def test_goal_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        laws.law_goal(answer)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (changed(omega=lambda w, r, a, *_: w + a * a), "in the mirror"),
        (changed(v=lambda v, *_: 5 * v), "v_max is"),
        (changed(omega=lambda w, *_: -w), "V rises"),
        (changed(omega=lambda w, r, a, *_: w + a), "but not by what"),
        (lambda *_: (0.0, 0.0), "but not by what"),
    ],
)
def test_property_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        laws.law_properties(answer)
