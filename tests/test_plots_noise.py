"""Figures of noise: each draws, has axes with units, and an alternative text with the numbers of what it shows."""

import html
import io
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import figures

GOAL = wmr.Pose(9.0, 57.0, 1.0)
FOUND = wmr.stationary_scatter(
    wmr.read_track(Path(__file__).parent.parent / "notebooks" / "data" / "ublox5-standing.nmea")
)
RANDOM = np.random.default_rng(4)
ENDS = wmr.Pose(
    9.0 + RANDOM.normal(0, 0.2, 300),
    57.0 + RANDOM.normal(0, 0.2, 300),
    1.0 + np.linspace(-3.1, 3.1, 300),
)
RADII, SIGMAS, STEPS = np.array([0.1, 0.3, 1.0]), np.array([0.0, 0.5, 1.0]), np.array([0.1, 1.2])
T = np.linspace(0.0, 10.0, 51)
PICTURES = {
    "scatter": lambda: figures.scatter(FOUND),
    "end_poses": lambda: figures.end_poses(ENDS, GOAL, 0.05),
    "arrival_radii": lambda: figures.arrival_radii(
        RADII, np.array([0.2, 0.5, 1.4]), np.array([80.0, 34.0, 60.0]), 0.5
    ),
    "near_goal": lambda: figures.near_goal(
        {"one": wmr.Pose(T, 57.0 + 0.0 * T, 0.0 * T), "two": wmr.Pose(T - 2.0, T + 49.0, 0.0 * T)},
        GOAL,
    ),
    "rising": lambda: figures.rising(
        {"falls": (T, 1.5 * np.exp(-T)), "waves": (T, 2.0 + np.sin(T))}
    ),
    "rising, one": lambda: figures.rising({"falls": (T, np.exp(-T))}),
    "rise_map": lambda: figures.rise_map(
        SIGMAS, STEPS, np.array([[0.0, 3.0, 18.0], [48.0, 47.0, 46.0]])
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
    assert "-0.0 " not in picture.alt
    pixels = imread(io.BytesIO(bundle["image/png"]))[..., :3]
    assert (
        0.01 < np.mean(pixels.min(axis=2) < 0.9) < (0.9 if name == "rise_map" else 0.7)
    )  # neither blank nor flooded


@pytest.mark.parametrize("name", PICTURES)
def test_every_axis_says_what_it_shows_and_in_which_unit(name):
    for axes in PICTURES[name]().figure.axes:
        assert "[" in axes.get_ylabel()
        if axes.get_label() != "<colorbar>":
            assert "[" in axes.get_xlabel() or not axes.xaxis.get_tick_params().get(
                "labelbottom", True
            )


def test_texts_carry_the_numbers():
    assert "9 positions" in figures.scatter(FOUND).alt
    assert (
        "they walk from 7.5 m west and 0.5 m south to 2.7 m east and 0.6 m north, where the last two are one"
        in figures.scatter(FOUND).alt
    )
    assert "a dashed circle of 2.1 m holds half of them" in figures.scatter(FOUND).alt
    assert "150 of 300 robots" in PICTURES["end_poses"]().alt
    assert (
        "the heading errors of all: about 15 % within 30 deg, about 50 % more than 90 deg off"
        in PICTURES["end_poses"]().alt
    )
    assert (
        "goes from 0.2 to 1.4 m, the heading error is smallest, about 35 deg, near 0.3 m"
        in PICTURES["arrival_radii"]().alt
    )
    assert "one, 1.0 m from the goal; two, 2.2 m from the goal" in PICTURES["near_goal"]().alt
    assert "falls, 0 %; waves, 45 %" in PICTURES["rising"]().alt
    assert (
        "0 % with no noise and a step of 0.1 s, about 20 % with 1 m of noise, and about 50 % with no noise"
        in PICTURES["rise_map"]().alt
    )


def test_scatter_says_how_many_positions_are_the_last_dot():
    place = wmr.point_at(
        wmr.paper.GPS_POINT_1,
        np.array([0.0, 3.0, 5.0, 5.0, 5.0]),
        np.array([0.0, -1.0, 1.0, 1.0, 1.0]),
    )
    for count, word in ((2, "last"), (3, "last"), (4, "last two"), (5, "last three")):
        found = wmr.stationary_scatter(wmr.GeoPoint(lat=place.lat[:count], lon=place.lon[:count]))
        picture = figures.scatter(found)
        assert [text.get_text() for text in picture.figure.axes[0].texts] == ["first", word]
        assert (f"the {word} are one dot" in picture.alt) == (count > 3)


def test_end_poses_say_how_many_are_drawn():
    place, heading = PICTURES["end_poses"]().figure.axes
    assert place.get_title().startswith("150 of 300 robots")
    assert len(place.patches) == 150 + 4  # goal and circle, each with its rim
    assert heading.get_title() == "all 300"
    few = figures.end_poses(wmr.Pose(*(field[:20] for field in ENDS)), GOAL, 0.05)
    assert few.alt.startswith("Left, all 20 robots")


def test_v_is_thick_and_red_where_it_rises_and_only_there():
    falls, waves = PICTURES["rising"]().figure.axes
    assert [len(lines.get_segments()) for lines in falls.collections] == [50, 0]
    values = 2.0 + np.sin(T)
    assert len(waves.collections[1].get_segments()) == int((np.diff(values) > 0).sum())
    assert waves.collections[1].get_linewidth()[0] > 2 * waves.collections[0].get_linewidth()[0]


def test_robots_stand_where_they_ended():
    axes = PICTURES["near_goal"]().figure.axes[0]
    first = axes.patches[0].get_xy()[:-1].mean(axis=0)
    assert first == pytest.approx([10.0, 57.0], abs=0.3)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: figures.scatter(ENDS), "a StationaryScatter is needed, not a Pose"),
        (lambda: figures.end_poses((1, 2, 3), GOAL, 0.1), "a Pose is needed"),
        (
            lambda: figures.near_goal({}, GOAL),
            "paths has 0 entries, which is not allowed: 1 to 4 are needed",
        ),
        (lambda: figures.arrival_radii(RADII, RADII, np.ones(2), 0.5), "mismatched lengths"),
        (
            lambda: figures.rise_map(SIGMAS, STEPS, np.ones((3, 2))),
            r"share has shape \(3, 2\).*\(2, 3\), one row a dt",
        ),
        (lambda: figures.rise_map(SIGMAS, STEPS, np.full((2, 3), 101.0)), "at most 100"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
