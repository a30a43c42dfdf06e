"""What the gains do near the goal, and the gains that do what is wanted: instead of the paper's "trial and error".

With the corrected law, equations (7)-(9) linearised at the goal fall into two parts, with rate = v_max k_rho:
the distance, rho' = -rate rho, and the angles, whose characteristic equation is s^2 + k_alpha s + h rate^2 = 0.
Aicardi's law has the same form with rate = k_rho. The law as printed has not: its heading never settles.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from wmrlib._checks import Real, choice, instance, real, same_shape
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.runs import Arrival
from wmrlib.sweeping import Trajectories, sweep

_LAWS = ("corrected", "aicardi")
_SAMPLED = ("polar_euler", "euler", "arc")


class Modes(NamedTuple):
    """How the closed loop settles near the goal: numbers, or arrays with the shape of the gains.

    distance_rate: the distance falls by exp(-distance_rate t), 1/s; heading_rate: so does the slowest part of the angles, 1/s;
    natural_frequency: of the angles, rad/s; damping: their damping ratio, oscillating below 1; poles: the distance's pole and the two
    of the angles, 1/s, complex; slower: how many times slower the heading settles than the distance.
    """

    distance_rate: Real
    heading_rate: Real
    natural_frequency: Real
    damping: Real
    poles: tuple[complex | np.ndarray, complex | np.ndarray, complex | np.ndarray]
    slower: Real


def modes(gains: Gains, law: str = "corrected") -> Modes:
    """The poles near the goal and what they say, see Modes for the fields and units; the gains may be arrays.

    With rate = v_max k_rho ("aicardi": k_rho), equations (7)-(9) linearised under (22) and the law for omega that makes the proof work:
    natural frequency rate sqrt(h), damping k_alpha/(2 rate sqrt(h)), poles -rate and -k_alpha/2 +- sqrt(k_alpha^2/4 - h rate^2).
    A gain of 0 leaves a mode that does not settle: damping and slower are then infinite, or NaN for 0/0.
    Raises ValueError for anything but Gains, or another law.
    """
    k_rho, k_alpha, h, v_max = instance("gains", gains, Gains)
    rate = k_rho * (v_max if choice("law", law, _LAWS) == "corrected" else 1.0)
    half, stiffness = 0.5 * np.asarray(k_alpha), h * np.square(rate)
    gap = half**2 - stiffness
    root = np.sqrt(gap.astype(complex))
    with np.errstate(divide="ignore", invalid="ignore"):
        slow = np.where(
            gap > 0.0, stiffness / (half + root.real), half
        )  # not half - root, which would cancel
        fast = half + root
        return Modes(
            distance_rate=_plain(rate),
            heading_rate=_plain(slow),
            natural_frequency=_plain(np.sqrt(stiffness)),
            damping=_plain(half / np.sqrt(stiffness)),
            poles=(
                _plain(np.asarray(-rate, dtype=complex)),
                _plain(np.where(gap > 0.0, -slow, -half + root)),
                _plain(-fast),
            ),
            slower=_plain(np.divide(rate, slow)),
        )


def longest_step(gains: Gains, method: str = "arc", law: str = "corrected") -> Real:
    """The longest time step, s, with which the sampled robot still settles in its goal's pose; shorter ones do, longer ones don't.

    With rate = v_max k_rho ("aicardi": k_rho), c = rate dt and turn = k_alpha + rate, one step near the goal multiplies (alpha, theta) by
    a matrix whose eigenvalues must stay inside the unit circle. Its determinant reaches 1, with oscillations that no longer fade, at

    - "polar_euler" (`sweep`): k_alpha/(h rate^2);
    - "euler": k_alpha/(rate (turn + h rate)), because the line of sight turns by alpha c/(1 - c) while the robot drives;
    - "arc": twice that of "euler";

    an eigenvalue reaches -1, where the nose swings to and fro from step to step, at 4/(b + sqrt(b^2 - 4 a)) with b = k_alpha,
    a = h rate^2 ("polar_euler") or b = turn + rate, a = rate (h rate + 2 turn) ("euler"), if that is real, and at 2/turn ("arc"); and at
    1/rate the robot drives past the goal within a step. The earliest counts. gains may be arrays. A gain of 0 can make it 0 or infinite.
    Raises ValueError for anything but Gains, another method or another law. Source: Jury's conditions; derived in chapter 8.
    """
    k_rho, k_alpha, h, v_max = instance("gains", gains, Gains)
    k_alpha, h = np.asarray(k_alpha), np.asarray(h)
    rate = np.asarray(k_rho * (v_max if choice("law", law, _LAWS) == "corrected" else 1.0))
    turn = k_alpha + rate
    with np.errstate(divide="ignore", invalid="ignore"):
        if choice("method", method, _SAMPLED) == "polar_euler":
            fading, flipping = k_alpha / (h * rate**2), _flipping(k_alpha, h * rate**2)
        elif method == "euler":
            fading, flipping = (
                k_alpha / (rate * (turn + h * rate)),
                _flipping(turn + rate, rate * (h * rate + 2.0 * turn)),
            )
        else:
            fading, flipping = 2.0 * k_alpha / (rate * (turn + h * rate)), 2.0 / turn
        return _plain(np.fmin(np.fmin(fading, flipping), 1.0 / rate))


def _flipping(b, a):
    """The smallest positive root of a dt^2 - 2 b dt + 4 = 0, or infinity: where 1 + trace + determinant is 0."""
    gap = b**2 - 4.0 * a
    return np.where(gap >= 0.0, 4.0 / (b + np.sqrt(np.maximum(gap, 0.0))), np.inf)


def gains_for(
    distance_rate: Real,
    *,
    natural_frequency: Real | None = None,
    heading_rate: Real | None = None,
    damping: Real = 1.0,
    v_max: Real = 4.0,
) -> Gains:
    """The Gains of the corrected law that settle as specified near the goal: the inverse of `modes`; arguments may be arrays.

    distance_rate: 1/s, the distance falls by exp(-distance_rate t); of the angles either the natural_frequency, rad/s, or the
    heading_rate, 1/s, at which the slowest part falls; damping: their damping ratio; v_max: the speed limit, m/s.
    k_rho = distance_rate/v_max, k_alpha = 2 damping natural_frequency, h = (natural_frequency/distance_rate)^2, where the heading_rate is
    natural_frequency times damping up to a damping of 1, and times damping - sqrt(damping^2 - 1) above.

    Raises ValueError for a rate, frequency, damping or v_max that is not positive (nothing would settle), if both or none of
    natural_frequency and heading_rate are given, for mismatched lengths, and for gains outside the range of numbers.
    """
    distance_rate, damping = (
        real("distance_rate", distance_rate, above=0.0),
        real("damping", damping, above=0.0),
    )
    if (natural_frequency is None) == (heading_rate is None):
        given = f"natural_frequency = {natural_frequency!r} and heading_rate = {heading_rate!r}"
        raise ValueError(f"{given} are not allowed together: one of the two is needed")
    if natural_frequency is None:
        heading_rate = real("heading_rate", heading_rate, above=0.0)
        same_shape(
            distance_rate=distance_rate, heading_rate=heading_rate, damping=damping, v_max=v_max
        )
        # 1/(damping - sqrt(damping^2 - 1)) without the cancellation
        per_rate = np.where(
            np.less(damping, 1.0),
            1.0 / damping,
            damping + np.sqrt(np.maximum(np.square(damping) - 1.0, 0.0)),
        )
        natural_frequency = heading_rate * per_rate
    else:
        natural_frequency = real("natural_frequency", natural_frequency, above=0.0)
        same_shape(
            distance_rate=distance_rate,
            natural_frequency=natural_frequency,
            damping=damping,
            v_max=v_max,
        )
    v_max = real("v_max", v_max, above=0.0)
    with np.errstate(over="ignore", under="ignore"):
        h = real(
            "(natural_frequency/distance_rate)^2",
            _plain(np.square(natural_frequency / distance_rate)),
            above=0.0,
        )
        return Gains(
            _plain(distance_rate / v_max), _plain(2.0 * damping * natural_frequency), h, v_max
        )


def gain_map(
    start: Pose, goal: Pose, gains: Gains, over: Mapping[str, np.ndarray], **options
) -> Arrival | tuple[Arrival, Trajectories]:
    """What the run from `start` to `goal` amounts to for every combination of gains: the paper's "trial and error", all at once.

    over: from the name of a gain to the values to try, a one-dimensional array; each field of the Arrival has one axis for each name, in
    that order. The other gains are those of `gains`. options: as for `sweep`, which runs them.
    Raises ValueError for a name that is no gain, for values that are not a list of numbers, and as `sweep`.
    """
    fields = instance("gains", gains, Gains)._asdict()
    if not instance("over", over, Mapping):
        raise ValueError("over = {} is not allowed: at least one gain and its values are needed")
    axes = {
        choice("over", name, Gains._fields): real(name, values) for name, values in over.items()
    }
    for name, values in axes.items():
        if np.ndim(values) != 1:
            raise ValueError(
                f"{name} has shape {np.shape(values)}, which is not allowed: a list of numbers is needed"
            )
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij"), strict=True))
    return sweep(start, goal, Gains(**(fields | grid)), **options)


def pareto(*costs: Real) -> np.ndarray:
    """Which choices no other one dominates: True where nothing else is at most as costly in each cost and less in at least one.

    costs: arrays of one shape, less is better, in any units; the result has that shape. An infinite or NaN cost is never chosen.
    Raises ValueError for no costs, or for different shapes.
    """
    table = [np.asarray(each, dtype=float) for each in costs]
    if not table or any(each.shape != table[0].shape for each in table):
        raise ValueError(
            f"costs of shape {[each.shape for each in table]} are not allowed: at least one, all of one shape, is needed"
        )
    points = np.stack([each.ravel() for each in table], axis=1)
    finite = np.isfinite(points).all(axis=1)
    left = points[finite]
    chosen = np.zeros(len(points), dtype=bool)
    chosen[finite] = [
        not ((left <= one).all(axis=1) & (left < one).any(axis=1)).any() for one in left
    ]
    return chosen.reshape(table[0].shape)


def _plain(value):
    """A Python number for a number, an array for an array."""
    return (
        value.item()
        if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0)
        else value
    )
