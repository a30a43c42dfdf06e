"""The panel's Python side: it and its sliders follow each other, and it refuses bad input."""

from __future__ import annotations

import copy
import json
import math
import posixpath
import re
from pathlib import Path, PurePosixPath

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("anywidget", reason="the panel needs anywidget and ipywidgets")
import ipywidgets as widgets
from kit import printed
from traitlets import TraitError

import wmrlib as wmr
from wmrbook import stages
from wmrbook.panel import Explorer, MyRobot, kit
from wmrbook.panel.controls import METHODS
from wmrlib import paper
from wmrlib.laws import POSE_LAWS

GAINS = wmr.Gains(0.7, 3.0, 1.5, 2.0)
PAGE = Path(__file__).parents[1] / "book" / "explorer.md"


def test_the_trajectory_is_that_of_the_state():
    explorer = Explorer(law="printed", method="euler")
    explorer.gains, explorer.dt, explorer.law = GAINS, 0.05, "aicardi"
    explorer.start, explorer.goal = wmr.Pose(1.0, 2.0, 3.0), wmr.Pose(4.0, 5.0, -1.0)
    for method in METHODS:
        explorer.method, explorer.arrival_radius = method, 0.2
        ends, options = (wmr.Pose(1.0, 2.0, 3.0), wmr.Pose(4.0, 5.0, -1.0)), {"dt": 0.05}
        options |= {"law": "aicardi", "method": method, "arrival_radius": 0.2}
        theirs = wmr.simulate(*ends, GAINS, **options)
        ours = explorer.trajectory()
        assert (ours.law, ours.method) == ("aicardi", method)
        np.testing.assert_array_equal(ours.x, theirs.x)
        np.testing.assert_array_equal(ours.omega, theirs.omega)
    assert (explorer.gains, explorer.dt) == (GAINS, 0.05)


def test_wheels_are_in_the_trajectory_while_commands_are_held():
    wheels = wmr.Wheels(0.4, acceleration=1.0, lag=0.2, dead_band=0.05)
    explorer = Explorer(wheels=wheels)
    assert explorer.wheels == wheels
    theirs = wmr.simulate(explorer.start, explorer.goal, explorer.gains, wheels=wheels,
                          arrival_radius=0.05)  # fmt: skip
    np.testing.assert_array_equal(explorer.trajectory().x, theirs.x)
    circle = Explorer.circle(wheels=wheels)
    assert wmr.residual(circle.trajectory()) > 0.1
    explorer.method = "continuous"
    assert explorer.wheels is None
    assert wmr.arrival(explorer.trajectory()).arrived


def test_the_circle_is_followed_with_and_without_feed_forward():
    explorer = Explorer.circle()
    assert explorer.moving
    assert wmr.residual(explorer.trajectory()) == pytest.approx(0.0900, abs=1e-4)
    explorer.law = "kanayama"
    assert wmr.residual(explorer.trajectory()) < 1e-6
    explorer.feedback = wmr.KanayamaGains(0.5, 1.0, 1.0)
    assert explorer.feedback == wmr.KanayamaGains(0.5, 1.0, 1.0)
    assert Explorer(reference=paper.circle).moving


def test_the_page_says_the_figures_that_its_panel_shows():
    text = PAGE.read_text(encoding="utf-8")
    panel = eval(re.search(r"^Explorer\(.*\)$", text, re.MULTILINE).group())
    end = wmr.arrival(panel.trajectory())
    off = abs(math.degrees(end.heading_error))
    assert f"{end.time:.1f} s" in text
    assert f"{off:.0f} deg" in text
    panel = Explorer(wheels=wmr.Wheels(0.5, acceleration=1.0))
    assert f"arrive after {wmr.arrival(panel.trajectory()).time:.1f} s" in text
    panel.gains, times = wmr.GENTLE_GAINS, []
    for wheels in (panel.wheels, wmr.Wheels(0.5)):
        panel.wheels = wheels
        times.append(wmr.arrival(panel.trajectory()).time)
    assert f"need {times[0] - times[1]:.0f} s more" in text


LAWS = str(tuple(POSE_LAWS))[1:-1]
BAD = [
    ("start", (0.0, 0.0, 0.0), " = (0.0, 0.0, 0.0) is not allowed: a Pose is needed"),
    (
        "goal",
        wmr.Pose(np.zeros(2), 0, 0),
        ".x = array([0., 0.]) is not allowed: one number is needed",
    ),
    (
        "goal",
        wmr.Pose(1e9, 0, 0),
        ".x = 1000000000.0 is not allowed: a finite number at least -1e+06",
    ),
    ("feedback", GAINS, f" = {GAINS!r} is not allowed: a KanayamaGains is needed"),
    ("wheels", wmr.Wheels(0.5, 2.0), " = Wheels(track_width=0.5, max_speed=2.0"),
    ("law", "kanayama", f" = 'kanayama' is not allowed: one of {LAWS} is needed"),
    ("dt", 0.0, " = 0.0 is not allowed: a finite number at least 0.0006 and at most 60"),
    ("reference", "square", " = 'square' is not allowed: None, 'circle' or wmrlib.paper.circle is"),
    ("view", "map", " = 'map' is not allowed: one of 'time', 'gains' is needed"),
]


