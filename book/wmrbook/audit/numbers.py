"""Every number that the paper prints, against one that is computed here."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import sympy as sp

from wmrbook.audit.figures import AXES, MISSING, chase, drive
from wmrbook.audit.rows import Row, Verdict, fits
from wmrbook.ellipsoid import FLATTENING, SEMI_MAJOR_M, sphere_error
from wmrlib import paper
from wmrlib.geodesy import GeoPoint, haversine_distance, initial_bearing
from wmrlib.metrics import arrival, residual
from wmrlib.runs import Outcome
from wmrlib.tuning import modes

_WEIGHTS = (0.1, 1.0, 10.0)
_LAWS = (("aicardi",), *(("linear", weight) for weight in _WEIGHTS))


def rows() -> list[Row]:
    """A row for each key of `wmrlib.paper.PUBLISHED`, in its order."""
    found = _earth() | _circle() | _outdoor() | _loops()
    return [found[key] for key in paper.PUBLISHED]


def _row(key: str, verdict: Verdict, holds: str, why: str) -> Row:
    value, unit, place = paper.PUBLISHED[key]
    return Row(
        key,
        key.replace("_", " "),
        f"{_shown(value)} {unit}".strip() + f" ({place})",
        holds,
        verdict,
        why,
    )


def _shown(value: float) -> str:
    turns = Fraction(value / math.pi).limit_denominator(12)
    if turns and math.isclose(turns * math.pi, value, rel_tol=1e-12):
        over = f"/{turns.denominator}" if turns.denominator > 1 else ""
        return f"${sp.latex(sp.pi * turns.numerator)}{over}$"
    return f"{value:.10g}"


def _computed(key: str, *values: float, note: str = "{}") -> Row:
    """Holds if one of the computed values is what is printed; several are several readings of the paper."""
    agrees = any(fits(value, paper.PUBLISHED[key]) for value in values)
    why = "ours has the printed digits" if agrees else "no reading gives the printed digits"
    return _row(key, Verdict.HOLDS if agrees else Verdict.WRONG, note.format(*values), why)


def _given(key: str, used: float, works: bool, result: str) -> Row:
    """An input holds if the run that was made with it has the result that the paper reports."""
    same = used == paper.PUBLISHED[key].value
    if same and works:
        return _row(
            key,
            Verdict.HOLDS,
            f"An input: with it, {result}.",
            "the result that rests on it is reproduced",
        )
    why = (
        "the run with the paper's result used another value"
        if not same
        else "the result that rests on it is not reproduced"
    )
    return _row(key, Verdict.WRONG, f"An input: with {used:.10g}, {result}.", why)


def sphere_bounds() -> tuple[float, float]:
    """The least and the greatest error of the sphere on a short line, in percent."""
    errors = 100.0 * sphere_error(np.linspace(0.0, 90.0, 9001), np.array([[0.0], [math.pi / 2.0]]))
    return float(errors.min()), float(errors.max())


def _earth() -> dict[str, Row]:
    low, high = sphere_bounds()
    mean = SEMI_MAJOR_M * (3.0 - FLATTENING) / 3e3
    number = {
        key: paper.PUBLISHED[key].value
        for key in ("start_latitude", "start_longitude", "goal_latitude", "goal_longitude")
    }
    start, goal = (
        GeoPoint(lat=number[f"{end}_latitude"], lon=number[f"{end}_longitude"])
        for end in ("start", "goal")
    )
    distance, bearing = haversine_distance(start, goal), math.degrees(initial_bearing(start, goal))
    swapped = haversine_distance(*(GeoPoint(lat=each.lon, lon=each.lat) for each in (start, goal)))
    reproduced = fits(distance, paper.PUBLISHED["distance"])
    result = f"the distance is {distance:.2f} m (read in the other order, {swapped:.2f} m)"
    used = {"start": paper.GPS_POINT_1, "goal": paper.GPS_POINT_2}
    points = {
        f"{end}_{name}": _given(f"{end}_{name}", getattr(used[end], name[:3]), reproduced, result)
        for end in used
        for name in ("latitude", "longitude")
    }
    range_note = f"From {low:+.2f} % to {high:+.2f} %, by the radii of curvature; half of that range is {{:.3f}} %."
    return points | {
        "earth_radius": _computed(
            "earth_radius", mean, note="The mean radius of WGS84, (2a + b)/3, is {:.4f} km."
        ),
        "sphere_error": _computed("sphere_error", 0.5 * (high - low), note=range_note),
        "distance": _computed("distance", distance, note="(11) to (13) give {:.4f} m."),
        "bearing": _computed("bearing", bearing, note="(15) to (17) give {:.4f} deg."),
    }


def _circle() -> dict[str, Row]:
    run, gains, reference = (
        chase(),
        paper.CIRCLE_GAINS,
        paper.circle(np.array([0.0, 1e-4, paper.CIRCLE_PERIOD])),
    )
    behind = residual(run)
    works, result = (
        fits(behind, paper.PUBLISHED["circle_residual"]),
        f"the circle ends {behind:.4f} m behind",
    )
    tangent = math.atan2(reference.y[1] - reference.y[0], reference.x[1] - reference.x[0])
    lap = math.tau / float(np.gradient(reference.heading[:2], 1e-4)[0])
    return {
        **{f"lqr_{name}_advantage": _advantage(name) for name in "yx"},
        "circle_period": _computed(
            "circle_period", lap, note="The reference turns once in {:.1f} s."
        ),
        "circle_radius": _computed(
            "circle_radius",
            float(np.ptp(run.goal.x)) / 2,
            note="Half the width of the reference's path is {:.3f} m.",
        ),
        "circle_x_error": _computed(
            "circle_x_error", abs(float(run.x_error[0])), note="The first error in x is {:.3f} m."
        ),
        "circle_y_error": _computed(
            "circle_y_error", abs(float(run.y_error[0])), note="The first error in y is {:.3f} m."
        ),
        "circle_reference_heading": _tangent(tangent),
        "circle_start_heading": _given(
            "circle_start_heading", paper.CIRCLE_START.heading, works, result
        ),
        "circle_residual": _computed(
            "circle_residual",
            behind,
            note="{:.4f} m, with $v_{{\\max}} = 4$ m/s, which the paper does not give here.",
        ),
        **{
            f"circle_{name}": _given(f"circle_{name}", getattr(gains, name), works, result)
            for name in ("k_rho", "k_alpha", "h")
        },
    }


def _advantage(name: str) -> Row:
    """By how many percent an LQR's rms error on the circle is below a polar law's: with weights on both sides of what is printed, open."""
    key, rms = (
        f"lqr_{name}_advantage",
        [math.sqrt(np.mean(getattr(chase(*law), f"{name}_error") ** 2)) for law in _LAWS],
    )
    better = [100.0 * (1.0 - each / rms[0]) for each in rms[1:]]
    listed = ", ".join(
        f"{each:.1f} % with q = {weight:g}" for each, weight in zip(better, _WEIGHTS, strict=True)
    )
    text = f"On the paper's circle, an LQR with $Q = qI$ and $R = I$ is better than Aicardi's law by {listed}."
    if min(better) < paper.PUBLISHED[key].value < max(better):
        return _row(key, Verdict.OPEN, text, MISSING)
    return _row(key, Verdict.WRONG, text, "outside of what the weights tried give")


def _tangent(tangent: float) -> Row:
    key, wanted = "circle_reference_heading", paper.PUBLISHED["circle_reference_heading"].value
    agrees = abs(tangent - wanted) < 1e-4
    text = f"The reference sets out at {math.degrees(tangent):.2f} deg from the x axis."
    return _row(
        key,
        Verdict.HOLDS if agrees else Verdict.WRONG,
        text,
        "along the path's tangent" if agrees else "not along the path's tangent",
    )


def _outdoor() -> dict[str, Row]:
    runs, gains = {axis: drive(axis) for axis in AXES}, paper.OUTDOOR_GAINS
    works = all(run.outcome is Outcome.ARRIVED for run in runs.values())
    times = {axis: arrival(run).time for axis, run in runs.items()}
    result = f"the robot is within 5 cm after {times['east']:.1f} s (x east) or {times['north']:.1f} s (x north)"
    errors = {
        name: [abs(float(getattr(run, f"{name}_error")[0])) for run in runs.values()]
        for name in "xy"
    }
    both = "x east: {:.2f} m; x north: {:.2f} m."
    fastest = max(float(run.v.max()) for run in runs.values())
    return {
        "start_heading": _given("start_heading", paper.START_HEADING, works, result),
        "goal_heading": _given("goal_heading", paper.GOAL_HEADING, works, result),
        **{
            f"{name}_error_at_start": _computed(f"{name}_error_at_start", *errors[name], note=both)
            for name in "xy"
        },
        **{
            f"outdoor_{name}": _given(f"outdoor_{name}", getattr(gains, name), works, result)
            for name in ("k_rho", "k_alpha", "h")
        },
        "speed_limit": _computed(
            "speed_limit", fastest, note="The fastest of both runs is {:.4f} m/s."
        ),
    }


def slowest_pole(ratio: float) -> float:
    """The largest real part of the angles' poles near the goal, 1/s, behind wheels `ratio` times as fast as the distance's rate.

    Both commands lag by 1/(ratio rate). The robot then brakes late: v = p rho with p(1 - p lag) = rate.
    """
    gains = paper.OUTDOOR_GAINS
    rate = gains.v_max * gains.k_rho
    lag = 1.0 / (ratio * rate)
    p = (1.0 - math.sqrt(1.0 - 4.0 * rate * lag)) / (2.0 * lag)
    matrix = [
        [p, 0.0, -1.0],
        [p, 0.0, 0.0],
        [(gains.k_alpha + rate) / lag, rate * gains.h / lag, -1.0 / lag],
    ]
    return float(np.linalg.eigvals(np.array(matrix)).real.max())


def _loops() -> dict[str, Row]:
    gains, dt, ratio = (
        paper.OUTDOOR_GAINS,
        paper.PUBLISHED["time_step"].value,
        paper.PUBLISHED["inner_loop"].value,
    )
    growth = max(abs(1.0 + dt * pole) for pole in modes(gains).poles)
    border = gains.k_alpha / (gains.h * (gains.v_max * gains.k_rho) ** 2)
    step = f"An Euler step multiplies the angles near the goal by {growth:.3f}; only steps below {border:.3f} s shrink them."
    settles = growth < 1.0
    pole = slowest_pole(ratio)
    calmer = f"{slowest_pole(3 * ratio):+.2f} with {3 * ratio:g} times"
    wheels = f"The slowest pole at the goal is {pole:+.2f} 1/s with wheels {ratio:g} times faster, {calmer}."
    return {
        "time_step": _row(
            "time_step",
            Verdict.HOLDS if settles else Verdict.WRONG,
            step,
            "the angles shrink" if settles else "the angles grow, so that the pose can't converge",
        ),
        "inner_loop": _row(
            "inner_loop",
            Verdict.HOLDS if pole < 0.0 else Verdict.WRONG,
            wheels,
            "the heading settles"
            if pole < 0.0
            else "too slow for the paper's own gains: the heading does not settle",
        ),
    }
