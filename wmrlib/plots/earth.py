"""Figures of GPS points."""

from __future__ import annotations

import math

import numpy as np

from wmrlib._checks import instance
from wmrlib.geodesy import GeoPoint, haversine_distance, initial_bearing, local_position
from wmrlib.picture import Picture
from wmrlib.plots._style import COLOURS, equal_scales, new_figure


def local_map(origin: GeoPoint, point: GeoPoint) -> Picture:
    """Two GPS points (single ones) in the local frame of the first: east to the right, north up, in metres, equal scales."""
    instance("origin", origin, GeoPoint)
    east, north = local_position(origin, point)
    distance, bearing = haversine_distance(origin, point), math.degrees(initial_bearing(origin, point))
    figure, axes = new_figure(5.0, 5.5)
    axes.plot([0, east], [0, north], "--", color=COLOURS["path"])
    axes.plot(0, 0, "o", ms=10, color=COLOURS["start"])
    axes.plot(east, north, "*", ms=15, color=COLOURS["goal"])
    for name, where, at in (("start", origin, (0, 0)), ("goal", point, (east, north))):
        label = f"{name}\n{where.lat:.6f} deg N\n{where.lon:.6f} deg E"
        axes.annotate(label, at, xytext=(10, -4), textcoords="offset points", va="center", fontsize=10)
    axes.annotate(f"{distance:.2f} m at {bearing:.2f} deg", (east / 2, north / 2), xytext=(10, 0), textcoords="offset points", va="center")
    equal_scales(axes, np.array([0, east]), np.array([0, north]), room=0.25)
    axes.set(xlabel="east [m]", ylabel="north [m]")
    return Picture(
        figure,
        f"Map in metres: from the start at the origin a dashed line leads to the goal {east:.1f} m east and {north:.1f} m north; "
        f"it is {distance:.2f} m long, at a bearing of {bearing:.2f} deg.",
    )
