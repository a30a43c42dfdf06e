"""From GPS points to metres on a spherical Earth; equations (11) to (17) of the paper.

Short distances differ from the WGS84 ellipsoid's by -0.45 % to +0.56 % (chapter 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wmrlib.checks import Real, instance, plain, real, reals, same_shape, scalar
from wmrlib.elementary import direction, elementwise, root, sincos
from wmrlib.records import by_keyword, record

EARTH_RADIUS_M = 6_371_000.0
"""The mean Earth radius R of equation (11), in metres."""


@record
@by_keyword
@dataclass(frozen=True, kw_only=True, slots=True)
class GeoPoint:
    """A point on the Earth, or many; by keyword, so that the order can't be mixed up.

    Parameters
    ----------
    lat, lon : float or array, degrees north (-90 to 90) and east (-180 to 180); they broadcast

    Raises
    ------
    ValueError : a value out of range, NaN or mismatched lengths
    TypeError : positional arguments

    Examples
    --------
    >>> import wmrlib as wmr
    >>> town = wmr.GeoPoint(lat=-33.9, lon=18.4)  # south and west are negative
    >>> wmr.GeoPoint(lat=[52.1, 52.2], lon=13.4).lat  # two points on one meridian
    array([52.1, 52.2])
    """

    lat: Real
    lon: Real

    def __post_init__(self) -> None:
        object.__setattr__(self, "lat", real("lat", self.lat, low=-90.0, high=90.0))
        object.__setattr__(self, "lon", real("lon", self.lon, low=-180.0, high=180.0))
        same_shape(lat=self.lat, lon=self.lon)


def great_circle_angle(lat1, lat2, delta_lat, delta_lon):
    """The angle between two points, seen from the Earth's centre, rad; (11) and (12)."""
    (sin_lat, _), (sin_lon, cos_lon) = sincos(delta_lat / 2), sincos(delta_lon / 2)
    across = sincos(lat1)[1] * sincos(lat2)[1]
    e = sin_lat**2 + across * sin_lon**2
    # 1 - e without the difference, which loses digits near the antipode: the haversine to it
    rest = sincos((lat2 + lat1) / 2)[0] ** 2 + across * cos_lon**2
    return 2 * direction(root(e), root(rest))


def bearing_angle(lat1, lat2, delta_lat, delta_lon):
    """The bearing of point 2 from point 1, rad clockwise from north in (-pi, pi]; (15) to (17)."""
    cos_lat2 = sincos(lat2)[1]
    # equals (17), and loses no digits for points close together
    zeta_y = sincos(delta_lat)[0] + 2 * sincos(lat1)[0] * cos_lat2 * sincos(delta_lon / 2)[0] ** 2
    return direction(cos_lat2 * sincos(delta_lon)[0], zeta_y)


def haversine_distance(a: GeoPoint, b: GeoPoint, radius: float = EARTH_RADIUS_M) -> Real:
    """Return the great-circle distance from `a` to `b`.

    Parameters
    ----------
    a, b : GeoPoint; they broadcast
    radius : float, m; of the sphere

    Returns
    -------
    float or array, m; equations (11)-(13)

    Raises
    ------
    ValueError : mismatched lengths, or a radius that is not positive

    Examples
    --------
    >>> import wmrlib as wmr
    >>> a = wmr.GeoPoint(lat=33.273572, lon=44.373160)
    >>> b = wmr.GeoPoint(lat=33.274087, lon=44.373264)
    >>> print(f"{wmr.haversine_distance(a, b):.2f} m")  # the paper prints 58.07
    58.08 m
    """
    angles = _radians(a=a, b=b)
    return scalar("radius", radius, above=0.0) * elementwise(great_circle_angle, *angles)


def initial_bearing(a: GeoPoint, b: GeoPoint) -> Real:
    """Return the direction in which the great circle from `a` to `b` starts.

    Parameters
    ----------
    a, b : GeoPoint; they broadcast

    Returns
    -------
    float or array, rad clockwise from north in [0, 2 pi), 0 for equal points; equations (15)-(17)

    Raises
    ------
    ValueError : mismatched lengths

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> a, b = wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2
    >>> print(f"{math.degrees(wmr.initial_bearing(a, b)):.2f} deg")  # the paper prints 9.4
    9.58 deg
    """
    turn = 2.0 * np.pi
    bearing = np.mod(elementwise(bearing_angle, *_radians(a=a, b=b)), turn)
    return plain(np.where(bearing < turn, bearing, 0.0))  # mod rounds -1e-17 up to a full turn


