"""What the log of a receiver at rest tells of its error, and what it can't."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wmrlib.checks import real, refusal, scalar

_MEMORIES = np.geomspace(0.1, 1e6, 1401)  # s or, in samples, steps: what a fit tries
_QUANTILE = 3.841  # of chi-squared with one degree of freedom: 95 %


def allan_deviation(error, spans) -> np.ndarray:
    """How much the means of two neighbouring spans differ: the overlapping Allan deviation.

    Of white noise it falls as 1/sqrt(span); of a Gauss-Markov process it is
    largest at 1.9 memories; a constant offset does not show.

    Parameters
    ----------
    error : array (..., n), m, equally spaced in time
    spans : ints, numbers of samples in a span, at most n/2

    Returns
    -------
    array (..., len(spans)), m
    """
    error, deviations = real("error", error), []
    total = np.cumsum(np.insert(error, 0, 0.0, axis=-1), axis=-1)
    for m in spans:
        if not 1 <= m <= error.shape[-1] // 2:
            raise refusal("spans", m, f"1 to {error.shape[-1] // 2} for {error.shape[-1]} samples")
        steps = total[..., 2 * m :] - 2.0 * total[..., m:-m] + total[..., : -2 * m]
        deviations.append(np.sqrt(np.mean((steps / m) ** 2, axis=-1) / 2.0))
    return np.stack(deviations, axis=-1)


class Fit(NamedTuple):
    """A Gauss-Markov error fitted to a log: sigma and bias in m, memory in s, all about one axis.

    The memories between `shortest` and `longest` are those that the log does not reject, with 95 %
    confidence. Where `longest` is infinite it can't tell the error from a random walk, and bounds
    neither sigma nor bias; where a random walk fits best, sigma and memory are infinite too.
    """

    sigma: float
    memory: float
    bias: float
    shortest: float
    longest: float


def fit_receiver(error, dt: float) -> Fit:
    """Fit sigma, memory and bias of a Gauss-Markov error to a log, by likelihood.

    Fit every tenth position too: where the memory then changes by more than its bounds allow, the
    error is no Gauss-Markov process (a receiver smooths what it shows), and the bounds mean little.

    Parameters
    ----------
    error : array (n,), m, along one axis, every dt (s); n at least 3, not all the same
    """
    error, dt = real("error", error), scalar("dt", dt, above=0.0)
    if error.ndim != 1 or error.size < 3 or not np.ptp(error) > 0.0:
        raise refusal("error", error, "an array of at least 3 numbers, not all the same")
    n, c = error.size, np.exp(-1.0 / _MEMORIES)
    ends, inner = error[0] + error[-1], error[1:-1].sum()
    bias = (ends + (1.0 - c) * inner) / (2.0 + (n - 2) * (1.0 - c))
    # Sums over e = error - bias, for all c at once: of e^2 inside, at the ends, and of neighbours.
    middle = error.mean()
    e, off = error - middle, bias - middle
    square = np.sum(e[1:-1] ** 2) - 2.0 * off * e[1:-1].sum() + (n - 2) * off**2
    edge = e[0] ** 2 + e[-1] ** 2 - 2.0 * off * (e[0] + e[-1]) + 2.0 * off**2
    pairs = e[1:] @ e[:-1] - off * (2.0 * e.sum() - e[0] - e[-1]) + (n - 1) * off**2
    fresh = 1.0 - c**2
    variance = (edge + (1.0 + c**2) * square - 2.0 * c * pairs) / ((n - 1) * fresh)
    # The likelihood of the differences, which no bias changes: else a fit to a short log takes
    # much of what is slow for a bias.
    loss = (n - 1) * (np.log(variance) + np.log(fresh))
    loss += np.log((2.0 + (n - 2) * (1.0 - c)) / (1.0 + c))
    best, plausible = loss.argmin(), np.flatnonzero(loss <= loss.min() + _QUANTILE)
    low, high = plausible[0], plausible[-1]
    memories = np.append(np.insert(_MEMORIES[1:-1], 0, 0.0), math.inf) * dt
    sigma = math.sqrt(variance[best]) if best < c.size - 1 else math.inf
    return Fit(sigma, *map(float, (memories[best], bias[best], memories[low], memories[high])))


def gauss_markov(sigma, memory, dt, n, runs, seed) -> np.ndarray:
    """Errors (runs, n) in m of a settled receiver, every dt (s), with its memory (s)."""
    fresh = np.random.default_rng(seed).standard_normal((runs, n))
    c = math.exp(-dt / memory) if memory > 0.0 else 0.0
    fresh[:, 1:] *= math.sqrt(1.0 - c**2)
    from scipy.signal import lfilter  # here, because it takes a second to import

    return sigma * lfilter([1.0], [1.0, -c], fresh, axis=1)
