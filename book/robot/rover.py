"""A rover with mass, in MuJoCo: what the theorem's model leaves out, measured.

    python book/robot/rover.py [--json book/wmrbook/rover.json] [--jobs N]

The corrected law drives two wheels, motors and a castor over the paper's two points, on concrete
and on wet grass, level and on slopes, beside the kinematic robot. It needs the package mujoco.
"""

from __future__ import annotations

import argparse
import json
import math
import os
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import Any

import mujoco
import numpy as np

import wmrlib as wmr
from wmrbook import rover_model as model
from wmrbook.rover_model import ARRIVAL, LONGEST, PERIOD, Rover
from wmrlib import paper
from wmrlib.elementary import wrap

CASE = paper.outdoor()
WHEELS = wmr.Wheels(model.TRACK_WIDTH, max_speed=model.FASTEST)
SLOW = 0.5  # m/s, below which a slip angle says little
PAPERS, GENTLE, SLOWER = "the paper's", "gentle", "gentle, 1 m/s"
GAINS = {
    PAPERS: CASE.gains,
    GENTLE: wmr.GENTLE_GAINS,
    SLOWER: wmr.GENTLE_GAINS._replace(k_rho=0.8, v_max=1.0),  # with the same lambda
}
GROUNDS = {"concrete": model.DRY, "wet grass": model.WET_GRASS}
TO_GOAL = math.degrees(math.atan2(CASE.goal.y, CASE.goal.x))
SLOPES = {"uphill": TO_GOAL + 180.0, "downhill": TO_GOAL, "across": TO_GOAL - 90.0}
KAPPAS, WEIGHTS = [0.5 * k for k in range(1, 13)], [0.5 * k for k in range(11)]
VARIED = [{"height": it} for it in (0.1, 0.3, 0.4, 0.5)] + [{"load": it} for it in (4.5, 72.0)]
SAMPLE = ["t", "x", "y", "heading", "rho", "ahead", "side", "left", "right", "castor"]


class World:
    """The rover in MuJoCo, at rest at a pose."""

    def __init__(self, rover: Rover, pose: wmr.Pose) -> None:
        self.model = mujoco.MjModel.from_xml_string(model.mjcf(rover))
        self.data, half = mujoco.MjData(self.model), 0.5 * pose.heading
        turned = math.cos(half), 0.0, 0.0, math.sin(half)
        self.data.qpos[:7] = pose.x, pose.y, model.WHEEL_RADIUS, *turned
        self.steps = round(PERIOD / rover.timestep)
        mujoco.mj_step(self.model, self.data, self.steps)  # it comes to stand on its springs

    @property
    def pose(self) -> wmr.Pose:
        """Of the middle of the axle, from above."""
        x, y, _, a, b, c, d = self.data.qpos[:7].tolist()
        return wmr.Pose(x, y, math.atan2(2.0 * (a * d + b * c), 1.0 - 2.0 * (c * c + d * d)))

    def sample(self, pose: wmr.Pose) -> tuple[float, ...]:
        """The speeds ahead and to the left [m/s], and the loads of wheels and castor [N]."""
        east, north = self.data.qvel[:2].tolist()
        sine, cosine = math.sin(pose.heading), math.cos(pose.heading)
        speeds = cosine * east + sine * north, cosine * north - sine * east
        return *speeds, *self.data.sensordata.tolist()

    def roll(self, v: float, omega: float) -> None:
        """Tell the wheels a twist for a period."""
        speeds = wmr.twist_to_wheels(v, omega, model.TRACK_WIDTH)
        self.data.ctrl[:] = np.array(speeds) / model.WHEEL_RADIUS
        mujoco.mj_step(self.model, self.data, self.steps)


def drive(
    rover: Rover,
    gains: wmr.Gains,
    start: wmr.Pose = CASE.start,
    goal: wmr.Pose = CASE.goal,
    radius: float = ARRIVAL,
    duration: float = LONGEST,
) -> dict[str, np.ndarray]:
    """Drive the rover from pose to pose by the corrected law: its samples, by the names SAMPLE."""
    world, rows, speed = World(rover, start), [], 0.0
    for k in range(round(duration / PERIOD) + 1):
        pose = world.pose
        polar = wmr.polar_error(pose, goal)
        rows.append((k * PERIOD, *pose, polar.rho, *world.sample(pose)))
        if polar.rho <= radius:
            break
        v, omega = wmr.limit_wheels(*wmr.control_law(*polar, gains), WHEELS)
        speed = min(abs(v), speed + rover.acceleration * PERIOD)
        world.roll(math.copysign(speed, v), omega)
    return dict(zip(SAMPLE, np.array(rows).T, strict=True))


def ideal(gains: wmr.Gains, start: wmr.Pose = CASE.start, goal: wmr.Pose = CASE.goal):
    """The same drive of the kinematic robot."""
    return wmr.simulate(start, goal, gains, dt=PERIOD, duration=LONGEST, wheels=WHEELS)


def apart(at: dict[str, np.ndarray], run: wmr.Trajectory) -> float:
    """How far the rover's path leads from the kinematic one at most [m]."""
    fine = np.linspace(0.0, run.t[-1], 40 * len(run))
    path = np.interp(fine, run.t, run.x) + 1j * np.interp(fine, run.t, run.y)
    return float(max(np.abs(path - place).min() for place in at["x"] + 1j * at["y"]))


def off_deg(rho: np.ndarray, heading: np.ndarray, goal: wmr.Pose = CASE.goal) -> float | None:
    """The heading error where the path enters the arrival radius, between its last two samples.

    None if it does not.
    """
    if rho[-1] > ARRIVAL:
        return None
    share = (rho[-2] - ARRIVAL) / (rho[-2] - rho[-1])
    return math.degrees(wrap(heading[-2] + share * wrap(heading[-1] - heading[-2]) - goal.heading))


