"""Measures of a run: its arrival, its effort, and its distance behind a moving reference."""

from __future__ import annotations

import math

from wmrlib.checks import scalar
from wmrlib.runs import Arrival, Outcome, Trajectory, with_samples


def arrival(trajectory: Trajectory) -> Arrival:
    """Return when and how a run reached its goal.

    Parameters
    ----------
    trajectory : Trajectory

    Returns
    -------
    Arrival, with an infinite time if the run did not arrive

    Raises
    ------
    ValueError : a trajectory without a sample

    Examples
    --------
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> end = wmr.arrival(wmr.simulate(start, goal, wmr.GENTLE_GAINS, method="continuous"))
    >>> print(f"{end.arrived}: {end.path_length:.1f} m in {end.time:.1f} s")
    True: 61.8 m in 23.1 s
    """
    run = with_samples("trajectory", trajectory)
    arrived = run.outcome is Outcome.ARRIVED
    return Arrival(
        arrived=arrived,
        time=float(run.t[-1]) if arrived else math.inf,
        heading_error=float(run.heading_error[-1]),
        peak_omega=run.peak_omega,
        path_length=run.path_length,
        distance=float(run.rho[-1]),
    )


def residual(trajectory: Trajectory, last: float = 5.0) -> float:
    """Return the mean distance to the reference at the end of a run.

    Parameters
    ----------
    trajectory : Trajectory
    last : float, s; how much of the end counts

    Returns
    -------
    float, m; on a circle, without feed-forward, about -ln(1 - speed/v_max)/k_rho by (22)

    Raises
    ------
    ValueError : a trajectory without a sample, or `last` not positive

    Examples
    --------
    >>> import wmrlib as wmr
    >>> run = wmr.track(wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS)
    >>> print(f"{wmr.residual(run, last=10.0):.2f} m")
    0.09 m
    """
    run = with_samples("trajectory", trajectory)
    late = run.t >= run.t[-1] - scalar("last", last, above=0.0)
    return float(run.rho[late].mean())
