"""The paper's scenarios, as data.

Yousif and Ali: Simulation of Pose to Pose Moving of the Mobile Robot with Specified GPS Points.

The outdoor case has GPS_POINT_1, GPS_POINT_2, START_HEADING and GOAL_HEADING [rad], OUTDOOR_GAINS
and TIME_STEP [s]; the circle CIRCLE_START, CIRCLE_GAINS, CIRCLE_RADIUS [m], CIRCLE_PERIOD [s] and
CIRCLE_SPEED [m/s].
"""

from __future__ import annotations

import math
from typing import NamedTuple

from wmrlib.checks import Real, choice, real
from wmrlib.elementary import elementwise, sincos
from wmrlib.gains import Gains
from wmrlib.geodesy import GeoPoint, local_position
from wmrlib.kinematics import Pose, Reference

# The outdoor start and goal. The paper writes (longitude, latitude): read the other way round, its
# points would be 42.5 m apart, not 58.
GPS_POINT_1 = GeoPoint(lat=33.273572, lon=44.373160)
GPS_POINT_2 = GeoPoint(lat=33.274087, lon=44.373264)
START_HEADING = 2.0 * math.pi / 5.0  # rad
GOAL_HEADING = -2.0 * math.pi / 6.0  # rad
TIME_STEP = 0.1  # s
OUTDOOR_GAINS = Gains(k_rho=2.0, k_alpha=1.0, h=0.3, v_max=4.0)

CIRCLE_PERIOD = 40.0  # T, s
CIRCLE_RADIUS = 4.0  # m
CIRCLE_SPEED = 2.0 * math.pi * CIRCLE_RADIUS / CIRCLE_PERIOD  # of the reference, m/s
CIRCLE_START = Pose(1.0, 2.0, 0.0)
# The paper gives no v_max for the circle; with 4 m/s the error that remains is the paper's.
CIRCLE_GAINS = Gains(k_rho=1.9, k_alpha=1.0, h=0.05, v_max=4.0)


class Scenario(NamedTuple):
    """A run from start to goal with the paper's gains and time step, s."""

    start: Pose
    goal: Pose
    gains: Gains
    dt: float


def outdoor(x_axis: str = "east") -> Scenario:
    """Return the outdoor case, from GPS point 1 to GPS point 2.

    Parameters
    ----------
    x_axis : "east" as in section 2 (y is north), or "north" as in section 4, whose 57 m are in x

    Returns
    -------
    Scenario

    Raises
    ------
    ValueError : another name

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> start, goal, gains, dt = wmr.paper.outdoor()
    >>> print(f"from {math.degrees(start.heading):.0f} to {math.degrees(goal.heading):.0f} deg")
    from 72 to -60 deg
    """
    east, north = local_position(GPS_POINT_1, GPS_POINT_2)
    x, y = (east, north) if choice("x_axis", x_axis, ("east", "north")) == "east" else (north, east)
    start, goal = Pose(0.0, 0.0, START_HEADING), Pose(x, y, GOAL_HEADING)
    return Scenario(start, goal, OUTDOOR_GAINS, TIME_STEP)


def circle(t: Real) -> Reference:
    """Return the circle's reference: x = 4 cos(2 pi t/T) - 4, y = 4 sin(2 pi t/T).

    Parameters
    ----------
    t : float or array, s

    Returns
    -------
    Reference, with v = 0.628 m/s and omega = 0.157 rad/s

    Raises
    ------
    ValueError : NaN

    Examples
    --------
    >>> import wmrlib as wmr
    >>> print(wmr.paper.circle([0.0, 10.0, 20.0]).x.round(2))  # half a turn, in m
    [ 0. -4. -8.]
    """
    return Reference(*elementwise(circle_at, real("t", t)))


def circle_at(t):
    """The formula of `circle`.

    :meta private:
    """
    turn = 2.0 * math.pi / CIRCLE_PERIOD
    angle, still = turn * t, 0.0 * t
    sine, cosine = sincos(angle)
    x, y = CIRCLE_RADIUS * (cosine - 1.0), CIRCLE_RADIUS * sine
    return x, y, angle + math.pi / 2.0, CIRCLE_SPEED + still, turn + still