def measured(name: str, ground: str, slope: str, changes: dict[str, float]) -> dict[str, Any]:
    """What a drive over the paper's two points comes to, beside the kinematic one."""
    steep = {"friction": GROUNDS[ground], "downhill_deg": SLOPES.get(slope, 0.0)}
    at, run = drive(Rover(**changes | steep), GAINS[name]), ideal(GAINS[name])
    slip = np.degrees(np.arctan2(at["side"], np.abs(at["ahead"])))
    mean = np.ones(5) / 5  # over a quarter of a second: a knock is no lifting
    loads = [np.convolve(at[it] / at[it][0], mean, "valid") for it in ("left", "right", "castor")]
    return {
        **{"gains": name, "ground": ground, "slope": slope, **changes},
        **{"time": at["t"][-1], "ideal_time": run.t[-1], "apart": apart(at, run)},
        "off_deg": off_deg(at["rho"], at["heading"]),
        "ideal_off_deg": off_deg(run.rho, run.heading),
        "slip_deg": np.abs(slip[np.abs(at["ahead"]) > SLOW]).max(),
        "least_load": np.min(loads),
    }


def castor_kick(**changes: float) -> dict[str, Any]:
    """How far a castor that points ahead swings the rover round and aside as it sets off."""
    start, goal = wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(20.0, 0.0, 0.0)
    aligned, ahead = (
        drive(Rover(castor_deg=angle, **changes), GAINS[SLOWER], start, goal, duration=4.0)
        for angle in (0.0, 175.0)  # at 180 it would balance
    )
    heading, side = (np.abs(ahead[name] - aligned[name]).max() for name in ("heading", "y"))
    return {"heading_deg": math.degrees(heading), "side": side, **changes}


def stalls_at(dry: float, timestep: float = 0.002) -> dict[str, Any]:
    """Where motors with friction stall before the goal, beside their dead band over lambda."""
    rover, gains = Rover(dry=dry, timestep=timestep), wmr.GENTLE_GAINS
    predicted = model.WHEEL_RADIUS * dry / rover.servo / (gains.k_rho * gains.v_max)
    rest = drive(rover, gains, radius=1e-4)["rho"][-1]
    return {"dry": dry, "timestep": timestep, "rest": rest, "predicted": predicted}


def window(pace: float, ground: str, kappa: float) -> list[tuple[float | None, ...]]:
    """For each h, the rover's heading error on the page's drive and the ideal one, in deg.

    `pace` is how many times faster than PAGE_GAINS lets it drive, and how much later brake.
    """
    k_rho, _, _, v_max = (pace * gain for gain in model.PAGE_GAINS)
    found = []
    for h in WEIGHTS:
        gains = wmr.Gains(k_rho, kappa * k_rho * v_max, h, v_max)
        at = drive(Rover(friction=GROUNDS[ground]), gains, *model.PAGE_DRIVE)
        run = ideal(gains, *model.PAGE_DRIVE)
        ways = (at["rho"], at["heading"]), (run.rho, run.heading)
        found.append(tuple(off_deg(*way, model.PAGE_DRIVE[1]) for way in ways))
    return found


def everything(jobs: int | None) -> dict[str, Any]:
    """All that the chapter, the page and the tests read."""
    level = [(name, ground, "level") for name in GAINS for ground in GROUNDS]
    cases = [(*it, change) for it in level for change in ({}, {"timestep": 0.001})]
    steep = [(slope, {"slope_deg": deg}) for slope in SLOPES for deg in (5.0, 10.0)]
    cases += [(name, ground, *it) for name, ground, _ in level for it in steep]
    cases += [(name, "concrete", "level", it) for name in (PAPERS, GENTLE) for it in VARIED]
    at_once = {"slope_deg": 5.0, "acceleration": 1000.0}
    cases += [(GENTLE, "concrete", "uphill", at_once)]
    kicks = [{}, {"friction": model.WET_GRASS}, {"timestep": 0.001}, *VARIED[-2:]]
    maps = [(pace, ground) for pace in (1.0, 2.0) for ground in GROUNDS]
    with ProcessPoolExecutor(jobs) as pool:
        lines = [pool.map(partial(window, *it), KAPPAS) for it in maps]
        drives = list(pool.map(measured, *zip(*cases, strict=True)))
        windows = [list(it) for it in lines]
    at = drive(Rover(), model.PAGE_GAINS, *model.PAGE_DRIVE)
    return {
        "mujoco": mujoco.__version__,
        "drives": drives,
        "kicks": [castor_kick(**it) for it in kicks],
        "stalls": [stalls_at(*it) for it in ((0.25,), (0.5,), (1.0,), (2.0,), (0.5, 0.001))],
        "kappas": KAPPAS,
        "weights": WEIGHTS,
        "windows": [[*it, found] for it, found in zip(maps, windows, strict=True)],
        "page": [[at[it][k] for it in ("x", "y", "heading")] for k in range(0, len(at["x"]), 20)],
    }


def main() -> None:
    """Print the drives, and store everything."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    given = parser.parse_args()
    found = everything(given.jobs)
    for it in found["drives"]:
        print(", ".join(f"{name} {value}" for name, value in it.items()))
    if given.json:
        with open(given.json, "w", encoding="utf-8") as file:
            exact = json.dumps(found, default=float)
            rounded = json.loads(exact, parse_float=lambda text: round(float(text), 6))
            json.dump(rounded, file)


if __name__ == "__main__":
    main()
