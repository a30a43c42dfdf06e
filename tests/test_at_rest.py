"""The log of a receiver at rest, against published numbers, theory and a second method."""

import math

import numpy as np
import pytest
from logs import TEN_MINUTES
from scipy.linalg import toeplitz
from scipy.optimize import minimize_scalar
from scipy.stats import multivariate_normal

import wmrlib as wmr
from wmrbook.chapters import at_rest


def test_allan_deviation_of_the_thousand_points_of_nist():
    """Riley, Handbook of Frequency Stability Analysis (NIST SP 1065, 2008), table 31."""
    numbers = [1234567890]
    while len(numbers) < 1000:
        numbers.append(16807 * numbers[-1] % 2147483647)
    measured = at_rest.allan_deviation(np.array(numbers) / 2147483647, [1, 10, 100])
    assert measured == pytest.approx([2.922319e-1, 9.159953e-2, 3.241343e-2], rel=5e-7)


def in_theory(sigma, memory, span):
    """The Allan deviation of a Gauss-Markov error over spans, in continuous time."""
    r = span / memory
    return sigma * np.sqrt(2.0 / r * (1.0 - (3.0 - 4.0 * np.exp(-r) + np.exp(-2.0 * r)) / (2 * r)))


@pytest.mark.parametrize("memory", [20.0, 60.0])
def test_allan_deviation_and_correlation_of_a_gauss_markov_error(memory):
    error = at_rest.gauss_markov(0.5, memory, 1.0, 6000, 300, 2)
    assert error.std(axis=0) == pytest.approx(0.5, rel=0.2)
    assert np.sqrt(np.mean(error**2)) == pytest.approx(0.5, rel=0.02)
    spans = np.array([10, 40, 100, 300])  # long against a sample
    measured = np.sqrt(np.mean(at_rest.allan_deviation(error, spans) ** 2, axis=0))
    assert measured == pytest.approx(in_theory(0.5, memory, 1.0 * spans), rel=0.04)
    r = np.linspace(0.5, 5.0, 4501)
    peak = in_theory(1.0, 1.0, r)
    assert (r[peak.argmax()], peak.max()) == pytest.approx((1.89, 0.617), abs=5e-3)
    alike = [
        np.mean(error[:, lag:] * error[:, : 6000 - lag]) / np.mean(error**2) for lag in (10, 40)
    ]
    assert alike == pytest.approx(np.exp(-np.array([10, 40]) / memory), abs=0.04)


def test_a_fit_is_that_of_the_likelihood_of_the_differences():
    """Computed again from the whole matrix of covariances."""
    error = at_rest.gauss_markov(0.7, 8.0, 2.0, 60, 1, 3)[0] + 4.0
    differences = np.diff(np.eye(60), axis=0)

    def loss(log_memory):
        c = toeplitz(np.exp(-2.0 * np.arange(60) / math.exp(log_memory)))
        inner = differences @ c @ differences.T
        e = differences @ error
        variance = e @ np.linalg.solve(inner, e) / 59
        return -multivariate_normal(cov=variance * inner).logpdf(e), variance, c

    best = minimize_scalar(lambda x: loss(x)[0], (1.0, 2.0, 4.0)).x
    _, variance, c = loss(best)
    weights = np.linalg.solve(c, np.ones(60))
    fit = at_rest.fit_receiver(error, 2.0)
    assert fit.memory == pytest.approx(math.exp(best), rel=0.01)
    assert fit.sigma == pytest.approx(math.sqrt(variance), rel=0.01)
    assert fit.bias == pytest.approx(weights @ error / weights.sum(), abs=1e-3)
    for bound in (fit.shortest, fit.longest):
        worse = 2.0 * (loss(math.log(bound))[0] - loss(best)[0])
        assert worse == pytest.approx(3.84, abs=0.15)


def test_white_noise_has_no_memory_and_odd_input_is_refused():
    fit = at_rest.fit_receiver(np.random.default_rng(4).standard_normal(4000), 5.0)
    assert fit.memory < 2.0
    assert fit.sigma == pytest.approx(1.0, rel=0.05)
    for error in ([1.0, 2.0], [1.0] * 9, [[1.0, 2.0, 4.0]], [1.0, math.nan, 2.0]):
        with pytest.raises(ValueError, match=r"^error = "):
            at_rest.fit_receiver(error, 1.0)
    with pytest.raises(ValueError, match=r"spans = 6 .* 1 to 5 for 10 samples"):
        at_rest.allan_deviation(np.arange(10.0), [6])


def test_eleven_minutes_bound_a_memory_of_minutes_from_below_only():
    for memory in (30.0, 300.0, 3600.0):
        logs = at_rest.gauss_markov(1.0, memory, 1.0, 655, 200, 5)
        fits = [at_rest.fit_receiver(error, 1.0) for error in logs]
        right = np.mean([fit.shortest <= memory <= fit.longest for fit in fits])
        assert 0.9 <= right <= 0.99  # of 95 %
        open_ended = np.mean([fit.longest == math.inf for fit in fits])
        assert (open_ended < 0.1) if memory == 30.0 else (open_ended > 0.8)
    track = wmr.read_track(TEN_MINUTES)
    middle = wmr.GeoPoint(lat=track.points.lat.mean(), lon=track.points.lon.mean())
    for error in wmr.local_position(middle, track.points):
        every, tenth = (at_rest.fit_receiver(error[::k], float(k)) for k in (1, 10))
        assert every.longest == tenth.longest == math.inf
        assert tenth.memory < every.shortest or tenth.shortest < 0.5 * every.shortest
        steps = np.diff(error)
        alike = [np.corrcoef(steps[lag:], steps[:-lag])[0, 1] for lag in (1, 5)]
        assert min(alike) > 0.2  # which no Gauss-Markov error's are
