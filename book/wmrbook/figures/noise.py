"""Figures of what noise, bias and delay do: a receiver's scatter, where robots end, and where the Lyapunov function rises."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from wmrlib._checks import instance, real, same_shape
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, LINES, arrow, near_zero, new_figure
from wmrlib.tracks import StationaryScatter

_MOST_ARROWS = 150
_COUNTS = {2: "two", 3: "three", 4: "four"}


def scatter(found: StationaryScatter) -> Picture:
    """The positions of a receiver that stands still, east and north of their mean, joined in their order; the circle holds half of them.

    If the last ones are equal, they are one dot, and the picture says how many they are.
    """
    instance("found", found, StationaryScatter)
    figure, axes = new_figure(7.5, 3.9)
    axes.plot(found.east, found.north, "-", color=COLOURS["path"], lw=1.2)
    axes.plot(
        found.east, found.north, "o", color=COLOURS["path"], ms=6, label="positions, in order"
    )
    axes.plot(0.0, 0.0, "+", color=COLOURS["goal"], ms=16, mew=2.5, label="mean")
    axes.add_patch(Circle((0.0, 0.0), found.cep, fill=False, ls="--", ec=COLOURS["ink"]))
    axes.plot(
        [],
        [],
        "--",
        color=COLOURS["ink"],
        lw=1.0,
        label=f"half of them within {found.cep:.1f} m (CEP)",
    )
    places = np.column_stack([found.east, found.north])
    same = int(
        np.argmin([*np.isclose(places[::-1], places[-1], rtol=0.0, atol=1e-3).all(axis=1), False])
    )  # how many are where the last is
    last = "last" if same == 1 else f"last {_COUNTS.get(same, same)}"
    for k, name in ((0, "first"), (found.n - 1, last)):
        axes.annotate(
            name,
            (found.east[k], found.north[k]),
            xytext=(0, 9),
            textcoords="offset points",
            ha="center",
            fontsize=11,
        )
    left, right = min(found.east.min(), -found.cep) - 1.0, max(found.east.max(), found.cep) + 1.0
    height = 1.15 * max(np.abs(found.north).max(), found.cep)
    axes.set(
        xlim=(left, right),
        ylim=(-height, height),
        aspect="equal",
        xlabel="east of the mean [m]",
        ylabel="north of the mean [m]",
    )
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False, fontsize=10)
    return Picture(
        figure,
        f"{found.n} positions about their mean, joined in order: they walk from {_compass(*places[0])} to {_compass(*places[-1])}"
        f"{'' if same == 1 else f', where the {last} are one dot'}; a dashed circle of {found.cep:.1f} m holds half of them; "
        f"the standard deviation is {found.std_east:.1f} m east and {found.std_north:.1f} m north.",
    )


def end_poses(ends: Pose, goal: Pose, radius: float) -> Picture:
    """Where many robots end, as arrows in metres about the goal (the first 150 of them), and how the headings of all are spread.

    ends: Pose of arrays. radius: of the dashed circle in which they believed themselves, m. Raises ValueError for anything else.
    """
    x, y, heading = (
        np.ravel(field) for field in np.broadcast_arrays(*instance("ends", ends, Pose))
    )
    instance("goal", goal, Pose)
    radius = real("radius", radius, low=0.0)
    figure, axes = new_figure(9.0, 4.2, mosaic=[["place", "heading"]])
    distance = np.hypot(x - goal.x, y - goal.y)
    reach = 1.15 * max(np.quantile(distance, 0.97), radius)
    for pose in zip(x[:_MOST_ARROWS], y[:_MOST_ARROWS], heading[:_MOST_ARROWS], strict=True):
        dart = Pose(float(pose[0] - goal.x), float(pose[1] - goal.y), float(pose[2]))
        axes["place"].add_patch(
            arrow(dart, 0.045 * reach, fc=COLOURS["robot"], ec=COLOURS["ink"], lw=0.5)
        )
    for colour, more in (
        ("white", 3.0),
        (None, 0.0),
    ):  # each with a white rim, to stand out from the darts
        looks = {"fc": "none", "ec": colour or COLOURS["goal"], "lw": 2.5 + more, "zorder": 4}
        axes["place"].add_patch(arrow(Pose(0.0, 0.0, goal.heading), 0.16 * reach, **looks))
        axes["place"].add_patch(
            Circle(
                (0.0, 0.0),
                radius,
                fill=False,
                ls="--" if colour is None else "-",
                lw=2.0 + more,
                ec=colour or "k",
                zorder=4,
            )
        )
    axes["place"].set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes["place"].set(xlabel="east of the goal [m]", ylabel="north of the goal [m]")
    drawn = (
        f"{min(x.size, _MOST_ARROWS)} of {x.size} robots"
        if x.size > _MOST_ARROWS
        else f"all {x.size} robots"
    )
    axes["place"].set_title(f"{drawn}; dashed: arrival\nradius; open arrow: the goal", fontsize=11)
    error = np.degrees(wrap_angle(heading - goal.heading))
    axes["heading"].hist(
        error,
        bins=np.arange(-180, 181, 30),
        weights=np.full(error.size, 100.0 / error.size),
        color=COLOURS["path"],
        ec="white",
    )
    axes["heading"].set_title(f"all {x.size}", fontsize=11)
    axes["heading"].set(
        xlabel="heading error [deg]",
        ylabel="robots [%]",
        xlim=(-180, 180),
        xticks=range(-180, 181, 90),
    )
    near = 5 * round(20 * np.mean(np.abs(error) < 30))
    far = 5 * round(20 * np.mean(np.abs(error) > 90))
    half = np.median(distance)
    return Picture(
        figure,
        f"Left, {drawn} where they stand, about a dashed circle of {radius:.2f} m and the open arrow of the goal: half of all are within "
        f"{half:.1f} m of it. Right, the heading errors of all: about {near} % within 30 deg, about {far} % more than 90 deg off.",
    )


def arrival_radii(
    radius: np.ndarray, distance: np.ndarray, heading_deg: np.ndarray, sigma: float
) -> Picture:
    """Distance from the goal [m] and heading error [deg] at the end, over the arrival radius [m]; a line marks the noise, sigma [m]."""
    radius, distance, heading_deg = (
        real("radius", radius),
        real("distance", distance),
        real("heading_deg", heading_deg),
    )
    same_shape(radius=radius, distance=distance, heading_deg=heading_deg)
    figure, (upper, lower) = new_figure(7.0, 4.8, rows=2)
    upper.plot(radius, distance, "o-", color=COLOURS["x_error"])
    upper.plot(radius, radius, ":", color=COLOURS["ink"], label="the radius itself")
    upper.set(ylabel="distance [m]", xscale="log", ylim=(0.0, None))
    lower.plot(radius, heading_deg, "s--", color=COLOURS["y_error"])
    lower.set(xlabel="arrival radius [m]", ylabel="heading error [deg]", ylim=(0.0, None))
    for axes in (upper, lower):
        axes.axvline(sigma, color=COLOURS["goal"], ls="-.", lw=1.5, label=f"sigma, {sigma:g} m")
    upper.legend(loc="upper left", fontsize=10)
    lower.set_xticks(radius, [f"{value:g}" for value in radius])
    lower.minorticks_off()
    figure.align_ylabels()
    best = int(np.argmin(heading_deg))
    return Picture(
        figure,
        f"Over arrival radii from {radius[0]:g} to {radius[-1]:g} m: the distance at the end goes from {distance[0]:.1f} to "
        f"{distance[-1]:.1f} m, the heading error is smallest, about {5 * round(heading_deg[best] / 5):.0f} deg, near {radius[best]:g} m.",
    )


def near_goal(paths: Mapping[str, Pose], goal: Pose, radius: float = 4.0) -> Picture:
    """The last metres of up to four robots: paths by their names, each a Pose of arrays that ends where the robot stands."""
    if not 1 <= len(instance("paths", paths, Mapping)) <= len(LINES):
        raise ValueError(
            f"paths has {len(paths)} entries, which is not allowed: 1 to {len(LINES)} are needed"
        )
    figure, axes = new_figure(5.5, 5.5)
    colours = (COLOURS["path"], COLOURS["y_error"], COLOURS["omega"], COLOURS["start"])
    told = []
    for (name, path), style, colour in zip(paths.items(), LINES, colours, strict=False):
        axes.plot(path.x, path.y, style, color=colour, label=name)
        end = Pose(*(float(np.ravel(field)[-1]) for field in path))
        axes.add_patch(arrow(end, 0.07 * radius, fc=colour, ec=COLOURS["ink"], zorder=3))
        told.append(f"{name}, {math.hypot(end.x - goal.x, end.y - goal.y):.1f} m from the goal")
    axes.add_patch(arrow(goal, 0.1 * radius, fc="none", ec=COLOURS["goal"], lw=2.5, zorder=4))
    axes.set(
        xlim=(goal.x - radius, goal.x + radius),
        ylim=(goal.y - radius, goal.y + radius),
        aspect="equal",
        xlabel="x [m]",
        ylabel="y [m]",
    )
    axes.legend(loc="lower left", fontsize=10)
    return Picture(
        figure,
        f"The last {radius:.0f} m about the open arrow of the goal, and where each robot stands: {'; '.join(told)}.",
    )


def rising(runs: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> Picture:
    """V over time of several runs, one below the other, thick and red wherever it rises.

    runs: from a name to (t in s, V), both one-dimensional and of equal length.
    """
    figure, rows = new_figure(
        8.0, 1.75 * len(instance("runs", runs, Mapping)) + 0.5, rows=len(runs)
    )
    told = []
    for axes, (name, (t, values)) in zip(np.ravel(rows), runs.items(), strict=True):
        share = _draw_rising(axes, np.asarray(t), np.asarray(values))
        axes.set_title(f"{name}: V rises in {share:.0f} % of the steps", fontsize=11, loc="left")
        told.append(f"{name}, {5 * round(share / 5):.0f} %")
    axes.set_xlabel("time [s]")
    return Picture(
        figure,
        f"V over time, on a logarithmic scale, and about how many of its steps rise: {'; '.join(told)}.",
    )


def rise_map(sigma: np.ndarray, dt: np.ndarray, share: np.ndarray) -> Picture:
    """The share of time in which V rises [%] over the noise sigma [m] (columns) and the time step dt [s] (rows)."""
    sigma, dt, share = (
        real("sigma", sigma),
        real("dt", dt),
        real("share", share, low=0.0, high=100.0),
    )
    if share.shape != (len(dt), len(sigma)):
        raise ValueError(
            f"share has shape {share.shape}, which is not allowed: {(len(dt), len(sigma))}, one row a dt, is needed"
        )
    figure, axes = new_figure(8.0, 4.6)
    axes.grid(visible=False)
    image = axes.imshow(share, cmap="cividis", origin="lower", aspect="auto", vmin=0.0, vmax=50.0)
    for (row, column), value in np.ndenumerate(share):
        axes.text(
            column,
            row,
            f"{value:.0f}",
            ha="center",
            va="center",
            color="white" if value < 25 else "black",
        )
    axes.set_xticks(range(len(sigma)), [f"{value:g}" for value in sigma])
    axes.set_yticks(range(len(dt)), [f"{value:g}" for value in dt])
    axes.set(xlabel="noise of the position, sigma [m]", ylabel="time step dt [s]")
    figure.colorbar(image, ax=axes).set_label("share of time with V rising [%]")
    return Picture(
        figure,
        f"Map of the share of time in which V rises: {share[0, 0]:.0f} % with no noise and a step of {dt[0]:g} s, "
        f"about {5 * round(share[0, -1] / 5):.0f} % with {sigma[-1]:g} m of noise, and about {5 * round(share[-1, 0] / 5):.0f} % "
        f"with no noise and a step of {dt[-1]:g} s.",
    )


def _compass(east: float, north: float) -> str:
    along, across = ("west" if east < 0 else "east"), ("south" if north < 0 else "north")
    return f"{abs(near_zero(east)):.1f} m {along} and {abs(near_zero(north)):.1f} m {across}"


def _draw_rising(axes, t: np.ndarray, values: np.ndarray) -> float:
    """V in one panel; returns the share of rising steps, %."""
    up = np.diff(values) > 1e-9 * values[0]
    points = np.column_stack([t, np.maximum(values, 1e-12)])
    pieces = np.stack([points[:-1], points[1:]], axis=1)
    axes.add_collection(LineCollection(pieces[~up], color=COLOURS["V"], lw=2.0))
    axes.add_collection(LineCollection(pieces[up], color=COLOURS["V_rising"], lw=4.5))
    low, high = (
        math.floor(math.log10(points[:, 1].min())),
        math.ceil(math.log10(points[:, 1].max())),
    )
    axes.set(
        ylabel="V [1]",
        yscale="log",
        xlim=(0.0, t[-1]),
        ylim=(10.0 ** (low - 0.2), 10.0 ** (high + 0.2)),
    )
    axes.set_yticks(10.0 ** np.arange(low, high + 1, max(1, (high - low) // 3)))
    axes.minorticks_off()
    return 100.0 * float(np.mean(up))
