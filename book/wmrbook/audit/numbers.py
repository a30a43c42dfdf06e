"""Every number that the paper prints, against one that is computed here."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import sympy as sp

from wmrbook.audit.figures import AXES, MISSING, circle_run, outdoor_run
from wmrbook.audit.row import Row, Verdict, fits
from wmrbook.ellipsoid import FLATTENING, SEMI_MAJOR_M, sphere_error
from wmrbook.published import PUBLISHED
from wmrlib import paper
from wmrlib.geodesy import GeoPoint, haversine_distance, initial_bearing
from wmrlib.metrics import arrival, residual
from wmrlib.runs import Outcome
from wmrlib.tuning import longest_step, modes

_WEIGHTS = (0.1, 1.0, 10.0)


def rows() -> list[Row]:
    """A row for each key of `wmrbook.published.PUBLISHED`, in its order."""
    every = [*_earth(), *_circle(), *_outdoor(), *_loops()]
    found = {row.item: row for row in every}
    return [found[key] for key in PUBLISHED]


def _row(key: str, verdict: Verdict | bool, holds: str, why: str) -> Row:
    if isinstance(verdict, bool):
        verdict = Verdict.HOLDS if verdict else Verdict.WRONG
    value, unit, place = PUBLISHED[key]
    says = f"{_shown(value)} {unit}".strip() + f" ({place})"
    return Row(key, key.replace("_", " "), says, holds, verdict, why)


def _shown(value: float) -> str:
    turns = Fraction(value / math.pi).limit_denominator(12)
    if turns and math.isclose(turns * math.pi, value, rel_tol=1e-12):
        over = f"/{turns.denominator}" if turns.denominator > 1 else ""
        return f"${sp.latex(sp.pi * turns.numerator)}{over}$"
    return f"{value:.10g}"


def _computed(key: str, note: str, *values: float) -> Row:
    """Holds if one of the values is what is printed; several are several readings of the paper."""
    agrees = any(fits(value, PUBLISHED[key]) for value in values)
    why = "ours has the printed digits" if agrees else "no reading gives the printed digits"
    return _row(key, agrees, note.format(*values), why)


def _given(key: str, used: float, works: bool, result: str) -> Row:
    """An input holds if the run that was made with it has the result that the paper reports."""
    if used != PUBLISHED[key].value:
        why = "the run with the paper's result used another value"
        return _row(key, False, f"An input: with {used:.10g}, {result}.", why)
    if not works:
        why = "the result that rests on it is not reproduced"
        return _row(key, False, f"An input: with {used:.10g}, {result}.", why)
    why = "the result that rests on it is reproduced"
    return _row(key, True, f"An input: with it, {result}.", why)


def sphere_bounds() -> tuple[float, float]:
    """The least and the greatest error of the sphere on a short line, in percent."""
    latitudes = np.linspace(0.0, 90.0, 9001)[:, None]
    errors = 100.0 * sphere_error(latitudes, np.array([0.0, math.pi / 2.0]))
    return float(errors.min()), float(errors.max())


def _earth() -> list[Row]:
    low, high = sphere_bounds()
    mean = SEMI_MAJOR_M * (3.0 - FLATTENING) / 3e3
    used = {"start": paper.GPS_POINT_1, "goal": paper.GPS_POINT_2}
    names = {"latitude": "lat", "longitude": "lon"}
    start, goal = (
        GeoPoint(**{names[name]: PUBLISHED[f"{end}_{name}"].value for name in names})
        for end in used
    )
    distance, bearing = haversine_distance(start, goal), math.degrees(initial_bearing(start, goal))
    swapped = haversine_distance(*(GeoPoint(lat=each.lon, lon=each.lat) for each in (start, goal)))
    reproduced = fits(distance, PUBLISHED["distance"])
    result = f"the distance is {distance:.2f} m (read in the other order, {swapped:.2f} m)"
    sphere_note = (
        f"From {low:+.2f} % to {high:+.2f} %, by the radii of curvature; "
        "half of that range is {:.3f} %."
    )
    return [
        *(
            _given(f"{end}_{name}", getattr(point, names[name]), reproduced, result)
            for end, point in used.items()
            for name in names
        ),
        _computed("earth_radius", "The mean radius of WGS84, (2a + b)/3, is {:.4f} km.", mean),
        _computed("sphere_error", sphere_note, 0.5 * (high - low)),
        _computed("distance", "(11) to (13) give {:.4f} m.", distance),
        _computed("bearing", "(15) to (17) give {:.4f} deg.", bearing),
    ]


def _circle() -> list[Row]:
    run = circle_run()
    reference = paper.circle(np.array([0.0, 1e-4]))
    x, y, heading = (float(np.diff(field)[0]) for field in reference[:3])
    lap, width = math.tau * 1e-4 / heading, float(np.ptp(run.goal.x))
    behind = residual(run)
    works = fits(behind, PUBLISHED["circle_residual"])
    result = f"the circle ends {behind:.4f} m behind"
    inputs = {"start_heading": paper.CIRCLE_START.heading}
    inputs |= {name: getattr(paper.CIRCLE_GAINS, name) for name in ("k_rho", "k_alpha", "h")}
    left = "{:.4f} m, with $v_{{\\max}} = 4$ m/s, which the paper does not give here."
    return [
        *(_advantage(f"lqr_{name}_advantage", f"{name}_error") for name in "yx"),
        *(_given(f"circle_{name}", value, works, result) for name, value in inputs.items()),
        *(
            _computed(
                f"circle_{name}_error",
                f"The first error in {name} is {{:.3f}} m.",
                abs(float(getattr(run, f"{name}_error")[0])),
            )
            for name in "xy"
        ),
        _computed("circle_period", "The reference turns once in {:.1f} s.", lap),
        _computed(
            "circle_radius", "Half the width of the reference's path is {:.3f} m.", width / 2
        ),
        _computed("circle_residual", left, behind),
        _tangent(math.atan2(y, x)),
    ]


def _advantage(key: str, error: str) -> Row:
    """By how many percent an LQR's rms error on the circle is below a polar law's.

    Weights give advantages on both sides of what is printed: open.
    """
    laws = [("aicardi",), *(("linear", weight) for weight in _WEIGHTS)]
    polar, *lqr = (math.sqrt(np.mean(getattr(circle_run(*law), error) ** 2)) for law in laws)
    better = [100.0 * (1.0 - each / polar) for each in lqr]
    listed = ", ".join(
        f"{each:.1f} % with q = {weight:g}" for each, weight in zip(better, _WEIGHTS, strict=True)
    )
    text = (
        "On the paper's circle, an LQR with $Q = qI$ and $R = I$ "
        f"is better than Aicardi's law by {listed}."
    )
    if min(better) < PUBLISHED[key].value < max(better):
        return _row(key, Verdict.OPEN, text, MISSING)
    return _row(key, False, text, "outside of what the weights tried give")


def _tangent(tangent: float) -> Row:
    key = "circle_reference_heading"
    agrees = abs(tangent - PUBLISHED[key].value) < 1e-4
    text = f"The reference sets out at {math.degrees(tangent):.2f} deg from the x axis."
    return _row(key, agrees, text, f"{'' if agrees else 'not '}along the path's tangent")


def _outdoor() -> list[Row]:
    runs = [outdoor_run(axis) for axis in AXES]
    works = all(run.outcome is Outcome.ARRIVED for run in runs)
    times = (f"{arrival(run).time:.1f} s (x {axis})" for axis, run in zip(AXES, runs, strict=True))
    result = f"the robot is within 5 cm after {' or '.join(times)}"
    inputs = {"start_heading": paper.START_HEADING, "goal_heading": paper.GOAL_HEADING}
    inputs |= {
        f"outdoor_{name}": getattr(paper.OUTDOOR_GAINS, name) for name in ("k_rho", "k_alpha", "h")
    }
    both = "x east: {:.2f} m; x north: {:.2f} m."
    fastest = max(float(run.v.max()) for run in runs)
    return [
        *(_given(key, used, works, result) for key, used in inputs.items()),
        *(
            _computed(
                f"{name}_at_start", both, *(abs(float(getattr(run, name)[0])) for run in runs)
            )
            for name in ("x_error", "y_error")
        ),
        _computed("speed_limit", "The fastest of both runs is {:.4f} m/s.", fastest),
    ]


def slowest_pole(ratio: float) -> float:
    """The largest real part [1/s] of the angles' poles behind wheels `ratio` times as fast.

    As fast as the distance's rate: both commands lag by 1/(ratio rate). The robot then brakes late:
    v = p rho with p(1 - p lag) = rate.
    """
    gains = paper.OUTDOOR_GAINS
    rate = gains.v_max * gains.k_rho
    lag = 1.0 / (ratio * rate)
    p = (1.0 - math.sqrt(1.0 - 4.0 * rate * lag)) / (2.0 * lag)
    turning = [(gains.k_alpha + rate) / lag, rate * gains.h / lag, -1.0 / lag]
    matrix = np.array([[p, 0.0, -1.0], [p, 0.0, 0.0], turning])
    return float(np.linalg.eigvals(matrix).real.max())


def _loops() -> list[Row]:
    gains, dt = paper.OUTDOOR_GAINS, PUBLISHED["time_step"].value
    growth = max(abs(1.0 + dt * pole) for pole in modes(gains).poles)
    border = longest_step(gains, "polar_euler")
    step = (
        f"An Euler step multiplies the angles near the goal by {growth:.3f}; "
        f"only steps below {border:.3f} s shrink them."
    )
    shrinking = "the angles shrink"
    growing = "the angles grow, so that the pose can't converge"
    ratio = PUBLISHED["inner_loop"].value
    pole = slowest_pole(ratio)
    wheels = (
        f"The slowest pole at the goal is {pole:+.2f} 1/s with wheels {ratio:g} times faster, "
        f"{slowest_pole(3 * ratio):+.2f} with {3 * ratio:g} times."
    )
    slow = "too slow for the paper's own gains: the heading does not settle"
    settles = "the heading settles" if pole < 0.0 else slow
    return [
        _row("time_step", growth < 1.0, step, shrinking if growth < 1.0 else growing),
        _row("inner_loop", pole < 0.0, wheels, settles),
    ]
