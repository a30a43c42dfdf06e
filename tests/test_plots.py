"""Figures: each has its alternative text, with the numbers of the run, and draws what it holds."""

import colorsys
import math
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from looks import drawn, heading_of, place_of

import wmrlib as wmr
from wmrbook import face, figures
from wmrbook.figures import style
from wmrbook.figures._drawing import SERIES

ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
PAPER = wmr.paper.outdoor()


@cache
def driven() -> wmr.Trajectory:
    return wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method="continuous")


@cache
def parked() -> wmr.Trajectory:
    return wmr.simulate(PAPER.goal, PAPER.goal, PAPER.gains)


@pytest.mark.parametrize("size", [(2.0, 2.0), (4.0, 12.0), (20.0, 3.0)])
def test_a_figure_fills_the_text_column_with_letters_of_nine_points(size):
    """A page shows it 690 px wide; letters of 9 pt are 12 px high there."""
    figure, axes = style.new_figure(*size)
    axes.plot([0.0, 1.0], [0.0, 5.0])
    axes.set(aspect="equal", title="a title", xlabel="x [m]", ylabel="y [m]")
    shown = style.Picture(figure, "A line.")
    shown.svg()  # which lays it out
    width = figure.get_figwidth()
    smallest = min(text.get_fontsize() for text in figure.findobj(style.Text))
    assert 12.0 <= smallest * 690 / (72 * width) <= 18.0
    bottom, top = axes.get_ylim()
    assert bottom < 0.0 < 5.0 < top
    assert axes.get_position().width > 0.8  # equal scales, over all of the width


def test_an_inset_shows_the_end_of_the_path_around_the_goal():
    (inset,) = figures.path(driven(), near=2.0).figure.axes[0].child_axes
    goal = driven().goal
    assert inset.get_xlim() == pytest.approx((goal.x - 2, goal.x + 2))
    assert inset.get_ylim() == pytest.approx((goal.y - 2, goal.y + 2))
    np.testing.assert_array_equal(
        inset.lines[0].get_xydata(), np.transpose([driven().x, driven().y])
    )
    assert not figures.path(driven()).figure.axes[0].child_axes
    with pytest.raises(ValueError, match=r"near = 0\.0 is not allowed"):
        figures.path(driven(), near=0.0)


def test_lines_are_the_runs_fields():
    every = [line for axes in figures.twist(driven()).figure.axes for line in axes.lines]
    curves = [line for line in every if len(line.get_xdata()) > 2]
    for line, values in zip(curves, (driven().v, driven().omega), strict=True):
        np.testing.assert_array_equal(line.get_xydata().T, [driven().t, values])


def test_path_has_equal_scales_and_the_robots_heading():
    again = {name: np.append(getattr(driven(), name), getattr(driven(), name)[-1]) for name in "xy"}
    # At its end it turns on the spot.
    turned = replace(driven(), **again, heading=np.append(driven().heading, 1.0))
    for run, last in ((driven(), driven().heading[-1]), (turned, 1.0)):
        axes = figures.path(run).figure.axes[0]
        assert axes.get_aspect() == 1.0
        robots, (goal, start) = drawn(axes, "robot"), drawn(axes, "pose")
        seen = [heading_of(it) for it in (robots[-1], goal, start)]
        assert seen == pytest.approx([last, PAPER.goal.heading, PAPER.start.heading])
        np.testing.assert_allclose(place_of(goal), PAPER.goal[:2], atol=1e-6)
        for robot in robots[:-1]:  # underway
            far = np.hypot(run.x - place_of(robot)[0], run.y - place_of(robot)[1])
            assert far.min() < 1e-6
            assert (
                abs(math.remainder(run.heading[far.argmin()] - heading_of(robot), math.tau)) < 1e-6
            )


@pytest.mark.parametrize("part", face.ROBOT)
def test_the_robot_of_the_figures_is_that_of_the_panels(part):
    """They are the same path: as text in the kit, as corners in matplotlib."""
    printed = face.javascript().split(f"  {part}: ")[1].split(",\n")[0]
    assert "".join(re.findall("'(.*?)'", printed)) == face.ROBOT[part]
    kit = (Path(__file__).parents[1] / "book/wmrbook/panel/kit/face.js").read_text("utf-8")
    assert printed in kit
    corners = [float(it) for it in re.findall(r"-?[\d.]+", face.ROBOT[part])]
    shape = style.icon(part)
    moves = shape.vertices[shape.codes != style.Path.CLOSEPOLY]
    np.testing.assert_array_equal(moves.ravel(), corners)


SHARED = "path", "start", "goal", "rho", "alpha", "theta", "h", "V"


