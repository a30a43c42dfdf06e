"""Figures of gains: texts with the numbers, axes with units, poles where the characteristic equation has them."""

import io
import re

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import figures

PAPER = wmr.paper.outdoor()
GENTLE = wmr.Gains(0.2, 2.0, 2.0, 4.0)
OVER = {"k_rho": np.array([0.1, 0.2, 0.5]), "h": np.array([1.0, 2.0, 4.0])}
TRIED = wmr.gain_map(PAPER.start, PAPER.goal, GENTLE, OVER, progress=False)
BEST = wmr.pareto(TRIED.time, np.abs(TRIED.heading_error))
ONE = wmr.arrival(wmr.simulate(PAPER.start, PAPER.goal, GENTLE, method="continuous"))
PICTURES = {
    "root_locus": lambda: figures.root_locus(PAPER.gains, "k_alpha", np.linspace(0.1, 20.0, 100)),
    "phase_portrait": lambda: figures.phase_portrait(
        {"the paper's": PAPER.gains, "gentle": GENTLE}, 0.5
    ),
    "front": lambda: figures.front(TRIED, BEST, {"gentle": ONE}),
}


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_draws_and_has_its_text(name):
    picture = PICTURES[name]()
    bundle, _ = picture._repr_mimebundle_()
    assert len(picture.alt) > 60
    assert picture.alt.endswith(".")
    assert any(letter.isdigit() for letter in picture.alt)
    assert 0.01 < np.mean(imread(io.BytesIO(bundle["image/png"]))[..., :3].min(axis=2) < 0.9) < 0.7
    for axes in picture.figure.axes:
        assert "[" in axes.get_ylabel()
        assert "[" in axes.get_xlabel() or axes.get_label() == "<colorbar>"


def test_the_crosses_are_the_roots():
    axes = PICTURES["root_locus"]().figure.axes[0]
    cross = next(line for line in axes.lines if line.get_marker() == "x")
    roots = np.roots([1.0, 1.0, 0.3 * 8.0**2])
    np.testing.assert_allclose(sorted(cross.get_ydata()), sorted(roots.imag))
    np.testing.assert_allclose(cross.get_xdata(), roots.real)


def test_a_locus_says_its_course():
    assert (
        "for k_alpha from 0.1 to 20. The pair runs on a circle of 4.38 rad/s to the real axis and parts there."
        in PICTURES["root_locus"]().alt
    )
    short = figures.root_locus(PAPER.gains, "k_alpha", np.linspace(0.1, 2.0, 20))
    assert "The pair runs on a circle of 4.38 rad/s. At" in short.alt
    straight = figures.root_locus(PAPER.gains, "h", np.geomspace(1e-4, 1.0, 100))
    assert (
        "for h from 0.0001 to 1. The two poles meet at -0.50, and the pair then runs straight up and down."
        in straight.alt
    )
    assert (
        "The pair runs straight up and down at -0.50."
        in figures.root_locus(PAPER.gains, "h", np.array([0.1, 1.0])).alt
    )
    assert (
        "Both poles stay real."
        in figures.root_locus(PAPER.gains, "k_alpha", np.array([10.0, 20.0])).alt
    )


def test_no_label_of_a_damping_lies_across_the_left_axis():
    """That of 0.7 ends near the corner."""
    picture = figures.root_locus(PAPER.gains, "h", np.geomspace(1e-4, 1.0, 100))
    picture.png()
    axes = picture.figure.axes[0]
    for text in axes.texts:
        box = text.get_window_extent()
        assert box.x0 > axes.bbox.x0 or box.x1 < axes.bbox.x0


def test_a_portrait_counts_the_turns_of_the_tangent():
    """Of s^2 + k_alpha s + h lam^2 the amplitude falls to a twentieth in ln(20)/sigma seconds, in which it turns so often."""
    text = figures.phase_portrait({"the paper's": PAPER.gains, "gentle": GENTLE}, 0.05).alt
    swing = np.sqrt(0.3 * 8.0**2 - 0.25)
    turns = float(re.search(r"a spiral of ([\d.]+) turns", text)[1])
    assert turns == pytest.approx(np.log(20.0) / 0.5 * swing / (2.0 * np.pi), abs=0.2)
    assert "with gentle gains (damping 0.884) one sweep, 0." in text
    assert "horizontal" not in text
    assert (
        "at alpha = +-90 deg the flow is horizontal"
        in figures.phase_portrait({"gentle": GENTLE}, 2.0).alt
    )


def test_the_front_shows_what_is_below_its_border():
    error = np.array(TRIED.heading_error)
    error[np.unravel_index(np.flatnonzero(BEST)[:2], error.shape)] = 1e-5
    picture = figures.front(TRIED._replace(heading_error=error), BEST, {"gentle": ONE})
    above, below = picture.figure.axes[0].collections
    assert len(below.get_offsets()) == 2
    assert len(above.get_offsets()) == BEST.sum() - 2
    assert set(below.get_offsets()[:, 1]) == {picture.figure.axes[0].get_ylim()[0]}
    assert "2 triangles at the lower border are below 0.01 deg." in picture.alt
    assert "triangles" not in PICTURES["front"]().alt


def test_a_portrait_of_nothing():
    with pytest.raises(ValueError, match="1 or 2 are needed"):
        figures.phase_portrait({}, 1.0)
