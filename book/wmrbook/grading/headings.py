"""Checks of where a robot looks: a heading from two fixes, and one heading from two."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._asking import ask_number, ask_numbers
from wmrbook.grading._hints import angle_equal, close, drawn, expect, explain, own_work, slip

_SIGMAS = (0.01, 0.5)


def distance_known(distance_for: Callable) -> str:
    """distance_for(sigma, deviation_deg): metres between two fixes, by (14.1)."""
    own_work(distance_for)
    for sigma, most in drawn(140, 20, (0.01, 3.0), (0.5, 20.0)):
        value, angle = ask_number(distance_for, sigma, most), math.radians(most)
        right = math.sqrt(2.0) * sigma / angle
        if close(value, right):
            continue
        mistakes = {
            "a deviation in degrees does not fit (14.1): it is an angle in radians.": right
            * (angle / most),
            "both fixes err, not one of them.": sigma / angle,
            "two independent errors add by their squares, not in full.": 2.0 * sigma / angle,
            "this is upside down: a smaller deviation takes a longer way.": angle
            / (math.sqrt(2.0) * sigma),
        }
        case = f"for {sigma:.3g} m and {most:.3g} deg yours says {value:.4g} m"
        explain(value, mistakes, f"{case}: solve (14.1) for the distance.", right=right)
    return "Twenty receivers, each with the distance after which its heading is good enough."


def distance_driven(distance_for: Callable) -> str:
    """4000 drives over that distance have headings with that deviation."""
    own_work(distance_for)
    fresh = np.random.default_rng(141).normal(size=(2, 4000)) * math.sqrt(2.0)
    for sigma, most in drawn(141, 6, (0.01, 3.0), (0.5, 5.0)):
        metres = ask_number(distance_for, sigma, most)
        expect(metres > 0.0, f"{metres:.4g} m is no distance.")
        off = np.arctan2(sigma * fresh[1], metres + sigma * fresh[0])
        spread_deg = math.degrees(math.sqrt(np.mean(np.square(off))))
        hint = (
            f"over {metres:.3g} m, fixes of {sigma:.3g} m give the heading to {spread_deg:.3g} deg"
        )
        expect(abs(spread_deg - most) < 0.1 * most, f"{hint}; {most:.3g} deg are asked for.")
    return "4000 drives over each of your distances: the headings err by what was asked for."


def joined_known(joined: Callable) -> str:
    """joined(first, first_sigma, second, second_sigma): the best heading of both, and its sigma."""
    own_work(joined)
    rows = drawn(142, 20, (-1.4, 1.4), _SIGMAS, (-1.0, 1.0), _SIGMAS)
    for first, one, gap, other in rows:
        second = first + gap
        heading, sigma = ask_numbers(joined, 2, first, one, second, other)
        right, joint = _joined(first, one, gap, other)
        heading -= math.tau * round((heading - right) / math.tau)
        if close(heading, right) and close(sigma, joint):
            continue
        share = one / (one + other)
        mistakes = {
            "the worse of the two headings counts more in yours.": (second - right + first, joint),
            "weights go by the squares of the deviations.": (first + share * gap, joint),
            "both count the same in yours, however bad one is.": (first + 0.5 * gap, joint),
            "what is known of two is known better: the joint deviation is less than either.": (
                right,
                math.hypot(one, other),
            ),
            "this is the joint variance; a deviation is asked for.": (right, joint**2),
            "the mean of two deviations is no deviation of a mean.": (right, 0.5 * (one + other)),
        }
        case = f"{first:.2f} within {one:.2f} and {second:.2f} within {other:.2f} rad"
        hint = f"{case} come out as {heading:.4g} within {sigma:.4g}: which mean errs least?"
        slip((heading, sigma), (right, joint), "(heading, sigma)")
        explain((heading, sigma), mistakes, hint, np.allclose)
    return "Twenty pairs of headings, each joined with the weights that make the error least."


def joined_across(joined: Callable) -> str:
    """It works across due west, whichever comes first."""
    own_work(joined)
    for first, one, gap, other in drawn(143, 20, (3.0, 3.1), _SIGMAS, (0.2, 0.8), _SIGMAS):
        second = first + gap - math.tau
        pair = (first, one), (second, other)
        right, plain = (_joined(first, one, it, other)[0] for it in (gap, second - first))
        degrees = f"{math.degrees(first):.0f} and {math.degrees(second):.0f} deg"
        near = round(math.degrees(gap))
        apart = f"{degrees} are {near} deg apart, not {360 - near}."
        for before, after in (pair, pair[::-1]):
            heading = ask_numbers(joined, 2, *before, *after)[0]
            if not angle_equal(heading, right):
                hint = f"{degrees} come out as {math.degrees(heading):.4g} deg."
                explain(heading, {apart: plain}, hint, angle_equal)
    return "Across due west too, whichever comes first."


def _joined(first: float, one: float, gap: float, other: float) -> tuple[float, float]:
    total = one**2 + other**2
    return first + gap * one**2 / total, one * other / math.sqrt(total)
