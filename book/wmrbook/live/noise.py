"""Chapter 9: a robot that sees what is wrong or late, and whose wheel slips."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from wmrbook.live.parts import Knob, Live, between, choose
from wmrlib import (
    Pose,
    Receiver,
    advance,
    control_law,
    paper,
    polar_error,
    simulate,
    sweep,
    twist_to_wheels,
    wheels_to_twist,
    wrap_angle,
)
from wmrlib.engine.receivers import normals
from wmrlib.gains import GENTLE_GAINS

DT, RADIUS, TRACK = 0.1, 0.2, 0.5  # s, m, m
ROBOTS, STEPS, SEED = 32, 400, 9
WHITE = 0.01  # s: a memory so short that each fix errs anew
LOST = 60.0  # s


def _turn(pose: Pose, by: float) -> Pose:
    return pose._replace(heading=pose.heading + by)


def _turned(what: str) -> Knob:
    label = f"{what.removeprefix('the ')} turned"
    return Knob(0.0, -180.0, 180.0, 5.0, f"{what}, turned from the drive's", "°", label=label)


@cache
def drawn() -> np.ndarray:
    """Normal random numbers for each sample, axis and robot: those of wmrlib's receivers.

    They are counted by robots and samples, as in `kit/random.js`.
    """
    rows = [
        [normals(robot, step, 0, (SEED, 0)) for robot in range(ROBOTS)] for step in range(STEPS)
    ]
    return np.moveaxis(rows, 2, 1)


def seeing(
    start: Pose, goal: Pose, error: np.ndarray, late: float = 0.0, slip: float = 0.0
) -> tuple[Pose, np.ndarray]:
    """Drive robots by positions with an error, (steps, 2, robots) in m, and that late.

    The right wheel loses the share `slip` of its motion.

    Returns
    -------
    Pose of arrays, (samples, robots), up to where all stand, and array of the steps of each robot
    """
    steps, _, robots = error.shape
    back = round(late / DT)
    truth = np.empty((steps + 1, 3, robots))
    truth[0] = np.array(start)[:, None]
    driven, going = np.zeros(robots, int), np.ones(robots, bool)
    for n in range(steps):
        then = max(n - back, 0)
        x, y = truth[then, :2] + error[then]
        polar = polar_error(Pose(x, y, truth[n, 2]), goal)
        going &= polar.rho > RADIUS
        driven += going
        if not going.any():
            truth = truth[: n + 1]
            break
        left, right = twist_to_wheels(*control_law(*polar, GENTLE_GAINS), TRACK)
        v, omega = wheels_to_twist(going * left, going * (1.0 - slip) * right, TRACK)
        truth[n + 1] = advance(Pose(*truth[n]), v, omega, DT)
    return Pose(*truth.transpose(1, 0, 2)), driven


def receiver(sigma: float, memory: float) -> np.ndarray:
    """The errors of the bench's receivers: a Gauss-Markov process each, (steps, 2, robots), m."""
    fresh, keep = drawn(), math.exp(-DT / memory)
    error = [fresh[0]]
    for noise in fresh[1:]:
        error.append(keep * error[-1] + math.sqrt(1.0 - keep**2) * noise)
    return sigma * np.array(error)


@cache
def last_ten_metres() -> tuple[Pose, Pose]:
    """The outdoor drive where 10 m are left, seen from its goal, and the goal."""
    start, goal, *_ = paper.outdoor()
    run = simulate(start, goal, GENTLE_GAINS, method="continuous", arrival_radius=10.0)
    x, y, heading = (float(field[-1]) for field in (run.x, run.y, run.heading))
    return Pose(x - goal.x, y - goal.y, heading), Pose(0.0, 0.0, goal.heading)


def left_over(
    sigma: float, memory: float, set_off: float = 0.0, **faults: float
) -> tuple[float, float]:
    """Medians of the distance [m] and of the heading error [rad] of the robots where they stand.

    They start turned by `set_off` [rad] from the drive's heading.
    """
    start, goal = last_ten_metres()
    start = _turn(start, set_off)
    path, _ = seeing(start, goal, receiver(sigma, memory), **faults)
    far, turned = np.hypot(path.x[-1], path.y[-1]), wrap_angle(path.heading[-1] - goal.heading)
    return float(np.median(far)), float(np.median(np.abs(turned)))


