"""Figures of what the clock and the wheels do: time steps, orders of convergence, inner loops, wheel limits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from wmrlib.gains import Gains
from wmrlib.kinematics import Pose
from wmrlib.metrics import arrival
from wmrlib.plots.picture import Picture
from wmrlib.plots.style import COLOURS, arrow, new_figure
from wmrlib.runs import Trajectory
from wmrlib.simulation import simulate
from wmrlib.tuning import longest_step

_METHODS = {"arc": (COLOURS["path"], "-", "s"), "euler": (COLOURS["goal"], "--", "o")}
_SERIES = tuple(
    zip(
        ("path", "goal", "start", "omega", "ink"),
        ("-", "--", "-.", ":", "-"),
        ("o", "s", "^", "D", ""),
        strict=True,
    )
)


def time_steps(
    start: Pose, goal: Pose, gains: Mapping[str, Gains], steps: Sequence[float]
) -> Picture:
    """The size of the heading error on arrival against the time step [s], for "euler", "arc" and "continuous", one panel for each gains.

    gains: from a name to two Gains. Thin vertical lines: the longest step of each method (`longest_step`). A cross at the top is a run
    that did not arrive. Runs every step with `simulate`. Raises ValueError as `simulate`, and for other than two gains.
    """
    _as_many("gains", gains, 2)
    figure, panels = new_figure(9.0, 6.6, rows=2)
    texts = []
    for axes, (name, tried) in zip(panels, gains.items(), strict=True):
        truth = abs(
            math.degrees(arrival(simulate(start, goal, tried, method="continuous")).heading_error)
        )
        axes.axhline(truth, color=COLOURS["ink"], ls=":", label=f"continuous: {truth:.1f} deg")
        for method, (colour, style, marker) in _METHODS.items():
            runs = [
                arrival(simulate(start, goal, tried, method=method, dt=float(dt))) for dt in steps
            ]
            error = np.array([abs(math.degrees(run.heading_error)) for run in runs])
            lost = ~np.array([run.arrived for run in runs])
            limit = longest_step(tried, method)
            axes.plot(
                steps,
                np.where(lost, np.nan, error),
                style,
                color=colour,
                marker=marker,
                ms=4,
                label=method,
            )
            axes.plot(
                np.asarray(steps)[lost],
                np.full(lost.sum(), 186.0 if method == "arc" else 194.0),
                "x",
                color=colour,
                ms=6,
            )
            axes.axvline(
                limit, color=colour, ls=style, lw=1.0, label=f"its longest step:\n{limit:.3f} s"
            )
            below = np.flatnonzero((np.asarray(steps) < limit) & ~lost)
            known = (
                f", {error[below[-1]]:.0f} deg at {steps[below[-1]]:.2g} s"
                if below.size and below[-1]
                else ""
            )
            first, lost_runs = (
                f"{error[0]:.0f} deg at {steps[0]:g} s{known}",
                f"{lost.sum()} of {len(runs)} runs lost",
            )
            texts.append(f"{name}, {method}: {first}, longest step {limit:.3f} s, {lost_runs}")
        axes.set(
            xscale="log",
            ylim=(-5.0, 200.0),
            yticks=range(0, 181, 45),
            ylabel="|heading error| [deg]",
        )
        axes.set_title(name, fontsize=12)
        axes.legend(fontsize=10, loc="center left", bbox_to_anchor=(1.0, 0.5))
    panels[-1].set(xlabel="time step dt [s], crosses: did not arrive")
    panels[-1].xaxis.set_major_formatter("{x:g}")
    return Picture(
        figure,
        "Heading error on arrival against the time step, two panels: " + "; ".join(texts) + ".",
    )


def orders(
    steps: Sequence[float], errors: Mapping[str, Sequence[float]], what: str = "error [m]"
) -> Picture:
    """Errors against the time step [s], both logarithmic; the slope of each line is in the legend. Up to five lines."""
    _at_most("errors", errors, len(_SERIES))
    figure, axes = new_figure(7.0, 4.2)
    texts = []
    for (name, values), (colour, style, marker) in zip(errors.items(), _SERIES, strict=False):
        slope = np.polyfit(np.log(steps), np.log(values), 1)[0]
        axes.plot(
            steps,
            values,
            style,
            color=COLOURS[colour],
            marker=marker,
            label=f"{name}: slope {slope:.2f}",
        )
        texts.append(f"{name} with slope {slope:.2f}, {values[-1]:.2g} at {steps[-1]:g} s")
    axes.set(xscale="log", yscale="log", xlabel="time step dt [s]", ylabel=what)
    axes.legend(loc="upper left", fontsize=10)
    return Picture(
        figure,
        "Straight lines in logarithmic scales, errors against the time step: "
        + "; ".join(texts)
        + ".",
    )


def responses(
    t: Sequence[float],
    series: Mapping[str, Sequence[float]],
    what: str = "wheel speed / commanded [1]",
) -> Picture:
    """Answers to a unit step over time [s], with a line at 1. Up to five."""
    _at_most("series", series, len(_SERIES))
    figure, axes = new_figure(7.0, 3.8)
    axes.axhline(1.0, color=COLOURS["ink"], lw=0.8)
    texts = []
    for (name, values), (colour, style, _) in zip(series.items(), _SERIES, strict=False):
        axes.plot(t, values, style, color=COLOURS[colour], label=name)
        late = float(np.interp(0.632, np.maximum.accumulate(values), t))
        texts.append(f"{name} reaches 63 % after {late:.3f} s")
    axes.set(xlabel="time [s]", ylabel=what, ylim=(0.0, 1.15))
    axes.legend(loc="lower right", fontsize=10)
    return Picture(figure, "Answers to a unit step, all rising to 1: " + "; ".join(texts) + ".")


def inner_loops(cases: Mapping[str, Mapping[str, Trajectory]]) -> Picture:
    """The heading error against the distance left to the goal, one panel for each of two cases, one line for each inner loop (up to five).

    cases: from a title to a mapping from a label to a run. Raises ValueError for other numbers of cases or lines.
    """
    _as_many("cases", cases, 2)
    figure, panels = new_figure(7.5, 6.8, rows=2)
    texts = []
    for axes, (title, runs) in zip(panels, cases.items(), strict=True):
        _at_most("runs", runs, len(_SERIES))
        for (label, run), (colour, style, _) in zip(runs.items(), _SERIES, strict=False):
            heading = np.degrees(run.theta - run.alpha)  # "continuous" never jumps
            axes.plot(run.rho, heading, style, color=COLOURS[colour], label=label)
            texts.append(f"{title}, {label}: {heading[-1]:.0f} deg")
        axes.axhline(0.0, color=COLOURS["ink"], lw=0.8)
        axes.set(xscale="log", xlim=(5.0, 0.05), ylabel="heading error [deg]")
        axes.set_title(title, fontsize=12)
        axes.legend(
            title="inner loop",
            fontsize=10,
            title_fontsize=10,
            loc="center left",
            bbox_to_anchor=(1.0, 0.5),
        )
    panels[-1].set_xlabel("distance left to the goal [m], the goal to the right")
    panels[-1].set_xticks(
        [5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05], ["5", "2", "1", "0.5", "0.2", "0.1", "0.05"]
    )
    panels[-1].minorticks_off()
    return Picture(
        figure,
        "Heading error against the distance left to the goal; where it ends: "
        + "; ".join(texts)
        + ".",
    )


def driven(paths: Mapping[str, Sequence[Pose]], goal: Pose) -> Picture:
    """Paths of one robot under different limits, from the first pose of each (the same) to `goal`, in metres, equal scales. Up to five.

    The text says how far each strays from the first, and which can't be told from it.
    """
    _at_most("paths", paths, len(_SERIES))
    figure, axes = new_figure(5.0, 6.5)
    texts, everything, alike = [], [], []
    for (label, poses), (colour, style, _) in zip(paths.items(), _SERIES, strict=False):
        x, y = np.array([pose.x for pose in poses]), np.array([pose.y for pose in poses])
        axes.plot(
            x,
            y,
            style,
            color=COLOURS[colour],
            label=label,
            lw=4.0 if not everything else 2.0,
            alpha=0.5 if not everything else 1.0,
        )
        everything.append((x, y))
        strays = _strays(x, y, *everything[0]) if len(everything) > 1 else 0.0
        beside = f", at most {strays:.2f} m beside the first" if len(everything) > 1 else ""
        if len(everything) > 1 and strays < 0.01 * max(np.ptp(each) for each in everything[0]):
            alike.append(label)
        texts.append(
            f"{label}: {np.hypot(np.diff(x), np.diff(y)).sum():.1f} m, as far as x = {x.max():.1f} m{beside}"
        )
    x, y = (np.concatenate(each) for each in zip(*everything, strict=True))
    size = 0.035 * max(np.ptp(x), np.ptp(y), 1.0)
    first = next(iter(paths.values()))[0]
    axes.add_patch(arrow(first, size, fc=COLOURS["start"], ec=COLOURS["start"], zorder=4))
    axes.add_patch(arrow(goal, size, fc="none", ec=COLOURS["goal"], lw=2.0, zorder=4))
    axes.margins(0.1)
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    for label, fill, edge in (
        ("start", COLOURS["start"], COLOURS["start"]),
        ("goal", "none", COLOURS["goal"]),
    ):
        axes.plot([], [], ls="none", marker=">", ms=10, mfc=fill, mec=edge, mew=2.0, label=label)
    axes.legend(fontsize=10, loc="center left", bbox_to_anchor=(1.0, 0.5))
    same = f". Not to be told from the first: {', '.join(map(_quoted, alike))}" if alike else ""
    return Picture(
        figure,
        f"Paths to the same goal, the open arrow, from the same start: {'; '.join(texts)}{same}.",
    )


def _quoted(label: str) -> str:
    return f'"{label}"'  # a label may have a comma of its own


def _strays(x: np.ndarray, y: np.ndarray, along_x: np.ndarray, along_y: np.ndarray) -> float:
    """The greatest distance of the points from a polyline, m."""
    points, begin = x + 1j * y, along_x + 1j * along_y
    begin, pieces = begin[:-1], np.diff(begin)
    length = np.maximum(np.abs(pieces), 1e-12)
    ahead = (points[:, None] - begin) * (pieces / length).conj()
    return float(np.abs(ahead - np.clip(ahead.real, 0.0, length)).min(axis=1).max())


def _as_many(name: str, entries: Mapping, wanted: int) -> None:
    if len(entries) != wanted:
        raise ValueError(
            f"{name} has {len(entries)} entries, which is not allowed: {wanted} are needed"
        )


def _at_most(name: str, entries: Mapping, most: int) -> None:
    if not 1 <= len(entries) <= most:
        raise ValueError(
            f"{name} has {len(entries)} entries, which is not allowed: 1 to {most} are needed"
        )
