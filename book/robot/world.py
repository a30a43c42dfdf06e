"""A lawn with a robot on it whose parts can fail: the true motion, and the sensors' readings.

Beside it `positions` drives a robot on which nothing fails.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

import wmrlib as wmr
import wmrrobot as wr
from wmrlib import paper
from wmrlib.body import follow

PERIOD = 0.05  # s
CASE = paper.outdoor()
WHEELS = wmr.Wheels(0.5, max_speed=1.0, min_speed=0.1, acceleration=2.0, lag=0.1)
WATCHDOG = 0.2  # s: a program that hangs for so long is started again, its wheels stopped


class Faults(NamedTuple):
    """The faults that a robot can have; by default none."""

    silent: bool = False  # the receiver
    stuck_position: bool = False
    stuck_message: bool = False
    not_a_number: str = ""  # the field
    quality: int = 4
    error: float = 0.02  # m, as the receiver reports it
    period: float = 0.1  # s, of the fixes
    delay: float = 0.05  # s, of them
    age_known: bool = True  # the fix's age is known
    jump: float = 0.0  # m, to the east
    wander: float = 0.0  # m: how far off it gets in a minute, as an RTK float
    antenna: float = 0.0  # m ahead of the axle
    antenna_known: bool = True
    drift: tuple[float, float] = (0.0, 0.0)  # m/s, to the east and to the north
    swapped: bool = False  # latitude and longitude
    time: float = 1.0  # how fast the time of the fixes goes on
    compass: float = 0.0  # rad
    compass_by_motors: float = 0.0  # rad at full speed
    clockwise: bool = False  # a bearing in place of a heading
    clock: float = 0.0  # s, by which it jumps at once
    clock_stands: bool = False
    hangs: bool = False  # the program
    left_encoder: float = 1.0
    right_motor: float = 1.0
    left_runs_on: bool = False
    cables_swapped: bool = False
    grip: float = 1.0  # the share of what the wheels roll
    dead_band: float = 0.0  # m/s
    battery: float = 24.0  # V
    pushed: float = 0.0  # m/s, downhill


class World:
    """The truth, and the sensors."""

    def __init__(self, seed: int, fence: tuple = (-15.0, -15.0, 25.0, 75.0)) -> None:
        self.rng, self.fence = np.random.default_rng(seed), fence
        self.pose, self.speeds = CASE.start, [0.0, 0.0]
        self.now, self.rolled, self.power = 0.0, 0.0, True
        self.past: list[tuple[float, wmr.Pose]] = []
        self.clock_error, self.drifted, self.wandered = 0.0, np.zeros(2), np.zeros(2)
        self.reported: wmr.Pose | None = None  # by the receiver, last
        self.time = self.due = 0.0  # of the fixes
        self.encoders = [0.0, 0.0]
        # what the program keeps of it
        self.clock = self.last_time = self.silence = 0.0

    def inside(self, x: float, y: float) -> bool:
        """Whether a place is inside the fence; NaN is not."""
        west, south, east, north = self.fence
        return west <= x <= east and south <= y <= north

    def roll(self, commands: tuple[float, float], faults: Faults) -> None:
        """A period of the truth."""
        commands = commands[::-1] if faults.cables_swapped else commands
        rolled = []
        for side, speed in enumerate(commands):
            goal = speed if self.power and abs(speed) >= faults.dead_band else 0.0
            goal *= faults.right_motor if side else 1.0
            if faults.left_runs_on and not side and self.power:
                goal = WHEELS.max_speed
            if side and not faults.right_motor:
                self.speeds[1] = 0.0  # it is blocked
            mean, self.speeds[side] = follow(
                self.speeds[side], goal, 1.0 / WHEELS.acceleration, WHEELS.lag, PERIOD
            )
            pushed = faults.pushed if self.power else 0.0  # without power its brakes are on
            rolled.append((mean + pushed) * PERIOD)
        self.encoders = [rolled[0] * faults.left_encoder, rolled[1]]
        v, omega = wmr.wheels_to_twist(
            *(faults.grip * distance / PERIOD for distance in rolled), 0.5
        )
        self.pose = wmr.advance(self.pose, v, omega, PERIOD)
        self.rolled += abs(v) * PERIOD
        self.now += PERIOD
        self.past.append((self.now, self.pose))

    def see(self, faults: Faults) -> wr.Seen:
        """The readings of a period, by the program's own clock."""
        self.drifted += np.multiply(faults.drift, PERIOD)
        before, clock = self.clock, self.now + self.clock_error
        if not faults.clock_stands:
            self.clock = clock
        fix = self._fix(faults)
        self.silence += PERIOD
        if fix:
            self.silence = 0.0 if fix["later"] > 0.0 else self.silence
        goal_inside = int(self.inside(CASE.goal.x, CASE.goal.y))
        given = {"battery": faults.battery, "goal_inside": goal_inside} | fix
        return wr.Seen(self.clock - before, *self.encoders, **given)

    def _fix(self, faults: Faults) -> dict:
        self.due += PERIOD
        self.time += PERIOD * faults.time
        if faults.silent or self.due < faults.period - 1e-9:
            return {}
        self.due = 0.0
        back = max(0, len(self.past) - 1 - round(faults.delay / PERIOD))
        pose = self.past[back][1] if self.past else self.pose
        x, y = np.array(pose[:2]) + self.rng.normal(0.0, 0.02, 2) + self.drifted + self.wandered
        if faults.wander:
            keep = math.exp(-faults.period / 60.0)
            fresh = self.rng.normal(0.0, faults.wander * math.sqrt(1.0 - keep**2), 2)
            self.wandered = keep * self.wandered + fresh
        x += faults.jump + faults.antenna * math.cos(pose.heading)
        y += faults.antenna * math.sin(pose.heading)
        if faults.swapped:
            x, y = swapped(x, y)
        load = max(map(abs, self.speeds)) / WHEELS.max_speed
        heading = pose.heading + self.rng.normal(0.0, 0.01)
        heading += faults.compass + faults.compass_by_motors * load
        heading = 0.5 * math.pi - heading if faults.clockwise else heading
        if faults.stuck_position or faults.stuck_message:
            x, y = (self.reported or pose)[:2]
        self.reported = wmr.Pose(float(x), float(y), wmr.wrap_angle(heading))
        fields = self.reported._asdict()
        if faults.not_a_number:
            fields[faults.not_a_number] = math.nan
        time = self.last_time if faults.stuck_message else self.time
        later = time - self.last_time
        if later > 0.0 or self.silence > 1.0:  # after a silence a receiver may begin anew
            self.last_time = time
        return fields | {
            "fresh": 1,
            "antenna_ahead": faults.antenna if faults.antenna_known else 0.0,
            "quality": faults.quality,
            "error": faults.error,
            "age": faults.delay if faults.age_known else 0.05,
            "later": later,
            "inside": int(self.inside(fields["x"], fields["y"])),
        }


def swapped(x: float, y: float) -> tuple[float, float]:
    """The position by a program that swaps latitude and longitude: far away."""
    a = paper.GPS_POINT_1
    b = wmr.point_at(a, x, y)
    east, north = wmr.local_position(a, wmr.GeoPoint(lat=b.lon, lon=b.lat))
    return float(east), float(north)


def positions(drive: wr.Drive, start: wmr.Pose, period: float, longest: float) -> list[wmr.Pose]:
    """Drive an ideal robot by any `Drive` until it has parked, or for `longest` s.

    Parameters
    ----------
    drive : `wr.Drive`, or what steps as one does
    start : Pose; m, m, rad
    period : float, s

    Returns
    -------
    list of Pose : where it is at the begin of each period, and at the end
    """
    poses, speeds = [start], (0.0, 0.0)
    width = drive.wheels.track_width
    while drive.state not in ("parked", "stopped") and period * len(poses) <= longest:
        left, right = (period * speed for speed in speeds)
        seen = wr.Seen(period, left, right, fresh=1, later=period, **poses[-1]._asdict())
        speeds = drive.step(seen)
        poses.append(wmr.advance(poses[-1], *wmr.wheels_to_twist(*speeds, width), period))
    return poses
