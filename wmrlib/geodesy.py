"""From GPS points to metres: the great circle on a sphere, and the local east-north frame; equations (11) to (17) of the paper.

The Earth is taken as a sphere. Over 100 m its distances differ from the WGS84 ellipsoid's by -0.45 % to +0.56 %, depending on
where and in which direction: `sphere_error` tells, and chapter 1 derives it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wmrlib._checks import Real, instance, real, same_shape

EARTH_RADIUS_M = 6_371_000.0
"""The mean Earth radius R of equation (11), in metres."""
WGS84_SEMI_MAJOR_M = 6_378_137.0
"""The radius of the WGS84 ellipsoid's equator, in metres; its source is the standard NGA.STND.0036."""
WGS84_FLATTENING = 1.0 / 298.257223563
"""How much shorter than the equator's radius the polar one is, as a share of it; same source."""


@dataclass(frozen=True, kw_only=True, slots=True)
class GeoPoint:
    """A point on the Earth, or many: latitude and longitude in degrees, by keyword, so that their order can't be mixed up.

    lat: degrees north, -90 to 90; lon: degrees east, -180 to 180. Numbers, or arrays that broadcast together.
    Raises ValueError for a value out of range, NaN, or mismatched lengths.
    """

    lat: Real
    lon: Real

    def __post_init__(self) -> None:
        object.__setattr__(self, "lat", real("lat", self.lat, low=-90.0, high=90.0))
        object.__setattr__(self, "lon", real("lon", self.lon, low=-180.0, high=180.0))
        same_shape(lat=self.lat, lon=self.lon)


def haversine_distance(a: GeoPoint, b: GeoPoint, radius: float = EARTH_RADIUS_M) -> Real:
    """Great-circle distance from `a` to `b` in metres (in the unit of `radius`), by the haversine.

    rho = R c, c = 2 atan2(sqrt(e), sqrt(1 - e)), e = sin^2(dlat/2) + cos(lat1) cos(lat2) sin^2(dlon/2); equations (11)-(13).
    1 - e is computed as the haversine to the antipode of `a`, sin^2((lat1 + lat2)/2) + cos(lat1) cos(lat2) cos^2(dlon/2), which is equal
    and lets the atan2 keep all digits at both ends: for points a micrometre apart, where an acos loses them, and near the antipode, where
    a difference from 1 does.

    Fields of a and b may be arrays that broadcast; the result has their common shape. Raises ValueError for mismatched lengths
    or a radius that is not positive.
    """
    lat1, lat2, delta_lat, delta_lon = _radians(a, b)
    radius = real("radius", radius, above=0.0)
    across = np.cos(lat1) * np.cos(lat2)
    e = np.sin(delta_lat / 2) ** 2 + across * np.sin(delta_lon / 2) ** 2
    rest = np.sin((lat2 + lat1) / 2) ** 2 + across * np.cos(delta_lon / 2) ** 2
    return _number(radius * 2.0 * np.arctan2(np.sqrt(e), np.sqrt(rest)))


def initial_bearing(a: GeoPoint, b: GeoPoint) -> Real:
    """Direction in which the great circle leaves `a` towards `b`, in radians clockwise from north, in [0, 2 pi).

    br = atan2(zeta_x, zeta_y), zeta_x = cos(lat2) sin(dlon), zeta_y = cos(lat1) sin(lat2) - sin(lat1) cos(lat2) cos(dlon);
    equations (15)-(17). zeta_y is computed as sin(lat2 - lat1) + 2 sin(lat1) cos(lat2) sin^2(dlon/2), which is equal and does
    not lose digits for points close together. Between equal points the bearing is 0. Shapes and errors as in `haversine_distance`.
    """
    lat1, lat2, delta_lat, delta_lon = _radians(a, b)
    zeta_x = np.cos(lat2) * np.sin(delta_lon)
    zeta_y = np.sin(delta_lat) + 2.0 * np.sin(lat1) * np.cos(lat2) * np.sin(delta_lon / 2) ** 2
    turn = 2.0 * np.pi
    bearing = np.mod(np.arctan2(zeta_x, zeta_y), turn)
    return _number(np.where(bearing < turn, bearing, 0.0))  # mod rounds -1e-17 up to a full turn


