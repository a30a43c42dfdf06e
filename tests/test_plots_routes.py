"""Figures of routes and of the challenge: each draws, has axes with units, and an alternative text with the numbers of what it shows."""

import html
import io
import math

import numpy as np
import pytest
from matplotlib.colors import same_color
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import challenge, figures
from wmrbook.challenge import Challenge, from_seed
from wmrlib import plots

GAINS = wmr.Gains(0.4, 2.0, 1.0, 3.0)
WAY = wmr.Pose(
    np.array([0.0, 25.0, 30.0, 0.0]),
    np.array([0.0, 2.0, 30.0, 40.0]),
    np.array([0.1, 0.8, 2.0, 3.0]),
)
MIXED = wmr.drive_route(WAY, GAINS, stop=[False, True, True])
STUCK = wmr.drive_route(WAY._replace(y=np.array([0.0, 2.0, 90.0, 95.0])), GAINS, duration=20.0)
GOOD = challenge.score(wmr.Gains(0.128, 1.089, 1.42, 7.528))
WILD = challenge.score(wmr.Gains(5.0, 0.1, 5.0, 20.0))
FIVE = challenge.score(wmr.Gains(2.0, 1.0, 0.3), Challenge(1, from_seed(1).cases[:5]))
PICTURES = {
    "route": lambda: figures.route(
        MIXED, background=(np.linspace(0.0, 25.0, 30), np.linspace(1.0, 3.0, 30))
    ),
    "route, not reached": lambda: figures.route(STUCK),
    "route of one pose": lambda: figures.route(
        wmr.drive_route(wmr.Pose(3.0, 4.0, 1.0), GAINS, start=wmr.Pose(3.0, 4.0, 1.0))
    ),
    "signals": lambda: figures.route_signals(MIXED),
    "signals of one pose": lambda: figures.route_signals(
        wmr.drive_route(wmr.Pose(3.0, 4.0, 1.0), GAINS, start=wmr.Pose(3.0, 4.0, 1.0))
    ),
    "challenge": lambda: figures.challenge_paths(GOOD),
    "challenge, wild": lambda: figures.challenge_paths(WILD),
    "challenge of five": lambda: figures.challenge_paths(FIVE),
    "challenge, nowhere": lambda: figures.challenge_paths(
        challenge.score(wmr.Gains(1e300, 1e300, 1e300, 1e300))
    ),
}


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_draws_and_has_its_text(name):
    picture = PICTURES[name]()
    bundle, metadata = picture._repr_mimebundle_()
    assert metadata["image/png"]["alt"] == picture.alt
    assert bundle["text/html"].startswith(f'<img alt="{html.escape(picture.alt)}" width=')
    assert len(picture.alt) > 60
    assert picture.alt.endswith(".")
    assert "nan" not in picture.alt
    assert "-0.0" not in picture.alt
    pixels = imread(io.BytesIO(bundle["image/png"]))[..., :3]
    assert 0.01 < np.mean(pixels.min(axis=2) < 0.9) < 0.7  # neither blank nor flooded


@pytest.mark.parametrize("name", PICTURES)
def test_the_outer_axes_say_what_they_show_and_in_which_unit(name):
    figure = PICTURES[name]().figure
    for axes in figure.axes:
        place = axes.get_subplotspec()
        if place.is_first_col() and axes.axison:
            assert "[" in (axes.get_ylabel() or figure.get_supylabel())
        if place.is_last_row() and axes.axison:
            assert "[" in (axes.get_xlabel() or figure.get_supxlabel())


def test_texts_carry_the_numbers():
    text = PICTURES["route"]().alt
    assert text.startswith("Path from (0.0, 0.0) m to (")
    aside = min(
        math.dist((WAY.x[1], WAY.y[1]), place) for place in zip(MIXED.x, MIXED.y, strict=True)
    )
    assert 0.1 < aside < 2.0
    assert (
        f"3 of 3 waypoints reached, 2 to stop at and 1 to pass (at most {aside:.1f} m aside); "
        in text
    )
    assert (
        f"{MIXED.length:.1f} m in {MIXED.time:.1f} s, with 30 points of a track behind it." in text
    )
    assert "1 of 3 waypoints reached, 3 to stop at and 0 to pass; " in figures.route(STUCK).alt
    assert "s without reaching the rest." in figures.route(STUCK).alt
    assert f"Over {MIXED.time:.1f} s and 3 legs: v between" in figures.route_signals(MIXED).alt
    assert "jumping up at 2 of 2 changes of the goal" in figures.route_signals(MIXED).alt
    text = PICTURES["challenge"]().alt
    assert (
        "12 of them reached, with 21.81 points in the mean; the dearest is case 12, far behind, with 42.7"
        in text
    )
    assert "the start a filled arrow and the goal an outlined one" in text


def arrows(axes):
    """(from, to) of the headings' arrows: annotations without a text."""
    return [
        (np.array(note.get_position()), np.array(note.xy))
        for note in axes.texts
        if not note.get_text()
    ]


def test_headings_point_where_the_route_wants_them():
    axes = figures.route(MIXED).figure.axes[0]
    for k, (tail, tip) in enumerate(arrows(axes), start=1):
        assert tail.tolist() == [WAY.x[k], WAY.y[k]]
        assert math.atan2(*(tip - tail)[::-1]) == pytest.approx(WAY.heading[k])
    assert [note.get_text() for note in axes.texts if note.get_text()] == ["1", "2", "3"]


