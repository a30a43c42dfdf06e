"""Figures over the state: what they mark as rising is what the rate and the runs say."""

import html
import io
import math

import numpy as np
import pytest
from matplotlib.image import imread

import wmrlib as wmr
from wmrbook import figures

GAINS = wmr.paper.OUTDOOR_GAINS
ORIGIN = wmr.Pose(0.0, 0.0, 0.0)
START = wmr.pose_from_polar(wmr.PolarError(math.log(2) / 2, math.pi / 4, 0.0), ORIGIN)
HOW = {"method": "continuous", "arrival_radius": 0.0, "duration": 6.0, "dt": 0.02}
CORRECTED, PRINTED = (
    wmr.simulate(START, ORIGIN, GAINS, law=law, **HOW) for law in ("corrected", "printed")
)
PICTURES = {
    "rate_sign": lambda: figures.rate_sign(GAINS, 0.3),
    "rate_sign of the corrected law": lambda: figures.rate_sign(GAINS, 0.3, "corrected"),
    "level_sets": lambda: figures.level_sets(GAINS),
    "level_sets with runs": lambda: figures.level_sets(
        GAINS, 0.01, "printed", [CORRECTED, PRINTED]
    ),
    "lyapunov_runs": lambda: figures.lyapunov_runs([CORRECTED, PRINTED]),
    "heading_errors": lambda: figures.heading_errors([CORRECTED, PRINTED], ["one", "two"]),
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
    pixels = imread(io.BytesIO(bundle["image/png"]))[..., :3]
    assert 0.01 < np.mean(pixels.min(axis=2) < 0.9) < 0.7  # neither blank nor flooded


@pytest.mark.parametrize("name", PICTURES)
def test_every_axis_says_what_it_shows_and_in_which_unit(name):
    for axes in PICTURES[name]().figure.axes:
        assert "[" in axes.get_ylabel()
        assert "[" in axes.get_xlabel()


def test_the_map_counts_what_the_closed_form_says():
    """V' under (24) at one distance, from its closed form: corrected V' + (S cos sin/rho)(1 - cos sin)(alpha + h theta)."""
    rng = np.random.default_rng(4)
    alpha, theta = rng.uniform(-math.pi, math.pi, (2, 400_000))
    speed, mixed = GAINS.v_max * (1 - math.exp(-GAINS.k_rho * 0.3)), np.cos(alpha) * np.sin(alpha)
    rate = (
        -0.3 * speed * np.cos(alpha) ** 2
        - GAINS.k_alpha * alpha**2
        + speed * mixed / 0.3 * (1 - mixed) * (alpha + GAINS.h * theta)
    )
    assert np.mean(rate > 0) == pytest.approx(0.24, abs=0.005)
    assert "V rises in the hatched 24 % and falls elsewhere" in PICTURES["rate_sign"]().alt
    assert "V falls everywhere" in PICTURES["rate_sign of the corrected law"]().alt


def test_arrows_point_where_the_state_goes():
    axes = figures.level_sets(GAINS, 0.01, "printed").figure.axes[0]
    falling, rising = (each for each in axes.collections if type(each).__name__ == "Quiver")
    assert rising.N > 20
    assert falling.N + rising.N == 225
    for arrows, rises in ((falling, False), (rising, True)):
        alpha, theta = np.radians(arrows.get_offsets()).T
        _, *rates = wmr.polar_rate(
            0.01, alpha, *wmr.control_law(0.01, alpha, theta, GAINS, law="printed")
        )
        length = np.maximum(np.hypot(*rates), 1e-12)
        np.testing.assert_allclose(arrows.U, rates[0] / length, atol=1e-9)
        np.testing.assert_allclose(arrows.V, rates[1] / length, atol=1e-9)
        assert ((alpha * rates[0] + GAINS.h * theta * rates[1] > 1e-12) == rises).all()


def test_alpha_never_passes_the_half_turn():
    """Theta is not wrapped and goes as far as the run; a state with |alpha| above 180 deg does not exist and gets no arrow."""
    axes = PICTURES["level_sets with runs"]().figure.axes[0]
    far = 1.08 * np.degrees(np.abs(PRINTED.theta).max())
    assert far > 180
    assert axes.get_xlim() == (-180.0, 180.0)
    assert axes.get_ylim() == pytest.approx((-far, far))
    offsets = np.concatenate(
        [each.get_offsets() for each in axes.collections if type(each).__name__ == "Quiver"]
    )
    np.testing.assert_allclose(np.abs(offsets).max(axis=0), (0.92 * 180.0, 0.92 * far))


def test_no_arrow_of_the_corrected_law_points_outwards():
    assert "0 of 225 arrows point outwards" in PICTURES["level_sets"]().alt


def test_v_is_thick_where_it_rises():
    picture = PICTURES["lyapunov_runs"]()
    calm, wild = picture.figure.axes[0].collections
    assert len(calm.get_segments()) == 0
    assert len(wild.get_segments()) == np.sum(np.diff(PRINTED.V) > 1e-9 * PRINTED.V[0]) > 50
    assert "corrected: from 0.37 to" in picture.alt
    assert "it never rises; printed: from 0.37 to 3.3, it rises, to 3.3 at most" in picture.alt


def test_heading_errors_are_not_wrapped():
    axes = PICTURES["heading_errors"]().figure.axes[0]
    np.testing.assert_allclose(axes.lines[2].get_ydata(), np.degrees(PRINTED.theta - PRINTED.alpha))
    assert axes.lines[2].get_ydata().max() > 180


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: figures.rate_sign(GAINS, 0.0),
            r"rho = 0\.0 is not allowed: a finite number above 0 is needed",
        ),
        (lambda: figures.rate_sign(GAINS, 1.0, "kanayama"), r"law = 'kanayama'"),
        (
            lambda: figures.level_sets(GAINS, runs=[PRINTED] * 5),
            r"runs has 5 entries, which is not allowed: 0 to 4 are needed",
        ),
        (
            lambda: figures.lyapunov_runs([]),
            r"runs has 0 entries, which is not allowed: 1 to 4 are needed",
        ),
        (lambda: figures.heading_errors([PRINTED], ["one", "two"]), r"labels has 2 entries"),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
