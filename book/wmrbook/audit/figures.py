"""The paper's figures 1 to 12: what their captions and its text say, against runs and geometry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
from scipy.linalg import solve_continuous_are

from wmrbook.audit.row import Row, Verdict, depends, fits
from wmrbook.published import PUBLISHED
from wmrlib import paper
from wmrlib.control import control_law
from wmrlib.gains import LinearGains
from wmrlib.kinematics import Pose, advance, polar_error, wheels_to_twist, wrap_angle
from wmrlib.metrics import arrival, residual
from wmrlib.runs import Outcome, Trajectory
from wmrlib.simulation import simulate, track

AXES = ("east", "north")
MISSING = "it depends on the gains, Q and R of Cornejo et al. (2018), which are not published"
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
def outdoor_run(x_axis: str, radius: float = 0.05, duration: float = 60.0) -> Trajectory:
    """The outdoor case in continuous time until `radius` before the goal, x "east" or "north"."""
    case = paper.outdoor(x_axis)
    how = {"method": "continuous", "arrival_radius": radius, "duration": duration}
    return simulate(case.start, case.goal, case.gains, dt=0.01 if radius else 0.1, **how)


@cache
def circle_run(law: str = "corrected", setting: float | None = None) -> Trajectory:
    """The circle with one of the pose laws, or "linear": an LQR of our own with feed-forward.

    setting: the k_rho of a pose law, the paper's for None; the weight of the LQR, 1 for None.
    """
    if law == "linear":
        gains = lqr_gains(1.0 if setting is None else setting)
    elif setting is None:
        gains = paper.CIRCLE_GAINS
    else:
        gains = paper.CIRCLE_GAINS._replace(k_rho=setting)
    how = {"law": law, "dt": paper.TIME_STEP, "duration": paper.CIRCLE_PERIOD}
    return track(paper.circle, paper.CIRCLE_START, gains, **how)


def lqr_gains(weight: float = 1.0) -> LinearGains:
    """The LQR of the circle's error in the robot's frame, with Q = weight I and R = I.

    e' = A e + B u, where u is the twist beyond the reference's.
    """
    turn, speed = paper.CIRCLE_SPEED / paper.CIRCLE_RADIUS, paper.CIRCLE_SPEED
    A = np.array([[0.0, turn, 0.0], [-turn, 0.0, speed], [0.0, 0.0, 0.0]])
    B = np.array([[-1.0, 0.0], [0.0, 0.0], [0.0, -1.0]])
    return LinearGains(-B.T @ solve_continuous_are(A, B, weight * np.eye(3), np.eye(2)))


def comparison() -> tuple[str, list[bool]]:
    """The circle's residual of the paper's law and of three rivals, in words; whether it is less.

    The rival's law and gains are not published. Three choices: Aicardi's law,
    v = k_rho rho cos(alpha), with the number that the paper has for k_rho; the same with the slope
    v_max k_rho that (22) has at the goal; and an LQR with feed-forward.
    """
    steep = paper.CIRCLE_GAINS.v_max * paper.CIRCLE_GAINS.k_rho
    ours, *rivals = (
        residual(circle_run(*each))
        for each in (("corrected",), ("aicardi",), ("aicardi", steep), ("linear",))
    )
    text = (
        f"Behind the circle: (24) corrected {ours:.3f} m; Aicardi's law {rivals[0]:.3f} m with the "
        f"same number for $k_\\rho$, {rivals[1]:.3f} m with the slope of (22), {steep:.1f} 1/s; "
        f"an LQR of our own {rivals[2]:.3f} m."
    )
    return text, [ours < rival for rival in rivals]


def _row(number: int, says: str, holds: str, agrees: bool | Sequence[bool], why: str) -> Row:
    """By `depends`; what holds is a typo if the caption is another figure's."""
    caption, verdict = CAPTIONS[number], depends(np.ravel(agrees))
    if verdict is Verdict.OPEN:
        why = MISSING
    first = min(each for each, text in CAPTIONS.items() if text == caption)
    if first != number:
        why = f"the caption is that of Fig. {first}; {why}"
        verdict = Verdict.TYPO if verdict is Verdict.HOLDS else verdict
    said = f'"{caption}" {says}'.strip()
    return Row(f"fig-{number}", f"Fig. {number}", said, holds, verdict, why)


def _drawings() -> list[Row]:
    return [_axle_row(), _angles_row(), _loop_row()]


def _axle_row() -> Row:
    left, right, width, dt = 0.7, 1.2, 0.4, 1e-6
    before = Pose(0.3, -0.2, 0.8)
    after = advance(before, *wheels_to_twist(left, right, width), dt)
    speeds = [
        math.dist(_wheel(before, side), _wheel(after, side)) / dt
        for side in (width / 2, -width / 2)
    ]
    text = (
        f"Wheels of {left} and {right} m/s move their ends of the axle "
        f"at {speeds[0]:.3f} and {speeds[1]:.3f} m/s."
    )
    agrees = np.allclose(speeds, (left, right), rtol=0.0, atol=1e-5)
    says = "The point $a$ between two wheels $b$ apart."
    return _row(1, says, text, agrees, "the geometry of (1) to (6)")


