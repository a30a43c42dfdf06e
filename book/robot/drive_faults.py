"""Faults, each in drives over the paper's two points: does the robot drive blind?

    python book/robot/drive_faults.py [--c] [--seeds 5]

prints what the first run of each came to, and which others came to something else than they must.
With --c the drive is the compiled wmr_drive.h.
"""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any, NamedTuple

import compiled
from world import CASE, PERIOD, WATCHDOG, WHEELS, Faults, World

import wmrlib as wmr
import wmrrobot as wr

GAINS = wmr.GENTLE_GAINS
LONGEST = 300.0  # s
SPEED, BRAKE = WHEELS.max_speed, WHEELS.acceleration
BRAKING = SPEED**2 / (2.0 * BRAKE) + SPEED * (WHEELS.lag + 2 * PERIOD)  # m, as far as it rolls on
SIDES = -15.0, -15.0, 25.0  # m, of the fence: west, south, east
SILENCE = SPEED * (wr.Rules().patience + 0.2) + BRAKING  # m, after the last usable fix


class Case(NamedTuple):
    """A fault: what is wrong `begin` to `end` s after the start, and what must come of it.

    `must` is "parked", or the state and the reason in which it stands in the end, or two of these,
    with a "|" between them, if either will do. `within` is, in m, how far from its goal it may
    park, or how far it may roll from the fault on.
    """

    name: str
    wrong: dict[str, Any]
    must: str
    within: float
    begin: float = 20.0
    end: float = math.inf
    rules: dict[str, Any] = {}  # noqa: RUF012 (nobody changes it)
    fence: tuple = (*SIDES, 75.0)