def destination_point(
    a: GeoPoint, distance: Real, bearing: Real, radius: float = EARTH_RADIUS_M
) -> GeoPoint:
    """The point reached from `a` after `distance` metres along the great circle that leaves at `bearing` (radians from north).

    The inverse of `haversine_distance` and `initial_bearing` together. Longitudes come back in [-180, 180).
    Fields of a, distance and bearing may be arrays that broadcast. Raises ValueError for NaN, a negative distance or mismatched lengths.
    Source: https://www.movable-type.co.uk/scripts/latlong.html, "Destination point", rearranged so that short steps and the
    neighbourhood of the poles keep their digits (an atan2 where the source has an asin).
    """
    instance("a", a, GeoPoint)
    distance = real("distance", distance, low=0.0)
    bearing = real("bearing", bearing)
    delta = distance / real("radius", radius, above=0.0)
    same_shape(lat=a.lat, lon=a.lon, distance=distance, bearing=bearing)
    lat1, lon1 = np.radians(a.lat), np.radians(a.lon)
    north, east = np.sin(delta) * np.cos(bearing), np.sin(delta) * np.sin(bearing)
    up = (
        np.cos(lat1) * np.cos(delta) - np.sin(lat1) * north
    )  # towards lon1 in the plane of the equator
    lat2 = np.arctan2(np.sin(lat1) * np.cos(delta) + np.cos(lat1) * north, np.hypot(up, east))
    lon2 = np.degrees(lon1 + np.arctan2(east, up))
    lon2 = np.where((lon2 >= -180.0) & (lon2 < 180.0), lon2, np.mod(lon2 + 180.0, 360.0) - 180.0)
    return GeoPoint(lat=_number(np.clip(np.degrees(lat2), -90.0, 90.0)), lon=_number(lon2))


def local_position(
    origin: GeoPoint, point: GeoPoint, radius: float = EARTH_RADIUS_M
) -> tuple[Real, Real]:
    """`point` in the local frame of `origin`: (east, north) in metres.

    east = rho sin(br), north = rho cos(br): the distance and the bearing from the origin are exact (the azimuthal equidistant
    projection). The paper's theta = 90 deg - br, equation (14), is the same direction counted from east. Shapes and errors as
    in `haversine_distance`.
    """
    distance = haversine_distance(origin, point, radius)
    bearing = initial_bearing(origin, point)
    return _number(distance * np.sin(bearing)), _number(distance * np.cos(bearing))


def point_at(origin: GeoPoint, east: Real, north: Real, radius: float = EARTH_RADIUS_M) -> GeoPoint:
    """The GeoPoint at (east, north) metres in the local frame of `origin`: the inverse of `local_position`."""
    east, north = real("east", east), real("north", north)
    same_shape(east=east, north=north)
    return destination_point(
        origin, _number(np.hypot(east, north)), _number(np.arctan2(east, north)), radius
    )


def sphere_error(lat: Real, bearing: Real, radius: float = EARTH_RADIUS_M) -> Real:
    """How much longer a short line is on the sphere than on the WGS84 ellipsoid, as a share of its length: 0.002 is 0.2 % too long.

    R sqrt(cos^2(br)/M^2 + sin^2(br)/N^2) - 1, with the ellipsoid's radii of curvature M = a (1 - e^2)/w^3 along the meridian and N = a/w
    across it, w = sqrt(1 - e^2 sin^2(lat)). lat in degrees, bearing in radians from north, on the ellipsoid; they broadcast. Of 100 m
    lines `haversine_distance` and WGS84's geodesic give the same to 1e-7. Raises ValueError for a latitude out of range, NaN, mismatched
    lengths, or a radius that is not positive. Source of M and N: any textbook of geodesy, such as Torge and Mueller, Geodesy.
    """
    lat, bearing = np.radians(real("lat", lat, low=-90.0, high=90.0)), real("bearing", bearing)
    radius = real("radius", radius, above=0.0)
    same_shape(lat=lat, bearing=bearing)
    eccentricity_squared = WGS84_FLATTENING * (2.0 - WGS84_FLATTENING)
    w = np.sqrt(1.0 - eccentricity_squared * np.sin(lat) ** 2)
    along, across = WGS84_SEMI_MAJOR_M * (1.0 - eccentricity_squared) / w**3, WGS84_SEMI_MAJOR_M / w
    return _number(radius * np.hypot(np.cos(bearing) / along, np.sin(bearing) / across) - 1.0)


def _radians(a: GeoPoint, b: GeoPoint) -> tuple[Real, Real, Real, Real]:
    """lat1, lat2, lat2 - lat1 and lon2 - lon1 in radians; the differences are taken in degrees, where they are exact for close points."""
    instance("a", a, GeoPoint)
    instance("b", b, GeoPoint)
    same_shape(**{"a.lat": a.lat, "a.lon": a.lon, "b.lat": b.lat, "b.lon": b.lon})
    differences = np.radians(np.subtract(b.lat, a.lat)), np.radians(np.subtract(b.lon, a.lon))
    return np.radians(a.lat), np.radians(b.lat), *differences


def _number(value: Real) -> Real:
    return float(value) if np.ndim(value) == 0 else value
