"""The panel's Python side: it and its sliders follow each other, and it refuses bad input."""

from __future__ import annotations

import math
import posixpath
import re
from pathlib import Path, PurePosixPath

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="the panel needs anywidget and ipywidgets")
from kit import printed
from traitlets import TraitError

import wmrlib as wmr
from wmrbook.panel import Explorer, kit
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
        explorer.state = explorer.state | {"method": method, "arrival_radius": 0.2}
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
    explorer.state = explorer.state | {"method": "continuous"}
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
    ("gains", 3.0, " = 3.0 is not allowed: a Gains is needed"),
    ("feedback", GAINS, f" = {GAINS!r} is not allowed: a KanayamaGains is needed"),
    ("wheels", wmr.Wheels(0.5, 2.0), " = Wheels(track_width=0.5, max_speed=2.0"),
    ("law", "kanayama", f" = 'kanayama' is not allowed: one of {LAWS} is needed"),
    ("method", "rk4", " = 'rk4' is not allowed: one of 'arc', 'euler', 'continuous' is needed"),
    ("dt", 0.0, " = 0.0 is not allowed: a finite number at least 0.0006 and at most 60"),
    ("duration", math.nan, " = nan is not allowed"),
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
    with pytest.raises(TraitError, match=f"a dict of .*{name}"):
        explorer.state = {key: value for key, value in before.items() if key != name}


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
