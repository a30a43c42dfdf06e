"""Chapter 14: after what distance a heading is known, and what a filter believes about it."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from wmrbook.figures._drawing import SERIES, check_count, figure_legend, note, panels
from wmrbook.figures.robot import draw_robot
from wmrbook.figures.style import COLOURS, Picture, new_figure
from wmrlib.checks import instance, real, same_shape, scalar
from wmrlib.kinematics import Pose

_USABLE = 5.0  # deg, of a heading


def heading_distance(
    distance: np.ndarray,
    series: Mapping[str, np.ndarray],
    reported: tuple[float, float],
) -> Picture:
    """The rms heading error [deg] over the distance driven [m], on logarithmic scales.

    series: from a receiver's name to its errors, one to five; seen: a distance and an error that
    someone reported.
    """
    distance = real("distance", distance, above=0.0)
    check_count("series", instance("series", series, Mapping), 1, len(SERIES))
    figure, axes = new_figure(6.5, 4.6)
    words = []
    for (name, errors), (role, style) in zip(series.items(), SERIES, strict=False):
        same_shape(distance=distance, **{f"series[{name!r}]": errors})
        axes.plot(distance, errors, color=COLOURS[role], ls=style, label=name)
        good = np.flatnonzero(errors <= _USABLE)
        after = f"after {distance[good[0]]:.2g} m" if good.size else "nowhere"
        words.append(f"{name}, {after}")
    axes.axhline(_USABLE, color=COLOURS["ink"], lw=0.9, ls=":")
    axes.plot(*reported, "*", color=COLOURS["goal"], ms=15)
    note(axes, "reported", reported, (9, 5))
    axes.set(xscale="log", yscale="log", xlabel="distance driven [m]", ylabel="heading, rms [deg]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    figure_legend(figure)
    return Picture(
        figure,
        f"The rms error of the heading over the distance driven straight, on logarithmic scales. "
        f"It is within {_USABLE:g} deg: {'; '.join(words)}. "
        f"A star marks a report of {reported[1]:g} deg at {reported[0]:g} m.",
    )


def lever_arm(arm: float, bias: float) -> Picture:
    """An antenna's circle in a spin, and where a biased heading [rad] puts a robot that stands.

    arm: the antenna's distance ahead of the robot's middle, m; bias: to the left, up to 0.5.
    """
    arm, bias = scalar("arm", arm, above=0.0), scalar("bias", bias, low=-0.5, high=0.5)
    figure, (spin, dock) = panels(1, 2, 8.6, 4.2)
    turned = np.linspace(0.0, 2 * math.pi, 73)
    spin.plot(arm * np.cos(turned), arm * np.sin(turned), color=COLOURS["path"])
    spin.plot(arm * np.cos(turned[::9]), arm * np.sin(turned[::9]), "o", color=COLOURS["path"])
    draw_robot(spin, Pose(0.0, 0.0, 0.0), 0.6 * arm, 0.12 * arm)
    spin.plot([0.0, arm], [0.0, 0.0], color=COLOURS["ink"])
    note(spin, "$r$", (0.8 * arm, 0.0), (0, 5))
    believed = Pose(arm - arm * math.cos(bias), -arm * math.sin(bias), bias)
    for pose, role in ((Pose(0.0, 0.0, 0.0), "path"), (believed, "rising")):
        draw_robot(dock, pose, 0.6 * arm, 0.12 * arm, role if pose is believed else "")
        dock.plot([pose.x, arm], [pose.y, 0.0], color=COLOURS[role])
        dock.plot(pose.x, pose.y, "o", color=COLOURS[role], zorder=6)
    dock.plot(arm, 0.0, "o", color=COLOURS["ink"], zorder=6)
    side = math.copysign(1.0, bias)
    for text, pose, role, beyond in (
        ("stands", Pose(0.0, 0.0, 0.0), "path", 0.5 * side),
        ("believed", believed, "rising", -0.5 * side),
    ):
        at = (pose.x - 0.1 * arm, pose.y + beyond * arm)
        note(dock, text, at, color=COLOURS[role], ha="center", va="center")
    for axes, title in ((spin, "a spin on the spot"), (dock, "at rest, with a bias")):
        axes.set(ylim=(-1.2 * arm, 1.2 * arm), aspect="equal", title=title)
        axes.set(xlim=(-1.2 * arm, 1.2 * arm), xlabel="east [m]", ylabel="north [m]")
    aside = f"{1000 * abs(believed.y):.3g} mm to the {'right' if bias > 0 else 'left'}"
    return Picture(
        figure,
        f"An antenna {arm:g} m ahead of the middle. In a spin its eight fixes lie on a circle. At "
        f"rest, with a heading that is {math.degrees(abs(bias)):.0f} deg too far to the "
        f"{'left' if bias > 0 else 'right'}, the antenna stays and the middle is believed {aside}."
        if bias
        else f"An antenna {arm:g} m ahead of the middle, its circle in a spin, and at rest.",
    )


def beliefs(time: np.ndarray, runs: Mapping[str, tuple[np.ndarray, np.ndarray]]) -> Picture:
    """The heading error [deg] over time [s] within twice the deviation [deg] that a filter claims.

    runs: from a name to (error, deviation), one to four, a row of axes each.
    """
    time = real("time", time)
    check_count("runs", instance("runs", runs, Mapping), 1, 4)
    figure, rows = new_figure(7.5, 1.2 + 1.5 * len(runs), rows=len(runs))
    words = []
    for axes, (name, (error, deviation)) in zip(np.atleast_1d(rows), runs.items(), strict=True):
        same_shape(time=time, **{f"runs[{name!r}]": error, f"{name} deviation": deviation})
        band = {"color": COLOURS["robot"], "alpha": 0.4, "lw": 0}
        axes.fill_between(time, -2.0 * deviation, 2.0 * deviation, **band)
        axes.plot(time, error, color=COLOURS["path"], lw=1.4)
        axes.set_title(name, loc="left")
        axes.set(ylabel="error [deg]")
        ends = f"{deviation[0]:.1f} to {deviation[-1]:.1f} deg"
        inside = np.mean(np.abs(error) <= 2.0 * deviation)
        words.append(f"{name}: {ends}, error inside {100 * inside:.0f} % of the time")
    np.atleast_1d(rows)[-1].set_xlabel("time [s]")
    what = "The heading error over time in a band of twice the deviation that the filter claims"
    return Picture(figure, f"{what}, by what it sees. {'; '.join(words)}.")
