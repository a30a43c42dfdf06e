"""What a prediction is compared with follows from wmrlib: with a flipped sign it is another."""

from __future__ import annotations

import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from wmrbook import live
from wmrbook.live import audit, noise, real_robot, routes, sampling


def _backwards(gains):
    return gains._replace(k_alpha=-gains.k_alpha)


FLIPS = [  # the thing, the module that makes it, and what it takes from wmrlib
    ("unit_circle", sampling, "longest_step", lambda f: lambda *a: 0.5 * f(*a)),
    ("wheel_limit", sampling, "wheels_to_twist", lambda f: lambda a, b, c: f(b, a, c)),
    ("bench", noise, "advance", lambda f: lambda pose, v, omega, dt: f(pose, v, -omega, dt)),
    ("late", noise, "control_law", lambda f: lambda *a: (-f(*a)[0], f(*a)[1])),
    ("threshold", audit, "simulate", lambda f: lambda a, b, k, **o: f(a, b, _backwards(k), **o)),
    ("rising", audit, "lyapunov_rate", lambda f: lambda *a, **o: -f(*a, **o)),
    ("compass", real_robot, "wrap_angle", lambda f: lambda angle: -f(angle)),
    ("silence", real_robot, "rolled", lambda f: lambda v, timeout, brake: f(v, timeout, -brake)),
    ("corners", routes, "headings_along", lambda f: lambda x, y: -f(x, y)),
    (
        "passing",
        routes,
        "drive_route",
        lambda f: lambda p, g, **o: f(p, g, **(o | {"pass_radius": 1e9})),
    ),
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
