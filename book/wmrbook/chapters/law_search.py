"""Chapter 13's search: each law with its own best gains, on two robots and with two seeds.

    python -m wmrbook.chapters.law_search    # minutes: writes wmrbook/data/chapter13_laws.json

The chapter shows what is stored, and computes one row of it anew.
"""

from __future__ import annotations

import itertools
import json
import math

import numpy as np

import wmrlib as wmr
from wmrbook import data

FILE = data.path("chapter13_laws.json")
LAWS = "corrected", "printed", "aicardi", "graceful", "barrier"
ROBOTS = (wmr.Wheels(0.4, 0.5), 0.02), (wmr.Wheels(0.3, 1.0), 0.05)  # and how often they sample, s
SPANS = (1, 2), (2, 5), (5, 10)  # m from the goal
RADII = 0.25, 0.1, 0.05  # m
GOAL = wmr.Pose(0.0, 0.0, 0.0)
LOST = 60.0  # s, in place of a time
FEW, MANY = 200, 4000  # starts to choose the gains by, and fresh ones to measure them by
FIRST = 20  # of the few
MOST_FAILURES = FEW // 100

Times = dict[tuple[tuple[int, int], float], np.ndarray]


def draw(law: str, rng: np.random.Generator) -> wmr.Gains:
    """Gains: k_rho, kappa or k_delta, h or k_phi, and v_max, each log-uniform."""
    low, high = np.log([0.3, 0.5, 0.02, 0.3]), np.log([8.0, 20.0, 20.0, 2.0])
    k_rho, kappa, h, v_max = np.exp(rng.uniform(low, high)).tolist()
    rate = {"graceful": 1.0, "aicardi": k_rho}.get(law, k_rho * v_max)
    return wmr.Gains(k_rho, kappa * rate, h, v_max)


def scattered(span: tuple[int, int], count: int, rng: np.random.Generator) -> wmr.Pose:
    """Starts at random distances within the span, in all directions, with all headings."""
    aim, heading = rng.uniform(-math.pi, math.pi, (2, count))
    far = rng.uniform(*span, count)
    return wmr.Pose(far * np.cos(aim), far * np.sin(aim), heading)


def judged(starts: wmr.Pose, trials: np.ndarray, options: dict) -> np.ndarray:
    """Mean seconds to 5 deg, to 10 deg, or with a last turn; NaN if over 1 % don't park."""
    gains, wheels = wmr.Gains(*trials.T[..., None]), options["wheels"]
    run = wmr.sweep(starts, GOAL, gains, **options)
    off, spin = np.abs(run.heading_error), 2 * wheels.max_speed / wheels.track_width
    good = [run.arrived & (np.degrees(off) <= most) for most in (5, 10, np.inf)]
    mean = np.where(good, [run.time, run.time, run.time + off / spin], LOST).mean(axis=2)
    return np.where(np.mean(good, axis=2) >= 0.99, mean, np.nan)


def searched(
    law: str, robot: tuple[wmr.Wheels, float], span: tuple[int, int], radius: float, seed: int
) -> np.ndarray:
    """The mean times for 5 deg, 10 deg and with a last turn, each with gains of its own.

    Gains that miss the radius too often from the first few starts need not see the others.
    """
    rng, (wheels, dt) = np.random.default_rng(seed), robot
    options = {"law": law, "method": "arc", "dt": dt, "duration": LOST, "wheels": wheels}
    options |= {"arrival_radius": radius, "progress": False}
    few, many = scattered(span, FEW, rng), scattered(span, MANY, rng)
    trials = np.array([draw(law, rng) for _ in range(80)])
    first = wmr.Pose(*(field[:FIRST] for field in few))
    missed = ~wmr.sweep(first, GOAL, wmr.Gains(*trials.T[..., None]), **options).arrived
    hopeful, costs = missed.sum(axis=1) <= MOST_FAILURES, np.full((3, len(trials)), np.inf)
    costs[:, hopeful] = np.nan_to_num(judged(few, trials[hopeful], options), nan=np.inf)
    return judged(many, trials[costs.argmin(axis=1)], options).diagonal()


def row(span: tuple[int, int], radius: float) -> np.ndarray:
    """The mean times [s] of each law, in each set of a robot and a seed, of the three kinds."""
    sets = itertools.product(LAWS, ROBOTS, (1, 2))
    times = [searched(law, robot, span, radius, seed) for law, robot, seed in sets]
    return np.reshape(times, (len(LAWS), 4, 3))


def read() -> Times:
    """The stored rows, by the span of starts and the radius."""
    rows = json.loads(FILE.read_text(encoding="utf-8"))
    return {
        (tuple(item["span"]), item["radius"]): np.array([*item["seconds"].values()], float)
        for item in rows
    }


def write() -> None:
    """Search all rows and store them, a line each; what doesn't park has null for its time."""
    lines = []
    for span, radius in itertools.product(SPANS, RADII):
        times = np.round(row(span, radius), 6).astype(object)
        times[times != times] = None
        seconds = dict(zip(LAWS, times.tolist(), strict=True))
        lines.append(json.dumps({"span": span, "radius": radius, "seconds": seconds}))
        print(f"{span[0]} to {span[1]} m, {100 * radius:.0f} cm", flush=True)
    FILE.write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8")


if __name__ == "__main__":
    write()
