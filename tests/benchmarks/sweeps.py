"""Sweeps on one core: sampled and by a receiver against C, in continuous time against heyoka."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path
from unittest import mock

import numpy as np
from timing import Row, in_turn

import wmrlib as wmr
from wmrlib import threads

GOAL = wmr.Pose(9000.0, 9000.0, 0.3)  # too far to arrive: all steps are taken
GOAL_HERE = wmr.Pose(0.0, 0.0, 0.0)
RUNS, STEPS, DT = 10_000, 300, 0.02
ENSEMBLE = 4_000
METHODS = {"euler": "tangent", "arc": "arc"}  # of a sweep, and the functions in C
# GCC joins sin(a) and cos(a) into one call that has no vector form, unless that pass is disabled.
FAST = ("-O3", "-march=native", "-ffast-math", "-fdisable-tree-sincos")
BUILDS = {
    "C, scalar (-O3 -march=native)": ("-O3", "-march=native"),
    "C, libmvec (-ffast-math)": FAST,
    "C, widest vectors, with arrivals and sums": (*FAST, "-mprefer-vector-width=512", "-DSUMS"),
}


def gains(runs: int) -> wmr.Gains:
    """Different gains, with k_rho so small that exp(-k_rho rho) is normal: else libmvec is slow."""
    random = np.random.default_rng(0)
    return wmr.Gains(0.02, random.uniform(0.2, 5.0, runs), random.uniform(0.0, 4.0, runs))


def states(runs: int) -> list[np.ndarray]:
    """The start, the goal and the gains, as arrays of one entry a run."""
    row = (*wmr.paper.outdoor().start, *GOAL, *gains(runs))
    return [np.array(np.broadcast_to(value, runs), dtype=float) for value in row]


def on_one_core():
    """A context in which sweeps have one core."""
    return mock.patch.object(threads, "CORES", 1)


def sweep(method: str):
    start, of = wmr.paper.outdoor().start, gains(RUNS)
    options = {"method": method, "dt": DT, "duration": STEPS * DT, "progress": False}

    def run():
        with on_one_core():
            return wmr.sweep(start, GOAL, of, **options)

    return run


def in_c(folder: Path) -> dict[str, ctypes.CDLL]:
    """The loop in C, compiled on the spot in each way; empty where there is no compiler."""
    compiler = shutil.which("gcc")
    libraries = {}
    for name, options in BUILDS.items() if compiler else ():
        library = folder / f"limit{len(libraries)}.so"
        source = Path(__file__).with_name("limit.c")
        command = [compiler, *options, "-shared", "-fPIC", source, "-o", library, "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            print(f"{name} was not compiled: {done.stderr}")
        else:
            libraries[name] = ctypes.CDLL(str(library))
    return libraries


def c_case(library: ctypes.CDLL, name: str):
    function, pointer = getattr(library, name), np.ctypeslib.ndpointer(np.float64, flags="C")
    function.argtypes = [pointer] * 13 + [ctypes.c_long] * 2 + [ctypes.c_double] * 2

    def run():
        left, peak, length = np.full(RUNS, float(STEPS)), np.zeros(RUNS), np.zeros(RUNS)
        function(*states(RUNS), left, peak, length, RUNS, STEPS, DT, 0.05)

    return run


def euler_step(x, y, heading, goal_x, goal_y, goal_heading, k_rho, k_alpha, h, v_max):

    def wrap(angle):
        return angle - 2.0 * np.pi * np.rint(angle / (2.0 * np.pi))

    rho, sight = np.hypot(goal_x - x, goal_y - y), np.arctan2(goal_y - y, goal_x - x)
    alpha, theta = wrap(sight - heading), wrap(sight - goal_heading)
    v = v_max * (1 - np.exp(-k_rho * rho)) * np.cos(alpha)
    omega = k_alpha * alpha + v / rho * (np.sin(alpha) / alpha) * (alpha + h * theta)
    moved = x + DT * v * np.cos(heading), y + DT * v * np.sin(heading)
    return *moved, wrap(heading + DT * omega)


def numpy_case():
    def run():
        *pose, goal_x, goal_y, goal_heading, k_rho, k_alpha, h, v_max = states(RUNS)
        for _ in range(STEPS):
            pose = euler_step(*pose, goal_x, goal_y, goal_heading, k_rho, k_alpha, h, v_max)
        return pose

    return run


def sampled(folder: Path) -> list[Row]:
    libraries, timings = in_c(folder), []
    if not libraries:
        print("gcc was not found: no limit to compare with")
    for method, function in METHODS.items():
        cases = {name: c_case(library, function) for name, library in libraries.items()}
        cases["wmrlib.sweep, metrics included"] = sweep(method)
        if method == "euler":
            cases["numpy"] = numpy_case()
        seconds = in_turn(cases)
        limit = min((seconds[name] for name in libraries), default=None)
        section = f"10,000 gains by 300 steps on one core, {method.title()}, against the fastest C"
        for name, value in seconds.items():
            step, ratio = 1e9 * value / RUNS / STEPS, value / limit if limit else None
            timings.append(Row(section, name, step, "ns a step", ratio))
    return timings


RECEIVER, SEED = wmr.Receiver(0.05, 10.0, 0.2, 0.1, 0.1), 9  # 10 Hz, read at 10 Hz


def receiver_in_c(folder: Path, starts: wmr.Pose, gains: wmr.Gains, options: dict):
    """The same runs in C: its function, and where it writes what the runs amount to."""
    library, source = folder / "receiver.so", Path(__file__).with_name("receiver.c")
    command = ["gcc", "-O3", "-march=native", "-shared", "-fPIC", source, "-o", library, "-lm"]
    subprocess.run(command, check=True)
    function = ctypes.CDLL(str(library)).read_by_a_receiver
    pointer, words = (
        np.ctypeslib.ndpointer(np.float64, flags="C"),
        np.ctypeslib.ndpointer(np.uint32),
    )
    samples, key = (
        round(options["duration"] / options["dt"]) + 1,
        np.array([SEED, 0], dtype=np.uint32),
    )
    function.argtypes = [pointer] * 16 + [ctypes.c_long] * 2 + [ctypes.c_double] * 4
    function.argtypes += [ctypes.c_long] * 3 + [words]
    rows = [np.array(np.broadcast_to(row, ENSEMBLE)) for row in (*starts, *GOAL_HERE, *gains)]
    metrics, record = [np.empty(ENSEMBLE) for _ in range(5)], np.empty(8 * samples)
    late = [round(seconds / options["dt"]) for seconds in RECEIVER[2:5]]
    numbers = (
        options["dt"],
        options["arrival_radius"],
        RECEIVER.sigma,
        options["dt"] / RECEIVER.memory,
    )
    arguments = *rows, *metrics, record, ENSEMBLE, samples, *numbers, *late, key
    return lambda: function(*arguments), metrics


def by_a_receiver(folder: Path) -> list[Row]:
    """To arrival within 30 cm by what a receiver shows, or for a minute."""
    starts, gains = some_runs()
    motion = {"method": "arc", "dt": 0.1, "duration": 60.0, "arrival_radius": 0.3}
    options = motion | {"receiver": RECEIVER, "seed": SEED, "progress": False}
    with on_one_core():
        ours = "wmrlib.sweep, all metrics"
        cases = {ours: lambda: wmr.sweep(starts, GOAL_HERE, gains, **options)}
        if not shutil.which("gcc"):
            print("gcc was not found: no limit to compare with")
        else:
            cases["C (-O3 -march=native)"], metrics = receiver_in_c(folder, starts, gains, motion)
            cases["C (-O3 -march=native)"]()
            mine = cases[ours]()
            for row, theirs in zip(mine[1:], metrics, strict=True):
                np.testing.assert_allclose(row, theirs, rtol=1e-6, atol=1e-6)
        seconds = in_turn(cases)
    section, limit = (
        f"{ENSEMBLE:,} runs by a receiver on one core, against C",
        min(seconds.values()),
    )
    limit = seconds.get("C (-O3 -march=native)", limit)
    return [
        Row(section, name, 1e6 * s / ENSEMBLE, "us a run", s / limit) for name, s in seconds.items()
    ]


def some_runs() -> tuple[wmr.Pose, wmr.Gains]:
    """Starts round the origin and gains, neither stiff nor alike."""
    draw = np.random.default_rng(1).uniform
    far, sight = draw(5.0, 60.0, ENSEMBLE), draw(-np.pi, np.pi, ENSEMBLE)
    starts = wmr.Pose(far * np.cos(sight), far * np.sin(sight), draw(-2.0, 2.0, ENSEMBLE))
    rate, damping = draw(0.3, 1.0, ENSEMBLE), draw(0.7, 1.5, ENSEMBLE)
    return starts, wmr.gains_for(
        rate, natural_frequency=draw(0.7, 1.4, ENSEMBLE) * rate, damping=damping, v_max=4.0
    )


def heyoka_case(starts: wmr.Pose, gains: wmr.Gains, seconds: float):
    """Taylor series, a batch of runs at a time, until the last of it is within 5 cm."""
    import heyoka as hy

    rho, alpha, theta = hy.make_vars("rho", "alpha", "theta")
    k_rho, k_alpha, h, v_max = (hy.par[i] for i in range(4))
    v = v_max * (1.0 - hy.exp(-k_rho * rho)) * hy.cos(alpha)
    turning = v / rho * hy.sin(alpha)
    omega = k_alpha * alpha + v / rho * (hy.sin(alpha) / alpha) * (alpha + h * theta)
    system = [(rho, -v * hy.cos(alpha)), (alpha, turning - omega), (theta, turning)]
    width, arrived = hy.recommended_simd_size(), {}
    end = hy.nt_event_batch(rho - 0.05, lambda _, time, sign, lane: arrived.setdefault(lane, time))
    robots = hy.taylor_adaptive_batch(
        system, np.ones((3, width)), tol=1e-10, nt_events=[end], pars=np.ones((4, width))
    )
    begin = np.array(wmr.polar_error(starts, GOAL_HERE))
    pars = np.array(np.broadcast_arrays(*gains))

    def run():
        times = np.empty(ENSEMBLE)
        for first in range(0, ENSEMBLE, width):
            some = slice(first, first + width)
            arrived.clear()
            robots.set_time(0.0)
            robots.state[:], robots.pars[:] = begin[:, some], pars[:, some]
            robots.propagate_until(seconds, callback=lambda _: len(arrived) < width)
            times[some] = [arrived.get(lane, np.inf) for lane in range(width)]
        return times

    return run


def continuous() -> list[Row]:
    """To arrival within 5 cm or for a minute, at a tolerance of 1e-10."""
    (starts, gains), goal = some_runs(), GOAL_HERE
    with on_one_core():
        ours = "wmrlib.sweep, peaks and lengths too"
        cases = {ours: lambda: wmr.sweep(starts, goal, gains, progress=False)}
        try:
            cases["heyoka, batches"] = heyoka_case(starts, gains, 60.0)
        except ImportError:
            print("heyoka is not installed: left out")
        else:
            mine, theirs = cases[ours]().time, cases["heyoka, batches"]()
            np.testing.assert_allclose(mine, theirs, atol=1e-6)
        seconds = in_turn(cases)
    section = f"{ENSEMBLE:,} runs in continuous time on one core, against sweep"
    return [
        Row(section, name, 1e6 * s / ENSEMBLE, "us a run", s / seconds[ours])
        for name, s in seconds.items()
    ]


def rows(folder: Path) -> list[Row]:
    return [*sampled(folder), *by_a_receiver(folder), *continuous()]