def test_stops_passes_and_what_was_not_reached_have_markers_of_their_own():
    def markers(route):
        lines = figures.route(route).figure.axes[0].lines
        return [line.get_marker() for line in lines if line.get_marker() in ("s", "o", "x")]

    assert markers(MIXED) == ["o", "s", "s"]
    assert markers(STUCK) == ["s", "s", "x", "s", "x"]
    labels = [
        text.get_text() for text in figures.route(MIXED).figure.axes[0].get_legend().get_texts()
    ]
    assert labels == ["path", "start", "stop", "passed"]


def test_the_path_that_is_drawn_is_the_one_that_was_driven():
    line = figures.route(MIXED).figure.axes[0].lines[0]
    np.testing.assert_array_equal(line.get_xydata(), np.column_stack([MIXED.x, MIXED.y]))


def test_signals_are_cut_where_the_goal_changes():
    upper, lower = figures.route_signals(MIXED).figure.axes
    parts = [line for line in lower.lines if same_color(line.get_color(), plots.COLOURS["V"])]
    assert len(parts) == 3
    assert all((np.diff(part.get_ydata()) <= 1e-9 * part.get_ydata()[0]).all() for part in parts)
    changes = [line.get_xdata()[0] for line in upper.lines if line.get_linestyle() == "--"]
    assert changes == pytest.approx(np.cumsum([leg.t[-1] for leg in MIXED.legs])[:-1])
    for part, leg, end in zip(
        parts, MIXED.legs, [*changes, MIXED.time], strict=True
    ):  # down to the arrival itself
        np.testing.assert_array_equal(part.get_ydata(), np.maximum(leg.V, 1e-12))
        assert part.get_xdata()[-1] == pytest.approx(end)


def test_a_jump_is_counted_from_the_arrival():
    """One sample before the arrival V is still above that of the next leg."""
    poses = wmr.Pose(np.array([0.0, 10.0, 12.0]), np.zeros(3), np.zeros(3))
    driven = wmr.drive_route(poses, wmr.Gains(0.3, 1.0, 1.5), stop=[False, True], dt=1.0)
    change = int(np.flatnonzero(np.diff(driven.leg))[0])
    assert driven.legs[0].V[-1] < driven.V[change + 1] < driven.V[change]
    assert "jumping up at 1 of 1 changes" in figures.route_signals(driven).alt
    back = wmr.drive_route(
        poses._replace(x=np.array([0.0, 10.0, 9.0])),
        wmr.Gains(0.3, 1.0, 1.5),
        stop=[False, True],
        dt=0.1,
    )
    assert (
        back.legs[1].V[0] < back.legs[0].V[-1]
    )  # the next goal is nearer than the one that is passed
    assert "jumping up at 0 of 1 changes" in figures.route_signals(back).alt


def test_each_case_of_the_challenge_has_its_panel():
    panels = PICTURES["challenge, wild"]().figure.axes
    for k, (axes, row) in enumerate(zip(panels, WILD.cases, strict=True), start=1):
        assert axes.get_title().startswith(f"{k} {row.kind}: {row.points:.1f} points\n")
        assert axes.lines[0].get_linestyle() == ("--" if row.note else "-")
        assert row.note in axes.get_title()
    assert sum(axes.axison for axes in PICTURES["challenge of five"]().figure.axes) == 5


def test_the_legend_says_which_arrow_is_the_start():
    def legend(name):
        found = PICTURES[name]().figure.legends[0]
        return dict(
            zip([text.get_text() for text in found.get_texts()], found.legend_handles, strict=True)
        )

    handles = legend("challenge")
    assert list(handles) == ["path", "start", "goal"]
    assert list(legend("challenge, wild")) == ["path", "path that got the penalty", "start", "goal"]
    goal, start = PICTURES["challenge"]().figure.axes[0].patches  # drawn in this order
    assert same_color(handles["start"].get_markerfacecolor(), start.get_facecolor())
    assert handles["goal"].get_markerfacecolor() == "none"
    assert not goal.get_facecolor()[3]
    assert same_color(handles["goal"].get_markeredgecolor(), goal.get_edgecolor())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: figures.route(WAY), "a Route is needed, not a Pose"),
        (
            lambda: figures.route(wmr.drive_route(WAY, wmr.Gains(1e308, 1e308, 1e308, 1e308))),
            "driven has no sample",
        ),
        (
            lambda: figures.route(MIXED, background=(np.ones(3), np.ones(2))),
            "background = .* is not allowed: .east, north., two lists",
        ),
        (
            lambda: figures.route(MIXED, background=(np.ones(5), np.ones(1))),
            "background = .* is not allowed: .east, north., two lists",
        ),
        (
            lambda: figures.route(MIXED, background=np.zeros((5, 2))),
            "is not allowed: .east, north., two lists of one length, is needed",
        ),
        (
            lambda: figures.route(MIXED, background=5),
            "background = 5 is not allowed: .east, north., two lists",
        ),
        (
            lambda: figures.route(MIXED, background=(["a"], ["b"])),
            "background = .* is not allowed: a finite number",
        ),
        (lambda: figures.route_signals(GOOD), "a Route is needed"),
        (lambda: figures.challenge_paths(GAINS), "a Score is needed, not a Gains"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
