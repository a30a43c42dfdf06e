"""The sketch on a simulated Uno parks a robot on the lawn: how large, how fast, how well?

    python book/robot/arduino_run.py [--runs N]
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from arduino_board import Board, compiled
from gpsd import Position, ubx

import wmrlib as wmr
from wmrbook.robot_sheet import RECEIVERS, Robot, sheet
from wmrlib.body import follow
from wmrlib.motion import arc_step

STEP = 0.005  # s, of the truth
FULL, COUNT = 1.25, 0.001  # m/s at full PWM, m from one change of an encoder to the next
IRON, DECLINATION, FIELD = (600.0, -400.0), 0.087, 3000.0  # counts, rad, counts
SETTINGS = (("compass.iron_x = 0, compass.iron_y = 0;", "compass.iron_x = 600, compass.iron_y = -400;"),)
LAG, AGILE, DEAD = 0.08, 3.0, 0.05  # s, m/s^2, duty that turns no wheel
BEFORE = 0.05  # s from the fix's time to its first byte
STATES = "wait", "drive", "turn", "parked", "stopped"


class Said(NamedTuple):
    """What the sketch reports: state and reason, and pose [m, rad] and longest period [s]."""

    time: float
    state: str
    reason: int
    pose: wmr.Pose
    longest: float


class Ended(NamedTuple):
    said: list
    pose: wmr.Pose
    time: float
    untouched: int
    path: list


def drive(robot=Robot(), start=None, seed=1, faults=lambda now: {}, longest=200.0, changes=()):
    told, rng = sheet(robot), np.random.default_rng(seed)
    program = compiled(robot, SETTINGS + changes)
    board = Board(program)
    origin = wmr.GeoPoint(lat=robot.start_lat, lon=robot.start_lon)
    pose = tuple(start or (0.0, 0.0, math.atan2(told.y, told.x)))
    speeds, rolled, text, said, past, path = [0.0, 0.0], [0.0, 0.0], b"", [], [], []
    scale = 1.0 + rng.normal(0.0, 0.005)
    off = math.radians(robot.compass) * rng.normal()
    error = rng.normal(0.0, robot.sigma, 2)
    keep = math.exp(-robot.fix_period / robot.memory)
    every, steps, ends = round(robot.fix_period / STEP), 0, None
    while steps * STEP < longest:
        now = steps * STEP
        wrong = faults(now)
        if steps % every == 0:
            error = keep * error + math.sqrt(1 - keep**2) * rng.normal(0.0, robot.sigma, 2)
            x, y = past[max(0, len(past) - 1 - round(BEFORE / STEP))] if past else pose[:2]
            place = wmr.point_at(origin, float(x + error[0]), float(y + error[1]))
            rtk = 2 if robot.sigma < 0.05 else 1 if robot.sigma < 0.5 else 0
            if not wrong.get("silent"):
                data = ubx(Position(round(now + 1.0, 3), place.lat, place.lon, robot.sigma, rtk))
                board.send(wrong.get("bytes", lambda b: b)(data))
        turn = pose[2] - 0.5 * math.pi + DECLINATION + off
        field = np.array(IRON) + FIELD * np.array([math.cos(turn), -math.sin(turn)]) + rng.normal(0, 30, 2)
        *duties, power = board.pins()
        before = list(rolled)
        for k in range(2):
            goal = FULL * duties[k] if power and abs(duties[k]) >= DEAD else 0.0
            mean, speeds[k] = follow(speeds[k], goal, 1.0 / AGILE, LAG, STEP)
            rolled[k] += mean * STEP
        seen = [2 * each / COUNT for each in rolled]
        if wrong.get("stuck"):
            seen[0] = stuck
        stuck = seen[0]
        if "hang" in wrong:
            board.hang(wrong["hang"])
        text += board.run(STEP, seen, [int(f) for f in field], not wrong.get("no_compass"), wrong.get("pressed", False))
        *lines, text = text.split(b"\n")
        for line in lines:
            n = [int(w) for w in line.split()]
            said.append(Said(now, STATES[n[0]], n[1], wmr.Pose(n[2] / 100, n[3] / 100, n[4] / 1000), n[5] * 1e-6))
        l, r = ((a - b) / STEP * scale for a, b in zip(rolled, before))
        pose = arc_step(*pose, 0.5 * (l + r), (r - l) / robot.track_width, STEP)
        past.append(pose[:2])
        steps += 1
        if said and said[-1].state in ("parked",) and ends is None:
            ends = steps + 200
        if ends and steps > ends:
            break
    return Ended(said, wmr.Pose(*pose), steps * STEP, board.untouched(), past)


if __name__ == "__main__":
    import time
    b = time.time()
    robot = Robot()
    p = compiled(robot, SETTINGS)
    print(p.flash, p.ram, time.time() - b)
    b = time.time()
    e = drive(longest=20)
    for s in e.said[:: 4]: print(s)
    print(e.said[-1], e.pose, e.untouched, time.time() - b)
