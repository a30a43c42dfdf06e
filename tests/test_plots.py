"""Figures: each has its alternative text, with the numbers of the run, and draws what the run holds."""

import html
import io
import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import figures
from wmrlib import plots

PAPER = wmr.paper.outdoor()
RUN = wmr.simulate(PAPER.start, PAPER.goal, PAPER.gains, method="continuous")
CIRCLE = wmr.track(
    wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS, law="printed", duration=40.0
)
STANDING = wmr.simulate(PAPER.goal, PAPER.goal, PAPER.gains)
PICTURES = {
    "local_map": lambda: figures.local_map(wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2),
    "path": lambda: plots.path(RUN),
    "paths": lambda: plots.path([RUN, STANDING], ["one", "two"]),
    "arrival": lambda: plots.arrival(RUN),
    "twist": lambda: plots.twist(RUN),
    "errors": lambda: plots.errors(RUN),
    "lyapunov": lambda: plots.lyapunov(RUN),
    "dashboard": lambda: plots.dashboard(RUN),
    "dashboard of a circle": lambda: plots.dashboard(CIRCLE),
    "dashboard of a single sample": lambda: plots.dashboard(STANDING),
}


def _seen_in_a_mirror():
    start, goal = (wmr.Pose(pose.x, -pose.y, -pose.heading) for pose in (PAPER.start, PAPER.goal))
    return wmr.simulate(start, goal, PAPER.gains, method="continuous")


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_draws_and_has_its_text(name):
    picture = PICTURES[name]()
    bundle, metadata = picture._repr_mimebundle_()
    assert metadata["image/png"]["alt"] == picture.alt
    assert bundle["text/plain"] == f"<Picture: {picture.alt}>"
    assert bundle["text/html"].startswith(f'<img alt="{html.escape(picture.alt)}" width=')
    assert len(picture.alt) > 60
    assert picture.alt.endswith(".")
    assert "nan" not in picture.alt
    assert "-0.0 " not in picture.alt
    pixels = imread(io.BytesIO(bundle["image/png"]))[..., :3]
    assert pixels.shape[1] == pytest.approx(1.5 * metadata["image/png"]["width"], abs=2)
    assert 0.01 < np.mean(pixels.min(axis=2) < 0.9) < 0.7  # neither blank nor flooded


@pytest.mark.parametrize("name", PICTURES)
def test_every_axis_says_what_it_shows_and_in_which_unit(name):
    for axes in PICTURES[name]().figure.axes:
        assert "[" in axes.get_ylabel()
        assert "[" in axes.get_xlabel() or not axes.xaxis.get_tick_params().get("labelbottom", True)


def test_texts_carry_the_numbers():
    assert "58.08 m long, at a bearing of 9.58 deg" in PICTURES["local_map"]().alt
    assert (
        "stops 0.05 m from it, its heading 27 deg clockwise of the open arrow"
        in plots.arrival(RUN).alt
    )
    assert "deg counter-clockwise of the open arrow" in plots.arrival(_seen_in_a_mirror()).alt
    assert (
        "x error goes from 9.7 m to 0.0 m, the y error from 57.3 m to 0.0 m"
        in plots.errors(RUN).alt
    )
    assert "from 1690 to 0.132; V falls in every step" in plots.lyapunov(RUN).alt


def test_the_twist_is_told_as_it_goes():
    v, omega = plots.twist(RUN).alt.split("; ")
    until = RUN.t[RUN.v > 0.95 * PAPER.gains.v_max][-1]
    assert "v goes from 4.0 to 0.4 m/s, within 5 % of its peak, 4.0 m/s, from 0.0 to " in v
    assert v.endswith(f" to {until:.1f} s")
    assert (
        omega
        == "omega goes from 0.2 to -4.1 rad/s, within 5 % of its peak, -4.3 rad/s, from 15.4 to 15.5 s."
    )
    wave = replace(RUN, omega=np.sin(RUN.t))  # up again and again: no one spell
    assert plots.twist(wave).alt.endswith(
        "omega goes from 0.0 to 0.2 rad/s, between -1.0 and 1.0 rad/s."
    )


