"""The loop closed on a lawn: which design parks with which receiver, and how well?

    python book/robot/lawn.py [--runs 20] [--route] [--gpsd N] [--json FILE] [--jobs N]

A robot of acceleration limits, lag, a dead band and encoder steps drives over the paper's two
points, or a route. Its receiver's fixes become UBX or NMEA and positions again, in N runs of each
kind through a pty and the real gpsd; the filter of `wmrrobot.estimation` makes poses of them, and
the compiled wmr_drive.h steers. Printed: rms and 95 % of the true place and heading errors.
"""

from __future__ import annotations

import argparse
import json
import math
import os
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack, closing
from pathlib import Path
from typing import NamedTuple

import numpy as np
from compiled import CDrive
from gpsd import FORMATS, Gpsd, Position, rounded
from world import CASE, PERIOD

import wmrlib as wmr
import wmrrobot as wr
from wmrlib import paper
from wmrlib.body import LastTurn, at_rest, roll
from wmrlib.motion import arc_step, wheel_speeds
from wmrrobot import estimation, kalman

WHEELS = wmr.Wheels(
    0.5, max_speed=1.0, min_speed=0.12, acceleration=2.0, lag=0.1, dead_band=0.04, encoder_step=1e-3
)
EVERY = 4  # periods from fix to fix
PATIENT = 5  # fixes that the filter refuses before it doubts itself
LONGEST = 240.0  # s, of a leg
GYRO, GYRO_BIAS = 0.002, 0.01  # rad/s
SCALE = 0.01  # of the wheels, unknown to the robot
COMPASS = math.radians(5.0)  # what is left of its errors for a drive
ROUTE = (wmr.Pose(15.0, 20.0, 0.5), wmr.Pose(15.0, 45.0, 2.4), CASE.goal)
FORM = tuple(FORMATS)


class Receiver(NamedTuple):
    """Standard deviation [m] and memory [s] of its error, quality, delay [s], and two antennas'."""

    sigma: float
    memory: float
    quality: float  # as NMEA counts
    delay: float = 0.1
    heading: float = math.inf  # rad; infinite without a second antenna


class Design(NamedTuple):
    """Gains and a law; an arrival radius [m], if negative in sigmas; whether with a last turn."""

    gains: wmr.Gains
    radius: float
    last_turn: bool
    law: str = "corrected"


RECEIVERS = {name: Receiver(**numbers) for name, numbers in wr.RECEIVERS.items()}
RECEIVERS["two antennas"] = RECEIVERS["RTK fixed"]._replace(heading=0.02)
DESIGNS = {
    "gentle": Design(wmr.GENTLE_GAINS, 0.2, False),
    "matched": Design(
        wmr.gains_for(0.2, natural_frequency=0.6, damping=0.5 / 0.6, v_max=4.0), -2.0, False
    ),
    "in the window": Design(wmr.Gains(0.1, 1.0, 3.0, 4.0), 0.2, False),  # kappa = 2.5 < 1 + 3
    "h = 0, last turn": Design(wmr.Gains(0.2, 2.0, 0.0, 4.0), 0.2, True),
    "Nav2's graceful": Design(wmr.Gains(0.2, 2.0, 3.0, 4.0), 0.2, True, "graceful"),
}


class Ended(NamedTuple):
    """Whether it parked everywhere; at the last place its errors [m, rad] and the time [s]."""

    parked: bool
    distance: float
    heading: float
    time: float
    reason: str


