"""The numbers a law is tuned with, checked where they are made, in the form that the compiled loops take."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from wmrlib._checks import Real, instance, real, same_shape, scalar


class GainsFields(NamedTuple):
    """Gains without the checks, which compiled loops can make."""

    k_rho: Real
    k_alpha: Real
    h: Real
    v_max: Real


class Gains(GainsFields):
    """The gains of the laws "corrected", "printed" and "aicardi" (which knows no v_max).

    k_rho: how fast the speed falls near the goal, 1/m ("aicardi": 1/s); k_alpha: steering towards the goal, 1/s; h: weight of the
    final heading; v_max: speed limit, m/s. The proof asks for positive gains; 0 is allowed, to see what a gain does. Fields may
    be arrays that broadcast. Raises ValueError for a negative gain, a v_max that is not positive, NaN or mismatched lengths.
    """

    __slots__ = ()

    def __new__(cls, k_rho: Real, k_alpha: Real, h: Real, v_max: Real = 4.0) -> Gains:
        same_shape(k_rho=k_rho, k_alpha=k_alpha, h=h, v_max=v_max)
        return super().__new__(
            cls,
            real("k_rho", k_rho, low=0.0),
            real("k_alpha", k_alpha, low=0.0),
            real("h", h, low=0.0),
            real("v_max", v_max, above=0.0),
        )

    @classmethod
    def _make(
        cls, fields: Iterable[Real]
    ) -> Gains:  # what `_replace` calls; the namedtuple's own would check nothing
        return cls(*fields)


GENTLE_GAINS = Gains(k_rho=0.2, k_alpha=2.0, h=2.0, v_max=4.0)
"""The book's own gains for the paper's outdoor drive: well damped, and slow."""


class _KanayamaFields(NamedTuple):
    k_x: Real
    k_y: Real
    k_heading: Real


class KanayamaGains(_KanayamaFields):
    """The gains of the law "kanayama": k_x in 1/s, k_y in 1/m^2, k_heading in 1/m.

    Raises ValueError for a negative gain, k_y = 0 or NaN.
    """

    __slots__ = ()

    def __new__(cls, k_x: float, k_y: float, k_heading: float) -> KanayamaGains:
        return super().__new__(
            cls,
            real("k_x", k_x, low=0.0),
            real("k_y", k_y, above=0.0),
            real("k_heading", k_heading, low=0.0),
        )

    @classmethod
    def _make(
        cls, fields: Iterable[Real]
    ) -> KanayamaGains:  # what `_replace` calls; the namedtuple's own would check nothing
        return cls(*fields)


class _LinearFields(NamedTuple):
    v_x: float
    v_y: float
    v_heading: float
    omega_x: float
    omega_y: float
    omega_heading: float


class LinearGains(_LinearFields):
    """The gains of the law "linear": a 2 x 3 matrix K from the error (ahead in m, to the left in m, heading in rad) to (v, omega).

    Raises ValueError for another shape or NaN. For example K = control.lqr(A, B, Q, R)[0].
    """

    __slots__ = ()

    def __new__(cls, matrix) -> LinearGains:
        entries = real("matrix", matrix)
        if np.shape(entries) != (2, 3):
            raise ValueError(
                f"matrix has shape {np.shape(entries)}, which is not allowed: (2, 3) is needed"
            )
        return super().__new__(cls, *(float(entry) for entry in np.ravel(entries)))

    def __getnewargs__(self) -> tuple:  # how it is copied and pickled
        return ((self[:3], self[3:]),)

    @classmethod
    def _make(cls, fields: Iterable[float]) -> LinearGains:  # what `_replace` calls
        entries = [scalar(name, value) for name, value in zip(cls._fields, fields, strict=True)]
        return cls((entries[:3], entries[3:]))


class WheelLimits(NamedTuple):
    """The fastest that either wheel can turn: `track_width`, the distance between the wheels, m; `max_speed` over ground, m/s."""

    track_width: float
    max_speed: float = math.inf


class Tuning(NamedTuple):
    """The gains of every law side by side, as the compiled loops take them; those of the laws not in use are not looked at."""

    pose: Gains
    kanayama: KanayamaGains = KanayamaGains(0.0, 1.0, 0.0)
    linear: LinearGains = LinearGains(np.zeros((2, 3)))


NO_LIMITS = WheelLimits(1.0, math.inf)
NO_TUNING = Tuning(Gains(0.0, 0.0, 0.0))


def checked_wheels(limits: WheelLimits | None, name: str = "wheels") -> WheelLimits:
    """The limits as floats, and limits that never bind for None; raises ValueError, with the argument's name, as `limit_wheels`."""
    if limits is None:
        return NO_LIMITS
    width, speed = instance(name, limits, WheelLimits)
    width = scalar(f"{name}.track_width", width, above=0.0)
    unlimited = isinstance(speed, float) and speed == math.inf
    return WheelLimits(
        width, math.inf if unlimited else scalar(f"{name}.max_speed", speed, above=0.0)
    )
