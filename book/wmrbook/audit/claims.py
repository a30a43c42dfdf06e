"""What the paper prints as a number or says in words, each sentence judged once.

Inputs such as gains, and what any gains would make true, such as that the distance falls, have no
row: they could not fail. Nor has "smooth", for which the paper gives no measure.
"""

from __future__ import annotations

import math
from functools import cache
from itertools import product

import numpy as np

from wmrbook.audit.equations import polar_rates
from wmrbook.audit.proof import CLOSED, law_row, rising, slope, steering
from wmrbook.audit.published import PUBLISHED
from wmrbook.audit.row import THRESHOLDS, Row, Verdict, decide, equivalent, fits, latex, printed
from wmrbook.ellipsoid import FLATTENING, SEMI_MAJOR_M, sphere_error
from wmrbook.equations import theta_rate
from wmrlib import paper
from wmrlib.body import Wheels
from wmrlib.geodesy import EARTH_RADIUS_M, GeoPoint, haversine_distance, initial_bearing
from wmrlib.metrics import arrival, residual
from wmrlib.runs import Trajectory
from wmrlib.simulation import simulate, track
from wmrlib.symbolic import alpha, rho
from wmrlib.tuning import longest_step, modes

AXES = ("east", "north")
_METHODS = ("polar_euler", "euler", "arc", "continuous")
STEPS = ("continuous", "arc", "euler")  # ways of stepping in the plane, at the printed 0.1 s
_BLOCK_DIAGRAM = "Block diagram of the mobile robot controller."
CAPTIONS = {
    1: "Coordinate System Mobile Robot.",
    2: "Mobile robot pose to pose configuration.",
    **dict.fromkeys(range(3, 8), _BLOCK_DIAGRAM),
    8: "Simulation sense of the tracking performance for the proposed mobile robot.",
    9: "Linear velocity profile.",
    10: "Angular velocity profile.",
    11: "Tracking error in the x-direction.",
    12: "Tracking error in the y-direction.",
}
"""What the paper prints below each figure; the pictures themselves are not in this repository."""


@cache
def outdoor_run(
    x_axis: str, radius: float, law: str = "corrected", method: str = "continuous"
) -> Trajectory:
    """The outdoor case until `radius` before the goal, x "east" or "north"."""
    case = paper.outdoor(x_axis)
    dt = 0.01 if method == "continuous" else PUBLISHED["time_step"].value
    options = {"law": law, "method": method, "arrival_radius": radius, "dt": dt}
    return simulate(case.start, case.goal, case.gains, **options)


@cache
def circle_run(
    law: str = "corrected", wheels=None, method: str = "continuous", **changed: float
) -> Trajectory:
    """The circle with the paper's gains but for those that are changed; with wheels, in arcs."""
    gains = paper.CIRCLE_GAINS._replace(**changed)
    options = {"law": law, "wheels": wheels, "duration": paper.CIRCLE_PERIOD}
    options["method"] = "arc" if wheels else method
    return track(paper.circle, paper.CIRCLE_START, gains, **options)


# Numbers ----------------------------------------------------------------------------------------


def numbers() -> list[Row]:
    """A row for each number of `PUBLISHED` that is not an input or another work's, in its order."""
    rows = {row.item: row for row in [*_earth(), *_circle(), *_outdoor(), *_loops()]}
    return [rows[key] for key in PUBLISHED if key in rows]


def _number(key: str, verdict: Verdict, holds: str, why: str) -> Row:
    value, unit, place = PUBLISHED[key]
    text = r"$\pi/2$" if value == math.pi / 2 else f"{value:.10g}"
    return Row(key, key.replace("_", " "), f"{text} {unit} ({place})", holds, verdict, why)