OFF_COURSE = "stopped: heading disagrees with course"
OFF_WHEELS = "stopped: heading disagrees with wheels"
STUCK = "stopped: wheel or encoder stuck"
UNTOLD = "stopped: wheel turns untold"
SLIPPING = "stopped: wheels turn and robot stands"
OUTSIDE = "stopped: robot outside the fence"
POOR = "wait: fix of too low quality"
STALE = "wait: fix time stands or goes back"
JUMPED = "wait: position jumped"
_WHEEL = 2.5 * wr.Rules().wheel + BRAKING
_FROZEN = wr.Rules().frozen + SILENCE
_LEG = 2.0 * wr.Rules().course + BRAKING
_AT_ONCE = 4 * PERIOD * SPEED + BRAKING
# With an RTK receiver, the rules of its sheet: what follows from its error.
_RTK = wr.sheet(wr.Robot(sigma=0.02, fix_period=0.1, acceleration=BRAKE)).rules._asdict()
RTK = {name: _RTK[name] for name in ("jump", "largest_error", "least")}
CASES = (
    Case("no fix at boot", {"silent": True}, "wait: no fix", 0.0, begin=0.0),
    Case("a fix after 15 s", {"silent": True}, "parked", 0.3, begin=0.0, end=15.0),
    Case("silent", {"silent": True}, "wait: no fix", SILENCE),
    Case("silent for 10 s", {"silent": True}, "parked", 0.3, end=30.0),
    Case("quality 0", {"quality": 0}, POOR, SILENCE),
    Case("dead reckoning", {"quality": 6}, POOR, SILENCE),
    Case("its own error 3 m", {"error": 3.0}, POOR, SILENCE),
    Case("message frozen", {"stuck_message": True}, STALE, SILENCE),
    Case("position frozen", {"stuck_position": True}, "wait: position frozen", _FROZEN),
    Case("time goes back", {"time": -1.0}, STALE, SILENCE),
    Case("x is NaN", {"not_a_number": "x"}, "wait: fix is no number", SILENCE),
    Case("heading is NaN", {"not_a_number": "heading"}, "wait: fix is no number", SILENCE),
    Case("1 s late, and says so", {"delay": 1.0}, "wait: fix too old", SILENCE),
    Case("0.4 s late, unsaid", {"delay": 0.4, "age_known": False}, "parked", 0.4),
    Case("one fix a second", {"period": 1.0}, "parked", 0.4, rules={"patience": 1.5}, begin=0.0),
    Case("one fix a second, patience 0.5 s", {"period": 1.0}, "wait: too few good fixes", 0.0, 0.0),
    Case("a jump of 30 m", {"jump": 30.0}, JUMPED, SILENCE),
    Case("a jump, and back", {"jump": 30.0}, "parked", 0.3, end=25.0),
    Case("one fix 30 m off", {"jump": 30.0}, "parked", 0.3, end=20.1),
    *(
        Case(f"RTK, {off:g} m off", {"jump": off}, JUMPED, SILENCE, rules=RTK)
        for off in (0.2, 0.5, 0.8, 2.0)
    ),
    Case("RTK falls to float, says so", {"quality": 5, "error": 0.2}, POOR, SILENCE, rules=RTK),
    Case(
        "silent, 10 s allowed",
        {"silent": True},
        "stopped: waited too long",
        SILENCE,
        rules={"longest_wait": 10.0},
    ),
    Case("antenna 0.3 m ahead", {"antenna": 0.3}, "parked", 0.3, 0.0),
    Case("drifts by 2 m/s", {"drift": (2.0, 0.0)}, OFF_COURSE, _LEG),
    Case(
        "drifts ahead by 3 m/s", {"drift": (0.0, 3.0)}, "stopped: position outruns the wheels", _LEG
    ),
    Case("lat and lon swapped", {"swapped": True}, OUTSIDE, 0.0, 0.0),
    Case("swapped on the way", {"swapped": True}, JUMPED, SILENCE),
    Case("clock jumps an hour", {"clock": 3600.0}, "parked", 0.3),
    Case("clock goes back", {"clock": -10.0}, "parked", 0.3),
    Case("clock stands", {"clock_stands": True}, "wait: clock jumped", _AT_ONCE),
    Case("program hangs for 2 s", {"hangs": True}, "parked", 0.3, end=22.0),
    Case("encoder lost", {"left_encoder": 0.0}, STUCK, _WHEEL),
    Case("wheel blocked", {"right_motor": 0.0}, STUCK, _WHEEL),
    Case("motor runs on as it waits", {"silent": True, "left_runs_on": True}, UNTOLD, _WHEEL, 0.0),
    Case("pushed as it waits", {"silent": True, "pushed": 0.3}, UNTOLD, _WHEEL, 0.0),
    Case("cables swapped", {"cables_swapped": True}, f"{STUCK} | {UNTOLD}", _LEG, 0.0),
    Case("spins in the mud", {"grip": 0.0}, SLIPPING, _LEG),
    Case("dead band unknown", {"dead_band": 0.15}, STUCK, _LEG, 60.0),
    Case("compass a quarter off", {"compass": 1.571}, OFF_COURSE, _LEG, 0.0),
    Case("bearing for heading", {"clockwise": True}, OFF_WHEELS, _LEG, 0.0),
    Case("compass by a motor", {"compass_by_motors": 1.5}, OFF_WHEELS, _LEG, 0.0),
    Case(
        "battery low", {"battery": 20.0}, "stopped: battery low", SILENCE, rules={"battery": 22.0}
    ),
    Case(
        "goal outside the fence",
        {},
        "stopped: goal outside the fence",
        0.0,
        0.0,
        fence=(*SIDES, 50.0),
    ),
    Case(
        "goal 58 m away, 50 allowed",
        {},
        "stopped: goal too far",
        0.0,
        0.0,
        rules={"farthest": 50.0},
    ),
    Case(
        "40 s, and not there",
        {},
        "stopped: drive too long",
        40.0,
        0.0,
        rules={"longest_drive": 40.0},
    ),
    Case("fence across the way", {}, OUTSIDE, BRAKING, math.inf, fence=(*SIDES, 57.5)),
)

# Too slight for the table: what it does not notice, or late. `within` is of the goal.
SLIGHT = (
    Case("compass 40 deg off", {"compass": 0.7}, "parked", 0.3, 0.0),
    Case("0.8 m off, no RTK asked for", {"jump": 0.8}, "parked", 1.2),
    Case("RTK falls to float, unsaid", {"wander": 0.2}, "parked", 1.0, rules=RTK),
    Case(
        "antenna 0.3 m ahead, unsaid",
        {"antenna": 0.3, "antenna_known": False},
        "parked",
        1.0,
        0.0,
    ),
    Case("drifts by 0.2 m/s", {"drift": (0.2, 0.0)}, "parked", 10.0),
    Case("drifts by 0.5 m/s", {"drift": (0.5, 0.0)}, SLIPPING, 60.0),
    Case("a wheel at 30 %", {"right_motor": 0.3}, OUTSIDE, 60.0),
)


