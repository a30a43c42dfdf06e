"""The checks of wheels, steps and limits: other right answers pass, and what is no answer gets a clear hint."""

import cmath
import math

import numpy as np
import pytest

import wmrlib as wmr
from wmrbook.grading import Hint, motion


def wheels(v, omega, track_width, wheel_radius):
    """By solving (1) and (2)."""
    return np.linalg.solve(
        [
            [wheel_radius / 2, wheel_radius / 2],
            [-wheel_radius / track_width, wheel_radius / track_width],
        ],
        [v, omega],
    )


def twist(left, right, track_width, wheel_radius):
    return np.array([[0.5, 0.5], [-1 / track_width, 1 / track_width]]) @ [
        left * wheel_radius,
        right * wheel_radius,
    ]


def arc(x, y, heading, v, omega, dt):
    """The integral of exp(i heading) over the time, by Gauss and Legendre."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    times = dt * (nodes + 1) / 2
    place = complex(x, y) + v * dt / 2 * (weights @ np.exp(1j * (heading + omega * times)))
    return place.real, place.imag, cmath.phase(cmath.exp(1j * (heading + omega * dt)))


def limited(left, right, max_speed):
    both = np.array([left, right])
    return both * max_speed / max(max_speed, np.abs(both).max())


def test_other_forms_pass():
    assert motion.wheels_known(wheels)
    assert motion.twist_known(twist)
    for check in (motion.arc_known, motion.arc_straight, motion.arc_properties):
        assert check(arc)
    for check in (motion.limited_speed, motion.limited_curvature):
        assert check(limited)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda v, w, b, r: wheels(v, w, b, r) * r * r, "a small wheel must turn faster"),
        (lambda v, w, b, r: (v / r, v / r), "not turn at omega"),
        (lambda v, w, b, r: (0.0, 0.0), "would not drive at v"),
        (lambda v, w, b, r: v / r, "2 numbers"),
        (lambda v, w, b, r: wmr.twist_to_wheels(v / r, w / r, b), "of wmrlib"),
    ],
)
def test_wheels_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        motion.wheels_known(answer)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda a, b, w, r: twist(a, b, w, 1.0), "over the ground they are radius times that"),
        (lambda a, b, w, r: twist(a, b, w, r) * [1, 2], "twice as fast"),
        (lambda a, b, w, r: twist(a, b, w, r) * [2, 1], "v is not the mean"),
        (lambda a, b, w, r: (twist(a, b, w, r)[0], 0.1), "omega is not"),
    ],
)
def test_twist_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        motion.twist_known(answer)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda x, y, h, v, w, t: (*arc(x, y, h, v, w, t)[:2], h), "the heading is wrong"),
        (
            lambda x, y, h, v, w, t: (
                x + v * t * math.cos(h + w * t),
                y + v * t * math.sin(h + w * t),
                h + w * t,
            ),
            "along the .new. heading",
        ),
        (
            lambda x, y, h, v, w, t: (*arc(x, y, h, v, -w, t)[:2], h + w * t),
            "bends to the other side",
        ),
        (lambda x, y, h, v, w, t: (x, y, h + w * t), "not on the arc"),
        (
            lambda x, y, h, v, w, t: (
                *arc(x, y, h, v, w if abs(w) > 0.01 else 0.0, t)[:2],
                h + w * t,
            ),
            "Euler's step",
        ),
        (lambda x, y, h, v, w, t: wmr.advance(wmr.Pose(x, y, h), v, w, t), "of wmrlib"),
    ],
)
def test_arc_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        motion.arc_known(answer)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda x, y, h, v, w, t: (x, y, h), "does not move"),
        (lambda x, y, h, v, w, t: (*arc(x, y, h, abs(v), w, t)[:2], h + w * t), "reversed"),
        (lambda x, y, h, v, w, t: arc(x, y, h, v, abs(w), t), "reversed|mirror"),
    ],
)
def test_arc_property_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        motion.arc_properties(answer)


@pytest.mark.parametrize(
    ("straight", "hint"),
    [
        (
            lambda x, y, h, v, w, t: (x + v * math.cos(h), y + v * math.sin(h), h),
            "with omega = 0 the place is 1 m off: how far",
        ),
        (lambda x, y, h, v, w, t: (x + v * t, y, h), "and which way"),
        (
            lambda x, y, h, v, w, t: (x + v * t * math.cos(h), y + v * t * math.sin(h), 0.0),
            "becomes 0 rad; it was 0.5 rad",
        ),
    ],
)
def test_straight_hints(straight, hint):
    with pytest.raises(Hint, match=hint):
        motion.arc_straight(
            lambda x, y, h, v, w, t: arc(x, y, h, v, w, t) if w else straight(x, y, h, v, w, t)
        )


def test_lost_digits():
    def by_radius(x, y, h, v, w, t):
        return (
            x + v / w * (math.sin(h + w * t) - math.sin(h)),
            y - v / w * (math.cos(h + w * t) - math.cos(h)),
            h + w * t,
        )

    with pytest.raises(Hint, match="loses its digits"):
        motion.arc_straight(lambda *each: by_radius(*each) if each[4] else arc(*each))


@pytest.mark.parametrize(
    ("check", "answer", "hint"),
    [
        (motion.limited_speed, lambda a, b, m: (a, b), "a wheel turns at 2.00 times its limit"),
        (
            motion.limited_speed,
            lambda a, b, m: (a, b) if max(abs(a), abs(b)) <= m else limited(a, b, 0.9 * m),
            "could go faster",
        ),
        (motion.limited_speed, lambda a, b, m: (0.0, 0.0), "left alone"),
        (
            motion.limited_speed,
            lambda a, b, m: (m * a / max(abs(a), abs(b)), m * b / max(abs(a), abs(b))),
            "sped up",
        ),
        (motion.limited_curvature, lambda a, b, m: -limited(a, b, m), "the other way"),
        (
            motion.limited_curvature,
            lambda a, b, m: limited(a, b, m)[::-1],
            "turning centre moves|other way",
        ),
        (motion.limited_curvature, lambda a, b, m: (0.0, 0.0), "other way"),
    ],
)
def test_limit_hints(check, answer, hint):
    with pytest.raises(Hint, match=hint):
        check(answer)