def channels(code):
    return [int(code[at : at + 2], 16) / 255 for at in (1, 3, 5)]


def hue_deg(colour):
    """The hue, or None of a grey."""
    hue, saturation, _ = colorsys.rgb_to_hsv(*colour)
    return 360.0 * hue if saturation > 0.1 else None


def hues_apart(one, other):
    return abs((one - other + 180.0) % 360.0 - 180.0)


def brightness(colour):
    """The relative luminance of WCAG 2."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
    return float(np.dot([0.2126, 0.7152, 0.0722], linear))


@pytest.mark.parametrize("theme", [0, 1], ids=["light", "dark"])
@pytest.mark.parametrize("role", [*SHARED, "ink", "soft", "rising", "focus"])
def test_a_thing_has_one_hue_on_both_papers_and_is_legible(role, theme):
    codes = face.COLOURS[role]
    if role not in ("ink", "soft", "rising"):  # red is lighter, and nearer to orange, in the dark
        assert hues_apart(*(hue_deg(channels(code)) for code in codes)) < 12.0
    low, high = sorted(brightness(channels(face.COLOURS[it][theme])) for it in (role, "paper"))
    assert (high + 0.05) / (low + 0.05) > 4.5  # of text


@pytest.mark.parametrize("role", [*SHARED, "ink", "y_error", "omega"])
def test_on_dark_paper_a_thing_keeps_its_hue_and_is_legible(role):
    code = figures.COLOURS[role].lower()
    light, dark = (channels(colour) for colour in (code, style.DARK.get(code, code)))
    if role != "ink":
        assert hues_apart(hue_deg(light), hue_deg(dark)) < 12.0
    paper = brightness(channels(style.DARK["#ffffff"]))
    assert (brightness(dark) + 0.05) / (paper + 0.05) > 4.5  # of text


def test_a_figure_is_the_same_text_each_time_and_the_dark_one_has_no_ink_and_no_white():
    light, again = (figures.path([driven(), parked()], ["one", "two"]).svg() for _ in range(2))
    assert light == again
    assert len(light) < 40_000
    root = ElementTree.fromstring(style.darkened(light))
    assert root.get("fill") == style.DARK["#000000"]  # of what has no colour of its own: letters
    used = set(re.findall("#[0-9a-f]{6}", ElementTree.tostring(root, "unicode")))
    assert {face.COLOURS["ink"][1], face.COLOURS["path"][1]} <= used
    assert not {"#ffffff", face.COLOURS["ink"][0]} & used


def test_the_last_bits_of_a_run_do_not_change_its_picture():
    """They differ from processor to processor, and with them matplotlib's names of shapes."""
    random = np.random.default_rng(0)

    def nudged(values):
        return values * (1.0 + 1e-14 * random.standard_normal(len(values)))

    wanted = figures.path(driven()).svg()
    for _ in range(10):
        other = replace(driven(), x=nudged(driven().x), y=nudged(driven().y))
        assert figures.path(other).svg() == wanted


def test_different_things_have_different_hues_and_no_run_has_a_poses():
    for theme in (0, 1):
        hues = sorted(hue_deg(channels(face.COLOURS[role][theme])) for role in SHARED)
        assert all(hues_apart(a, b) > 20.0 for a, b in zip(hues, hues[1:] + hues[:1], strict=True))
    series = [figures.COLOURS[role] for role, _ in SERIES]
    assert len(set(series)) == len(series)
    assert not set(series) & {figures.COLOURS["start"], figures.COLOURS["goal"]}


def test_a_page_plays_a_drive_where_the_picture_has_it():
    picture = figures.path(driven(), near=2.0)
    picture.svg()
    motion, (whole,) = picture.motion(), picture.figure.axes
    for robot in motion["robots"]:
        robot.update({name: np.cumsum(robot[name]) for name in ("x", "y", "heading")})
    assert motion["seconds"] == pytest.approx(driven().t[-1], abs=0.01)
    for robot, axes in zip(motion["robots"], (whole, *whole.child_axes), strict=True):
        left, top, right, bottom = robot["box"]
        assert 0 <= left < right <= 10_000
        assert 0 <= top < bottom <= 10_000
        for k, place in ((0, 0), (-1, -1)):
            (west, east), (south, north) = axes.get_xlim(), axes.get_ylim()
            across = left + (right - left) * (driven().x[k] - west) / (east - west)
            down = bottom - (bottom - top) * (driven().y[k] - south) / (north - south)
            assert robot["x"][place] == pytest.approx(across, abs=12)  # boxes are rounded, and
            assert robot["y"][place] == pytest.approx(down, abs=12)  # an inset enlarges that
            assert robot["heading"][place] == round(math.degrees(np.unwrap(driven().heading)[k]))