def _computed(key: str, note: str, readings: dict[str, float]) -> Row:
    """Holds if one reading of the paper gives the printed number; `why` names that reading."""
    printed = PUBLISHED[key]
    verdict = decide(lambda cut: any(fits(it, printed, cut) for it in readings.values()), "cut")
    if verdict is Verdict.OPEN:
        why = "It depends on how much a cut may lose."
    elif verdict is Verdict.HOLDS:
        by = [name for name, value in readings.items() if fits(value, printed)]
        alone = f", with {by[0]} only" if len(by) < len(readings) else ""
        why = f"Ours has the printed digits{alone}."
    else:
        why = "No consistent reading gives the printed digits."
    return _number(key, verdict, note.format(*readings.values()), why)


def _earth() -> list[Row]:
    latitudes = np.linspace(0.0, 90.0, 9001)[:, None]
    errors = 100.0 * sphere_error(latitudes, np.array([0.0, math.pi / 2.0]))
    low, high = float(errors.min()), float(errors.max())  # of short lines
    start, goal = (
        GeoPoint(lat=PUBLISHED[f"{end}_latitude"].value, lon=PUBLISHED[f"{end}_longitude"].value)
        for end in ("start", "goal")
    )
    mean = "The mean radius of WGS84, (2a + b)/3, is {:.4f} km."
    measures = {
        "half of the range": 0.5 * (high - low),
        "the largest error": max(-low, high),
        "that of the paper's pair": 100.0 * sphere_error(start.lat, initial_bearing(start, goal)),
    }
    sphere = f"From {low:+.2f} % to {high:+.2f} %: "
    sphere += ", ".join(f"{name} is {value:.2f} %" for name, value in measures.items()) + "."
    meant = decide(
        lambda name, cut: fits(measures[name], PUBLISHED["sphere_error"], cut),
        "cut",
        over=[(name,) for name in measures],
    )
    why = "It depends on which error is meant."
    if meant is not Verdict.OPEN:
        why = "The verdict is the same, whichever error is meant."
    bearing = math.degrees(initial_bearing(start, goal))
    return [
        _computed("earth_radius", mean, {"": SEMI_MAJOR_M * (3.0 - FLATTENING) / 3e3}),
        _number("sphere_error", meant, sphere, why),
        _computed("distance", "(11) to (13) give {:.4f} m.", {"": haversine_distance(start, goal)}),
        _computed("bearing", "(15) to (17) give {:.4f} deg.", {"": bearing}),
    ]


def _circle() -> list[Row]:
    x, y = (np.diff(field)[0] for field in paper.circle(np.array([0.0, 1e-9]))[:2])
    key, choices = "circle_residual", [factor * THRESHOLDS["v_max"] for factor in (0.5, 1.0, 2.0)]
    behind = ", ".join(f"{residual(circle_run(v_max=v)):.3f} m with {v:g} m/s" for v in choices)
    verdict = decide(
        lambda by, v, cut: fits(residual(circle_run(method=by, v_max=v)), PUBLISHED[key], cut),
        *("v_max", "cut"),
        over=[(by,) for by in STEPS],
    )
    so = verdict is not Verdict.OPEN
    text = f"In continuous time it is {behind} as the limit $v_{{\\max}}$."
    why = "It depends on the circle's speed limit, which the paper does not give."
    if so:
        why = "It is so with each limit."
    tangent = math.degrees(math.atan2(y, x))
    agrees = abs(tangent - math.degrees(PUBLISHED["circle_reference_heading"].value)) < 1e-4
    return [
        _number(
            "circle_reference_heading",
            Verdict.HOLDS if agrees else Verdict.WRONG,
            f"The reference sets out at {tangent:.2f} deg from the x axis.",
            f"It is {'' if agrees else 'not '}the direction of the path's tangent.",
        ),
        _number(key, verdict, text, why),
    ]


def _outdoor() -> list[Row]:
    goals = {f"x {axis}": paper.outdoor(axis).goal for axis in AXES}
    both = "x east: {:.2f} m; x north: {:.2f} m."
    ends = [PUBLISHED[f"{end}_longitude"].value for end in ("start", "goal")]
    mixed = EARTH_RADIUS_M * math.radians(ends[1] - ends[0]) * math.cos(math.radians(ends[0]))
    mixture = f" The cosine of the longitude, for the latitude's, would give {mixed:.2f} m."
    return [
        _computed(
            f"{name}_error_at_start",
            both + (mixture if name == "y" else ""),
            {reading: abs(getattr(goal, name)) for reading, goal in goals.items()},
        )
        for name in "xy"
    ]


