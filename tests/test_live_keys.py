"""What a prediction is compared with follows from wmrlib: with a flipped sign it is another."""

from __future__ import annotations

import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from wmrbook import live
from wmrbook.live import circle, design, lyapunov, pose_to_pose


def _uphill(f):
    return lambda a, b, gains, **how: f(a, b, gains, **(how | {"law": "printed"}))


FLIPS = [  # the thing, the module that makes it, and what it takes from wmrlib
    ("bowl", lyapunov, "simulate", _uphill),
    ("two_bars", lyapunov, "control_law", lambda f: lambda *a: (-f(*a)[0], f(*a)[1])),
    ("x_axis", pose_to_pose, "polar_error", lambda f: lambda a, b: f(b, a)),
    ("heading_left", pose_to_pose, "simulate", _uphill),
    ("lag", circle, "track", lambda f: lambda g, a, k, **o: f(g, a, k._replace(k_rho=1.9), **o)),
    ("phase", design, "modes", lambda f: lambda k: f(k._replace(k_alpha=2 * k.k_alpha))),
    ("poles", design, "modes", lambda f: lambda k: f(k._replace(h=1 / k.h))),
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


def test_what_is_aside_is_no_faster_only_because_the_wheels_cannot_push_there(monkeypatch):
    key = live.lqr().setup["ask"]["key"]
    monkeypatch.setattr(circle, "B", -circle.np.eye(3)[:, :2])  # a robot that moves sideways
    monkeypatch.setattr(circle, "A", 0 * circle.A + circle.np.diag([0.0, 0.0, -50.0]))
    assert live.lqr().setup["ask"]["key"] != key
