"""What a prediction is compared with follows from wmrlib: with a flipped sign it is another."""

from __future__ import annotations

import sys

import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from wmrbook import live


def _turned(goal):
    return goal._replace(heading=-goal.heading)


def _to_the_right(f, *methods):
    """Turn right where `advance` turns left, with all methods or with some."""
    return lambda pose, v, omega, dt, method="arc": f(
        pose, v, -omega if method in methods or not methods else omega, dt, method=method
    )


def _uphill(f):
    return lambda a, b, gains, **options: f(a, b, gains, **(options | {"law": "printed"}))


FLIPS = {  # the thing, and what its module takes from wmrlib
    "stopping simulate": _uphill,
    "bearing local_position": lambda f: lambda *to: (f(*to)[0], -f(*to)[1]),
    "flat_map local_position": lambda f: lambda *to: (f(*to)[0], -f(*to)[1]),
    "one_step advance": lambda f: _to_the_right(f, "euler"),
    "polar_angles polar_error": lambda f: lambda *a: f(*a)._replace(alpha=-f(*a).alpha),
    "half_turn simulate": lambda f: lambda a, b, k, **o: f(_turned(a), b, k, **o),
    "bowl simulate": _uphill,
    "two_bars control_law": lambda f: lambda *a: (-f(*a)[0], f(*a)[1]),
    "window modes": lambda f: lambda it: f(it._replace(k_alpha=4 * it.k_alpha, h=16 * it.h)),
    "silence rolled": lambda f: lambda v, timeout, brake: f(v, timeout, -brake),
    "corners headings_along": lambda f: lambda x, y: -f(x, y),
}


@pytest.mark.parametrize("flipped", FLIPS)
def test_a_flipped_sign_changes_what_is_right_or_is_refused(monkeypatch, flipped):
    name, of = flipped.split()
    module = sys.modules[getattr(live, name).__module__]
    before = getattr(live, name)().setup["ask"]
    assert before["key"] is not None or before["kind"] == "sketch"
    monkeypatch.setattr(module, of, FLIPS[flipped](getattr(module, of)))
    try:
        after = getattr(live, name)().setup["ask"]
    except (ValueError, ArithmeticError):
        return
    shown = "why" if before["kind"] == "sketch" else "key"
    assert after is None or after[shown] != before[shown]