def slowest_pole(rate: float) -> float:
    """The largest real part [1/s] of the angles' poles, both commands lagging by 1/rate.

    The robot then brakes late: v = p rho with p(1 - p lag) = v_max k_rho. Infinite if there is no
    such p.
    """
    gains, lag = paper.OUTDOOR_GAINS, 1.0 / rate
    steep = gains.v_max * gains.k_rho
    if 4.0 * steep * lag > 1.0:
        return math.inf
    p = (1.0 - math.sqrt(1.0 - 4.0 * steep * lag)) / (2.0 * lag)
    turning = [(gains.k_alpha + steep) / lag, steep * gains.h / lag, -1.0 / lag]
    matrix = np.array([[p, 0.0, -1.0], [p, 0.0, 0.0], turning])
    return float(np.linalg.eigvals(matrix).real.max())


def _loops() -> list[Row]:
    gains, dt = paper.OUTDOOR_GAINS, PUBLISHED["time_step"].value
    borders = {method: longest_step(gains, method) for method in _METHODS}
    step = "It must be below {:.3f} s with Euler in polar coordinates, {:.3f} s with Euler and "
    step += "{:.3f} s with arcs in the plane; a solver may print every 0.1 s."
    ratio, main = PUBLISHED["inner_loop"].value, modes(gains)
    rates = {"the distance's": main.distance_rate}
    rates |= {r"$1/\Delta t$": 1.0 / dt, r"$2\pi/\Delta t$": math.tau / dt}
    poles = {name: slowest_pole(ratio * rate) for name, rate in rates.items()}
    wheels = ", ".join(f"{pole:+.2g} 1/s if that is {name}" for name, pole in poles.items())
    verdicts = {
        "time_step": decide(lambda method: dt < borders[method], over=[(m,) for m in _METHODS]),
        "inner_loop": decide(lambda name: poles[name] < 0.0, over=[(name,) for name in rates]),
    }
    texts = {"time_step": step.format(*borders.values())}
    texts["inner_loop"] = f"The slowest pole with wheels {ratio:g} times the main rate: {wheels}."
    whys = {
        "time_step": "It depends on how the authors stepped, which the paper does not say.",
        "inner_loop": "It depends on which rate is the main loop's.",
    }
    return [
        _number(
            key,
            verdict,
            texts[key],
            whys[key] if verdict is Verdict.OPEN else "It is so in each case.",
        )
        for key, verdict in verdicts.items()
    ]


# Statements -------------------------------------------------------------------------------------


def statements() -> list[Row]:
    """A row for each statement, those about figures included."""
    return [
        _captions(),
        _reference(),
        _stable(),
        _tracking(),
        _better(),
        _still(),
        _pose(),
        _figure_5(),
    ]


def _claim(name: str, title: str, says: str, holds: str, verdict: Verdict, *whys: str) -> Row:
    """whys: the reason if it holds, if it does not, and if it is not decided."""
    order = (Verdict.HOLDS, Verdict.WRONG, Verdict.OPEN)
    why = whys[order.index(verdict)] if verdict in order else whys[1]
    return Row(f"claim-{name}", title, says, holds, verdict, why)


def _captions() -> Row:
    texts = list(CAPTIONS.values())
    again = [number for number, text in CAPTIONS.items() if texts.index(text) != number - 1]
    verdict = Verdict.TYPO if again else Verdict.HOLDS
    listed = ", ".join(map(str, again)) or "none"
    text = f"The caption of another figure is below Figs. {listed}."
    whys = (
        "Each figure has its own caption.",
        "One caption was copied, in print or in conversion: the text names what they show.",
    )
    return _claim("captions", "Captions", f'Fig. 3: "{CAPTIONS[3]}"', text, verdict, *whys)


