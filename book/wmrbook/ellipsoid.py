"""The WGS84 ellipsoid, against which chapter 1 and the audit hold the paper's sphere."""

from __future__ import annotations

import numpy as np

from wmrlib.checks import Real, real, same_shape, scalar
from wmrlib.geodesy import EARTH_RADIUS_M

SEMI_MAJOR_M = 6_378_137.0
"""The radius of the equator, in metres; source: the standard NGA.STND.0036."""
FLATTENING = 1.0 / 298.257223563
"""How much shorter the polar radius is than the equator's, as a share of it; same source."""


def sphere_error(lat: Real, bearing: Real, radius: float = EARTH_RADIUS_M) -> Real:
    """Return how much longer a short line is on the sphere than on the ellipsoid.

    R sqrt(cos^2(br)/M^2 + sin^2(br)/N^2) - 1 with the ellipsoid's radii of curvature, M along the
    meridian and N across it (Torge and Mueller, Geodesy).

    Parameters
    ----------
    lat : float or array, degrees
    bearing : float or array, rad from north, on the ellipsoid; broadcasts
    radius : float, m; of the sphere

    Returns
    -------
    float or array, as a share of the length: 0.002 is 0.2 % too long

    Raises
    ------
    ValueError : a latitude out of range, NaN, a radius that is not positive, mismatched lengths
    """
    lat, bearing = np.radians(real("lat", lat, low=-90.0, high=90.0)), real("bearing", bearing)
    radius = scalar("radius", radius, above=0.0)
    same_shape(lat=lat, bearing=bearing)
    eccentricity_squared = FLATTENING * (2.0 - FLATTENING)
    w = np.sqrt(1.0 - eccentricity_squared * np.sin(lat) ** 2)
    along, across = SEMI_MAJOR_M * (1.0 - eccentricity_squared) / w**3, SEMI_MAJOR_M / w
    error = radius * np.hypot(np.cos(bearing) / along, np.sin(bearing) / across) - 1.0
    return error if np.ndim(error) else float(error)