def test_bad_options_are_refused_by_name():
    for name, value, message in BAD:
        with pytest.raises(ValueError, match=re.escape(name + message)):
            Explorer(**{name: value})


OTHERS = [True, None, "1", "toString", {}, [1, 2], [1, 2, "3"], math.nan, [0, math.inf, 0]]


@pytest.mark.parametrize("name", [*Explorer().state])
def test_a_state_of_other_kinds_is_refused_by_name_and_leaves_the_panel_as_it_was(name):
    explorer = Explorer()
    before = explorer.state
    for value in OTHERS:
        if (name, value) in [("moving", True), (name, before[name])]:
            continue
        with pytest.raises(TraitError, match=re.escape(f"state['{name}'] = ")):
            explorer.set_state({"state": before | {name: value}})  # as a page does
        assert explorer.state == before
    others = {key: value for key, value in before.items() if key != name}
    gain = "h" if name == "k_rho" else "k_rho"
    with pytest.raises(TraitError, match=f"a dict of .*{name}"):
        explorer.set_state({"state": others, gain: 0.5})
    assert explorer.state == before


NEW = {
    "k_rho": 0.7,
    "k_alpha": 3.0,
    "h": 1.5,
    "v_max": 2.0,
    "gains": GAINS,
    "feedback": wmr.KanayamaGains(0.5, 1.0, 1.0),
    "start": wmr.Pose(1.0, 2.0, 3.0),
    "goal": wmr.Pose(4.0, 5.0, -1.0),
    "wheels": wmr.Wheels(0.4, acceleration=1.0),
    "dt": 0.05,
    "duration": 30.0,
    "arrival_radius": 0.2,
    "law": "printed",
    "method": "euler",
    "view": "gains",
    "metric": "time",
    "axes": "k_rho",
}


def observed(explorer, *names):
    """A list that grows by each notification of these traits, by default of all."""
    seen = []

    def note(change):
        assert change["new"] == getattr(explorer, change["name"])
        fields = (getattr(explorer, name) for name in wmr.Gains._fields)
        assert explorer.gains == wmr.Gains(*fields)
        seen.append(change["name"])

    explorer.observe(note, names or [*NEW, "moving"])
    return seen


@pytest.mark.parametrize("name", NEW)
def test_a_trait_follows_the_cell_and_the_page_with_one_notification(name):
    explorer, as_made = Explorer(), Explorer().state
    assert f" {name}," in f" {explorer.settable()},"
    seen, before = observed(explorer, name), getattr(explorer, name)
    explorer.set_trait(name, NEW[name])
    assert getattr(explorer, name) == NEW[name]
    assert explorer.state != as_made
    setattr(explorer, name, NEW[name])  # again
    assert seen == [name]
    explorer.set_state({"state": {**as_made}})  # as a page does
    assert getattr(explorer, name) == before
    assert seen == [name, name]


GAIN = st.sampled_from([0.5, 1.0, 2.0, 7.0])
DEEDS = st.one_of(
    st.fixed_dictionaries({}, optional=dict.fromkeys(wmr.Gains._fields, GAIN)),
    st.builds(wmr.Gains, GAIN, GAIN, GAIN, GAIN),
)


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(DEEDS, st.sampled_from(["cell", "held", "page"])), max_size=4))
def test_whoever_changes_gains_an_observer_sees_whole_ones_and_each_change_once(deeds):
    explorer = Explorer()
    seen = observed(explorer)
    for deed, by in deeds:
        before, told = explorer.gains, deed if isinstance(deed, dict) else deed._asdict()
        if by == "page":
            explorer.set_state({**told, "state": explorer.state | told})
        elif by == "cell" and not isinstance(deed, dict):
            explorer.gains = deed
        else:
            with explorer.hold_trait_notifications():
                for name, value in told.items():
                    setattr(explorer, name, value)
        pairs = zip(before._asdict().items(), explorer.gains, strict=True)
        changed = [name for (name, old), new in pairs if old != new]
        assert explorer.gains == before._replace(**told)
        assert sorted(seen) == sorted([*changed, *["gains"][: len(changed)]])
        seen.clear()


def test_an_observer_that_sets_a_gain_is_heard_once_and_last():
    explorer = Explorer()
    explorer.observe(lambda change: setattr(explorer, "h", 2 * change["new"]), "k_alpha")
    seen = observed(explorer)
    explorer.gains = GAINS
    assert (explorer.k_alpha, explorer.h) == (3.0, 6.0)
    assert sorted(seen) == ["gains", "gains", "h", "h", "k_alpha", "k_rho", "v_max"]


