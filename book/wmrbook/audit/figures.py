"""The paper's figures 1 to 12: what their captions and its text say of them, against runs and geometry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
from scipy.linalg import solve_continuous_are

from wmrbook.audit.rows import Row, Verdict, depends, fits
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
def drive(x_axis: str) -> Trajectory:
    """The outdoor case in continuous time until 5 cm before the goal, x towards "east" or "north"."""
    case = paper.outdoor(x_axis)
    return simulate(case.start, case.goal, case.gains, method="continuous", dt=0.01)


@cache
def settle(x_axis: str) -> Trajectory:
    """The same for 40 s, past the 5 cm."""
    case = paper.outdoor(x_axis)
    return simulate(
        case.start, case.goal, case.gains, method="continuous", arrival_radius=0.0, duration=40.0
    )


@cache
def chase(law: str = "corrected", setting: float | None = None) -> Trajectory:
    """The circle with one of the pose laws, or "linear": an LQR of our own with feed-forward.

    setting: the k_rho of a pose law, the paper's for None; the weight of the LQR, 1 for None.
    """
    if law == "linear":
        gains = lqr_gains(1.0 if setting is None else setting)
    else:
        gains = (
            paper.CIRCLE_GAINS if setting is None else paper.CIRCLE_GAINS._replace(k_rho=setting)
        )
    return track(
        paper.circle,
        paper.CIRCLE_START,
        gains,
        law=law,
        dt=paper.TIME_STEP,
        duration=paper.CIRCLE_PERIOD,
    )


def lqr_gains(weight: float = 1.0) -> LinearGains:
    """The LQR of the circle's error in the robot's frame: e' = A e + B u, u the twist beyond the reference's; Q = weight I, R = I."""
    turn, speed = paper.CIRCLE_SPEED / paper.CIRCLE_RADIUS, paper.CIRCLE_SPEED
    A = np.array([[0.0, turn, 0.0], [-turn, 0.0, speed], [0.0, 0.0, 0.0]])
    B = np.array([[-1.0, 0.0], [0.0, 0.0], [0.0, -1.0]])
    return LinearGains(-B.T @ solve_continuous_are(A, B, weight * np.eye(3), np.eye(2)))


def comparison() -> tuple[str, list[bool]]:
    """The circle's residual of the paper's law and of what its rival may have been, in words, and for each whether the paper's is smaller.

    The rival's law and gains are not published. Three choices: Aicardi's law, v = k_rho rho cos(alpha), with the number that the paper has
    for k_rho; the same with the slope v_max k_rho that (22) has at the goal; and an LQR with feed-forward.
    """
    steep = paper.CIRCLE_GAINS.v_max * paper.CIRCLE_GAINS.k_rho
    ours, *rivals = (
        residual(chase(*each))
        for each in (("corrected",), ("aicardi",), ("aicardi", steep), ("linear",))
    )
    text = (
        f"Behind the circle: (24) corrected {ours:.3f} m; Aicardi's law {rivals[0]:.3f} m with the same number for $k_\\rho$, "
        f"{rivals[1]:.3f} m with the slope of (22), {steep:.1f} 1/s; an LQR of our own {rivals[2]:.3f} m."
    )
    return text, [ours < rival for rival in rivals]


def _row(number: int, says: str, holds: str, agrees: bool | Sequence[bool], why: str) -> Row:
    """By `depends`, of the content's outcome or outcomes; what holds is a typo if the caption is another figure's."""
    first = min(each for each, caption in CAPTIONS.items() if caption == CAPTIONS[number])
    caption = f"the caption is that of Fig. {first}; " if first != number else ""
    content = depends(np.ravel(agrees))
    verdict = Verdict.TYPO if caption and content is Verdict.HOLDS else content
    reason = f"{caption}{MISSING if content is Verdict.OPEN else why}"
    return Row(
        f"fig-{number}",
        f"Fig. {number}",
        f'"{CAPTIONS[number]}" {says}'.strip(),
        holds,
        verdict,
        reason,
    )


def _drawings() -> list[Row]:
    left, right, width, dt = 0.7, 1.2, 0.4, 1e-6
    v, omega = wheels_to_twist(left, right, width)
    before = Pose(0.3, -0.2, 0.8)
    after = advance(before, v, omega, dt)
    speeds = [
        math.dist(_wheel(before, side * width / 2), _wheel(after, side * width / 2)) / dt
        for side in (1, -1)
    ]
    off = max(abs(speeds[0] - left), abs(speeds[1] - right))
    goal = Pose(9.0, 57.0, -1.0)
    rho, alpha, theta = polar_error(before, goal)
    sight = math.atan2(goal.y - before.y, goal.x - before.x)
    gaps = (
        rho - math.dist(before[:2], goal[:2]),
        alpha - (sight - before.heading),
        theta - (sight - goal.heading),
    )
    closed = abs(wrap_angle(theta - alpha - (before.heading - goal.heading)))
    case, pose = paper.outdoor(), paper.outdoor().start
    run = simulate(case.start, case.goal, case.gains, dt=case.dt)
    for _ in range(50):
        pose = advance(pose, *control_law(*polar_error(pose, case.goal), case.gains), case.dt)
    apart = math.dist(pose, (run.x[50], run.y[50], run.heading[50]))
    return [
        _row(
            1,
            "The point $a$ between two wheels $b$ apart.",
            f"Wheels of {left} and {right} m/s move their ends of the axle at {speeds[0]:.3f} and {speeds[1]:.3f} m/s.",
            off < 1e-5,
            "the geometry of (1) to (6)",
        ),
        _row(
            2,
            "$A = \\theta - \\gamma$ between the robot's nose and the line $\\rho$.",
            f"At one pose $\\theta - \\alpha$ is {math.degrees(theta - alpha):.1f} deg, as is the heading seen from the goal's.",
            max(map(abs, gaps)) < 1e-12 and closed < 1e-12,
            "the angles of the drawing close",
        ),
        _row(
            3,
            "The loop of the law, the robot and its error.",
            f"The loop closed by hand is {apart:.3f} m from the simulation after 50 steps.",
            apart < 1e-9,
            "composing the blocks gives the run",
        ),
    ]


def _wheel(pose: Pose, left: float) -> tuple[float, float]:
    return pose.x - left * math.sin(pose.heading), pose.y + left * math.cos(pose.heading)


def _circles() -> list[Row]:
    run = chase()
    start = abs(run.x_error[0]), abs(run.y_error[0])
    behind, (rivals, nearer) = residual(run), comparison()
    at_start = fits(start[0], paper.PUBLISHED["circle_x_error"]) and fits(
        start[1], paper.PUBLISHED["circle_y_error"]
    )
    ends = fits(behind, paper.PUBLISHED["circle_residual"])
    return [
        _row(
            4,
            "The circle and the robot's path.",
            f"The start is {start[0]:.0f} m and {start[1]:.0f} m off, and the robot follows.",
            at_start,
            "redrawn",
        ),
        _row(
            5,
            "The error converges to 0.1 m.",
            f"It ends at {behind:.4f} m with $v_{{\\max}} = 4$ m/s.",
            ends,
            "redrawn",
        ),
        _row(
            6,
            "The paths of both controllers, the paper's nearer to the circle.",
            rivals,
            nearer,
            "the same with every rival tried",
        ),
        _row(
            7,
            "The errors of both controllers, the paper's the smaller.",
            rivals,
            nearer,
            "the same with every rival tried",
        ),
    ]


def _outdoor() -> list[Row]:
    runs = [drive(axis) for axis in AXES]
    results = [arrival(run) for run in runs]
    settled = [settle(axis) for axis in AXES]
    both = "; ".join(f"x {axis}: {{}}" for axis in AXES).format
    arrived = all(run.outcome is Outcome.ARRIVED for run in runs)
    fastest = [run.v.max() for run in runs]
    limit = paper.PUBLISHED["speed_limit"]
    calm = max(abs(run.omega[-1]) for run in settled) < 1e-3
    left = [
        f"{result.time:.1f} s, {abs(math.degrees(result.heading_error)):.1f} deg off"
        for result in results
    ]
    peaks = [
        f"peak {result.peak_omega:.1f} rad/s, {abs(run.omega[-1]):.1f} at 5 cm"
        for result, run in zip(results, runs, strict=True)
    ]
    rows = [
        _row(
            8,
            "From the start to the final point.",
            f"It comes within 5 cm: {both(*left)}.",
            arrived,
            "the position arrives, in both readings of x",
        ),
        _row(
            9,
            "Limited to 4 m/s.",
            f"Fastest: {both(*(f'{each:.3f} m/s' for each in fastest))}.",
            all(fits(each, limit) and each <= limit.value for each in fastest),
            "the limit is approached and not passed",
        ),
        _row(
            10,
            "$\\omega$ converges to zero.",
            f"In continuous time and in the end; before, {both(*peaks)}.",
            calm,
            f"{'below' if calm else 'above'} 0.001 rad/s after 40 s",
        ),
    ]
    for number, name, index in ((11, "x", 0), (12, "y", 1)):
        key = paper.PUBLISHED[f"{name}_error_at_start"]
        starts = [abs((run.x_error, run.y_error)[index][0]) for run in runs]
        ends = max(abs((run.x_error, run.y_error)[index][-1]) for run in runs)
        fitting = [axis for axis, start in zip(AXES, starts, strict=True) if fits(start, key)]
        why = f"true with x {fitting[0]}" if fitting else "true in neither reading of x"
        text = f"It starts at {both(*(f'{each:.2f} m' for each in starts))}, and ends below {ends + 0.005:.2f} m."
        rows.append(
            _row(
                number, f"From {key.value:.0f} m to zero.", text, bool(fitting) and ends < 0.05, why
            )
        )
    return rows


def rows() -> list[Row]:
    """The 12 rows, in order."""
    return [*_drawings(), *_circles(), *_outdoor()]
