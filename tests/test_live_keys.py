"""What a prediction is compared with follows from wmrlib: with a flipped sign it is another."""

from __future__ import annotations

import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from wmrbook import live
from wmrbook.live import angles, earth, first_drive, robot


def _turned(goal):
    return goal._replace(heading=-goal.heading)


def _to_the_right(f, *methods):
    """Turn right where `advance` turns left, with all methods or with some."""
    return lambda pose, v, omega, dt, method="arc": f(
        pose, v, -omega if method in methods or not methods else omega, dt, method=method
    )


FLIPS = [  # the thing, the module that makes it, and what it takes from wmrlib
    (
        "last_metres",
        first_drive,
        "simulate",
        lambda f: lambda a, b, k, **o: f(a, _turned(b), k, **o),
    ),
    (
        "stopping",
        first_drive,
        "simulate",
        lambda f: lambda a, b, k, **o: f(a, b, k, law="printed", **o),
    ),
    ("bearing", earth, "local_position", lambda f: lambda *to: (f(*to)[0], -f(*to)[1])),
    ("flat_map", earth, "local_position", lambda f: lambda *to: (f(*to)[0], -f(*to)[1])),
    ("turning_centre", robot, "wheels_to_twist", lambda f: lambda a, b, c: f(b, a, c)),
    ("commutator", robot, "advance", _to_the_right),
    ("one_step", robot, "advance", lambda f: _to_the_right(f, "euler")),
    (
        "polar_angles",
        angles,
        "polar_error",
        lambda f: lambda *a: f(*a)._replace(alpha=-f(*a).alpha),
    ),
    ("half_turn", angles, "simulate", lambda f: lambda a, b, k, **o: f(_turned(a), b, k, **o)),
]


@pytest.mark.parametrize(("name", "module", "of", "flip"), FLIPS, ids=[row[0] for row in FLIPS])
def test_a_flipped_sign_changes_what_is_right_or_is_refused(monkeypatch, name, module, of, flip):
    before = getattr(live, name)().setup["ask"]
    assert before["key"] is not None or before["kind"] == "sketch"
    monkeypatch.setattr(module, of, flip(getattr(module, of)))
    try:
        after = getattr(live, name)().setup["ask"]
    except (ValueError, ArithmeticError):
        return
    shown = "why" if before["kind"] == "sketch" else "key"
    assert after is None or after[shown] != before[shown]
