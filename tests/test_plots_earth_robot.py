"""Figures of the Earth and of the robot: each has its text with its numbers, and draws what the library computes."""

import html
import io
import math

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import figures

HERE, THERE = wmr.GeoPoint(lat=5.0, lon=0.0), wmr.GeoPoint(lat=35.0, lon=70.0)
GAPS = np.array([1e-6, 1e-3, 1.0])
ERRORS = {
    "one": (np.array([0.0, 1e-9, 5e-9]), np.array([0.02, 1e-3, 1e-4])),
    "two": (GAPS * 1e-16, np.array([math.nan, 1e-9, 1e-9])),
}
PICTURES = {
    "spherical_triangle": lambda: figures.spherical_triangle(HERE, THERE),
    "rounding_errors": lambda: figures.rounding_errors(GAPS, GAPS, ERRORS),
    "sphere_error_map": lambda: figures.sphere_error_map(
        wmr.paper.GPS_POINT_1, math.radians(9.6274)
    ),
    "coordinate_system": lambda: figures.coordinate_system(
        wmr.Pose(2.0, 1.5, math.radians(35.0)), 1.0, 0.25
    ),
    "turning_centre": lambda: figures.turning_centre(1.0, 0.8, 0.6),
    "turning_centre to the right": lambda: figures.turning_centre(1.0, -2.5, 0.6),
    "commutator": lambda: figures.commutator(1.0, 0.5, 3),
    "approach": lambda: figures.approach(wmr.paper.OUTDOOR_GAINS),
    "steps": lambda: figures.steps(4.0, 1.0, 0.5),
}
NUMBERS = {
    "spherical_triangle": "c = 70.8 deg long and leaves point 1 at the bearing br = 54.6 deg",
    "rounding_errors": "one: left level, below 10 nm, right rising as the gap closes, below 1 m; two: left falling as the gap",
    "sphere_error_map": "from -0.45 % at the poles to +0.56 % northwards on the equator, with -0.11 % eastwards there",
    "coordinate_system": "35 deg from east",
    "turning_centre": "left wheel, 0.76 m/s, of its middle, 1.00 m/s, and of its right wheel, 1.24 m/s",
    "turning_centre to the right": "0.40 m to the right",
    "commutator": "at x = 0.367 m and y = -1.438 m",
    "approach": "-6.00 to 6.00 rad/s at 0.001 m",
    "steps": "a circle of 4.0 m radius",
}


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_draws_and_has_its_text(name):
    picture = PICTURES[name]()
    bundle, metadata = picture._repr_mimebundle_()
    assert bundle["text/html"].startswith(f'<img alt="{html.escape(picture.alt)}" width=')
    assert len(picture.alt) > 60
    assert picture.alt.endswith(".")
    assert "nan" not in picture.alt
    pixels = imread(io.BytesIO(bundle["image/png"]))[..., :3]
    assert pixels.shape[1] == pytest.approx(1.5 * metadata["image/png"]["width"], abs=2)
    assert (
        0.01 < np.mean(pixels.min(axis=2) < 0.9) < (0.9 if name == "sphere_error_map" else 0.7)
    )  # neither blank nor flooded
    assert NUMBERS[name] in picture.alt


@pytest.mark.parametrize("name", PICTURES)
def test_every_axis_says_what_it_shows_and_in_which_unit(name):
    for axes in PICTURES[name]().figure.axes:
        if name == "spherical_triangle":  # a globe has no axes
            assert not axes.axison
        else:
            assert "[" in axes.get_xlabel()
            assert "[" in axes.get_ylabel() or not axes.yaxis.get_tick_params()["labelleft"]


def test_an_error_of_zero_and_a_failure_are_left_out():
    for axes, sizes in zip(
        figures.rounding_errors(GAPS, GAPS, ERRORS).figure.axes, ([2, 3], [3, 2]), strict=True
    ):
        assert [line.get_xdata().size for line in axes.lines] == sizes


def test_an_error_that_has_its_peak_in_between_is_told_so():
    gaps = np.geomspace(1e-6, 1e6, 60)
    peak, flat = np.minimum(gaps, 1e-2 / gaps), np.full(60, 3e-9)
    alt = figures.rounding_errors(gaps, gaps, {"one": (peak, flat)}).alt
    assert alt.endswith(
        "one: left rising and then falling as the gap closes, below 1 m, right level, below 10 nm."
    )


