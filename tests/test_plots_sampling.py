"""Figures of time steps, inner loops and wheel limits: the checks of every figure, and that they draw the numbers they are given."""

import math

import numpy as np
import pytest
from test_plots import test_every_axis_says_what_it_shows_and_in_which_unit as check_axes
from test_plots import test_every_picture_draws_and_has_its_text as check_picture

import wmrlib as wmr
from wmrbook import figures

CASE = wmr.paper.outdoor()
GENTLE = wmr.Gains(0.2, 2.0, 2.0)
STEPS = np.array([0.02, 0.1, 0.7, 1.0])
BOTH = {"the paper's gains": CASE.gains, "gentle gains": GENTLE}
LATE = wmr.simulate(CASE.start, CASE.goal, CASE.gains, method="continuous", wheel_lag=0.1)
AT_ONCE = wmr.simulate(CASE.start, CASE.goal, CASE.gains, method="continuous")
T = np.linspace(0.0, 1.0, 51)
WAY = [wmr.Pose(0.0, 0.0, 0.5), wmr.Pose(1.0, 0.0, 0.5), wmr.Pose(1.0, 3.0, 0.5)]
PICTURES = {
    "time_steps": lambda: figures.time_steps(CASE.start, CASE.goal, BOTH, STEPS),
    "orders": lambda: figures.orders(STEPS, {"linear": 3.0 * STEPS, "square": STEPS**2}),
    "responses": lambda: figures.responses(
        T, {"quick": 1.0 - np.exp(-10.0 * T), "slow": 1.0 - np.exp(-5.0 * T)}
    ),
    "inner_loops": lambda: figures.inner_loops(
        {"one": {"slow": LATE, "at once": AT_ONCE}, "two": {"slow": LATE}}
    ),
    "driven": lambda: figures.driven({"all of it": WAY, "part": WAY[:2]}, WAY[-1]),
}


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture(name, monkeypatch):
    monkeypatch.setattr("test_plots.PICTURES", PICTURES)
    check_picture(name)
    check_axes(name)


def test_texts_carry_the_numbers():
    assert (
        "linear with slope 1.00, 3 at 1 s; square with slope 2.00, 1 at 1 s"
        in PICTURES["orders"]().alt
    )
    assert (
        "quick reaches 63 % after 0.100 s; slow reaches 63 % after 0.200 s"
        in PICTURES["responses"]().alt
    )
    assert "all of it: 4.0 m, as far as x = 1.0 m; part: 1.0 m" in PICTURES["driven"]().alt
    assert PICTURES["driven"]().alt.endswith(
        'part: 1.0 m, as far as x = 1.0 m, at most 0.00 m beside the first. Not to be told from the first: "part".'
    )
    ends = [math.degrees(wmr.arrival(run).heading_error) for run in (LATE, AT_ONCE)]
    assert (
        f"one, slow: {ends[0]:.0f} deg; one, at once: {ends[1]:.0f} deg; two, slow: {ends[0]:.0f} deg"
        in PICTURES["inner_loops"]().alt
    )


def test_driven_says_how_far_a_path_strays_and_what_its_arrows_are():
    aside = [wmr.Pose(0.0, 0.0, 0.5), wmr.Pose(2.0, 1.5, 0.5), wmr.Pose(1.0, 3.0, 0.5)]
    picture = figures.driven(
        {
            "all of it": WAY,
            "aside": aside,
            "near": [each._replace(x=each.x + 0.01) for each in WAY],
        },
        WAY[-1],
    )
    assert (
        "as far as x = 2.0 m, at most 1.00 m beside the first; near: 4.0 m, as far as x = 1.0 m, at most 0.01 m beside"
        in picture.alt
    )
    assert picture.alt.endswith('Not to be told from the first: "near".')
    beyond = figures.driven(
        {"part": WAY, "beyond": [*WAY, wmr.Pose(1.0, 5.0, 0.5)]}, WAY[-1]
    )  # on the line, but not on the path
    assert "at most 2.00 m beside the first" in beyond.alt
    assert [text.get_text() for text in picture.figure.axes[0].get_legend().get_texts()] == [
        "all of it",
        "aside",
        "near",
        "start",
        "goal",
    ]


def test_time_steps_draw_each_run_and_each_limit():
    picture = PICTURES["time_steps"]()
    axes = picture.figure.axes[0]
    drawn = {line.get_label(): line for line in axes.lines}
    for method in ("arc", "euler"):
        runs = [
            wmr.arrival(wmr.simulate(CASE.start, CASE.goal, CASE.gains, method=method, dt=dt))
            for dt in STEPS.tolist()
        ]
        wanted = [abs(math.degrees(run.heading_error)) if run.arrived else math.nan for run in runs]
        np.testing.assert_allclose(drawn[method].get_ydata(), wanted)
        assert any(
            set(line.get_xdata()) == {wmr.longest_step(CASE.gains, method)} for line in axes.lines
        )
    assert (
        "the paper's gains, euler: 46 deg at 0.02 s, longest step 0.011 s, 2 of 4 runs lost"
        in picture.alt
    )
    last = math.degrees(
        wmr.arrival(wmr.simulate(CASE.start, CASE.goal, GENTLE, method="arc", dt=0.7)).heading_error
    )
    assert (
        f"gentle gains, arc: 2 deg at 0.02 s, {abs(last):.0f} deg at 0.7 s, longest step 0.714 s"
        in picture.alt
    )


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: figures.time_steps(CASE.start, CASE.goal, {"one": GENTLE}, STEPS),
            r"gains has 1 entries, .* 2 are needed",
        ),
        (lambda: figures.inner_loops({}), r"cases has 0 entries"),
        (lambda: figures.driven({}, WAY[0]), r"paths has 0 entries, .* 1 to 5 are needed"),
        (lambda: figures.orders(STEPS, {str(k): STEPS for k in range(6)}), r"errors has 6 entries"),
        (lambda: figures.responses(T, {}), r"series has 0 entries"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
