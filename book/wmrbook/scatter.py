"""The scatter of a receiver that does not move."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from wmrlib.checks import instance, same_shape
from wmrlib.geodesy import GeoPoint, local_position, point_at
from wmrlib.tracks import Track
from wmrlib.tracks.neighbours import strays


@dataclass(frozen=True, eq=False, slots=True)
class StationaryScatter:
    """The scatter of a receiver that does not move.

    Parameters
    ----------
    mean, n, left_out : GeoPoint and ints; mean position, number of positions, and of others that
        are far outside their scatter
    east, north : array (n,), m; each position from the mean
    std_east, std_north : float, m; standard deviations, with n - 1
    covariance : array (2, 2), m^2; of (east, north), with n - 1
    cep, two_drms : float, m; median distance from the mean, 2 sqrt(std_east^2 + std_north^2)
    """

    mean: GeoPoint
    n: int
    east: np.ndarray
    north: np.ndarray
    std_east: float
    std_north: float
    covariance: np.ndarray
    cep: float
    two_drms: float
    left_out: int

    def __repr__(self) -> str:
        others = f" ({self.left_out} left out)" if self.left_out else ""
        return (
            f"<StationaryScatter: {self.n} positions{others} about {self.mean.lat:.7f} deg N, "
            f"{self.mean.lon:.7f} deg E; std {self.std_east:.3g} m east, "
            f"{self.std_north:.3g} m north, CEP {self.cep:.3g} m, 2drms {self.two_drms:.3g} m>"
        )


def stationary_scatter(track: Track | GeoPoint) -> StationaryScatter:
    """Return the mean position and the scatter about it, right at the date line and the poles too.

    Positions far outside the scatter of the others are counted and left out.

    Parameters
    ----------
    track : Track, or GeoPoint of arrays

    Returns
    -------
    StationaryScatter, in the local frame of the mean

    Raises
    ------
    ValueError : fewer than two positions, or positions all over the Earth
    """
    points = instance("track", getattr(track, "points", track), GeoPoint)
    n = math.prod(same_shape(lat=points.lat, lon=points.lon))
    if n < 2:
        raise ValueError(f"track has {n} position, which is not allowed: at least 2 are needed")
    scattered = ~strays(points)
    n = int(scattered.sum())
    lat, lon = np.broadcast_arrays(points.lat, points.lon)
    left_out, points = lat.size - n, GeoPoint(lat=lat[scattered], lon=lon[scattered])
    mean = _mean_position(points)
    east, north = (np.ravel(values) for values in local_position(mean, points))
    covariance = np.cov(east, north)
    std_east, std_north = np.sqrt(np.diag(covariance)).tolist()
    cep, two_drms = float(np.median(np.hypot(east, north))), 2.0 * math.hypot(std_east, std_north)
    return StationaryScatter(
        mean, n, east, north, std_east, std_north, covariance, cep, two_drms, left_out
    )


def _mean_position(points: GeoPoint) -> GeoPoint:
    """The point from which the positions average to (0, 0) east and north, by Newton steps."""
    lat, lon = np.broadcast_arrays(np.radians(points.lat), np.radians(points.lon))
    vectors = np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)
    x, y, z = (float(np.mean(values)) for values in vectors)
    if math.hypot(x, y, z) < 0.5:
        raise ValueError("points all over the Earth have no mean: points on one side are needed")
    north_of_equator = math.degrees(math.atan2(z, math.hypot(x, y)))
    mean = GeoPoint(lat=north_of_equator, lon=math.degrees(math.atan2(y, x)))
    for _ in range(100):
        east, north = (float(np.mean(values)) for values in local_position(mean, points))
        mean = point_at(mean, east, north)
        if math.hypot(east, north) < 1e-7:  # m
            break
    return mean