def bench() -> Live:
    """How robots drive up and park whose receiver errs and is late, and whose wheel slips."""
    start, goal = last_ten_metres()
    far, turned = zip(*(left_over(0.5, memory) for memory in (WHITE, 300.0)), strict=True)
    nearer, better = far[0] < far[1], turned[0] < turned[1]
    ends = {
        "Those with new errors stop nearer and face better": nearer and better,
        "Those with new errors stop nearer; the others face better": nearer and not better,
        "Those with a lasting error stop nearer and face better": not nearer and not better,
        "Those with a lasting error stop nearer; the others face better": not nearer and better,
    }
    return Live(
        "bench",
        f"{ROBOTS} robots, each with a receiver that errs by {{sigma}}, remembers it for "
        "{memory} and is {late} late; the right wheel loses {slip} of its motion. Half of them "
        "park within {far} of the goal, and half within {turned} of its heading{driving}.",
        {
            "sigma": Knob(0.5, 0.0, 2.0, 0.05, "the receiver's error", "m", label="error"),
            "memory": Knob(
                WHITE, WHITE, 1000.0, None, "how long the error lasts", "s", label="it lasts"
            ),
            "late": Knob(0.0, 0.0, 1.0, 0.1, "how late the position comes", "s", label="late by"),
            "slip": Knob(0.0, 0.0, 20.0, 1.0, "what the right wheel loses", "%", label="slip"),
            "set_off": _turned("the start"),
            "time": Knob(1.0, 0.0, 1.0, 0.02, "how far they have driven", label="drive", plays=8),
        },
        data=between(start, goal, gains=GENTLE_GAINS._asdict(), dt=DT, radius=RADIUS)
        | {"track": TRACK, "robots": ROBOTS, "steps": STEPS, "seed": SEED},
        ask=choose(
            "Receivers err by 0.5 m, anew in each fix or alike for five minutes. Which robots "
            "stop nearer to the goal, and which face its heading better?",
            "While the radius is well below the error, a slow robot averages what changes quickly, "
            "and what lasts moves the place. In the last metres what changes swings the line of "
            "sight, and with it the heading.",
            answers=ends,
            wrong=(
                "Nearer, yes. But in the last metres an error that is new in each fix throws "
                "the line of sight about, and the heading with it.",
                "",
                "An error that lasts moves the place where the robot stops by as much.",
                "It is the other way round: what lasts costs the place, and what changes costs "
                "the heading.",
            ),
            asked=({"memory": 300.0},),
        ),
    )


def late_drive(
    position: float, heading: float, set_off: float = 0.0, face: float = 0.0
) -> tuple[Pose, float]:
    """The outdoor drive with both readings late [s]: its poses, and its time, infinite if lost.

    Its start is turned by `set_off` and its goal by `face` [rad].
    """
    start, goal = map(_turn, paper.outdoor()[:2], (set_off, face))
    late = Receiver(delay=position, heading_delay=heading)
    how = {"method": "arc", "dt": DT, "duration": LOST, "arrival_radius": RADIUS}
    end, path = sweep(start, goal, GENTLE_GAINS, receiver=late, trajectories=True, **how)
    driven = np.isfinite(path.x)
    return Pose(path.x[driven], path.y[driven], path.heading[driven]), end.time


def late() -> Live:
    """Two robots race: one sees its position late, the other its heading."""
    start, goal, *_ = paper.outdoor()
    delay = 0.6
    position, heading = (math.isfinite(late_drive(*each)[1]) for each in ((delay, 0), (0, delay)))
    return Live(
        "late",
        "Both robots have gentle gains. One sees its position {delay} late and {position}; the "
        "other sees its heading that late and {heading}.",
        {
            "delay": Knob(delay, 0.0, 1.5, 0.1, "how late it is", "s", label="late by"),
            "set_off": _turned("the start"),
            "face": _turned("the goal"),
            "time": Knob(1.0, 0.0, 1.0, 0.005, "how far through the race", label="race", plays=12),
        },
        data=between(start, goal, gains=GENTLE_GAINS._asdict(), dt=DT, radius=RADIUS, lost=LOST),
        ask=choose(
            "Two robots drive at up to 4 m/s. One sees its position 0.6 s late, the other its "
            "heading. Which of them come to the goal, 58 m away, within a minute?",
            "The heading turns as fast as the law steers, so an old one makes it steer too far, "
            "and back: it comes in on a long spiral, or never. Far away the line of sight hardly "
            "turns, so an old position does harm only near the goal.",
            answers={
                "Both": position and heading,
                "Only the one whose position is late": position and not heading,
                "Only the one whose heading is late": heading and not position,
                "Neither": not position and not heading,
            },
            wrong=(
                "An old heading lets it steer too far, and back, for longer than a minute.",
                "",
                "It is the other way round: far away the line of sight hardly turns, so an old "
                "position does little harm there.",
                "An old position does harm only near the goal, where the line of sight turns.",
            ),
        ),
    )
