"""Figures that compare runs, and the block diagram: as test_plots, and that each draws what it was given."""

import dataclasses
import html
import io
import math

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import figures
from wmrlib import paper

CASE = paper.outdoor()
RUN = wmr.simulate(CASE.start, CASE.goal, CASE.gains, method="continuous")
NORTH = paper.outdoor("north")
OTHER = wmr.simulate(NORTH.start, NORTH.goal, NORTH.gains, law="printed")
CHASE = wmr.track(paper.circle, paper.CIRCLE_START, paper.CIRCLE_GAINS, duration=40.0)
LIMITS = np.array([1.0, 2.0, 4.0])
LEFT = np.array([0.524, 0.199, 0.090])


def predict(v_max):
    """What `LEFT` is nearly."""
    return np.interp(v_max, LIMITS, LEFT - 0.001)


GROUPS = {
    "one": (np.array([1.0, 2.0]), np.array([0.5, 0.4])),
    "two": (np.array([3.0]), np.array([0.25])),
}
PICTURES = {
    "together": lambda: figures.together({"one": RUN, "two": OTHER}, "v", level=(4.0, "the limit")),
    "together, logarithmic": lambda: figures.together({"one": CHASE}, "rho", log=True, until=15.0),
    "snapshots, tall": lambda: figures.snapshots(RUN, [0.0, 5.0, 10.0, RUN.t[-1]]),
    "snapshots, wide": lambda: figures.snapshots(OTHER, [0.0, 5.0, OTHER.t[-1]]),
    "chase": lambda: figures.chase({"one": CHASE}),
    "residual_curve": lambda: figures.residual_curve(LIMITS, LEFT, predict, published=0.1),
    "heading_shares": lambda: figures.heading_shares(
        {"one": np.array([1.0, 2.0, -4.0, 30.0]), "two": np.array([4.0])}
    ),
    "tradeoff": lambda: figures.tradeoff(
        GROUPS, (1.5, 0.3, "ours"), xlabel="peak speed [m/s]", ylabel="rms distance [m]"
    ),
    "block_diagram": lambda: figures.block_diagram(0.1, 10.0),
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
    assert "-0.0 " not in picture.alt
    pixels = imread(io.BytesIO(bundle["image/png"]))[..., :3]
    assert 0.01 < np.mean(pixels.min(axis=2) < 0.9) < 0.7  # neither blank nor flooded


@pytest.mark.parametrize("name", [name for name in PICTURES if name != "block_diagram"])
def test_every_axis_says_what_it_shows_and_in_which_unit(name):
    for axes in PICTURES[name]().figure.axes:
        assert "[" in axes.get_ylabel() or not axes.yaxis.get_tick_params().get("labelleft", True)
        assert "[" in axes.get_xlabel() or not axes.xaxis.get_tick_params().get("labelbottom", True)


def test_texts_carry_the_numbers():
    assert "one goes from 3.96 to 0.36 m/s" in PICTURES["together"]().alt
    assert "a dotted line marks the limit, 4 m/s" in PICTURES["together"]().alt
    assert "b after 5.0 s, 38.1 m to go, heading 84 deg" in PICTURES["snapshots, tall"]().alt
    assert "the goal's heading is -60 deg" in PICTURES["snapshots, tall"]().alt
    assert (
        "a dotted line marks the 4 m/s of the paper."
        in figures.together({"one": RUN}, "v", level=(4.0, "the 4 m/s of the paper")).alt
    )
    assert "differ by at most 0.0010 m" in PICTURES["residual_curve"]().alt
    assert "one goes from 2.2 to 0.09 m" in PICTURES["together, logarithmic"]().alt
    assert (
        "one 25.0 % end more than 5 deg off, the worst 30.0 deg" in PICTURES["heading_shares"]().alt
    )
    assert "two 0.0 % end" in PICTURES["heading_shares"]().alt
    assert "one from 0.4 to 0.5" in PICTURES["tradeoff"]().alt
    assert "every 0.1 s" in PICTURES["block_diagram"]().alt
    assert "every 0.01 s" in PICTURES["block_diagram"]().alt


def test_together_draws_the_field_it_was_asked_for():
    for field in ("v", "omega", "x_error", "y_error", "rho"):
        axes = figures.together({"one": RUN, "two": OTHER}, field).figure.axes[0]
        drawn = axes.lines[-2:]
        assert np.array_equal(drawn[0].get_ydata(), getattr(RUN, field))
        assert np.array_equal(drawn[1].get_ydata(), getattr(OTHER, field))
        assert drawn[0].get_linestyle() != drawn[1].get_linestyle()  # never colour alone


def test_snapshots_show_the_robot_where_it_was_and_how_it_looked():
    panels = PICTURES["snapshots, tall"]().figure.axes
    for axes, moment in zip(panels, (0.0, 5.0, 10.0, RUN.t[-1]), strict=True):
        goal, robot = axes.patches
        k = int(np.abs(RUN.t - moment).argmin())
        for dart, x, y, heading in (
            (goal, *CASE.goal),
            (robot, RUN.x[k], RUN.y[k], RUN.heading[k]),
        ):
            tip, tail = dart.get_xy()[0], dart.get_xy()[2]
            assert math.atan2(tip[1] - tail[1], tip[0] - tail[0]) == pytest.approx(
                math.remainder(heading, 2 * math.pi)
            )
            assert np.hypot(*(0.5 * (tip + tail) - [x, y])) < 2.0
        assert np.array_equal(axes.lines[1].get_xdata(), RUN.x[: k + 1])
        assert np.array_equal(axes.lines[1].get_ydata(), RUN.y[: k + 1])
        assert axes.get_aspect() == 1.0


def test_chase_draws_the_reference_and_each_run():
    axes = figures.chase({"one": CHASE, "two": CHASE}).figure.axes[0]
    reference, *runs = axes.lines
    assert np.array_equal(reference.get_xydata(), np.column_stack([CHASE.goal.x, CHASE.goal.y]))
    assert len(runs) == 2
    for run in runs:
        assert np.array_equal(run.get_xydata(), np.column_stack([CHASE.x, CHASE.y]))
    for dart, place, heading in zip(
        axes.patches, ((1.0, 2.0), (0.0, 0.0)), (0.0, math.pi / 2), strict=True
    ):  # robot and goal at 0 s
        tip, tail = dart.get_xy()[0], dart.get_xy()[2]
        assert math.atan2(*(tip - tail)[::-1]) == pytest.approx(heading, abs=1e-6)
        assert np.hypot(*(0.5 * (tip + tail) - place)) < 0.3
    assert [(text.get_text(), text.xy) for text in axes.texts] == [("goal at 0 s", (0.0, 0.0))]


def test_a_chase_says_what_the_goal_does():
    circle = "A grey reference circle of radius 4 m about (-4, 0) m, driven once round counter-clockwise from (0, 0) m"
    robot = "and the robot that starts at (1, 2) m; distance from the goal at the end: one 0.090 m."
    assert PICTURES["chase"]().alt == f"{circle}, {robot}"
    assert "and 2 robots that start at (1, 2) m" in figures.chase({"one": CHASE, "two": CHASE}).alt
    x, y, heading = CHASE.goal
    half = len(CHASE) // 2

    def told(x, y):
        return figures.chase({"one": dataclasses.replace(CHASE, goal=wmr.Pose(x, y, heading))}).alt

    assert "driven once round clockwise from (0, 0) m" in told(x, -y)
    stop = np.minimum(np.arange(len(CHASE)), half)
    assert "driven 0.5 times round counter-clockwise" in told(x[stop], y[stop])
    assert told(x, x + 1.0).startswith("A grey reference from (0, 1) m to ")
    assert told(0.0 * x + 2.0, 0.0 * y).startswith(
        "A goal that stands still at (2, 0) m, and the robot"
    )


def test_on_a_logarithmic_scale_nothing_is_drawn_below_a_millionth():
    tiny = dataclasses.replace(CHASE, rho=np.geomspace(1.0, 1e-9, len(CHASE)))
    axes = figures.together({"one": tiny}, "rho", log=True).figure.axes[0]
    drawn = axes.lines[-1].get_ydata()
    assert np.isnan(drawn[tiny.rho < 1e-6]).all()
    assert np.array_equal(drawn[tiny.rho >= 1e-6], tiny.rho[tiny.rho >= 1e-6])
    assert axes.get_ylim()[0] == 1e-6
    assert figures.together({"one": CHASE}, "rho", log=True).figure.axes[0].get_ylim()[0] > 0.01


def test_a_course_is_told_once():
    """No range where the ends are the range; and what rounds to zero is not called zero."""
    assert PICTURES["together, logarithmic"]().alt.endswith("one goes from 2.2 to 0.09 m.")
    assert figures.together({"one": CHASE}, "omega").alt.endswith("rad/s.")
    assert ", between " in figures.together({"one": CHASE}, "omega").alt
    near = dataclasses.replace(CHASE, rho=np.linspace(1.0, 1e-4, len(CHASE)))
    assert figures.together({"one": near}, "rho").alt.endswith(
        "one goes from 1.00 to less than 0.01 m."
    )
    x = CHASE.x + np.linspace(1.0, -1e-4, len(CHASE))
    past = dataclasses.replace(CHASE, goal=CHASE.goal._replace(x=x))
    assert figures.together({"one": past}, "x_error").alt.endswith(
        "one goes from 1.00 to nearly 0 m."
    )


def test_tradeoff_and_residual_curve_draw_their_points():
    one, two, star = PICTURES["tradeoff"]().figure.axes[0].lines[:3]
    assert one.get_xydata().tolist() == [[1.0, 0.5], [2.0, 0.4]]
    assert one.get_marker() != two.get_marker()
    assert star.get_xydata().tolist() == [[1.5, 0.3]]
    line, circles, level = PICTURES["residual_curve"]().figure.axes[0].lines
    assert np.array_equal(line.get_ydata(), predict(line.get_xdata()))
    assert np.array_equal(circles.get_xydata(), np.column_stack([LIMITS, LEFT]))
    assert set(level.get_ydata()) == {0.1}


def test_the_share_at_an_error_is_that_of_the_runs_below_it():
    line = PICTURES["heading_shares"]().figure.axes[0].lines[0]
    assert line.get_xdata()[1:-1].tolist() == [1.0, 2.0, 4.0, 30.0]
    assert line.get_ydata()[1:-1].tolist() == [25.0, 50.0, 75.0, 100.0]


def test_the_block_diagram_goes_round_in_the_order_of_the_data():
    said = [text.get_text() for text in figures.block_diagram(0.2, 4.0).figure.axes[0].texts]
    order = ["GPS", "geodesy", "polar error", "control law", "wheel loop", "robot"]
    assert [text for text in said if text in order][:6] == order
    assert "wheel speeds, fed back every 0.05 s" in said


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: figures.together({}, "v"),
            r"runs has 0 entries, which is not allowed: 1 to 5 are needed",
        ),
        (lambda: figures.together({str(k): RUN for k in range(6)}, "v"), r"runs has 6 entries"),
        (
            lambda: figures.together({"one": RUN}, "speed"),
            r"field = 'speed' is not allowed: one of 'v'",
        ),
        (
            lambda: figures.together({"one": 3}, "v"),
            r"runs\['one'\] = 3 is not allowed: a Trajectory is needed",
        ),
        (lambda: figures.chase([CHASE]), r"runs = .* is not allowed: a Mapping is needed"),
        (
            lambda: figures.snapshots(RUN, [0.0]),
            r"times has 1 entries, which is not allowed: 2 to 6 are needed",
        ),
        (
            lambda: figures.snapshots(RUN, [0.0, 99.0]),
            r"times = .* is not allowed: a finite number at least 0 and at most 15.5",
        ),
        (
            lambda: figures.residual_curve(LIMITS, LEFT[:2], predict, published=0.1),
            r"mismatched lengths",
        ),
        (lambda: figures.heading_shares({"one": np.array([math.nan])}), r"one = .* is not allowed"),
        (
            lambda: figures.tradeoff(
                {"one": (0.0, 1.0)}, (1, 1, "a"), xlabel="x [m]", ylabel="y [m]"
            ),
            r"one x = 0.0 is not allowed",
        ),
        (lambda: figures.block_diagram(0.0, 10.0), r"time_step = 0.0 is not allowed"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
