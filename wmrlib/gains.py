"""The gains of the laws, checked where they are made, in the form that compiled loops take."""

from __future__ import annotations

from collections import namedtuple
from typing import NamedTuple

import numpy as np

from wmrlib.checks import Real, checked, real, scalar
from wmrlib.records import record


@record
@checked("at_least_0", above_0=("v_max",))
class Gains(NamedTuple):
    """The gains of the laws for a goal that stands still; "aicardi" has no speed limit.

    The proof asks for positive gains; 0 is allowed, to show what a gain does.

    Parameters
    ----------
    k_rho : float or array, 1/m ("aicardi": 1/s). How near the goal the speed falls: at a distance
        of 1/k_rho it is 63 % of v_max.
    k_alpha : float or array, 1/s ("graceful": k_delta, no unit). Steering towards the goal.
    h : float or array ("graceful": k_phi). Weight of the final heading.
    v_max : float or array, m/s. Speed limit.

    Raises
    ------
    ValueError : for a negative gain, a v_max that is not positive, NaN or mismatched lengths.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> gains = wmr.Gains(k_rho=1.0, k_alpha=2.0, h=2.0, v_max=0.8)
    >>> gains._replace(v_max=0.5)  # the same gains at another speed
    Gains(k_rho=1.0, k_alpha=2.0, h=2.0, v_max=0.5)
    >>> wmr.Gains(k_rho=1.0, k_alpha=-2.0, h=2.0)
    Traceback (most recent call last):
    ValueError: k_alpha = -2.0 is not allowed: a finite number at least 0 is needed
    """

    k_rho: Real
    k_alpha: Real
    h: Real
    v_max: Real = 4.0


# Gains as compiled loops make them. They are unchecked, because unused lanes hold zeros.
GainsFields = namedtuple("GainsFields", "k_rho k_alpha h v_max")
GENTLE_GAINS = Gains(k_rho=0.2, k_alpha=2.0, h=2.0, v_max=4.0)
"""The book's own gains for the paper's outdoor drive: well damped, and slow."""


@record
@checked("at_least_0", above_0=("k_y",))
class KanayamaGains(NamedTuple):
    """The gains of the law "kanayama".

    Parameters
    ----------
    k_x, k_y, k_heading : float; 1/s, 1/m^2, 1/m

    Raises
    ------
    ValueError : for a negative gain, k_y = 0 or NaN.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> gains = wmr.KanayamaGains(k_x=1.0, k_y=2.0, k_heading=2.0)
    >>> run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, gains, law="kanayama")
    >>> print(f"{wmr.residual(run):.3f} m behind")
    0.000 m behind
    """

    k_x: Real
    k_y: Real
    k_heading: Real


KanayamaFields = namedtuple("KanayamaFields", "k_x k_y k_heading")
LinearFields = namedtuple("LinearFields", "v_x v_y v_heading omega_x omega_y omega_heading")


class LinearGains(LinearFields):
    """The gains of the law "linear", such as K = control.lqr(A, B, Q, R)[0].

    Parameters
    ----------
    matrix : 2 x 3 numbers, from the error (ahead in m, to the left in m, heading in rad) to
        (v in m/s, omega in rad/s).

    Raises
    ------
    ValueError : for another shape or NaN.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> gains = wmr.LinearGains([[1.0, 0.0, 0.0], [0.0, 2.0, 2.0]])
    >>> run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, gains, law="linear")
    >>> print(f"{wmr.residual(run):.3f} m behind")
    0.000 m behind
    """

    __slots__ = ()

    def __new__(cls, matrix) -> LinearGains:
        entries = real("matrix", matrix)
        if (shape := np.shape(entries)) != (2, 3):
            raise ValueError(f"matrix has shape {shape}, which is not allowed: (2, 3) is needed")
        return super().__new__(cls, *np.ravel(entries).tolist())

    def __getnewargs__(self) -> tuple:  # how it is copied and pickled
        return ((self[:3], self[3:]),)

    @classmethod
    def _make(cls, fields):  # type: ignore[override]  # what `_replace` calls
        entries = [scalar(name, value) for name, value in zip(cls._fields, fields, strict=True)]
        return cls((entries[:3], entries[3:]))
