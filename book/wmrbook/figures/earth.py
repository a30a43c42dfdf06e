"""Chapter 1: the Earth that GPS points lie on."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle

from wmrbook.ellipsoid import sphere_error
from wmrbook.figures._drawing import note
from wmrbook.figures.style import COLOURS, Picture, new_figure
from wmrlib.checks import instance, scalar
from wmrlib.geodesy import (
    EARTH_RADIUS_M,
    GeoPoint,
    destination_point,
    haversine_distance,
    initial_bearing,
)

DARK_INK = "#0a0a0a"  # on a map that stays light in the dark theme


def spherical_triangle(a: GeoPoint, b: GeoPoint) -> Picture:
    """The triangle of the north pole and two points on a globe seen from between them."""
    instance("a", a, GeoPoint)
    instance("b", b, GeoPoint)
    view = GeoPoint(lat=45.0, lon=(a.lon + b.lon) / 2)
    figure, axes = new_figure(5.8, 5.8)
    axes.add_patch(Circle((0, 0), 1, fc="none", ec=COLOURS["ink"], lw=1.0))
    _graticule(axes, view)
    pole = GeoPoint(lat=90.0, lon=0.0)
    sides = (
        (pole, a, "-", COLOURS["ink"], "$90^\\circ-\\mathrm{lat}_1$", (-14, 10), "right"),
        (pole, b, "--", COLOURS["ink"], "$90^\\circ-\\mathrm{lat}_2$", (12, 10), "left"),
        (a, b, "-", COLOURS["path"], "$c=\\rho/R$", (8, -16), "left"),
    )
    for start, end, style, colour, name, offset, side in sides:
        steps = np.linspace(0.0, haversine_distance(start, end), 101)
        x, y = _projected(destination_point(start, steps, initial_bearing(start, end)), view)
        axes.plot(x, y, style, color=colour, lw=3.0)
        note(axes, name, (x[50], y[50]), offset, ha=side, fontsize=14, color=colour)
    for corner, first, second, name, offset in (
        (pole, a, b, "$\\Delta\\mathrm{lon}$", (0, -24)),
        (a, pole, b, "br", (14, 22)),
    ):
        turns = np.unwrap([initial_bearing(corner, first), initial_bearing(corner, second)])
        arc = destination_point(corner, 0.16 * EARTH_RADIUS_M, np.linspace(*turns, 30))
        x, y = _projected(arc, view)
        axes.plot(x, y, color=COLOURS["omega"])
        looks = {"ha": "center", "va": "center", "fontsize": 14, "color": COLOURS["omega"]}
        note(axes, name, (x[15], y[15]), offset, **looks)
    named = (
        (pole, "north pole", (0, 10), "center"),
        (a, "point 1", (-10, -8), "right"),
        (b, "point 2", (10, -8), "left"),
    )
    for point, name, offset, side in named:
        axes.plot(*_projected(point, view), "o", ms=8, color=COLOURS["ink"])
        note(axes, name, _projected(point, view), offset, ha=side)
    axes.set(xlim=(-1.08, 1.08), ylim=(-1.08, 1.12), aspect="equal")
    axes.set_axis_off()
    length = math.degrees(haversine_distance(a, b, 1.0))
    bearing = math.degrees(initial_bearing(a, b))
    return Picture(
        figure,
        "A globe with a triangle on it. From the north pole two meridians, "
        f"{abs(b.lon - a.lon):.0f} deg of longitude apart, lead down to "
        f"point 1 at latitude {a.lat:.0f} deg and point 2 at latitude {b.lat:.0f} deg: "
        "their lengths are 90 deg minus the latitudes. The third side joins the points; "
        f"it is c = {length:.1f} deg long and leaves point 1 at the bearing br = {bearing:.1f} deg "
        "from its meridian.",
    )


def chord(angle: float) -> Picture:
    """The chord of an angle c [rad] at the centre of a circle of radius 1, and half of it."""
    half = 0.5 * scalar("angle", angle, above=0.0, high=math.pi)
    figure, axes = new_figure(7.5, 4.4)
    turn = np.linspace(-0.2, 0.2, 61) + np.linspace(-half, half, 61)
    axes.plot(np.sin(turn), np.cos(turn), color=COLOURS["ink"], lw=1.0)
    arc = np.linspace(-half, half, 61)
    axes.plot(np.sin(arc), np.cos(arc), color=COLOURS["path"], lw=3.0)
    ends = np.array([-math.sin(half), math.sin(half)]), np.full(2, math.cos(half))
    axes.plot([ends[0][0], 0.0], [ends[1][0], 0.0], color=COLOURS["ink"])
    axes.plot([ends[0][1], 0.0], [ends[1][1], 0.0], color=COLOURS["ink"])
    axes.plot([0.0, 0.0], [0.0, math.cos(half)], "--", color=COLOURS["soft"], lw=1.2)
    axes.plot(*ends, "--", color=COLOURS["goal"])
    axes.plot([0.0, ends[0][1]], ends[1], color=COLOURS["goal"], lw=3.5)
    size = 0.06
    corner = np.array([[size, size, 0.0], math.cos(half) - np.array([0.0, size, size])])
    axes.plot(*corner, color=COLOURS["soft"], lw=1.2)
    for first, last, name, side in ((0.0, half, "$c/2$", 1), (-half, 0.0, "$c/2$", -1)):
        turn = np.linspace(first, last, 31)
        axes.plot(0.25 * np.sin(turn), 0.25 * np.cos(turn), color=COLOURS["omega"])
        at = 0.33 * math.sin(side * half / 2), 0.33 * math.cos(half / 2)
        note(axes, name, at, ha="center", va="center", color=COLOURS["omega"])
    axes.plot(*ends, "o", ms=8, color=COLOURS["ink"])
    right = ends[0][1], ends[1][1]
    note(axes, "point 1", (ends[0][0], ends[1][0]), (-12, -2), ha="right")
    note(axes, "point 2", right, (12, -2))
    note(axes, "arc: $c$", (0.0, 1.0), (0, 8), ha="center", color=COLOURS["path"])
    middle = 0.5 * right[0], right[1]
    note(axes, "$\\sin(c/2)$", middle, (4, -22), ha="center", color=COLOURS["goal"])
    note(axes, "1", (0.5 * right[0], 0.5 * right[1]), (10, -4))
    note(axes, "the Earth's centre", (0.0, 0.0), (12, -4))
    axes.set(xlim=(-1.3, 1.3), ylim=(-0.08, 1.16), aspect="equal")
    axes.set_axis_off()
    return Picture(
        figure,
        "A slice through the centre of a circle of radius 1 and two points on it, "
        f"c = {math.degrees(2 * half):.1f} deg apart. The chord between them is "
        f"{2 * math.sin(half):.3f} long and the arc {2 * half:.3f}. A dashed line from the centre "
        f"halves both; half of the chord is sin(c/2) = {math.sin(half):.3f}.",
    )


def curvature_radii(lat: float, flattening: float) -> Picture:
    """The two radii of curvature at a latitude [deg] of an ellipse that is flattened more."""
    lat = scalar("lat", lat, above=0.0, high=89.0)
    flat = scalar("flattening", flattening, above=0.0, high=0.5)
    normal = np.array([math.cos(math.radians(lat)), math.sin(math.radians(lat))])
    share = flat * (2.0 - flat)
    w = math.sqrt(1.0 - share * normal[1] ** 2)
    across, along = 1.0 / w, (1.0 - share) / w**3
    point = across * normal * np.array([1.0, 1.0 - share])
    middle, foot = point - along * normal, point - across * normal
    figure, axes = new_figure(7.5, 4.8)
    turn = np.linspace(0.0, 2.0 * np.pi, 241)
    axes.plot(np.cos(turn), (1.0 - flat) * np.sin(turn), color=COLOURS["ink"])
    axes.plot([0.0, 0.0], [-1.0, 1.0], "-.", color=COLOURS["soft"], lw=1.2)
    axes.plot([-1.0, 1.15], [0.0, 0.0], ":", color=COLOURS["soft"], lw=1.2)
    near = np.radians(lat) + np.linspace(-0.9, 0.9, 61)
    fit = middle[:, None] + along * np.array([np.cos(near), np.sin(near)])
    axes.plot(*fit, "--", color=COLOURS["goal"])
    for end, role, wide in ((foot, "path", 2.0), (middle, "goal", 7.0)):
        axes.plot(*np.transpose([point, end]), color=COLOURS[role], lw=wide, zorder=4.0 - wide / 9)
        axes.plot(*end, "o", ms=7, color=COLOURS[role], zorder=5)
    axes.plot(*point, "o", ms=9, color=COLOURS["ink"], zorder=5)
    note(axes, "point", point, (10, 4))
    note(axes, "$M$", (point + middle) / 2, (-8, 12), ha="center", color=COLOURS["goal"])
    note(axes, "$N$", (foot + middle) / 2, (12, -12), ha="center", color=COLOURS["path"])
    note(axes, "pole", (0.0, 1.0 - flat), (8, 6))
    note(axes, "equator", (-1.0, 0.0), (8, 6))
    level = foot[0] - foot[1] * normal[0] / normal[1]  # where the normal crosses the equator
    turn = np.linspace(0.0, math.radians(lat), 31)
    axes.plot(level + 0.2 * np.cos(turn), 0.2 * np.sin(turn), color=COLOURS["omega"])
    at = level + 0.2 * math.cos(turn[15]), 0.2 * math.sin(turn[15])
    note(axes, "lat", at, (6, -2), color=COLOURS["omega"])
    axes.set(xlim=(-1.1, 1.5), ylim=(-0.75, 0.95), aspect="equal")
    axes.set_axis_off()
    return Picture(
        figure,
        f"An ellipse through the poles, flattened by {flat:.2g} so that one sees it. From a point "
        f"at latitude {lat:.0f} deg the normal leads down to the axis: its length N is "
        f"{across:.2f} equatorial radii. A circle that fits the ellipse at the point has its "
        f"centre on the same normal, and its radius M is {along:.2f}.",
    )


def sphere_error_map(point: GeoPoint, bearing: float) -> Picture:
    """The sphere's error [%] on short lines over bearing [rad] and latitude; a star marks one."""
    instance("point", point, GeoPoint)
    bearings, latitudes = np.linspace(0.0, 180.0, 121), np.linspace(-90.0, 90.0, 181)
    percent = 100.0 * sphere_error(latitudes[:, None], np.radians(bearings))
    grid = bearings, latitudes, percent
    figure, axes = new_figure(7.0, 5.0)
    axes.grid(False)
    levels = np.arange(-0.6, 0.61, 0.1)
    axes.contourf(*grid, levels=levels, cmap="PuOr_r", vmin=-1.0, vmax=1.0)
    levels = np.arange(-0.4, 0.51, 0.1)
    lines = axes.contour(*grid, levels=levels, colors=DARK_INK, linewidths=0.8)
    low = [(lat, -1) for lat in (81, 66, 56, 47, 38, 28.5, 15.5)]
    axes.clabel(
        lines,
        fmt=lambda level: "0" if abs(level) < 0.01 else f"{level:+.1f} %",
        manual=[(90, 72), (90, 48), (90, 31), *low],
    )
    here = 100.0 * sphere_error(point.lat, bearing)
    at = math.degrees(bearing), point.lat
    axes.plot(*at, "*", ms=16, color=COLOURS["path"], mec="white")
    note(axes, f"{here:+.3f} %", at, (12, -4), weight="bold", color=DARK_INK)
    axes.set(xlabel="bearing [deg]", ylabel="latitude [deg]")
    axes.set(xticks=range(0, 181, 30), yticks=range(-90, 91, 30))
    return Picture(
        figure,
        "Map of the sphere's error on short lines, over bearing and latitude: "
        f"from {percent.min():+.2f} % at the poles to {percent.max():+.2f} % northwards "
        f"on the equator, with {100.0 * sphere_error(0.0, math.pi / 2):+.2f} % eastwards there. "
        f"A star at latitude {point.lat:.1f} deg and bearing {math.degrees(bearing):.1f} deg "
        f"marks {here:+.3f} %.",
    )


def _projected(point: GeoPoint, view: GeoPoint) -> tuple[np.ndarray, np.ndarray]:
    """Right and up on the globe of radius 1, seen from far above `view`."""
    lat, tilt = np.radians(point.lat), math.radians(view.lat)
    turn = np.radians(np.subtract(point.lon, view.lon))
    up = math.cos(tilt) * np.sin(lat) - math.sin(tilt) * np.cos(lat) * np.cos(turn)
    return np.cos(lat) * np.sin(turn), up


def _graticule(axes: Axes, view: GeoPoint) -> None:
    every = np.linspace(-1.0, 1.0, 181)
    meridians = [GeoPoint(lat=90.0 * every, lon=float(lon)) for lon in range(-180, 180, 30)]
    parallels = [GeoPoint(lat=float(lat), lon=180.0 * every) for lat in range(-60, 61, 30)]
    for line in meridians + parallels:
        hidden = haversine_distance(view, line, 1.0) > math.pi / 2  # behind the edge of the globe
        x, y = (np.where(hidden, np.nan, values) for values in _projected(line, view))
        axes.plot(x, y, color="#999999", lw=0.6)