def test_sliders_of_ones_own_are_linked():
    explorer, slider = Explorer(), widgets.FloatSlider(1.0, max=5.0)
    widgets.link((slider, "value"), (explorer, "k_rho"))
    assert explorer.k_rho == 1.0
    explorer.gains = GAINS
    assert slider.value == 0.7
    widgets.dlink((explorer, "gains"), (slider, "description"), repr)
    explorer.set_state({"state": explorer.state | {"k_rho": 3.0}})
    assert (slider.value, slider.description) == (3.0, repr(GAINS._replace(k_rho=3.0)))
    for name in wmr.Gains._fields:
        widgets.jslink((slider, "value"), (explorer, name))
        widgets.jsdlink((explorer, name), (slider, "value"))


def test_a_page_gets_gains_and_state_in_one_message_and_its_own_not_back(monkeypatch):
    explorer, sent = Explorer(), []
    monkeypatch.setattr(explorer, "_send", lambda message, **_: sent.append(message))
    explorer.gains = GAINS
    (message,) = sent
    assert message["state"] == {**GAINS._asdict(), "state": explorer.state}
    sent.clear()
    explorer.set_state(
        {"k_rho": 3, "state": json.loads(json.dumps({**explorer.state, "k_rho": 3}))}
    )
    assert [message["method"] for message in sent] == ["echo_update"]
    assert explorer.k_rho == 3.0


def test_other_names_and_the_state_are_refused_by_a_sentence():
    explorer, thing = Explorer(), stages.first_drive()
    before = explorer.state
    for panel, name, words in (
        (explorer, "kp", "no attribute 'kp'; .* gains, .* k_alpha, k_rho, .* layout$"),
        (explorer, "K_rho", "no attribute 'K_rho'"),
        (MyRobot(), "sigma", "no attribute 'sigma'"),
        (thing, "h", r"no attribute 'h'; you can set \['k_rho'\], "),
        (explorer, "moving", "moving"),
    ):
        with pytest.raises((AttributeError, TraitError), match=words):
            setattr(panel, name, 3.0)
    with pytest.raises(TraitError, match=r"state is read-only: set .*k_rho"):
        explorer.state = before | {"k_rho": 1.0}
    for change in ("update(h=1)", "clear()", "pop('h')", "setdefault('x')", "__setitem__('h', 1)"):
        with pytest.raises(TypeError, match="state is read-only"):
            eval(f"explorer.state.{change}")
    with pytest.raises(TypeError):
        explorer.state["start"][0] = 1.0
    assert explorer.state == before == copy.deepcopy(before) == Explorer().state


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        *((name, -1.0, "a finite number at least 0") for name in ("k_rho", "k_alpha", "h")),
        ("v_max", 0.0, "a finite number above 0"),
        ("k_rho", math.nan, "a finite number"),
        ("k_rho", "2", "a finite number at least 0 is needed, not a str"),
        ("h", [1.0, 2.0], "one number is needed"),
        ("h", 1e9, "at most 1e\\+06"),
        ("gains", (1.0, 2.0, 3.0), "a Gains is needed"),
        ("method", "rk4", "one of 'arc', 'euler', 'continuous'"),
        ("duration", 0.01, "at least 0.1 and at most 10000"),
        ("arrival_radius", -1, "at least 0"),
    ],
)
def test_a_bad_value_is_refused_by_name_and_the_old_one_stays(name, value, allowed):
    explorer = Explorer()
    seen, before = observed(explorer), getattr(explorer, name)
    for kind in (ValueError, TraitError):
        with pytest.raises(kind, match=f"^{name} = .* is not allowed: .*{allowed}"):
            setattr(explorer, name, value)
    with pytest.raises(TraitError):
        explorer.set_state({name: value, "state": {**explorer.state, name: value}})
    assert getattr(explorer, name) == before
    assert seen == []


def imported(texts, path, above=()):
    """Every module that a module needs, itself included; none in a circle."""
    assert path not in above, (*above, path)
    others = re.findall(r"^(?:import|export|\}).* from '(.+)';$", texts[path], re.MULTILINE)
    imports = (posixpath.normpath(PurePosixPath(path).parent / other) for other in others)
    return {path}.union(*(imported(texts, other, (*above, path)) for other in imports))


def test_a_kernel_sends_all_that_a_program_imports_and_that_asks_for_nothing_else():
    for program in kit.programs():
        texts = kit.sources(program)
        for path in imported(texts, f"{program}.js"):
            assert not re.search(r"https?:|\brequire\(|\bfetch\(", texts[path]), path


def test_the_committed_modules_are_what_is_printed():
    for name, text in printed().items():
        assert (kit.KIT / name).read_text(encoding="utf-8") == text, "run python book/tools/kit.py"
