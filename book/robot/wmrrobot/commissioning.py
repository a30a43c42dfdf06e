"""What a bench test and a first drive tell of a robot: dead band, lag, acceleration, latency."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wmrlib.body import follow
from wmrlib.checks import book_extra, real, refusal, same_shape, scalar

with book_extra("wmrrobot.commissioning"):
    from scipy.optimize import least_squares

_LAGS = np.insert(np.geomspace(0.01, 1.0, 20), 0, 0.0)  # s
_EASINGS = np.insert(1.0 / np.geomspace(20.0, 0.1, 20), 0, 0.0)  # s^2/m
_AGES = np.arange(0.0, 3.0, 0.01)  # s


class DeadBand(NamedTuple):
    """Of what a wheel was told, in m/s: the most with which it stood, the least with which it went.

    `stood` above `turned` says that it lags, or sticks: it goes on with less than it begins with.
    """

    stood: float
    turned: float


class Response(NamedTuple):
    """How a wheel follows what it is told: s, m/s^2 (infinite where it is not seen), m/s rms."""

    lag: float
    acceleration: float
    misses: float


class Latency(NamedTuple):
    """How old a fix is when it arrives, and from where to where it may be as well [s].

    `misses` is how far the fixes lie from the wheels' way [m, rms], and `scale` their ratio.
    """

    age: float
    low: float
    high: float
    scale: float
    misses: float


def dead_band(told, went, quantum: float) -> DeadBand:
    """The dead band of a wheel off the ground, from slow ramps up to both sides and back.

    Parameters
    ----------
    told, went : arrays, m/s, what the wheel was told and what its encoder counted, by periods
    quantum : float, m/s, half an encoder step a period: what is less is not seen

    Raises
    ------
    ValueError : a wheel that never stood, or never turned
    """
    told, went = _alike(told=told, went=went)
    turns = np.abs(went) >= scalar("quantum", quantum, above=0.0)
    # The encoder says nothing for some periods even of a wheel that turns slowly.
    stands = np.array([not turns[max(k - 3, 0) : k + 4].any() for k in range(turns.size)])
    if not (stands.any() and turns.any()):
        raise refusal("went", went, "a ramp on which the wheel stands, and turns,")
    return DeadBand(float(np.abs(told[stands]).max()), float(np.abs(told[turns]).min()))


def wheel_response(told, went, dt: float, dead: float = 0.0) -> Response:
    """The lag and the acceleration with which `wmrlib.body.follow` is nearest to a wheel.

    Parameters
    ----------
    told, went : arrays, m/s, by periods, of steps in both directions, large ones and small ones;
        `went` is the mean speed in the period for which it was told
    dt : float, s
    dead : float, m/s, its dead band
    """
    told, went = _alike(told=told, went=went)
    dt, dead = scalar("dt", dt, above=0.0), scalar("dead", dead, low=0.0)
    if not np.ptp(told) > 0.0:
        raise refusal("told", told, "a change of the speed that is told")
    told = np.where(np.abs(told) < dead, 0.0, told)

    def misses(lag, easing):
        speed, left = np.zeros(np.shape(lag)), []
        for wanted, seen in zip(told, went, strict=True):
            mean, speed = follow(speed, wanted, easing, lag, dt)
            left.append(mean - seen)
        return np.array(left)

    grid = [each.ravel() for each in np.meshgrid(_LAGS, _EASINGS)]
    order = np.argsort(np.square(misses(*grid)).sum(axis=0))
    found = [
        least_squares(lambda pair: misses(*pair.reshape(2, 1)).ravel(), start, bounds=(0.0, 11.0))
        for start in np.transpose(grid)[order[:4]]
    ]
    best = min(found, key=lambda each: each.cost)
    lag, easing = (float(each) if each > 1e-3 else 0.0 for each in best.x)
    rms = math.sqrt(2.0 * best.cost / told.size)
    return Response(lag, 1.0 / easing if easing else math.inf, rms)


def latency(t, way, t_fix, way_fix, sigma: float) -> Latency:
    """How late the fixes of a drive straight on are, against the metres that its wheels rolled.

    Start, brake and start again: at a steady speed an old fix looks like a place farther back.

    Parameters
    ----------
    t, way : arrays, s and m, the wheels' metres from the start on
    t_fix, way_fix : arrays, s and m, when a fix arrived, and how far from the first one it is
    sigma : float, m, by how much a fix differs from one just before

    Raises
    ------
    ValueError : the robot hardly moved, or its speed hardly changed
    """
    t, way = _alike(t=t, way=way)
    t_fix, way_fix = _alike(t_fix=t_fix, way_fix=way_fix)
    sigma = scalar("sigma", sigma, above=0.0)
    if np.ptp(way_fix) < 10.0 * sigma:
        raise refusal("way_fix", way_fix, f"a drive of {10.0 * sigma:g} m at least")
    kept = t_fix >= t[0] + _AGES[-1]  # of each age the same fixes
    squares, scales = [], []
    for age in _AGES:
        rolled = np.interp(t_fix[kept] - age, t, way)
        (scale, _), left, *_ = np.polyfit(rolled, way_fix[kept], 1, full=True)
        squares.append(float(left[0]) if left.size else 0.0)
        scales.append(scale)
    loss = np.array(squares) / sigma**2
    near = np.flatnonzero(loss <= loss.min() + 3.84)  # chi-squared, 95 %
    if near[0] == 0 and near[-1] == _AGES.size - 1:
        raise refusal("way", way, "a drive that stops and starts again")
    best = int(loss.argmin())
    misses = math.sqrt(squares[best] / kept.sum())
    ages = (float(_AGES[k]) for k in (best, near[0], near[-1]))
    return Latency(*ages, float(scales[best]), misses)


def _alike(**columns) -> list[np.ndarray]:
    arrays = [np.atleast_1d(real(name, values)) for name, values in columns.items()]
    if len(same_shape(**columns)) != 1 or len({each.shape for each in arrays}) != 1:
        raise ValueError(f"mismatched lengths: {', '.join(columns)} need one length")
    return arrays
