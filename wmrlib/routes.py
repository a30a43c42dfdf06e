"""A route of several points, driven pose to pose: headings chosen along the way or given, each waypoint a stop or passed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wmrlib._checks import Real, instance, real, same_shape, scalar
from wmrlib.gains import Gains, WheelLimits
from wmrlib.geodesy import GeoPoint, haversine_distance, local_position, point_at
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.metrics import arrival, path_length
from wmrlib.runs import Arrival, Outcome, Trajectory
from wmrlib.simulation import simulate

_HAIRPIN = math.pi - 1e-9  # rad: a turn of 180 deg but for rounding
_APART = 1e-6  # m: nearer than this, two GPS points are one, and what lies between them is rounding
_JOINED = ("x", "y", "heading", "v", "omega", "V")


@dataclass(frozen=True, eq=False, slots=True)
class Route:
    """A driven route: its legs, each a Trajectory towards one waypoint, and their samples joined in arrays that can't be written to.

    start: Pose; waypoints: Pose of arrays, in their order, all that were asked for; stops: one bool a waypoint, False for one that was
    passed; legs and arrivals: one Trajectory and one Arrival a leg, up to the first that failed; outcome: ARRIVED if every waypoint was
    reached, or else how the last leg failed.
    Joined: t: s from the start; x, y: m; heading: rad in (-pi, pi]; v: m/s and omega: rad/s; V; leg: which of the `legs` a sample is of.
    Where the goal changes the sample is the next leg's, whose command moves the robot on, so that no time stands there twice. V, (18), is
    counted from each leg's own goal: it falls in each leg by itself, and may jump up where the goal changes. So the proof holds leg by
    leg; the route as a whole ends because its legs are finitely many.
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
        reached = f"{self.reached} of {len(self.stops)} waypoints reached"
        if self.outcome is Outcome.ARRIVED:
            return f"<Route: {reached} in {self.time:.4g} s, {self.length:.4g} m long>"
        left = (
            f", {self.arrivals[-1].distance:.4g} m from its waypoint" if len(self.legs[-1]) else ""
        )
        return f"<Route: {reached}; leg {len(self.legs)} {self.outcome.message}{left}>"

    @property
    def reached(self) -> int:
        """How many waypoints were reached."""
        return sum(leg.outcome is Outcome.ARRIVED for leg in self.legs)

    @property
    def length(self) -> float:
        """How far the robot rolled on all legs, forwards and backwards, metres."""
        return math.fsum(path_length(leg) for leg in self.legs if len(leg))

    @property
    def time(self) -> float:
        """Seconds to the last waypoint; infinite if not every one was reached."""
        return float(self.t[-1]) if self.outcome is Outcome.ARRIVED else math.inf


def headings_along(x: Real, y: Real) -> np.ndarray:
    """Headings along a line of points (x, y in metres), one a point, radians in (-pi, pi].

    At the first point the direction of the first leg, at the last that of the last, and in between the direction that bisects the turn:
    d + turn/2, with the incoming leg's direction d and the turn in (-pi, pi] to the outgoing one's. Half the turn is then done on each
    side. The tangent of the circle through three points would lean towards the direction of the shorter leg, the one that a GPS error
    turns the most; the bisecting direction does not look at lengths.
    A turn of 180 deg (a hairpin) has no side: it is taken to the left. Points that repeat have one heading; a single point, or points
    that are all equal, have the heading 0, east. Raises ValueError for NaN, no point, or x and y of different lengths.
    """
    x, y = np.atleast_1d(real("x", x)), np.atleast_1d(real("y", y))
    if x.shape != y.shape or x.ndim != 1 or not x.size:
        raise ValueError(
            f"mismatched lengths: x has shape {x.shape}, y has shape {y.shape}; two lists of at least one number are needed"
        )
    moved = np.flatnonzero((np.diff(x) != 0.0) | (np.diff(y) != 0.0))
    if not moved.size:
        return np.zeros(x.size)
    direction = np.arctan2(np.diff(y)[moved], np.diff(x)[moved])
    before = np.searchsorted(moved, np.arange(x.size))  # how many legs lie behind each point
    come, leave = np.maximum(before - 1, 0), np.minimum(before, moved.size - 1)
    turn = wrap_angle(direction[leave] - direction[come])
    return wrap_angle(direction[come] + 0.5 * np.where(np.abs(turn) > _HAIRPIN, math.pi, turn))