class Robot:
    """The truth, the sensors, and the filter that reads them."""

    def __init__(self, kind: Receiver, seed: int, link: Gpsd | None, form: str) -> None:
        self.rng, self.kind, self.link, self.form = np.random.default_rng(seed), kind, link, form
        self.pose, self.body = tuple(CASE.start), (0.0, 0.0, 0.0, 0.0)
        self.past, self.now, self.steps = [tuple(CASE.start[:2])], 0.0, 0
        self.error = self.rng.normal(0.0, kind.sigma, 2)
        self.scale = 1.0 + self.rng.normal(0.0, SCALE)
        self.bias = self.rng.normal(0.0, GYRO_BIAS)
        self.noise = tuple(estimation.Noise())
        compass = CASE.start.heading + self.rng.normal(0.0, COMPASS)
        x, y = self.fix()
        first = estimation.start(wmr.Pose(x, y, wmr.wrap_angle(compass)), kind.sigma, COMPASS)
        self.state, self.covariance, self.turned = first.state, first.covariance, 0.0
        self.refused = 0  # fixes in a row

    def fix(self) -> tuple[float, float]:
        """The measured position in m east and north, after its way as bytes."""
        share = math.exp(-EVERY * PERIOD / self.kind.memory)
        fresh = self.rng.normal(0.0, self.kind.sigma, 2)
        self.error = share * self.error + math.sqrt(1.0 - share**2) * fresh
        x, y = self.past[max(0, len(self.past) - 1 - round(self.kind.delay / PERIOD))] + self.error
        point = wmr.point_at(paper.GPS_POINT_1, float(x), float(y))
        time = round(self.now + 1.0, 2)
        sent = Position(time, point.lat, point.lon, self.kind.sigma, round(self.kind.quality))
        got = self.link.pass_on(sent) if self.link else rounded(sent, self.form)
        place = wmr.GeoPoint(lat=got.lat, lon=got.lon)
        east, north = wmr.local_position(paper.GPS_POINT_1, place)
        return float(east), float(north)

    def roll(self, commands: tuple[float, float]) -> tuple[float, float]:
        """A period of the true motion; returns the distances that the encoders count [m]."""
        twist = 0.5 * (commands[0] + commands[1]), (commands[1] - commands[0]) / WHEELS.track_width
        v, omega, self.body = roll(*twist, self.body, WHEELS, PERIOD)
        rolled = tuple(PERIOD * speed for speed in wheel_speeds(v, omega, WHEELS.track_width))
        self.turned = omega * self.scale * PERIOD
        self.pose = arc_step(*self.pose, v * self.scale, omega * self.scale, PERIOD)
        self.past.append((self.pose[0], self.pose[1]))
        self.now += PERIOD
        self.steps += 1
        return rolled

    def observe(self, rolled: tuple[float, float]) -> wr.Seen:
        """The readings of a period, with the filter's pose."""
        v = 0.5 * (rolled[0] + rolled[1]) / PERIOD
        omega = (rolled[1] - rolled[0]) / WHEELS.track_width / PERIOD
        gyro = self.turned / PERIOD + self.bias + self.rng.normal(0.0, GYRO)
        state, spread, kind = self.state, self.covariance, self.kind
        kalman.carry(state, spread, v, omega, gyro, PERIOD, self.noise, estimation.GATE_1)
        seen = wr.Seen(PERIOD, *rolled)
        if self.steps % EVERY:
            return seen
        x, y = self.fix()
        behind = -v * kind.delay  # where the antenna was
        gate, fix = estimation.GATE_2, (x, y, behind, 0.0, kind.sigma)
        surprise = kalman.see_antenna(state, spread, *fix, gate)
        self.refused = 0 if surprise <= gate else self.refused + 1
        if self.refused >= PATIENT:  # it may be the filter that is wrong
            spread *= 4.0
        if kind.heading < math.inf:
            heading = self.pose[2] + self.rng.normal(0.0, kind.heading)
            kalman.see_heading(state, spread, heading, kind.heading, estimation.GATE_1)
        if not surprise <= gate:  # a fix that is refused says nothing to the drive
            return seen
        x, y, heading = map(float, state[:3])
        return seen._replace(fresh=1, x=x, y=y, heading=heading, later=EVERY * PERIOD)