def _wheel(pose: Pose, left: float) -> tuple[float, float]:
    return pose.x - left * math.sin(pose.heading), pose.y + left * math.cos(pose.heading)


def _angles_row() -> Row:
    pose, goal = Pose(0.3, -0.2, 0.8), Pose(9.0, 57.0, -1.0)
    sight = math.atan2(goal.y - pose.y, goal.x - pose.x)
    drawn = math.dist(pose[:2], goal[:2]), sight - pose.heading, sight - goal.heading
    rho, alpha, theta = polar_error(pose, goal)
    closed = wrap_angle(theta - alpha - (pose.heading - goal.heading))
    gaps = np.abs([*np.subtract((rho, alpha, theta), drawn), closed])
    text = (
        f"At one pose $\\theta - \\alpha$ is {math.degrees(theta - alpha):.1f} deg, "
        "as is the heading seen from the goal's."
    )
    says = "$A = \\theta - \\gamma$ between the robot's nose and the line $\\rho$."
    return _row(2, says, text, gaps.max() < 1e-12, "the angles of the drawing close")


def _loop_row() -> Row:
    case = paper.outdoor()
    run, pose = simulate(case.start, case.goal, case.gains, dt=case.dt), case.start
    for _ in range(50):
        pose = advance(pose, *control_law(*polar_error(pose, case.goal), case.gains), case.dt)
    apart = math.dist(pose, (run.x[50], run.y[50], run.heading[50]))
    text = f"The loop closed by hand is {apart:.3f} m from the simulation after 50 steps."
    says = "The loop of the law, the robot and its error."
    return _row(3, says, text, apart < 1e-9, "composing the blocks gives the run")


def _circles() -> list[Row]:
    run = circle_run()
    off = {name: abs(getattr(run, f"{name}_error")[0]) for name in "xy"}
    at_start = all(fits(off[name], PUBLISHED[f"circle_{name}_error"]) for name in "xy")
    starts = f"The start is {off['x']:.0f} m and {off['y']:.0f} m off, and the robot follows."
    behind = residual(run)
    ends = f"It ends at {behind:.4f} m with $v_{{\\max}} = 4$ m/s."
    converges = fits(behind, PUBLISHED["circle_residual"])
    rivals, nearer = comparison()
    paths = "The paths of both controllers, the paper's nearer to the circle."
    errors = "The errors of both controllers, the paper's the smaller."
    return [
        _row(4, "The circle and the robot's path.", starts, at_start, "redrawn"),
        _row(5, "The error converges to 0.1 m.", ends, converges, "redrawn"),
        _row(6, paths, rivals, nearer, "the same with every rival tried"),
        _row(7, errors, rivals, nearer, "the same with every rival tried"),
    ]


def _outdoor() -> list[Row]:
    runs = [outdoor_run(axis) for axis in AXES]
    results = [arrival(run) for run in runs]
    both = "; ".join(f"x {axis}: {{}}" for axis in AXES).format
    arrived = all(run.outcome is Outcome.ARRIVED for run in runs)
    left = both(
        *(
            f"{each.time:.1f} s, {abs(math.degrees(each.heading_error)):.1f} deg off"
            for each in results
        )
    )
    fastest = [run.v.max() for run in runs]
    limit = PUBLISHED["speed_limit"]
    limited = all(fits(each, limit) and each <= limit.value for each in fastest)
    calm = max(abs(outdoor_run(axis, 0.0, 40.0).omega[-1]) for axis in AXES) < 1e-3
    peaks = both(
        *(
            f"peak {result.peak_omega:.1f} rad/s, {abs(run.omega[-1]):.1f} at 5 cm"
            for result, run in zip(results, runs, strict=True)
        )
    )
    calm_why = f"{'below' if calm else 'above'} 0.001 rad/s after 40 s"
    rows = [
        _row(
            8,
            "From the start to the final point.",
            f"It comes within 5 cm: {left}.",
            arrived,
            "the position arrives, in both readings of x",
        ),
        _row(
            9,
            "Limited to 4 m/s.",
            f"Fastest: {both(*(f'{each:.3f} m/s' for each in fastest))}.",
            limited,
            "the limit is approached and not passed",
        ),
        _row(
            10,
            "$\\omega$ converges to zero.",
            f"In continuous time and in the end; before, {peaks}.",
            calm,
            calm_why,
        ),
    ]
    for number, name in ((11, "x_error"), (12, "y_error")):
        key = PUBLISHED[f"{name}_at_start"]
        errors = [abs(getattr(run, name)) for run in runs]
        ends = max(error[-1] for error in errors)
        fitting = [axis for axis, error in zip(AXES, errors, strict=True) if fits(error[0], key)]
        why = f"true with x {fitting[0]}" if fitting else "true in neither reading of x"
        starts = both(*(f"{error[0]:.2f} m" for error in errors))
        text = f"It starts at {starts}, and ends below {ends + 0.005:.2f} m."
        says = f"From {key.value:.0f} m to zero."
        rows.append(_row(number, says, text, bool(fitting) and ends < 0.05, why))
    return rows


def rows() -> list[Row]:
    """The 12 rows, in order."""
    return [*_drawings(), *_circles(), *_outdoor()]