def test_a_path_that_begins_backwards_says_so():
    away = math.pi + 0.1
    runs = [
        wmr.simulate(wmr.Pose(-10.0, 0.0, sign * away), wmr.Pose(0.0, 0.0, 0.0), PAPER.gains)
        for sign in (1, -1)
    ]
    turning = int(np.flatnonzero(runs[0].v > 0)[0])
    one = f"backs up for the first {runs[0].t[turning]:.1f} s as far as ({runs[0].x[turning]:.1f}, {runs[0].y[turning]:.1f}) m"
    alt = plots.path(runs, ["one", "two"]).alt
    assert alt.startswith(
        "Path in metres: one: the robot starts at (-10.0, 0.0) m heading -174 deg, "
    )  # wrapped
    assert "two: the robot starts at (-10.0, 0.0) m heading 174 deg, " in alt
    assert one in alt
    assert alt.endswith("; the two paths are mirror images.")
    assert "mirror" not in plots.path([runs[0], runs[0]]).alt
    assert "mirror" not in plots.path([RUN, STANDING]).alt
    assert "backs up" not in plots.path(RUN).alt


def test_v_is_red_where_it_rises_and_only_there():
    figure = plots.lyapunov(CIRCLE).figure
    falling, rising = figure.axes[0].collections
    share = np.diff(CIRCLE.V) > 1e-9 * CIRCLE.V[0]
    assert 0 < share.sum() < share.size
    assert (len(falling.get_segments()), len(rising.get_segments())) == (
        (~share).sum(),
        share.sum(),
    )
    assert rising.get_linewidth()[0] > 2 * falling.get_linewidth()[0]  # a shape beside the colour
    assert len(plots.lyapunov(RUN).figure.axes[0].collections) == 1


def test_path_has_equal_scales_and_the_robots_heading():
    again = {name: np.append(getattr(RUN, name), getattr(RUN, name)[-1]) for name in "xy"}
    turned = replace(
        RUN, **again, heading=np.append(RUN.heading, 1.0)
    )  # at its end it turns on the spot
    for run, last in ((RUN, RUN.heading[-1]), (turned, 1.0)):
        axes = plots.path(run).figure.axes[0]
        assert axes.get_aspect() == 1.0
        assert len(axes.patches) == 12  # ten robots, goal and start
        end, goal, start = axes.patches[-3:]
        _check_darts(((end, last), (goal, PAPER.goal.heading), (start, PAPER.start.heading)))
        tip = goal.get_xy()[:, 1].max()
        assert tip < axes.get_ylim()[1] - 0.01 * np.ptp(axes.get_ylim())  # clear of the frame


def test_the_arrows_of_several_paths_have_one_size():
    near, far = (
        wmr.simulate(wmr.Pose(-far, 0.0, 0.5), wmr.Pose(0.0, 0.0, 0.0), PAPER.gains)
        for far in (5.0, 20.0)
    )
    darts = [dart.get_xy() for dart in plots.path([near, far]).figure.axes[0].patches]
    lengths = [np.linalg.norm(dart[0] - dart[2]) for dart in darts]
    assert len(lengths) == 4
    np.testing.assert_allclose(lengths, lengths[0])


def _check_darts(darts):
    for dart, heading in darts:
        tip, tail = dart.get_xy()[0], dart.get_xy()[2]
        assert math.atan2(tip[1] - tail[1], tip[0] - tail[0]) == pytest.approx(heading)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: plots.path([]), r"runs has 0 entries, which is not allowed: 1 to 4 are needed"),
        (lambda: plots.path([RUN] * 5), r"runs has 5 entries"),
        (
            lambda: plots.path([RUN, STANDING], ["one"]),
            r"labels has 1 entries, which is not allowed: one for each of the 2 runs is needed",
        ),
        (
            lambda: figures.local_map((33, 44), wmr.paper.GPS_POINT_1),
            r"a GeoPoint is needed, not a tuple",
        ),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
