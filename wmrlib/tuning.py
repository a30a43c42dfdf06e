"""The modes of the closed loop near the goal, and gains from a specification of them.

Equations (7)-(9) linearised at the goal fall into two parts: the distance, rho' = -rate rho, and
the angles, s^2 + k_alpha s + h rate^2 = 0. The printed law's heading never settles.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from wmrlib.checks import Real, choice, instance, plain, real, reals, refusal
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.records import record
from wmrlib.runs import Arrival, Trajectories
from wmrlib.sweeping import sweep

_LAWS = ("corrected", "aicardi")
_METHODS = ("continuous", "polar_euler", "euler", "arc")


@record
class Modes(NamedTuple):
    """The modes of the closed loop near the goal: their decay rates, frequency and damping.

    Parameters
    ----------
    distance_rate, heading_rate : float or array, 1/s; decay of the distance, of the angles
    natural_frequency, damping : float or array, rad/s and ratio; of the angles
    poles : three complex numbers or arrays, 1/s; the distance's, then the angles' two
    slower : float or array; distance_rate/heading_rate
    kappa : float or array; k_alpha/distance_rate. With h it sets the shape of the path: `slower`
        is below 1 exactly when 2 < kappa < 1 + h
    """

    distance_rate: Real
    heading_rate: Real
    natural_frequency: Real
    damping: Real
    poles: tuple[complex | np.ndarray, complex | np.ndarray, complex | np.ndarray]
    slower: Real
    kappa: Real


def modes(gains: Gains, law: str = "corrected") -> Modes:
    """Return the modes of the closed loop near the goal: poles, decay rates and damping.

    Parameters
    ----------
    gains : Gains, of numbers or arrays
    law : "corrected" or "aicardi"

    Returns
    -------
    Modes, in the shape of the gains; a gain of 0 makes ratios infinite, or NaN

    Raises
    ------
    ValueError : not Gains, or another law

    Examples
    --------
    >>> import wmrlib as wmr
    >>> settling = wmr.modes(wmr.paper.OUTDOOR_GAINS)
    >>> print(f"damping {settling.damping:.2f}; the heading is {settling.slower:.0f} times slower")
    damping 0.11; the heading is 16 times slower
    """
    rate, k_alpha, h = _near_goal(gains, law)
    with np.errstate(divide="ignore", invalid="ignore"):
        slow, frequency = _settling(rate, k_alpha, h), rate * np.sqrt(h)
        swing = 1j * np.sqrt(np.maximum(h * rate * rate - (k_alpha / 2) ** 2, 0.0))
        poles = -rate + 0j, swing - slow, slow - k_alpha - swing
        return Modes(
            distance_rate=plain(rate),
            heading_rate=plain(slow),
            natural_frequency=plain(frequency),
            damping=plain(k_alpha / (2.0 * frequency)),
            poles=tuple(plain(pole) for pole in poles),
            slower=plain(rate / slow),
            kappa=plain(k_alpha / rate),
        )


def longest_step(gains: Gains, method: str = "arc", law: str = "corrected") -> Real:
    """Return the longest time step with which the robot still settles in its goal's pose.

    It is a limit, at which the robot only just settles: take a fifth of it or less.

    For "euler" and "arc" by Jury's conditions, derived in chapter 8: beyond it oscillations no
    longer fade, or the nose swings to and fro, or the robot drives past the goal. "polar_euler" is
    Euler's method for (7)-(9); a step multiplies each mode by 1 + pole dt.

    Parameters
    ----------
    gains : Gains, of numbers or arrays; a gain of 0 can make the step 0 or infinite
    method : any of `simulate`, or "polar_euler"; infinite for "continuous"
    law : "corrected" or "aicardi"

    Returns
    -------
    float or array, s, in the shape of the gains

    Raises
    ------
    ValueError : not Gains, another method or another law

    Examples
    --------
    >>> import wmrlib as wmr
    >>> print(f"{wmr.longest_step(wmr.paper.OUTDOOR_GAINS):.3f} s")  # the paper's step is 0.1 s
    0.022 s
    """
    rate, k_alpha, h = _near_goal(gains, law)
    turn = k_alpha + rate
    with np.errstate(divide="ignore", invalid="ignore"):
        if choice("method", method, _METHODS) == "continuous":
            return plain(np.full(np.broadcast(rate, k_alpha, h).shape, np.inf))
        if method == "polar_euler":
            quicker = k_alpha - _settling(rate, k_alpha, h)
            return plain(np.fmin(np.fmin(k_alpha / (h * rate * rate), 2.0 / quicker), 1.0 / rate))
        fading = k_alpha / (rate * (turn + h * rate))
        flipping = _flipping(turn + rate, rate * (h * rate + 2.0 * turn))
        if method == "arc":
            fading, flipping = 2.0 * fading, 2.0 / turn
        return plain(np.fmin(np.fmin(fading, flipping), 1.0 / rate))


def gains_for(
    distance_rate: Real,
    *,
    natural_frequency: Real | None = None,
    heading_rate: Real | None = None,
    damping: Real | None = None,
    kappa: Real | None = None,
    h: Real | None = None,
    v_max: Real = 4.0,
) -> Gains:
    """Return the gains of the corrected law that settle as specified: the inverse of `modes`.

    Parameters
    ----------
    distance_rate, v_max : float or array, 1/s and m/s. Near the goal the distance falls as
        exp(-distance_rate t), to 2 % in about 4/distance_rate; from far away the robot also needs
        the time that the way takes at v_max.
    natural_frequency, heading_rate : float or array, rad/s and 1/s; of the angles, either of them.
        With a damping of 1 both are the same. A heading_rate above the distance_rate lets the
        heading settle before the robot is there.
    damping : float or array, ratio; beside either, by default 1, the least that does not swing
    kappa, h : float or array, no unit; instead of them, a point of the window 2 < kappa < 1 + h,
        where the heading settles faster than the distance; kappa is k_alpha/distance_rate

    Returns
    -------
    Gains, in the common shape

    Raises
    ------
    ValueError : not exactly one of the three specifications, an argument that is not positive, a
        point outside the window, mismatched lengths, or gains outside the range of numbers

    Examples
    --------
    >>> import wmrlib as wmr
    >>> wmr.gains_for(distance_rate=0.8, natural_frequency=1.0, damping=1.0)
    Gains(k_rho=0.2, k_alpha=2.0, h=1.5625, v_max=4.0)
    >>> wmr.gains_for(distance_rate=0.8, kappa=2.5, h=2.0)
    Gains(k_rho=0.2, k_alpha=2.0, h=2.0, v_max=4.0)
    """
    angles = {"natural_frequency": natural_frequency, "heading_rate": heading_rate, "kappa": kappa}
    given = {name: value for name, value in angles.items() if value is not None}
    beside = {"h": h, "damping": damping}
    if len(given) != 1 or (h is None) != (kappa is None) or not (kappa is None or damping is None):
        listed = ", ".join(f"{name} = {value!r}" for name, value in (angles | beside).items())
        needed = "one of the three is needed, kappa with h and the others without it"
        raise ValueError(f"{listed} are not allowed together: {needed}")
    named = {"damping": 1.0 if damping is None else damping} if h is None else {"h": h}
    specification = {"distance_rate": distance_rate, **given, **named, "v_max": v_max}
    rate, angle, other, v_max = reals(above_0=specification, **specification)
    with np.errstate(over="ignore", under="ignore"):
        k_rho = plain(rate / v_max)
        if kappa is not None:
            if np.all((angle > 2.0) & (angle < 1.0 + other)):
                return Gains(k_rho, plain(angle * rate), other, v_max)
            raise refusal("kappa", kappa, "a number between 2 and 1 + h", f", with h = {h!r}")
        if heading_rate is not None:
            # Above 1 this is 1/(damping - sqrt(damping^2 - 1)) without the cancellation.
            root = np.sqrt(np.maximum(np.square(other) - 1.0, 0.0))
            angle = angle * np.where(np.less(other, 1.0), 1.0 / other, other + root)
        weight = plain(np.square(angle / rate))
        weight = real("(natural_frequency/distance_rate)^2", weight, above=0.0)
        return Gains(k_rho, plain(2.0 * other * angle), weight, v_max)


def gain_map(
    start: Pose, goal: Pose, gains: Gains, over: Mapping[str, np.ndarray], **options
) -> Arrival | tuple[Arrival, Trajectories]:
    """Drive from `start` to `goal` with every combination of the listed gains.

    Parameters
    ----------
    start, goal, options : as for `sweep`
    gains : Gains; those not in `over` are kept
    over : mapping from a gain's name to the values to try, a one-dimensional array

    Returns
    -------
    Arrival whose fields have one axis a name, in the order of `over`; otherwise as `sweep`

    Raises
    ------
    ValueError : a name that is no gain, values that are not a list of numbers, and as `sweep`

    Examples
    --------
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> runs = wmr.gain_map(start, goal, gains, {"k_alpha": [1.0, 2.0, 4.0], "h": [0.3, 2.0]})
    >>> runs.heading_error.shape
    (3, 2)
    """
    fields = instance("gains", gains, Gains)._asdict()
    if not instance("over", over, Mapping):
        raise ValueError("over = {} is not allowed: at least one gain and its values are needed")
    axes = {choice("over", key, Gains._fields): real(key, values) for key, values in over.items()}
    for name, values in axes.items():
        if np.ndim(values) != 1:
            given = f"{name} has shape {np.shape(values)}"
            raise ValueError(f"{given}, which is not allowed: a list of numbers is needed")
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij"), strict=True))
    return sweep(start, goal, Gains(**(fields | grid)), **options)


def _near_goal(gains: Gains, law: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The distance's rate, k_alpha and h, as arrays."""
    k_rho, k_alpha, h, v_max = instance("gains", gains, Gains)
    rate = k_rho * (v_max if choice("law", law, _LAWS) == "corrected" else 1.0)
    return np.asarray(rate), np.asarray(k_alpha), np.asarray(h)


def _settling(rate: np.ndarray, k_alpha: np.ndarray, h: np.ndarray) -> np.ndarray:
    """The rate at which the slower mode of the angles decays: of s^2 + k_alpha s + h rate^2 = 0."""
    half, stiffness = k_alpha / 2.0, h * rate * rate
    root = np.sqrt(np.maximum(half * half - stiffness, 0.0))
    return np.where(root > 0.0, stiffness / (half + root), half)  # half - root does not cancel so


def _flipping(b: np.ndarray, a: np.ndarray) -> np.ndarray:
    """The smallest positive root of a dt^2 - 2 b dt + 4 = 0, where 1 + trace + determinant is 0."""
    gap = b**2 - 4.0 * a
    return np.where(gap >= 0.0, 4.0 / (b + np.sqrt(np.maximum(gap, 0.0))), np.inf)
