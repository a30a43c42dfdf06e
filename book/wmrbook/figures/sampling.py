"""Chapter 8: what the clock and the wheels do: time steps, inner loops, wheel limits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from wmrbook.figures._drawing import check_count
from wmrbook.figures.style import COLOURS, Picture, dart, new_figure
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.metrics import arrival
from wmrlib.runs import Trajectory
from wmrlib.simulation import simulate
from wmrlib.tuning import longest_step

_SERIES = (  # colour, line style and marker of each of up to five lines
    (COLOURS["path"], "-", "o"),
    (COLOURS["y_error"], "--", "s"),
    (COLOURS["theta"], "-.", "^"),
    (COLOURS["omega"], ":", "D"),
    (COLOURS["ink"], "-", ""),
)
_BESIDE = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5), "fontsize": 10}


def time_steps(
    start: Pose, goal: Pose, gains: Mapping[str, Gains], steps: Sequence[float]
) -> Picture:
    """The heading error on arrival against the time step [s], one panel for each of two gains.

    Thin vertical lines: the longest step of each method (`longest_step`). A cross at the top is a
    run that did not arrive.
    """
    check_count("gains", gains, 2, 2)
    figure, rows = new_figure(9.0, 6.6, rows=2)
    texts = []
    for axes, (name, tried) in zip(rows, gains.items(), strict=True):
        truth = _heading_left(arrival(simulate(start, goal, tried, method="continuous")))
        axes.axhline(truth, color=COLOURS["ink"], ls=":", label=f"continuous: {truth:.1f} deg")
        for method, colour, style, marker, top in (
            ("arc", COLOURS["path"], "-", "s", 186.0),
            ("euler", COLOURS["y_error"], "--", "o", 194.0),
        ):
            runs = [
                arrival(simulate(start, goal, tried, method=method, dt=float(dt))) for dt in steps
            ]
            limit = longest_step(tried, method)
            line = {"ls": style, "marker": marker, "ms": 4, "label": method}
            said = _draw_steps(axes, np.asarray(steps), runs, limit, top, colour, line)
            label = f"its longest step:\n{limit:.3f} s"
            axes.axvline(limit, color=colour, ls=style, lw=1.0, label=label)
            texts.append(f"{name}, {method}: {said}")
        axes.set(xscale="log", ylim=(-5.0, 200.0), yticks=range(0, 181, 45))
        axes.set_ylabel("|heading error| [deg]")
        axes.set_title(name, fontsize=12)
        axes.legend(**_BESIDE)
    rows[-1].set(xlabel="time step dt [s], crosses: did not arrive")
    rows[-1].xaxis.set_major_formatter("{x:g}")
    what = "Heading error on arrival against the time step, two panels"
    return Picture(figure, f"{what}: {'; '.join(texts)}.")


def inner_loops(cases: Mapping[str, Mapping[str, Trajectory]]) -> Picture:
    """The heading error against the distance left to the goal, one panel for each of two cases.

    cases: from a title to a mapping from an inner loop's label to its run, up to five.
    """
    check_count("cases", cases, 2, 2)
    figure, rows = new_figure(7.5, 6.8, rows=2)
    texts = []
    for axes, (title, runs) in zip(rows, cases.items(), strict=True):
        check_count("runs", runs, 1, len(_SERIES))
        for (label, run), (colour, style, _) in zip(runs.items(), _SERIES, strict=False):
            heading = np.degrees(run.theta - run.alpha)  # "continuous" never jumps
            axes.plot(run.rho, heading, style, color=colour, label=label)
            texts.append(f"{title}, {label}: {round(heading[-1])} deg")
        axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
        least = min(float(run.rho[-1]) for runs in cases.values() for run in runs.values())
        axes.set(xscale="log", xlim=(5.0, least), ylabel="heading error [deg]")
        axes.set_title(title, fontsize=12)
        axes.legend(title="inner loop", title_fontsize=10, **_BESIDE)
    rows[-1].set_xlabel("distance left to the goal [m], the goal to the right")
    rows[-1].xaxis.set_major_formatter("{x:g}")
    what = "Heading error against the distance left to the goal; where it ends"
    return Picture(figure, f"{what}: {'; '.join(texts)}.")


def wheel_limited_paths(paths: Mapping[str, Sequence[Pose]], goal: Pose) -> Picture:
    """Up to five paths from one start to `goal` under different limits, in metres.

    The text says how far each strays from the first, and which are indistinguishable from it.
    """
    check_count("paths", paths, 1, len(_SERIES))
    figure, axes = new_figure(5.0, 6.5)
    drawn = {label: np.array([pose[:2] for pose in poses]).T for label, poses in paths.items()}
    first, texts, alike = None, [], []
    for (label, (x, y)), (colour, style, _) in zip(drawn.items(), _SERIES, strict=False):
        looks = {"lw": 4.0, "alpha": 0.5} if first is None else {"lw": 2.0, "alpha": 1.0}
        axes.plot(x, y, style, color=colour, label=label, **looks)
        length = np.hypot(np.diff(x), np.diff(y)).sum()
        said = f"{label}: {length:.1f} m, as far as x = {x.max():.1f} m"
        if first is None:
            first = x, y
        else:
            strays = _strays(x, y, *first)
            said += f", at most {strays:.2f} m beside the first"
            if strays < 0.01 * max(np.ptp(each) for each in first):
                alike.append(f'"{label}"')  # quoted: a label may have a comma of its own
        texts.append(said)
    x, y = np.concatenate(list(drawn.values()), axis=1)
    size = 0.035 * max(np.ptp(x), np.ptp(y), 1.0)
    dart(axes, next(iter(paths.values()))[0], size, "start", "start", zorder=4)
    dart(axes, goal, size, "none", "goal", lw=2.0, zorder=4)
    axes.margins(0.1)
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    for role, fill in (("start", COLOURS["start"]), ("goal", "none")):
        looks = {"ls": "none", "marker": ">", "ms": 10, "mew": 2.0, "mec": COLOURS[role]}
        axes.plot([], [], label=role, mfc=fill, **looks)
    axes.legend(**_BESIDE)
    same = f". Indistinguishable from the first: {', '.join(alike)}" if alike else ""
    what = "Paths to the same goal, the open arrow, from the same start"
    return Picture(figure, f"{what}: {'; '.join(texts)}{same}.")


def _heading_left(run) -> float:
    return abs(math.degrees(run.heading_error))


def _draw_steps(axes: Axes, steps, runs, limit: float, top: float, colour: str, line) -> str:
    """The errors of one method, and crosses at `top` for runs that did not arrive; in words."""
    error = np.array([_heading_left(run) for run in runs])
    lost = ~np.array([run.arrived for run in runs])
    axes.plot(steps, np.where(lost, np.nan, error), color=colour, **line)
    axes.plot(steps[lost], np.full(lost.sum(), top), "x", color=colour, ms=6)
    below = np.flatnonzero((steps < limit) & ~lost)
    known = ""
    if below.size and below[-1]:
        known = f", {error[below[-1]]:.0f} deg at {steps[below[-1]]:.2g} s"
    first = f"{error[0]:.0f} deg at {steps[0]:g} s{known}"
    return f"{first}, longest step {limit:.3f} s, {lost.sum()} of {len(runs)} runs lost"


def _strays(x: np.ndarray, y: np.ndarray, along_x: np.ndarray, along_y: np.ndarray) -> float:
    """The greatest distance of the points from a polyline, m."""
    points, line = x + 1j * y, along_x + 1j * along_y
    pieces = np.diff(line)
    length = np.maximum(np.abs(pieces), 1e-12)
    ahead = (points[:, None] - line[:-1]) * (pieces / length).conj()
    return float(np.abs(ahead - np.clip(ahead.real, 0.0, length)).min(axis=1).max())
