"""The dead band, lag and acceleration of a wheel and the latency of fixes, from measurements."""

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
    """The largest command with which a wheel stood, and the smallest with which it turned, in m/s.

    If `stood` is above `turned`, the wheel lags or sticks: it keeps turning with a smaller command
    than it needs to begin.
    """

    stood: float
    turned: float


class Response(NamedTuple):
    """The lag [s] and the acceleration [m/s^2] with which a wheel follows its command.

    The acceleration is infinite if the measurements show no limit. `misses` is the difference
    between model and measurement, m/s rms.
    """

    lag: float
    acceleration: float
    misses: float


class Latency(NamedTuple):
    """The age of a fix when it arrives, with its confidence interval from `low` to `high` [s].

    `misses` is the distance between the fixes and the wheels' odometry [m, rms], and `scale` is the
    ratio of the two distances driven.
    """

    age: float
    low: float
    high: float
    scale: float
    misses: float


def dead_band(commanded, measured, quantum: float) -> DeadBand:
    """The dead band of a wheel off the ground, from slow ramps up to both sides and back.

    Parameters
    ----------
    commanded, measured : arrays, m/s; one entry a period, the wheel's command and the speed that
        its encoder counted
    quantum : float, m/s, half an encoder step a period: the encoder cannot resolve less

    Raises
    ------
    ValueError : a wheel that never stood, or never turned
    """
    commanded, measured = _alike(commanded=commanded, measured=measured)
    turns = np.abs(measured) >= scalar("quantum", quantum, above=0.0)
    # The encoder says nothing for some periods even of a wheel that turns slowly.
    stands = np.array([not turns[max(k - 3, 0) : k + 4].any() for k in range(turns.size)])
    if not (stands.any() and turns.any()):
        raise refusal("measured", measured, "a ramp on which the wheel stands, and turns,")
    return DeadBand(float(np.abs(commanded[stands]).max()), float(np.abs(commanded[turns]).min()))


def wheel_response(commanded, measured, dt: float, dead: float = 0.0) -> Response:
    """The lag and the acceleration with which `wmrlib.body.follow` is nearest to a wheel.

    Parameters
    ----------
    commanded, measured : arrays, m/s; one entry a period, with large and small steps in both
        directions; `measured` is the mean speed in the period of the command
    dt : float, s
    dead : float, m/s, its dead band
    """
    commanded, measured = _alike(commanded=commanded, measured=measured)
    dt, dead = scalar("dt", dt, above=0.0), scalar("dead", dead, low=0.0)
    if not np.ptp(commanded) > 0.0:
        raise refusal("commanded", commanded, "a change of the commanded speed")
    commanded = np.where(np.abs(commanded) < dead, 0.0, commanded)

    def misses(lag, easing):
        speed, errors = np.zeros(np.shape(lag)), []
        for command, speed_measured in zip(commanded, measured, strict=True):
            mean, speed = follow(speed, command, easing, lag, dt)
            errors.append(mean - speed_measured)
        return np.array(errors)

    grid = [values.ravel() for values in np.meshgrid(_LAGS, _EASINGS)]
    order = np.argsort(np.square(misses(*grid)).sum(axis=0))
    fits = [
        least_squares(lambda pair: misses(*pair.reshape(2, 1)).ravel(), start, bounds=(0.0, 11.0))
        for start in np.transpose(grid)[order[:4]]
    ]
    best = min(fits, key=lambda fit: fit.cost)
    lag, easing = (float(value) if value > 1e-3 else 0.0 for value in best.x)
    rms = math.sqrt(2.0 * best.cost / commanded.size)
    return Response(lag, 1.0 / easing if easing else math.inf, rms)


def latency(t, way, t_fix, way_fix, sigma: float) -> Latency:
    """The latency of the fixes of a straight drive, from a comparison with the wheels' odometry.

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
    usable = t_fix >= t[0] + _AGES[-1]  # of each age the same fixes
    squares, scales = [], []
    for age in _AGES:
        rolled = np.interp(t_fix[usable] - age, t, way)
        (scale, _), left, *_ = np.polyfit(rolled, way_fix[usable], 1, full=True)
        squares.append(float(left[0]) if left.size else 0.0)
        scales.append(scale)
    loss = np.array(squares) / sigma**2
    near = np.flatnonzero(loss <= loss.min() + 3.84)  # chi-squared, 95 %
    if near[0] == 0 and near[-1] == _AGES.size - 1:
        raise refusal("way", way, "a drive that stops and starts again")
    best = int(loss.argmin())
    misses = math.sqrt(squares[best] / usable.sum())
    ages = (float(_AGES[k]) for k in (best, near[0], near[-1]))
    return Latency(*ages, float(scales[best]), misses)


def _alike(**columns) -> list[np.ndarray]:
    arrays = [np.atleast_1d(real(name, values)) for name, values in columns.items()]
    if len(same_shape(**columns)) != 1 or len({array.shape for array in arrays}) != 1:
        raise ValueError(f"mismatched lengths: {', '.join(columns)} need one length")
    return arrays