def _reference() -> Row:
    """Whose theta (14) computes: that of the equation to which the paper points, or of another."""
    sight = polar_rates()[2]
    by_5 = {theta_rate: printed(5)}  # (6) by itself gives theta no rate
    rates = {"(6)": printed(6)[2].subs(by_5), "(8)": printed(8), "(10)": printed(10)[2]}
    meant = [name for name, rate in rates.items() if equivalent(rate, sight)]
    verdict = Verdict.HOLDS if "(6)" in meant else Verdict.TYPO if meant else Verdict.WRONG
    text = f"In (6) $\\theta$ is the heading, with the rate ${latex(rates['(6)'])}$ by (5). "
    text += f"In (14) it is the line of sight, with the rate ${latex(sight)}$."
    whys = (
        "(6) is about the same angle.",
        f"One number is wrong: {' and '.join(meant)} has the angle that (14) gives."
        if meant
        else "No equation has the angle that (14) gives.",
    )
    says = "Recalling Eq. (6) to find $\\theta$ from the bearing (above (14))."
    row = _claim("reference", "A reference", says, text, verdict, *whys)
    return row


def _stable() -> Row:
    """A claim about the law, so it stands or falls with (24), as far as V' proves anything."""
    proved = equivalent(slope(steering()), CLOSED)
    verdict = law_row().verdict if proved else Verdict.WRONG
    rises = rising(slope(printed(24))) is not None
    text = "With (24) as printed $\\dot V$ rises somewhere, for all gains. " if rises else ""
    text += "At $\\rho = \\alpha = 0$ $\\dot V = 0$ under any law: "
    text += "LaSalle's theorem is needed too (chapter 4)."
    slip = "For a goal at rest it is true of (24) without its slip, and not of (24) as printed."
    wrong = slip if verdict is Verdict.TYPO else "The law does not stabilise."
    whys = "It is true of (24) as printed, for a goal at rest.", wrong
    says = "The globally asymptotic stability of the controller had been proved (section 5)."
    return _claim("stable", "Stability", says, text, verdict, *whys)


def _tracking() -> Row:
    """The same claim for the first case, whose goal moves: whether an error of zero can stay."""
    slow = {rho: 0, alpha: 0}
    commanded, driven = float(printed(22).subs(slow)), paper.CIRCLE_SPEED
    keeps_up = math.isclose(commanded, driven, abs_tol=1e-9)
    verdict = _stable().verdict if keeps_up else Verdict.WRONG
    text = (
        "(7) to (9), and with them $\\dot V$, belong to a goal at rest. The circle's goal moves at "
    )
    text += f"{driven:.2f} m/s, and at zero distance (22) commands {commanded:g} m/s. "
    text += f"With 4 m/s the error settles at {residual(circle_run()):.3f} m."
    whys = (
        "A goal that stands still is the case that was proved.",
        "Without an error the robot stands still while the goal drives on, for any gains.",
    )
    says = (
        "The stability of the tracking controller is proved (abstract), where it tracks a circle."
    )
    return _claim("tracking", "Tracking", says, text, verdict, *whys)


def _better() -> Row:
    """By the rms of the paper's index, the distance, over the whole drive; both limited alike.

    The rival's law and gains are not printed. Two stand-ins for it, Aicardi's law
    v = k_rho rho cos(alpha): with the number that the paper has for k_rho, and with the slope
    v_max k_rho that (22) has at the goal. A verdict is one on the stand-ins.
    """
    wheels, gains = Wheels(0.4, PUBLISHED["speed_limit"].value), paper.CIRCLE_GAINS

    def index(law: str, k_rho: float) -> float:
        return math.sqrt(np.mean(circle_run(law, wheels, k_rho=k_rho).rho ** 2))

    ours = index("corrected", gains.k_rho)
    rivals = {k: index("aicardi", k) for k in (gains.k_rho, gains.v_max * gains.k_rho)}
    listed = ", ".join(f"{rival:.3f} m with {k:.1f} 1/s" for k, rival in rivals.items())
    text = f"Rms distance {ours:.3f} m; our two stand-ins, Aicardi's law: {listed}. "
    text += "The rival's law and gains are not printed in this paper."
    verdict = decide(lambda k: ours < rivals[k], over=[(k,) for k in rivals])
    whys = (
        "It is better than both of our stand-ins for the rival.",
        "It is better than neither of our stand-ins for the rival.",
        "The rival's law is not printed, and our two stand-ins for it disagree.",
    )
    says = "Better than the controller of Cornejo et al. (Figs. 6 and 7)."
    return _claim("cornejo", "Comparison", says, text, verdict, *whys)


