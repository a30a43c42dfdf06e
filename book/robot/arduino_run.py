"""The Arduino sketch on a simulated Uno parks the lawn's robot: how large, how fast, how well?

    python book/robot/arduino_run.py [--runs 3]

The real sketch, compiled, reads u-blox bytes, a compass and encoders and moves its motors by PWM;
between these, motors and wheels are a model. Faults come 8 s after the start.
"""

from __future__ import annotations

import argparse
import math
from typing import NamedTuple

import numpy as np
from arduino_board import CLOCK, Board, Inputs, compiled
from gpsd import Position, ubx

import wmrlib as wmr
from wmrlib.body import follow
from wmrlib.motion import arc_step
from wmrrobot import monitor
from wmrrobot.drive import REASONS
from wmrrobot.sensing import antenna
from wmrrobot.sheets import RECEIVERS, Robot, certificate, sheet

STEP = 0.005  # s, of the truth
FULL_SPEED, COUNT = 1.25, 0.001  # m/s at full PWM, m from one change of an encoder to the next
LAG, AGILE, DEAD = 0.08, 3.0, 0.05  # s, m/s^2; the duty below which a motor stands
FIELD, IRON, DECLINATION = 3000.0, (600.0, -400.0), 0.087  # counts, counts, rad
HARD_IRON = "compass.iron_x = 0, compass.iron_y = 0;"
SETTINGS = ((HARD_IRON, "compass.iron_x = 600, compass.iron_y = -400;"),)
BEFORE = 0.05  # s from a fix to its first byte; the bytes and the sketch's period add 0.05 s
BEGIN = 8.0  # s
NEAR = Robot(goal_lat=33.273672, goal_lon=44.373200)  # 12 m away


class Fault(NamedTuple):
    """A fault of the robot from `begin` to `end`, in s."""

    begin: float = BEGIN
    end: float = math.inf
    silent: bool = False  # the receiver
    garbled: bool = False  # a bit of each message
    compass: bool = False  # it does not answer
    encoder: bool = False  # the left one is stuck
    pressed: bool = False  # the emergency stop
    hangs: bool = False  # the program
    volts: float = 3.0  # at the battery's pin


SOUND = Fault(math.inf)
FAULTS = {  # and the state and reason that must come of it
    "receiver silent": (Fault(silent=True), "wait: no fix"),
    "messages garbled": (Fault(garbled=True), "wait: no fix"),
    "silent for 3 s": (Fault(silent=True, end=11.0), "parked"),
    "no compass": (Fault(0.0, compass=True), "wait: fix is no number"),
    "compass lost": (Fault(compass=True), "wait: fix is no number"),
    "encoder stuck": (Fault(encoder=True), "stopped: wheel or encoder stuck"),
    "emergency stop": (Fault(pressed=True), "stopped"),
    "pressed for 0.1 s": (Fault(pressed=True, end=BEGIN + 0.1), "stopped"),
    "program hangs": (Fault(hangs=True, end=BEGIN + 0.1), "parked"),
    "battery low": (Fault(volts=2.4), "stopped: battery low"),
}


class Ended(NamedTuple):
    """The result of a drive: its end by the sketch's report, and its true errors in m, rad, s.

    `rolled` is the distance that a wheel rolled from the fault on, `resets` counts the watchdog's;
    `longest` [s] is the longest period's work, `untouched` the bytes of RAM that were never used.
    """

    end: str
    place: float
    heading: float
    time: float
    rolled: float
    resets: int
    power: bool
    longest: float
    untouched: int


class Lawn:
    """The true motion, and the readings of receiver and compass."""

    def __init__(self, robot: Robot, start: wmr.Pose, seed: int) -> None:
        self.robot, self.pose, self.rng = robot, tuple(start), np.random.default_rng(seed)
        self.origin = wmr.GeoPoint(lat=robot.start_lat, lon=robot.start_lon)
        self.arm = robot.antenna_ahead, robot.antenna_left
        self.past, self.speeds = [antenna(*self.pose, *self.arm)], [0.0, 0.0]
        self.scale = 1.0 + self.rng.normal(0.0, 0.005)  # of the wheels, unknown to the sketch
        self.off = math.radians(robot.compass) * self.rng.normal()
        self.error = self.rng.normal(0.0, robot.sigma, 2)

    def roll(self, duties: tuple[float, float]) -> tuple[float, float]:
        """A step of motors and wheels; returns the distances that their encoders count [m]."""
        rolled = []
        for side, duty in enumerate(duties):
            commanded = FULL_SPEED * duty if abs(duty) >= DEAD else 0.0
            mean, self.speeds[side] = follow(self.speeds[side], commanded, 1.0 / AGILE, LAG, STEP)
            rolled.append(mean * STEP)
        v, omega = wmr.wheels_to_twist(*rolled, self.robot.track_width)
        self.pose = arc_step(*self.pose, v * self.scale, omega * self.scale, 1.0)
        self.past.append(antenna(*self.pose, *self.arm))
        return rolled[0], rolled[1]

    def fix(self, now: float) -> bytes:
        """The receiver's message: UBX, with an error that it remembers."""
        keep = math.exp(-self.robot.fix_period / self.robot.memory)
        fresh = self.rng.normal(0.0, self.robot.sigma, 2)
        self.error = keep * self.error + math.sqrt(1.0 - keep**2) * fresh
        x, y = self.past[max(0, len(self.past) - 1 - round(BEFORE / STEP))] + self.error
        at, sigma = wmr.point_at(self.origin, float(x), float(y)), self.robot.sigma
        quality = round(self.robot.quality)
        return ubx(Position(round(now + 1.0, 3), at.lat, at.lon, sigma, quality))

    def field(self) -> tuple[float, float]:
        """The compass's reading ahead and to the left, with hard iron and declination."""
        turn = self.pose[2] - 0.5 * math.pi + DECLINATION + self.off
        x, y = FIELD * np.array([math.cos(turn), -math.sin(turn)]) + self.rng.normal(0.0, 30.0, 2)
        return x + IRON[0], y + IRON[1]


