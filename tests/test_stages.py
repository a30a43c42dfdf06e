"""The stages that open the chapters, as Python makes them: scenes, handles, computed answers."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from wmrbook import stages

NAMES = sorted(set(stages.__all__) - stages.PARTS)


def _asked(stage) -> dict:
    """Return what a stage asks: the answers and their key, by scene."""
    return {it["name"]: it["ask"] for it in stage.setup["scenes"] if it["ask"]}


@pytest.mark.parametrize("name", NAMES)
def test_a_stage_opens_with_any_of_its_scenes_and_with_no_other(name):
    make = getattr(stages, name)
    listed = [scene["name"] for scene in make().setup["scenes"]]
    assert make().state["scene"] == listed[0]
    assert len(listed) > 1
    for scene in listed:
        assert make(scene).state["scene"] == scene
    with pytest.raises(ValueError, match=f"scene = 'nowhere' is not allowed.*{listed[0]}"):
        make("nowhere")


@pytest.mark.parametrize("name", ["first_drive", "late_looks"])  # with sliders, and a menu
def test_a_handle_goes_where_it_may_and_refuses_the_rest_by_name(name):
    stage = getattr(stages, name)()
    for knob in stage.setup["knobs"]:
        called = knob["name"]
        if "choices" in knob:
            allowed, refused = [value for value, _ in knob["choices"]], ["nothing"]
        else:
            low, high = knob["low"], knob["high"]
            allowed, refused = [low, high], [low - 1, high + 1, math.nan, "1"]
        for value in allowed:
            stage[called] = value
            assert stage[called] == stage.state[called] == value
        for value in refused:
            with pytest.raises((ValueError, TypeError), match=called):
                stage[called] = value
    with pytest.raises(ValueError, match="knob = 'k_beta' is not allowed"):
        stage["k_beta"] = 1.0


FLIPS = {  # what a stage's module takes from wmrlib, and the same with a flipped sign
    "first_drive simulate": lambda f: lambda a, b, k, **o: f(a, b, _turned_twice(k), **o),
    "gps_points local_position": lambda f: lambda a, b: (10 * f(a, b)[0], 10 * f(a, b)[1]),
    "two_wheels advance": lambda f: lambda *to: f(*to)._replace(y=-f(*to).x),
    "two_wheels wheels_to_twist": lambda f: (
        lambda left, right, track_width: f(right, left, track_width)
    ),
    "three_numbers simulate": lambda f: lambda a, b, k, **o: f(a, b, k._replace(h=2.0), **o),
    "three_numbers control_law": lambda f: lambda r, a, theta, k: f(r, a, -theta, k),
    "downhill lyapunov": lambda f: lambda *a: -f(*a),
    "two_drives simulate": lambda f: (
        lambda *a, arrival_radius, **o: f(*a, arrival_radius=0.005 / arrival_radius, **o)
    ),
    "two_numbers simulate": lambda f: lambda a, b, k, **o: f(a, b, k._replace(h=k.k_rho), **o),
    "two_numbers modes": lambda f: lambda k: f(k._replace(k_alpha=k.h)),
    "moving_goal track": lambda f: lambda g, a, k, **o: f(g, a, k._replace(k_rho=1 / k.h), **o),
    "late_looks simulate": lambda f: lambda *a, dt, **o: f(*a, dt=0.002 / dt, **o),
    "noisy_fixes sweep": lambda f: lambda a, b, k, **o: f(a, b, _turned_thrice(k), **o),
    "as_printed simulate": lambda f: lambda *a, law, **o: f(*a, law=OTHER[law], **o),
    "crooked_compass control_law": lambda f: lambda r, a, *o: f(r, a + math.radians(12), *o),
    "standing_still fixes": lambda f: lambda: np.random.default_rng(1).normal(size=f().shape),
    "race_of_laws simulate": lambda f: lambda *a, law, **o: f(*a, law=OTHER.get(law, law), **o),
    "course_from_gps polar_error": lambda f: lambda a, b: f(a, b._replace(x=b.x.clip(2, 3))),
    "course_from_gps advance": lambda f: lambda a, v, omega, dt: f(a, v + 1.0, omega, dt),
    "seam lyapunov": lambda f: lambda r, a, theta, h: f(r, a, max(theta, 0.0), h),
}
OTHER = {"corrected": "printed", "printed": "corrected"}


def _turned_twice(gains):
    """Return gains of which the doubled one is half as large."""
    return gains._replace(k_alpha=gains.k_alpha if gains.k_alpha < 2 else 0.5)


def _turned_thrice(gains):
    """Return gains of which three times as many are a third."""
    return gains._replace(k_alpha=12.0 / gains.k_alpha)


def test_every_question_is_asked_of_wmrlib():
    asking = {name for name in NAMES if _asked(getattr(stages, name)())}
    assert asking == {flipped.split()[0] for flipped in FLIPS}


@pytest.mark.parametrize("flipped", FLIPS)
def test_the_right_answer_follows_from_the_library(monkeypatch, flipped):
    name, of = flipped.split()
    module = sys.modules[getattr(stages, name).__module__]
    before = _asked(getattr(stages, name)())
    monkeypatch.setattr(module, of, FLIPS[flipped](getattr(module, of)))
    after = _asked(getattr(stages, name)())
    assert [ask["key"] for ask in before.values()] != [ask["key"] for ask in after.values()]


def test_where_nothing_runs_a_stage_says_where_its_handles_stand():
    for name in NAMES:
        stage = getattr(stages, name)()
        assert repr(stage).startswith("A stage, which begins with")
        assert all(knob["says"] in repr(stage) for knob in stage.setup["knobs"])