def route_poses(
    points: GeoPoint,
    headings: Sequence[float] | np.ndarray | None = None,
    origin: GeoPoint | None = None,
) -> Pose:
    """GPS points as poses in a local frame, x east and y north in metres: a Pose of arrays, for `drive_route`.

    points: a GeoPoint of arrays. headings: radians counter-clockwise from east, one a point; where one is NaN (or all, for None) it is
    chosen by `headings_along`. origin: the local frame's, a single GeoPoint; the first of the points for None. Right at the date line
    and at the poles too, where one point has many longitudes: points less than a micrometre apart are one that repeats. See
    `local_position` for the projection. Raises ValueError for no point, headings of another length, one that is infinite or no number,
    or an origin of arrays.
    """
    lat, lon = _listed(points)
    east, north = (
        np.ravel(value)
        for value in local_position(_origin(points if origin is None else _single(origin)), points)
    )
    apart = (
        haversine_distance(GeoPoint(lat=lat[:-1], lon=lon[:-1]), GeoPoint(lat=lat[1:], lon=lon[1:]))
        >= _APART
    )
    first = np.maximum.accumulate(
        np.where([True, *apart], np.arange(lat.size), 0)
    )  # of the points that are this one
    east, north = east[first], north[first]
    chosen = headings_along(east, north)
    if headings is None:
        return Pose(east, north, chosen)
    given = _given(headings)
    if given.shape != lat.shape:
        raise ValueError(
            f"mismatched lengths: headings have shape {given.shape}, points have shape {lon.shape}; the same is needed"
        )
    return Pose(east, north, np.where(np.isnan(given), chosen, given))


def route_points(route: Route, origin: GeoPoint) -> GeoPoint:
    """The driven path as GPS points, for `write_gpx` and `write_geojson`: `point_at(origin, route.x, route.y)`.

    origin: that of `route_poses`, or the points that were given to it, whose first it is. Raises ValueError for another type.
    """
    return point_at(_origin(origin), instance("route", route, Route).x, route.y)


def drive_route(
    poses: Pose,
    gains: Gains,
    *,
    start: Pose | None = None,
    stop: bool | Sequence[bool] = True,
    law: str = "corrected",
    method: str = "arc",
    dt: float = 0.1,
    duration: float = 120.0,
    arrival_radius: float = 0.05,
    pass_radius: float = 2.0,
    wheels: WheelLimits | None = None,
) -> Route:
    """Drive from pose to pose, each leg by `simulate`; a leg that fails is the last.

    poses: a Pose of arrays, one entry a waypoint. Without `start` the robot stands at the first, and the waypoints are the others; with
    a start, a single Pose, all are waypoints. stop: True, to stop at each; False, to pass all but the last, where it stops; or one bool
    a waypoint. A stop is reached within `arrival_radius` metres, and its goal is left when (22) has slowed the robot down; a waypoint
    that is passed counts as reached within `pass_radius`, so that the robot need not crawl there, nor have its heading yet. A waypoint
    within whose radius its leg starts is reached at once, by a leg of one sample.
    duration: of each leg, s. gains, law, method, dt, wheels as in `simulate`.

    Raises ValueError as `simulate`, for no waypoint, or for a `stop` of another length.
    """
    listed = np.broadcast_arrays(*map(np.atleast_1d, instance("poses", poses, Pose)))
    if listed[0].ndim != 1:
        raise ValueError(
            f"poses have shape {listed[0].shape}, which is not allowed: a list of poses is needed"
        )
    way = [Pose(*map(float, each)) for each in zip(*listed, strict=True)]
    pose, way = (way[0], way[1:]) if start is None and way else (start, way)
    if not way:
        raise ValueError(
            f"poses has {listed[0].size} entries, which is not allowed: a waypoint besides the start is needed"
        )
    stops = _stops(stop, len(way))
    radius = {
        True: scalar("arrival_radius", arrival_radius, low=0.0),
        False: scalar("pass_radius", pass_radius, low=0.0),
    }
    begin, legs = pose, []
    for goal, stopping in zip(way, stops, strict=True):
        options = {"law": law, "method": method, "dt": dt, "duration": duration, "wheels": wheels}
        legs.append(simulate(pose, goal, gains, arrival_radius=radius[stopping], **options))
        if legs[-1].outcome is not Outcome.ARRIVED:
            break
        pose = Pose(*(float(field[-1]) for field in (legs[-1].x, legs[-1].y, legs[-1].heading)))
    waypoints = Pose(*(np.array(column) for column in zip(*way, strict=True)))
    return Route(
        begin,
        waypoints,
        stops,
        tuple(legs),
        tuple(map(_arrival, legs)),
        legs[-1].outcome,
        **_joined(legs),
    )