def test_the_triangles_third_side_bulges_away_from_the_view():
    sides = [
        line
        for line in figures.spherical_triangle(HERE, THERE).figure.axes[0].lines
        if line.get_linewidth() == 3.0
    ]
    assert len(sides) == 3
    for line in sides:
        x, y = line.get_data()
        assert np.hypot(x, y).max() <= 1.0
        assert len(x) == 101


def test_the_maps_star_is_the_line_asked_for():
    axes = figures.sphere_error_map(wmr.paper.GPS_POINT_1, math.radians(9.6274)).figure.axes[0]
    assert [axes.lines[-1].get_xdata()[0], axes.lines[-1].get_ydata()[0]] == [
        pytest.approx(9.6274),
        pytest.approx(33.273572),
    ]
    assert any("+0.244 %" in text.get_text() for text in axes.texts)


def test_the_commutator_leads_sideways():
    axes = figures.commutator(0.2, 0.1).figure.axes[0]
    end = axes.patches[2].get_xy()[:4].mean(axis=0) + 0.2 * 0.07 * np.array(
        [0.25, 0.0]
    )  # the dart's corners lie 0.25 of its size behind
    assert end == pytest.approx([0.2 * (1 - math.cos(0.1)), -0.2 * math.sin(0.1)], abs=1e-9)


def test_eulers_steps_are_a_polygon_and_the_arcs_lie_on_the_circle():
    exact, arc, euler, _ = figures.steps(4.0, 1.0, 0.5).figure.axes[0].lines
    for line in (exact, arc):
        np.testing.assert_allclose(
            np.hypot(line.get_xdata(), line.get_ydata() - 4.0), 4.0, rtol=1e-12
        )
    np.testing.assert_allclose(
        np.hypot(np.diff(euler.get_xdata()), np.diff(euler.get_ydata())), 2.0, rtol=1e-12
    )
    for parts in (6, 12, 49):  # steps that divide the turn: the polygon closes and goes no further
        euler = figures.steps(4.0, 1.0, 2 * math.pi / parts).figure.axes[0].lines[2]
        assert euler.get_xdata().size == parts + 1
        assert math.hypot(euler.get_xdata()[-1], euler.get_ydata()[-1]) < 1e-12
    assert euler.get_ydata()[1] == 0.0  # the first step goes along the tangent


def test_at_the_goal_omega_still_depends_on_the_side():
    nearest = figures.approach(wmr.Gains(2.0, 1.0, 0.3), [0.5, 1e-6]).figure.axes[0].lines[1]
    assert np.interp(90.0, nearest.get_xdata(), nearest.get_ydata()) == pytest.approx(
        math.pi / 2, abs=1e-5
    )
    assert np.interp(0.0, nearest.get_xdata(), nearest.get_ydata()) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: figures.spherical_triangle((5, 0), THERE), r"a GeoPoint is needed, not a tuple"),
        (lambda: figures.sphere_error_map((5, 0), 0.0), r"a GeoPoint is needed, not a tuple"),
        (
            lambda: figures.rounding_errors(GAPS, GAPS, {}),
            r"errors has 0 entries, which is not allowed: 1 to 4 are needed",
        ),
        (
            lambda: figures.coordinate_system(wmr.Pose(0, 0, 0), 0.0, 0.1),
            r"track_width = 0\.0 .* above 0",
        ),
        (
            lambda: figures.coordinate_system(wmr.Pose(0, 0, 0), 1.0, -0.1),
            r"wheel_radius = -0\.1 .* above 0",
        ),
        (
            lambda: figures.turning_centre(1.0, 0.0, 0.6),
            r"omega = 0\.0 is not allowed: another number is needed",
        ),
        (lambda: figures.commutator(0.0, 0.5), r"step = 0\.0 .* above 0"),
        (lambda: figures.approach(wmr.Gains(2, 1, 1), [1, 2, 3, 4, 5]), r"distances has 5 entries"),
        (lambda: figures.steps(1.0, 0.0, 0.1), r"omega = 0\.0 is not allowed"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