class Ran(NamedTuple):
    """The result of a run: its end, its errors [m, rad], and all decisions and readings."""

    end: str
    distance: float
    heading: float
    blind: float  # m rolled from the fault on
    time: float
    decisions: tuple[tuple[str, str], ...]
    readings: tuple[wr.Seen, ...]


def run(case: Case, drive_kind: type = wr.Drive, seed: int = 1) -> Ran:
    """One drive, with the fault, until it has parked or has stood for 20 s."""
    rules = wr.Rules()._replace(**case.rules)
    drive = drive_kind(CASE.goal, GAINS, WHEELS, rules=rules)
    world, decisions, readings = World(seed, case.fence), [], []
    commands, at_fault, stands = (0.0, 0.0), None, 0.0
    longest = 20.0 + max(when for when in (0.0, case.begin, case.end) if when < math.inf)
    while world.now < LONGEST and stands < longest:
        wrong = case.begin <= world.now + 1e-9 < case.end
        faults = Faults(**case.wrong) if wrong else Faults()
        if at_fault is None and (wrong or not world.inside(*world.pose[:2])):
            at_fault, world.clock_error = world.rolled, faults.clock
        if faults.hangs:
            if world.now > case.begin + WATCHDOG:
                commands = (0.0, 0.0)
                drive.reset()
        else:
            readings.append(world.see(faults))
            commands = drive.step(readings[-1])
            decisions.append((drive.state, drive.reason))
        world.power = drive.state != "stopped"
        world.roll(commands, faults)
        stands = stands + PERIOD if max(map(abs, world.speeds)) < 1e-6 else 0.0
        if drive.state == "parked" and stands > 1.0:
            break
    end = drive.state + (f": {drive.reason}" if drive.reason else "")
    gap = math.dist(world.pose[:2], CASE.goal[:2])
    heading = abs(wmr.wrap_angle(world.pose.heading - CASE.goal.heading))
    blind = world.rolled - (world.rolled if at_fault is None else at_fault)
    return Ran(end, gap, heading, blind, world.now, tuple(decisions), tuple(readings))


def holds(case: Case, ran: Ran) -> bool:
    """Whether the run came to what it must."""
    far = ran.distance if case.must == "parked" else ran.blind
    return ran.end in case.must.split(" | ") and far <= case.within + 1e-9


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--c", action="store_true", help="by the compiled header")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--json", metavar="FILE")
    given = parser.parse_args()
    kind = compiled.CDrive if given.c else wr.Drive
    print(f"{'fault':33} {'came to':41} {'m':>6} {'at most':>7}")
    good, rows = 0, []
    for case in CASES:
        for seed in range(1, given.seeds + 1):
            ran = run(case, kind, seed)
            far = ran.distance if case.must == "parked" else ran.blind
            good += holds(case, ran)
            fault = "" if holds(case, ran) else f"  must be {case.must}, seed {seed}"
            if seed == 1:
                rows.append([case.name, ran.end, round(far, 2), case.within])
            if seed == 1 or fault:
                print(f"{case.name:33} {ran.end:41} {far:6.2f} {case.within:7.2f}{fault}")
    print(f"{good} of {len(CASES) * given.seeds} as they must")
    slight = []
    for case in SLIGHT:
        ran = run(case, kind)
        off = round(math.degrees(ran.heading))
        slight.append([case.name, ran.end, round(ran.blind), round(ran.distance, 1), off])
        print(f"{case.name:33} {ran.end:41} {ran.blind:6.2f}")
    if given.json:
        faults, rest = (",\n".join(map(json.dumps, part)) for part in (rows, slight))
        text = f'{{"faults": [\n{faults}\n],\n"slight": [\n{rest}\n]}}\n'
        Path(given.json).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
