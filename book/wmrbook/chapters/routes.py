"""A route of several points, driven pose to pose; each waypoint is a stop or is passed."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wmrlib.checks import Real, as_array, instance, real, refusal, same_shape, scalar
from wmrlib.gains import Gains
from wmrlib.geodesy import GeoPoint, haversine_distance, local_position, point_at, position_list
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.metrics import arrival
from wmrlib.runs import Arrival, Outcome, ReadOnly, Trajectory
from wmrlib.simulation import simulate

_HAIRPIN = math.pi - 1e-9  # rad: a turn of 180 deg but for rounding
_APART = 1e-6  # m: GPS points nearer than this are one, and what lies between them is rounding
_NOWHERE = Arrival(False, math.inf, *[math.nan] * 4)  # of a leg without a sample
_JOINED = ("t", "x", "y", "heading", "v", "omega", "V")


@dataclass(frozen=True, eq=False, slots=True)
class Route(ReadOnly):
    """A driven route: its legs, and their samples joined in arrays that can't be written to.

    Where the goal changes, the sample is the next leg's, so that t increases strictly; V, which
    falls in each leg by itself, may jump there.

    Parameters
    ----------
    start, waypoints, stops : Pose, Pose of arrays, and one bool a waypoint, False if it is passed
    legs, arrivals : tuples of Trajectory and Arrival, one a leg, up to the first that failed
    outcome : Outcome; ARRIVED if every waypoint was reached, or else the last leg's
    t, x, y, heading, v, omega : arrays, s from the start, m, m, rad in (-pi, pi], m/s, rad/s
    V, leg : arrays; (18) from each leg's own goal, and the index into `legs` of each sample
    """

    start: Pose
    waypoints: Pose
    stops: tuple[bool, ...]
    legs: tuple[Trajectory, ...]
    arrivals: tuple[Arrival, ...]
    outcome: Outcome
    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    v: np.ndarray
    omega: np.ndarray
    V: np.ndarray
    leg: np.ndarray

    def __len__(self) -> int:
        return self.t.size

    def __repr__(self) -> str:
        text = f"<Route: {self.reached} of {len(self.stops)} waypoints reached"
        if self.outcome is Outcome.ARRIVED:
            return f"{text} in {self.time:.4g} s, {self.length:.4g} m long>"
        text += f"; leg {len(self.legs)} {self.outcome.value}"
        distance = self.arrivals[-1].distance  # NaN without a sample
        return text + (">" if math.isnan(distance) else f", {distance:.4g} m from its waypoint>")

    @property
    def reached(self) -> int:
        """How many waypoints were reached."""
        return sum(leg.outcome is Outcome.ARRIVED for leg in self.legs)

    @property
    def length(self) -> float:
        """How far the robot rolled on all legs, forwards and backwards, m."""
        return math.fsum(leg.path_length for leg in self.legs)

    @property
    def time(self) -> float:
        """Time to the last waypoint, s; infinite if not every one was reached."""
        return float(self.t[-1]) if self.outcome is Outcome.ARRIVED else math.inf


def headings_along(x: Real, y: Real) -> np.ndarray:
    """Return headings along a line of points: each bisects the turn at its point.

    Parameters
    ----------
    x, y : arrays, m

    Returns
    -------
    array, rad in (-pi, pi]; a hairpin of 180 deg turns left; 0, east, without any leg

    Raises
    ------
    ValueError : NaN, no point, or different lengths

    Examples
    --------
    >>> import numpy as np
    >>> from wmrbook.chapters import routes
    >>> print(np.degrees(routes.headings_along([0.0, 10.0, 10.0], [0.0, 0.0, 10.0])).round(1))
    [ 0. 45. 90.]
    """
    x, y = np.atleast_1d(real("x", x)), np.atleast_1d(real("y", y))
    if x.shape != y.shape or x.ndim != 1 or not x.size:
        shapes = f"x has shape {x.shape}, y has shape {y.shape}"
        raise ValueError(f"mismatched lengths: {shapes}; at least one number in each is needed")
    moved = np.flatnonzero((np.diff(x) != 0.0) | (np.diff(y) != 0.0))
    if not moved.size:
        return np.zeros(x.size)
    direction = np.arctan2(np.diff(y)[moved], np.diff(x)[moved])
    before = np.searchsorted(moved, np.arange(x.size))  # how many legs lie behind each point
    come, leave = np.maximum(before - 1, 0), np.minimum(before, moved.size - 1)
    turn = wrap_angle(direction[leave] - direction[come])
    turn = np.where(np.abs(turn) > _HAIRPIN, math.pi, turn)
    return np.asarray(wrap_angle(direction[come] + 0.5 * turn))


def route_poses(
    points: GeoPoint, headings: Real | None = None, origin: GeoPoint | None = None
) -> Pose:
    """Return GPS points as poses in a local frame, for `drive_route`.

    Parameters
    ----------
    points : GeoPoint of arrays
    headings : array, rad from east; NaN, or None for all, to choose it by `headings_along`
    origin : single GeoPoint, of the local frame; the first point by default

    Returns
    -------
    Pose of arrays

    Raises
    ------
    ValueError : no point, headings of another length or not finite, or an origin of arrays

    Examples
    --------
    >>> import wmrlib as wmr
    >>> from wmrbook.chapters import routes
    >>> points = wmr.GeoPoint(lat=[33.2735, 33.2737, 33.2737], lon=[44.3731, 44.3731, 44.3734])
    >>> print(routes.route_poses(points).x.round(1))
    [ 0.   0.  27.9]
    """
    lat, lon = position_list(points)
    if origin is None:
        origin = GeoPoint(lat=lat[0], lon=lon[0])
    elif same_shape(lat=instance("origin", origin, GeoPoint).lat, lon=origin.lon):
        raise ValueError(f"origin = {origin!r} is not allowed: a single point is needed")
    east, north = (np.ravel(value) for value in local_position(origin, points))
    before, after = GeoPoint(lat=lat[:-1], lon=lon[:-1]), GeoPoint(lat=lat[1:], lon=lon[1:])
    # At a pole, or on the date line, one point may be given twice under two longitudes.
    new = np.append(True, np.asarray(haversine_distance(before, after)) >= _APART)
    first = np.maximum.accumulate(np.where(new, np.arange(lat.size), 0))  # of those that are one
    east, north = east[first], north[first]
    chosen = headings_along(east, north)
    if headings is None:
        return Pose(east, north, chosen)
    given = np.atleast_1d(real("headings", headings, nan=True))
    if given.shape != lat.shape:
        shapes = f"headings have shape {given.shape}, points have shape {lat.shape}"
        raise ValueError(f"mismatched lengths: {shapes}; the same is needed")
    return Pose(east, north, np.where(np.isnan(given), chosen, given))


def route_points(route: Route, origin: GeoPoint) -> GeoPoint:
    """Return the driven path as GPS points, for `write_gpx` and `write_geojson`.

    Parameters
    ----------
    route : Route
    origin : GeoPoint; that of `route_poses`, or the points given to it, whose first it is

    Returns
    -------
    GeoPoint of arrays

    Raises
    ------
    ValueError : another type
    """
    lat, lon = position_list(origin, "origin")
    x, y = instance("route", route, Route).x, route.y
    return point_at(GeoPoint(lat=lat[0], lon=lon[0]), x, y)


def drive_route(
    poses: Pose,
    gains: Gains,
    *,
    start: Pose | None = None,
    stop: bool | Sequence[bool] = True,
    duration: float = 120.0,
    arrival_radius: float = 0.05,
    pass_radius: float = 2.0,
    **options,
) -> Route:
    """Drive from pose to pose, each leg by `simulate`; a leg that fails is the last.

    Parameters
    ----------
    poses, start : Pose of arrays, and single Pose; the first of the poses by default
    stop : bool, or one a waypoint; False passes all but the last
    duration : float, s; of each leg
    arrival_radius, pass_radius : float, m; within which a stop, or a waypoint passed, is reached
    gains, options : as for `simulate`

    Returns
    -------
    Route

    Raises
    ------
    ValueError : as `simulate`, no waypoint, or a `stop` of another length

    Examples
    --------
    >>> import wmrlib as wmr
    >>> from wmrbook.chapters import routes
    >>> corner = wmr.Pose([0.0, 20.0, 20.0], [0.0, 0.0, 20.0], [0.0, 0.8, 1.6])
    >>> routes.drive_route(corner, wmr.GENTLE_GAINS, stop=False, method="continuous")
    <Route: 2 of 2 waypoints reached in 17.4 s, 39.81 m long>
    """
    listed = np.array(np.broadcast_arrays(*map(np.atleast_1d, instance("poses", poses, Pose))))
    if listed.ndim != 2 or listed.shape[1] <= (start is None):
        needed = "a list with at least one waypoint besides the start is needed"
        raise ValueError(f"poses have shape {listed.shape[1:]}, which is not allowed: {needed}")
    goals = [Pose(*pose) for pose in listed.T.tolist()]
    start = goals.pop(0) if start is None else start
    flags = as_array(stop)
    if flags.dtype != bool or flags.shape not in ((), (len(goals),)):
        raise refusal("stop", stop, f"True, False or a list of {len(goals)}, one a waypoint,")
    stops = tuple(flags.tolist()) if flags.ndim else (*[bool(flags)] * (len(goals) - 1), True)
    stop_radius = scalar("arrival_radius", arrival_radius, low=0.0)
    pass_radius = scalar("pass_radius", pass_radius, low=0.0)
    pose, legs = start, []
    for goal, stopping in zip(goals, stops, strict=True):
        radius = stop_radius if stopping else pass_radius
        leg = simulate(pose, goal, gains, duration=duration, arrival_radius=radius, **options)
        legs.append(leg)
        if leg.outcome is not Outcome.ARRIVED:
            break
        pose = Pose(float(leg.x[-1]), float(leg.y[-1]), float(leg.heading[-1]))
    waypoints = Pose(*np.array(goals).T)
    arrivals = tuple(arrival(leg) if len(leg) else _NOWHERE for leg in legs)
    which = np.repeat(np.arange(len(legs)), [len(leg) for leg in legs])
    # Where a leg ends stands the next one's first sample, whose command moves the robot on.
    kept = np.append(which[1:] == which[:-1], True)[: which.size]
    joined = {name: np.concatenate([getattr(leg, name) for leg in legs])[kept] for name in _JOINED}
    joined["t"] += np.cumsum([0.0, *(leg.t[-1] for leg in legs[:-1])])[which[kept]]
    columns = joined | {"leg": which[kept]}
    return Route(start, waypoints, stops, tuple(legs), arrivals, leg.outcome, **columns)
