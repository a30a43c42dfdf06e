"""Figures of gains: texts with the numbers, axes with units, poles where the characteristic equation has them."""

import io

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrlib import plots

PAPER = wmr.paper.outdoor()
GENTLE = wmr.Gains(0.2, 2.0, 2.0, 4.0)
OVER = {"k_rho": np.array([0.1, 0.2, 0.5]), "h": np.array([1.0, 2.0, 4.0])}
TRIED = wmr.gain_map(PAPER.start, PAPER.goal, GENTLE, OVER, progress=False)
BEST = wmr.pareto(TRIED.time, np.abs(TRIED.heading_error))
ONE = wmr.arrival(wmr.simulate(PAPER.start, PAPER.goal, GENTLE, method="continuous"))
PICTURES = {
    "root_locus": lambda: plots.root_locus(PAPER.gains, "k_alpha", np.linspace(0.1, 20.0, 100)),
    "phase_portrait": lambda: plots.phase_portrait({"the paper's": PAPER.gains, "gentle": GENTLE}, 0.5),
    "front": lambda: plots.front(TRIED, BEST, {"gentle": ONE}),
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


def test_a_portrait_of_nothing():
    with pytest.raises(ValueError, match="1 or 2 are needed"):
        plots.phase_portrait({}, 1.0)
