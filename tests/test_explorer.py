"""The panel's Python side: it and its sliders follow each other, and it refuses bad input."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="the panel needs anywidget and ipywidgets")
import wmrlib as wmr
from wmrlib import paper
from wmrlib.explorer import Explorer
from wmrlib.explorer.panel import javascript

GAINS = wmr.Gains(0.7, 3.0, 1.5, 2.0)


def test_the_defaults_are_the_papers():
    explorer = Explorer()
    outdoor = paper.outdoor()
    assert explorer.gains == outdoor.gains
    assert (explorer.start, explorer.goal, explorer.dt) == (outdoor.start, outdoor.goal, outdoor.dt)
    assert (explorer.law, explorer.moving) == ("corrected", False)


def test_gains_and_trajectory_follow_the_sliders():
    explorer = Explorer()
    for name, value in GAINS._asdict().items():
        explorer.sliders[name].value = value
    explorer.sliders["dt"].value = 0.05
    assert explorer.gains == GAINS
    ours, theirs = (
        explorer.trajectory(),
        wmr.simulate(explorer.start, explorer.goal, GAINS, dt=0.05),
    )
    np.testing.assert_array_equal(ours.x, theirs.x)
    np.testing.assert_array_equal(ours.omega, theirs.omega)


def test_setting_the_gains_moves_the_sliders_and_the_panel():
    explorer = Explorer()
    explorer.gains = GAINS
    assert [explorer.sliders[name].value for name in GAINS._fields] == list(GAINS)
    assert [getattr(explorer.panel, name) for name in GAINS._fields] == list(GAINS)


def test_gains_beyond_a_slider_widen_it():
    wide = wmr.Gains(50.0, 70.0, 90.0, 0.001)
    assert Explorer(gains=wide).gains == wide
    explorer = Explorer()
    explorer.gains = wide
    assert explorer.gains == wide
    explorer.dt = 30.0
    assert explorer.dt == pytest.approx(30.0)


def test_the_circle_is_followed_with_and_without_feed_forward():
    explorer = Explorer.circle()
    assert explorer.moving
    assert wmr.residual(explorer.trajectory()) == pytest.approx(0.0900, abs=1e-4)
    explorer.law = "kanayama"
    assert explorer.menus["circle_law"].index == explorer.panel.circle_law == 3
    assert wmr.residual(explorer.trajectory()) < 1e-6
    explorer.feedback = wmr.KanayamaGains(0.5, 1.0, 1.0)
    assert explorer.feedback == wmr.KanayamaGains(0.5, 1.0, 1.0)
    assert explorer.sliders["k_x"].value == 0.5
    assert Explorer(reference=paper.circle).moving


def test_start_goal_and_law_can_be_set():
    explorer = Explorer(law="printed", method="euler")
    explorer.start, explorer.goal, explorer.law = (
        wmr.Pose(1.0, 2.0, 3.0),
        wmr.Pose(4.0, 5.0, -1.0),
        "aicardi",
    )
    run = explorer.trajectory()
    assert (run.x[0], run.y[0], run.heading[0]) == (1.0, 2.0, 3.0)
    assert (run.goal, run.law, run.method) == (wmr.Pose(4.0, 5.0, -1.0), "aicardi", "euler")


def test_every_slider_and_menu_is_linked_and_named():
    explorer = Explorer()
    linked = {link.source[0].model_id for link in explorer.links}
    controls = [*explorer.sliders.values(), *explorer.menus.values()]
    assert {control.model_id for control in controls} <= linked
    assert all(control.description for control in controls)
    assert all(slider.readout for slider in explorer.sliders.values())  # where a value can be typed
    assert all(
        re.search(r"\[.+\]$", slider.description) for slider in explorer.sliders.values()
    )  # with its unit


BAD = [
    ({"start": (0.0, 0.0, 0.0)}, "start = (0.0, 0.0, 0.0) is not allowed: a Pose is needed"),
    (
        {"goal": wmr.Pose(np.zeros(2), 0.0, 0.0)},
        "goal.x = array([0., 0.]) is not allowed: one number is needed",
    ),
    (
        {"goal": wmr.Pose(1e9, 0.0, 0.0)},
        "goal.x = 1000000000.0 is not allowed: a finite number at least -1e+06",
    ),
    ({"gains": 3.0}, "gains = 3.0 is not allowed: a Gains is needed"),
    (
        {"gains": wmr.Gains(np.ones(2), 1.0, 1.0)},
        "gains.k_rho = array([1., 1.]) is not allowed",
    ),
    ({"feedback": GAINS}, "is not allowed: a KanayamaGains is needed"),
    (
        {"law": "kanayama"},
        "law = 'kanayama' is not allowed: one of 'corrected', 'printed', 'aicardi' is needed",
    ),
    (
        {"method": "continuous"},
        "method = 'continuous' is not allowed: one of 'arc', 'euler' is needed",
    ),
    ({"dt": 0.0}, "dt = 0.0 is not allowed: a finite number at least 0.0006 and at most 60"),
    ({"dt": 61.0}, "dt = 61.0 is not allowed"),
    ({"dt": 1e-9}, "dt = 1e-09 is not allowed"),
    ({"duration": math.nan}, "duration = nan is not allowed"),
    (
        {"arrival_radius": -1.0},
        "arrival_radius = -1.0 is not allowed: a finite number at least 0",
    ),
    (
        {"reference": "square"},
        "reference = 'square' is not allowed: None, 'circle' or wmrlib.paper.circle is needed",
    ),
    ({"view": "map"}, "view = 'map' is not allowed: one of 'time', 'gains' is needed"),
]


def test_bad_options_are_refused_by_name():
    for options, message in BAD:
        with pytest.raises(ValueError, match=re.escape(message)):
            Explorer(**options)


def test_bad_settings_are_refused_by_name():
    explorer = Explorer()
    for name, value in [
        ("gains", 1.0),
        ("feedback", 1.0),
        ("dt", -1.0),
        ("law", "linear"),
        ("start", None),
        ("goal", 7),
    ]:
        with pytest.raises(ValueError, match=f"^{name} = "):
            setattr(explorer, name, value)
    with pytest.raises(ValueError, match="k_rho = nan is not allowed: a finite number is needed"):
        explorer.panel.k_rho = math.nan


def test_the_module_asks_for_nothing_from_outside():
    source = javascript()
    assert not re.search(r"https?:|\bimport\b[^/\n]*from|\brequire\(|\bfetch\(", source)
    assert source.rstrip().endswith("export default { render };")


def test_no_law_is_typed_by_hand_in_the_drawing():
    ours = javascript().split("// Colours by role")[1]
    assert "expm1" not in ours
    assert "Math.exp" not in ours