def run(
    design: Design, kind: Receiver, seed: int, goals: tuple = (CASE.goal,), link: Gpsd | None = None
) -> Ended:
    """One drive over the goals."""
    robot = Robot(kind, seed, link, FORM[seed % 2])
    radius = design.radius if design.radius > 0.0 else max(0.1, -design.radius * kind.sigma)
    far = 6.0 * kind.sigma
    rules = wr.Rules(radius, jump=max(1.0, far), course=max(4.0, 2.0 * far), longest_drive=LONGEST)
    turn = LastTurn(min_rate=0.25) if design.last_turn else None
    for goal in goals:
        drive = CDrive(goal, design.gains, WHEELS, turn, rules, design.law)
        rolled, latest = (0.0, 0.0), robot.now + LONGEST
        while drive.state not in ("parked", "stopped") and robot.now < latest:
            rolled = robot.roll(drive.step(robot.observe(rolled)))
        while not at_rest(robot.body):
            robot.observe(robot.roll((0.0, 0.0)))
        if drive.state != "parked":
            break
    far = math.dist(robot.pose[:2], goals[-1][:2])
    off = float(wmr.wrap_angle(robot.pose[2] - goals[-1].heading))
    return Ended(drive.state == "parked", far, off, robot.now, drive.reason)


def _runs(work: tuple) -> list[Ended]:
    design, receiver, seeds, goals = work
    return [run(DESIGNS[design], RECEIVERS[receiver], seed, goals) for seed in seeds]


def summary(ended: list[Ended]) -> dict:
    """Share parked; rms and 95 % of those that did, and their median time."""
    parked = [drive for drive in ended if drive.parked]
    row = {"runs": len(ended), "parked": len(parked) / len(ended)}
    if parked:
        far = np.array([drive.distance for drive in parked])
        off = np.degrees(np.abs([drive.heading for drive in parked]))
        for name, values in (("place_m", far), ("heading_deg", off)):
            row |= {f"{name}_rms": float(np.sqrt(np.mean(values**2)))}
            row |= {f"{name}_95": float(np.quantile(values, 0.95))}
        row["time_s"] = float(np.median([drive.time for drive in parked]))
    return row


def through_gpsd(count: int, goals: tuple) -> float:
    """Drive `count` runs through gpsd and without it; how far apart they end, in m at most."""
    apart, names = 0.0, list(RECEIVERS)
    with ExitStack() as opened:
        links = [opened.enter_context(closing(Gpsd(form))) for form in FORM]
        for seed in range(count):
            kind, design = RECEIVERS[names[seed % len(names)]], list(DESIGNS.values())[seed % 5]
            ends = [run(design, kind, seed, goals, link) for link in (None, links[seed % 2])]
            apart = max(apart, abs(ends[0].distance - ends[1].distance))
    return apart


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=20, help="of each design with each receiver")
    parser.add_argument("--route", action="store_true", help="over three poses, not one")
    parser.add_argument("--gpsd", type=int, default=10, help="runs through the real gpsd")
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    given = parser.parse_args()
    goals = ROUTE if given.route else (CASE.goal,)
    pairs = [(design, receiver) for receiver in RECEIVERS for design in DESIGNS]
    work = [(*pair, range(given.runs), goals) for pair in pairs]
    with ProcessPoolExecutor(given.jobs) as pool:
        rows = [summary(ended) for ended in pool.map(_runs, work)]
    print(f"{'receiver':13} {'design':17} parked  place rms  95 %  heading rms   95 %   time")
    for (design, receiver), row in zip(pairs, rows, strict=True):
        print(f"{receiver:13} {design:17} {row['parked']:6.0%}", end="")
        if row["parked"]:
            print(f" {row['place_m_rms']:7.2f} m {row['place_m_95']:5.2f}", end="")
            print(f" {row['heading_deg_rms']:8.1f} deg {row['heading_deg_95']:6.1f}", end="")
            print(f" {row['time_s']:5.0f} s", end="")
        print()
    if given.gpsd:
        try:
            apart = 1000.0 * through_gpsd(given.gpsd, goals)
            print(f"{given.gpsd} runs through gpsd end within {apart:.1f} mm of those without")
        except RuntimeError as lacking:
            print(f"no run through gpsd: {lacking}")
    if given.json:
        lines = []
        for (design, receiver), row in zip(pairs, rows, strict=True):
            rounded = {name: round(value, 4) for name, value in row.items()}
            lines.append(json.dumps({"design": design, "receiver": receiver} | rounded))
        text = "[\n" + ",\n".join(lines) + "\n]\n"
        Path(given.json).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