def destination_point(
    a: GeoPoint, distance: Real, bearing: Real, radius: float = EARTH_RADIUS_M
) -> GeoPoint:
    """Return the point at `distance` along the great circle that leaves `a` at `bearing`.

    Parameters
    ----------
    a : GeoPoint
    distance, bearing : float or array, m (at least 0) and rad clockwise from north; they broadcast
    radius : float, m; of the sphere

    Returns
    -------
    GeoPoint, with longitudes in [-180, 180)

    Raises
    ------
    ValueError : NaN, a negative distance, a radius that is not positive, or mismatched lengths

    Examples
    --------
    >>> import math
    >>> import wmrlib as wmr
    >>> gate = wmr.GeoPoint(lat=48.1497, lon=11.5678)
    >>> tree = wmr.destination_point(gate, distance=100.0, bearing=math.radians(90))
    >>> print(f"{tree.lat:.6f}, {tree.lon:.6f}")  # 100 m to the east
    48.149700, 11.569148
    """
    # https://www.movable-type.co.uk/scripts/latlong.html, with an atan2 in place of its asin
    instance("a", a, GeoPoint)
    named = {"lat": a.lat, "lon": a.lon, "distance": distance, "bearing": bearing}
    lat1, lon1, distance, bearing = reals(at_least_0=("distance",), **named)
    lat1, lon1 = np.radians(lat1), np.radians(lon1)
    delta = distance / scalar("radius", radius, above=0.0)
    north, east = np.sin(delta) * np.cos(bearing), np.sin(delta) * np.sin(bearing)
    # towards lon1 in the plane of the equator
    up = np.cos(lat1) * np.cos(delta) - np.sin(lat1) * north
    lat2 = np.arctan2(np.sin(lat1) * np.cos(delta) + np.cos(lat1) * north, np.hypot(up, east))
    lon2 = np.degrees(lon1 + np.arctan2(east, up))
    lon2 = np.where((lon2 >= -180.0) & (lon2 < 180.0), lon2, np.mod(lon2 + 180.0, 360.0) - 180.0)
    return GeoPoint(lat=plain(np.degrees(lat2)), lon=plain(lon2))


def local_position(
    origin: GeoPoint, point: GeoPoint, radius: float = EARTH_RADIUS_M
) -> tuple[Real, Real]:
    """Return `point` in the local frame of `origin`: exact distance and bearing from there.

    Parameters
    ----------
    origin, point : GeoPoint; they broadcast
    radius : float, m; of the sphere

    Returns
    -------
    (east, north), floats or arrays, m; the direction from east is that of equation (14)

    Raises
    ------
    ValueError : as `haversine_distance`

    Examples
    --------
    >>> import wmrlib as wmr
    >>> east, north = wmr.local_position(wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2)
    >>> print(f"{east:.2f} m east, {north:.2f} m north")
    9.67 m east, 57.27 m north
    """
    _radians(origin=origin, point=point)  # its checks, by these names
    distance = haversine_distance(origin, point, radius)
    bearing = initial_bearing(origin, point)
    return plain(distance * np.sin(bearing)), plain(distance * np.cos(bearing))


def point_at(origin: GeoPoint, east: Real, north: Real, radius: float = EARTH_RADIUS_M) -> GeoPoint:
    """Return the point at (east, north) in the local frame of `origin`: `local_position` undone.

    Parameters
    ----------
    origin : GeoPoint
    east, north : float or array, m; they broadcast
    radius : float, m; of the sphere

    Returns
    -------
    GeoPoint

    Raises
    ------
    ValueError : NaN, or mismatched lengths

    Examples
    --------
    >>> import wmrlib as wmr
    >>> point = wmr.point_at(wmr.paper.GPS_POINT_1, east=9.67, north=57.27)
    >>> print(f"{point.lat:.6f}, {point.lon:.6f}")
    33.274087, 44.373264
    """
    instance("origin", origin, GeoPoint)
    east, north = reals(east=east, north=north)
    distance, bearing = np.hypot(east, north), np.arctan2(east, north)
    return destination_point(origin, plain(distance), plain(bearing), radius)


def position_list(points: GeoPoint, name: str = "points") -> tuple[np.ndarray, np.ndarray]:
    """The latitudes and longitudes of a list of positions; raises ValueError for anything else."""
    instance(name, points, GeoPoint)
    lat, lon = np.broadcast_arrays(np.atleast_1d(points.lat), np.atleast_1d(points.lon))
    if lat.ndim != 1 or not lat.size:
        needed = "a list of at least one position is needed"
        raise ValueError(f"{name} has shape {lat.shape}, which is not allowed: {needed}")
    return lat, lon


def _radians(**points: GeoPoint) -> tuple[Real, Real, Real, Real]:
    """lat1, lat2 and the differences, taken in degrees, where they are exact for close points."""
    named = {name: instance(name, point, GeoPoint) for name, point in points.items()}
    same_shape(**{f"{k}.{f}": getattr(named[k], f) for k in named for f in ("lat", "lon")})
    a, b = named.values()
    differences = np.subtract(b.lat, a.lat), _degrees_east(a.lon, b.lon)
    return tuple(map(np.radians, (a.lat, b.lat, *differences)))


def _degrees_east(lon1: Real, lon2: Real) -> np.ndarray:
    """The shorter way from one longitude to another; across the date line as exact as elsewhere."""
    difference = np.subtract(lon2, lon1)
    side = np.where(difference > 180.0, 180.0, np.where(difference < -180.0, -180.0, 0.0))
    # Each longitude from the date line, which is exact close to it, where -360 + 1e-13 is not.
    return np.subtract(lon2, side) - np.add(lon1, side)
