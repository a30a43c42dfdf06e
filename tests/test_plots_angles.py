"""Figures of angles: each has its text with the numbers, and arcs that end where the angle ends."""

import html
import io
import math

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import figures

ROBOT, GOAL = wmr.Pose(0.0, 0.0, math.radians(15)), wmr.Pose(4.0, 5.7, math.radians(-25))
ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
GAINS = wmr.paper.OUTDOOR_GAINS
RUNS = [
    wmr.simulate(ROBOT, GOAL, GAINS, law=law, method="continuous")
    for law in ("corrected", "aicardi")
]
WAY = wmr.Pose(np.linspace(-3.0, 0.0, 20), np.linspace(-2.0, 0.1, 20), np.linspace(1.0, 0.2, 20))
PICTURES = {
    "polar_angles": lambda: figures.polar_angles(ROBOT, GOAL),
    "polar_angles, clockwise": lambda: figures.polar_angles(
        wmr.Pose(5.0, 0.0, 2.0), wmr.Pose(0.0, -4.0, 3.0)
    ),
    "third_angle": lambda: figures.third_angle(ROBOT, GOAL),
    "ways": lambda: figures.ways({"one": WAY, "two": wmr.Pose(WAY.x, 0.5 * WAY.y, 0.0)}, ORIGIN),
    "angles_over_time": lambda: figures.angles_over_time(RUNS[0]),
    "angles_over_time of two": lambda: figures.angles_over_time(RUNS, ["one", "two"]),
}


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_draws_and_has_its_text(name):
    picture = PICTURES[name]()
    bundle, metadata = picture._repr_mimebundle_()
    assert metadata["image/png"]["alt"] == picture.alt
    assert bundle["text/html"].startswith(f'<img alt="{html.escape(picture.alt)}" width=')
    assert len(picture.alt) > 60
    assert picture.alt.endswith(".")
    assert any(letter.isdigit() for letter in picture.alt)
    assert "nan" not in picture.alt
    assert "-0 " not in picture.alt
    pixels = imread(io.BytesIO(bundle["image/png"]))[..., :3]
    assert 0.01 < np.mean(pixels.min(axis=2) < 0.9) < 0.7  # neither blank nor flooded


@pytest.mark.parametrize("name", PICTURES)
def test_every_axis_says_what_it_shows_and_in_which_unit(name):
    for axes in PICTURES[name]().figure.axes:
        assert "[" in axes.get_ylabel()
        assert "[" in axes.get_xlabel() or not axes.xaxis.get_tick_params().get("labelbottom", True)


def test_texts_carry_the_angles():
    text = PICTURES["polar_angles"]().alt
    for words in (
        "sight is at 55 deg",
        "heads 15 deg",
        "the goal -25 deg",
        "sight, is 40 deg",
        "sight, is 80 deg",
        "robot's, is 40 deg",
    ):
        assert words in text
    text = PICTURES["third_angle"]().alt
    assert "theta = 80 deg, turned from the goal's heading to the line of sight" in text
    assert (
        "beta = -80 deg, turned back from the line of sight to the goal's heading, as in Corke, Siegwart, PythonRobotics"
        in text
    )
    assert "one: ends 0.10 m from the goal, its heading 11 deg off" in PICTURES["ways"]().alt


def test_arcs_begin_and_end_on_their_sides():
    """Theta's arc runs from the goal's heading to the line of sight, beta's the other way; both are drawn to one scale."""
    figure = PICTURES["third_angle"]().figure
    figure.canvas.draw()
    theta_axes, beta_axes = figure.axes
    np.testing.assert_allclose(
        theta_axes.get_position().size, beta_axes.get_position().size, rtol=1e-3
    )
    assert theta_axes.get_position().y0 == pytest.approx(beta_axes.get_position().y0, abs=1e-3)
    assert (theta_axes.get_xlim(), theta_axes.get_ylim()) == (
        beta_axes.get_xlim(),
        beta_axes.get_ylim(),
    )
    sight = math.atan2(GOAL.y, GOAL.x)
    for axes, begin, end in ((theta_axes, GOAL.heading, sight), (beta_axes, sight, GOAL.heading)):
        x, y = axes.lines[-1].get_data()
        angles = np.arctan2(y - GOAL.y, x - GOAL.x)
        assert angles[0] == pytest.approx(begin)
        assert angles[-1] == pytest.approx(end, abs=0.05)  # the rest is the arrowhead
        assert np.ptp(np.hypot(x - GOAL.x, y - GOAL.y)) < 1e-9


@pytest.mark.parametrize("name", ["polar_angles", "polar_angles, clockwise", "third_angle"])
def test_no_name_lies_on_the_line_of_sight(name):
    figure = PICTURES[name]().figure
    figure.canvas.draw()
    for axes in figure.axes:
        line = next(
            each
            for each in axes.lines
            if each.get_linestyle() == "--" and len(each.get_xdata()) == 2
        )
        ends = axes.transData.transform(np.column_stack(line.get_data()))
        points = ends[0] + np.linspace(-0.2, 1.2, 400)[:, None] * (ends[1] - ends[0])
        for text in axes.texts:
            if text.get_text() in ("robot", "goal"):
                box = text.get_window_extent()
                assert not any(box.contains(*point) for point in points)


def test_the_headings_arcs_are_named():
    said = [text.get_text() for text in PICTURES["polar_angles"]().figure.axes[0].texts]
    assert {"15 deg", "-25 deg"} <= set(said)
    assert "black arc from east" in PICTURES["polar_angles"]().alt


def test_angles_over_time_are_the_runs():
    alpha_axes, theta_axes = PICTURES["angles_over_time"]().figure.axes
    np.testing.assert_allclose(alpha_axes.lines[0].get_ydata(), np.degrees(RUNS[0].alpha))
    np.testing.assert_allclose(theta_axes.lines[0].get_ydata(), np.degrees(RUNS[0].theta))


def test_ways_show_where_each_robot_ends():
    axes = figures.ways({"one": WAY}, ORIGIN).figure.axes[0]
    assert axes.get_aspect() == 1.0
    for dart, heading in zip(axes.patches, (1.0, 0.2, 0.0), strict=True):  # start, end, goal
        tip, tail = dart.get_xy()[0], dart.get_xy()[2]
        assert math.atan2(tip[1] - tail[1], tip[0] - tail[0]) == pytest.approx(heading)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: figures.ways({}, ORIGIN),
            r"tracks has 0 entries, which is not allowed: 1 to 4 are needed",
        ),
        (lambda: figures.ways({"one": WAY}, (0, 0, 0)), r"a Pose is needed, not a tuple"),
        (lambda: figures.angles_over_time([]), r"runs has 0 entries"),
        (lambda: figures.polar_angles((0, 0, 0), GOAL), r"a Pose is needed, not a tuple"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