def drive(
    robot: Robot = NEAR,
    start: wmr.Pose | None = None,
    seed: int = 1,
    fault: Fault = SOUND,
    changes: tuple[tuple[str, str], ...] = SETTINGS,
) -> Ended:
    """One drive, until it has parked or has stood for 6 s; by default it first faces the goal."""
    settings = sheet(robot)
    start = start or wmr.Pose(0.0, 0.0, math.atan2(settings.y, settings.x))
    lawn, board = Lawn(robot, start, seed), Board(compiled(robot, changes))
    counted, text, rolled, stood, step = [0.0, 0.0], b"", 0.0, 0.0, 0
    state, reason, longest, every = "wait", "", 0.0, round(robot.fix_period / STEP)
    while stood < (1.0 if state == "parked" else 6.0) and step * STEP < settings.duration:
        now, step = step * STEP, step + 1
        wrong = fault if fault.begin <= now < fault.end else SOUND
        if step % every == 0 and not wrong.silent:
            data = lawn.fix(now)
            board.send(data[:40] + bytes([data[40] ^ 8]) + data[41:] if wrong.garbled else data)
        if wrong.hangs and now - fault.begin < STEP:
            board.hang()
        *duties, power = board.pins()
        moved = lawn.roll((duties[0], duties[1]) if power else (0.0, 0.0))
        counted = [was + 2.0 * more / COUNT for was, more in zip(counted, moved, strict=True)]
        if wrong.encoder:
            counted[0] -= 2.0 * moved[0] / COUNT
        field = None if wrong.compass else lawn.field()
        inputs = Inputs((counted[0], counted[1]), field, wrong.pressed, wrong.volts)
        *lines, text = (text + board.run(STEP, inputs)).split(b"\n")
        for line in lines:
            numbers = list(map(int, line.split()))
            state, reason = monitor.STATES[numbers[0]], REASONS[numbers[1]]
            longest = max(longest, 1e-6 * numbers[5])
        rolled += max(map(abs, moved)) * (now >= fault.begin)
        stood = 0.0 if max(map(abs, lawn.speeds)) > 1e-3 else stood + STEP
    end = state + (f": {reason}" if reason else "")
    far = math.dist(lawn.pose[:2], (settings.x, settings.y))
    off = float(wmr.wrap_angle(lawn.pose[2] - settings.heading))
    measures = rolled, board.resets, board.pins()[2], longest, board.untouched()
    return Ended(end, far, off, step * STEP, *measures)


def starts(robot: Robot, runs: int) -> list[wmr.Pose]:
    """Poses within 3 m of the start that face the goal to within 90 degrees."""
    rng, settings = np.random.default_rng(2), sheet(robot)
    face = math.atan2(settings.y, settings.x)
    return [
        wmr.Pose(*rng.uniform(-3.0, 3.0, 2), face + rng.uniform(-1.5, 1.5)) for _ in range(runs)
    ]


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=3, help="starts with each receiver")
    given = parser.parse_args()
    print("receiver    parks   place  heading    time   (95 % of the certificate)")
    longest, untouched = 0.0, 2048
    for kind in ("RTK fixed", "SBAS", "GPS alone"):
        robot = Robot(**RECEIVERS[kind])
        bound = certificate(robot)
        for seed, start in enumerate(starts(robot, given.runs)):
            ran = drive(robot, start, seed)
            place, heading = f"{ran.place:5.2f} m", f"{math.degrees(ran.heading):5.1f} deg"
            print(f"{kind:10} {ran.end:>7} {place} {heading} {ran.time:5.0f} s", end="   ")
            print(f"({bound.place_bound:.2f} m, {math.degrees(bound.heading_bound):.0f} deg)")
            longest, untouched = max(longest, ran.longest), min(untouched, ran.untouched)
    print(f"{'fault':18} {'came to':33} rolled from then on")
    for name, (fault, must) in FAULTS.items():
        ran = drive(fault=fault)
        note = "" if ran.end == must else f"  must be {must}"
        print(f"{name:18} {ran.end:33} {ran.rolled:5.2f} m{note}")
        longest, untouched = max(longest, ran.longest), min(untouched, ran.untouched)
    program = compiled(NEAR, SETTINGS)
    stack = 2048 - untouched - program.ram
    print(f"flash {program.flash} bytes of 32256; RAM {program.ram} and {stack} of stack, of 2048")
    print(f"longest period {1e3 * longest:.1f} ms, {longest * CLOCK:.0f} cycles,", end=" ")
    print(f"of {1e3 * NEAR.period:.0f} ms")


if __name__ == "__main__":
    main()