def _joined(legs: list[Trajectory]) -> dict[str, np.ndarray]:
    driven = [k for k, leg in enumerate(legs) if len(leg)]
    counts = {
        k: len(legs[k]) - (k != driven[-1]) for k in driven
    }  # where a leg ends the next one's sample stands
    arrays = {name: [getattr(legs[k], name)[: counts[k]] for k in driven] for name in _JOINED}
    ends = np.cumsum([0.0, *(legs[k].t[-1] for k in driven)])
    arrays["t"] = [end + legs[k].t[: counts[k]] for k, end in zip(driven, ends, strict=False)]
    joined = {name: np.concatenate([np.empty(0), *parts]) for name, parts in arrays.items()}
    joined["heading"] = wrap_angle(
        joined["heading"]
    )  # a start may look in a direction written as 7 rad
    joined["leg"] = np.repeat(
        np.array(driven, dtype=int), np.array(list(counts.values()), dtype=int)
    )
    for values in joined.values():
        values.flags.writeable = False
    return joined


def _arrival(leg: Trajectory) -> Arrival:
    return arrival(leg) if len(leg) else Arrival(False, math.inf, *[math.nan] * 4)


def _stops(stop: bool | Sequence[bool], count: int) -> tuple[bool, ...]:
    try:
        flags = np.asarray(stop)
    except ValueError:  # lists of different lengths
        flags = np.empty(0)
    if flags.dtype != bool or flags.shape not in ((), (count,)):
        raise ValueError(
            f"stop = {stop!r} is not allowed: True, False or a list of {count}, one a waypoint, is needed"
        )
    return tuple(flags.tolist()) if flags.ndim else (*[bool(flags)] * (count - 1), True)


def _given(headings: Sequence[float] | np.ndarray) -> np.ndarray:
    """The headings as floats, NaN where none is given."""
    try:
        given = np.asarray([math.nan if each is None else each for each in headings])
    except (TypeError, ValueError):  # no list, or lists of different lengths
        given = np.empty(0, dtype=object)
    if given.dtype.kind not in "iuf" or np.isinf(given).any():
        raise ValueError(
            f"headings = {headings!r} is not allowed: a list of finite numbers, or NaN where one is to be chosen, is needed"
        )
    return given.astype(float)


def _listed(points: GeoPoint) -> tuple[np.ndarray, np.ndarray]:
    instance("points", points, GeoPoint)
    lat, lon = np.broadcast_arrays(np.atleast_1d(points.lat), np.atleast_1d(points.lon))
    if lat.ndim != 1 or not lat.size:
        raise ValueError(
            f"points have shape {lat.shape}, which is not allowed: a list of at least one position is needed"
        )
    return lat, lon


def _single(origin: GeoPoint) -> GeoPoint:
    if same_shape(lat=instance("origin", origin, GeoPoint).lat, lon=origin.lon):
        raise ValueError(f"origin = {origin!r} is not allowed: a single point is needed")
    return origin


def _origin(points: GeoPoint) -> GeoPoint:
    lat, lon = _listed(points)
    return GeoPoint(lat=float(lat[0]), lon=float(lon[0]))