def _still() -> Row:
    """By the law and the reading: whether the robot turns less at the end of the line than before.

    Which law the authors ran is not known: (24) as printed or the one that their proof needs.
    """

    def turns(axis, law, radius, end, by="continuous") -> tuple[float, float]:
        run = outdoor_run(axis, radius, law, by)
        return abs(run.omega[run.rho < end]).max(), abs(run.omega[run.rho >= end]).max()

    cases = list(product(AXES, ("corrected", "printed")))
    verdict = decide(
        lambda by, *case: bool(np.less(*turns(*case, by))),
        *("arrival", "end"),
        over=[(by, *case) for by in STEPS for case in cases],
    )
    limits = THRESHOLDS["arrival"], THRESHOLDS["end"]
    listed = "; ".join(
        f"{law}, x {axis}: {turns(axis, law, *limits)[0]:.1f} rad/s" for axis, law in cases
    )
    whys = (
        "At the end it turns less than before.",
        "At the end it turns more than before.",
        "It depends on the law that the authors ran.",
    )
    says = "It converges to zero because of the linear tracking path (Fig. 10)."
    text = f"The largest $\\omega$ in the last {limits[1]:g} m: {listed}."
    return _claim("omega", "Turning rate", says, text, verdict, *whys)


def _pose() -> Row:
    def off(axis: str, radius: float, by: str = "continuous") -> float:
        return abs(float(arrival(outdoor_run(axis, radius, method=by)).heading_error))

    radii = [factor * THRESHOLDS["arrival"] for factor in (0.5, 1.0, 2.0)]
    listed = "; ".join(
        f"x {axis}: " + ", ".join(f"{math.degrees(off(axis, radius)):.1f}" for radius in radii)
        for axis in AXES
    )
    stops = ", ".join(f"{100 * radius:g}" for radius in radii)
    verdict = decide(
        lambda axis, by, radius, most: off(axis, radius, by) < most,
        *("arrival", "parked"),
        over=[*product(AXES, STEPS)],
    )
    text = f"Degrees off on stopping {stops} cm short of the goal: {listed}."
    whys = (
        "It is parked, wherever it stops.",
        "It is not parked, wherever it stops.",
        "It depends on where one stops the robot, and on how one steps.",
    )
    says = "The robot moves from pose to pose, its error to zero (Fig. 8)."
    return _claim("pose", "Pose to pose", says, text, verdict, *whys)


def _figure_5() -> Row:
    limit, runs = PUBLISHED["speed_limit"].value, [circle_run(), outdoor_run("east", 0.05)]
    circle, outdoor = (float(run.v.max()) for run in runs)
    reached = [
        decide(lambda missing, fastest=speed: fastest > (1.0 - missing) * limit, "reached")
        for speed in (circle, outdoor)
    ]
    verdict = Verdict.TYPO if reached == [Verdict.WRONG, Verdict.HOLDS] else reached[0]
    text = f"The run of Fig. 5 reaches {circle:.2f} m/s, that of Fig. 9 {outdoor:.2f} m/s."
    whys = (
        "Fig. 5 reaches the limit.",
        "One number is wrong: Fig. 9 is the one that reaches the limit.",
        "It depends on how near counts as reached.",
    )
    says = "Limited to 4 m/s, as indicated in Fig. 5."
    return _claim("limit", "The limit", says, text, verdict, *whys)
