"""Sweeps of 300 steps, in nanoseconds a step, against C, numpy and JAX, and how the cost grows."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from timing import Row, in_turn

import wmrlib as wmr

os.environ.setdefault(
    "XLA_FLAGS", "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
)  # JAX on one core
GOAL = wmr.Pose(9000.0, 9000.0, 0.3)  # too far to arrive: all steps are taken
RUNS, STEPS, DT = 10_000, 300, 0.02
METHODS = (  # of a sweep, the functions in C, and titles
    ("polar_euler", "euler", "Euler"),
    ("rk4", "rk4", "Runge-Kutta"),
    ("euler", "tangent", "sampled, Euler"),
    ("arc", "arc", "sampled, arc"),
)
# GCC joins sin(a) and cos(a) into one call that has no vector form, unless that pass is disabled.
FAST = ("-O3", "-march=native", "-ffast-math", "-fdisable-tree-sincos")
BUILDS = {
    "C, scalar (-O3 -march=native)": ("-O3", "-march=native"),
    "C, libmvec (-ffast-math)": FAST,
    "C, libmvec, widest vectors": (*FAST, "-mprefer-vector-width=512"),
}


def gains(runs: int) -> wmr.Gains:
    """Different gains, with k_rho so small that exp(-k_rho rho) is normal: else libmvec is slow."""
    random = np.random.default_rng(0)
    return wmr.Gains(0.02, random.uniform(0.2, 5.0, runs), random.uniform(0.0, 4.0, runs))


def states(runs: int) -> list[np.ndarray]:
    """rho, alpha, theta and the gains, as arrays of one entry a run."""
    polar = wmr.polar_error(wmr.paper.outdoor().start, GOAL)
    return [
        np.full(runs, value) if np.ndim(value) == 0 else value.copy()
        for value in (*polar, *gains(runs))
    ]


def plane_states(runs: int) -> list[np.ndarray]:
    """The start, the goal and the gains."""
    row = (*wmr.paper.outdoor().start, *GOAL, *gains(runs))
    return [np.array(np.broadcast_to(value, runs), dtype=float) for value in row]


def sweep(method: str, runs: int, steps: int, executor):
    start, of = wmr.paper.outdoor().start, gains(runs)
    return lambda: wmr.sweep(
        start,
        GOAL,
        of,
        method=method,
        dt=DT,
        duration=steps * DT,
        executor=executor,
        progress=False,
    )


def in_c(folder: Path) -> dict[str, ctypes.CDLL]:
    """The loop in C, compiled on the spot in each way; empty where there is no compiler."""
    compiler = shutil.which("gcc")
    libraries = {}
    for name, options in BUILDS.items() if compiler else ():
        library = folder / f"limit{len(libraries)}.so"
        source = Path(__file__).with_name("limit.c")
        done = subprocess.run(
            [compiler, *options, "-shared", "-fPIC", source, "-o", library, "-lm"],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            print(f"{name} was not compiled: {done.stderr}")
        else:
            libraries[name] = ctypes.CDLL(str(library))
    return libraries


def c_case(library: ctypes.CDLL, name: str):
    function, pointer = getattr(library, name), np.ctypeslib.ndpointer(np.float64, flags="C")
    begin = plane_states if name in ("tangent", "arc") else states
    function.argtypes = [pointer] * len(begin(1)) + [ctypes.c_long] * 2 + [ctypes.c_double]
    return lambda: function(*begin(RUNS), RUNS, STEPS, DT)


def numpy_case():
    def run():
        rho, alpha, theta, k_rho, k_alpha, h, v_max = states(RUNS)
        for _ in range(STEPS):
            sine, cosine = np.sin(alpha), np.cos(alpha)
            v = v_max * (1 - np.exp(-k_rho * rho)) * cosine
            turning = v / rho * sine
            omega = k_alpha * alpha + v / rho * (sine / alpha) * (alpha + h * theta)
            rho, alpha, theta = (
                rho - DT * v * cosine,
                alpha + DT * (turning - omega),
                theta + DT * turning,
            )
        return rho

    return run


def jax_case():
    import jax
    import jax.numpy as jnp

    jax.config.update("jax_enable_x64", True)

    @jax.jit
    def run(rho, alpha, theta, k_rho, k_alpha, h, v_max):
        def step(_, state):
            rho, alpha, theta = state
            sine, cosine = jnp.sin(alpha), jnp.cos(alpha)
            v = v_max * (1 - jnp.exp(-k_rho * rho)) * cosine
            turning = v / rho * sine
            omega = k_alpha * alpha + v / rho * (sine / alpha) * (alpha + h * theta)
            return rho - DT * v * cosine, alpha + DT * (turning - omega), theta + DT * turning

        return jax.lax.fori_loop(0, STEPS, step, (rho, alpha, theta))

    return lambda: run(*states(RUNS))[0].block_until_ready()


def against_the_limit(folder: Path) -> list[Row]:
    libraries, rows = in_c(folder), []
    if not libraries:
        print("gcc was not found: no limit to compare with")
    with ThreadPoolExecutor(1) as one:
        for method, function, title in METHODS:
            cases = {name: c_case(library, function) for name, library in libraries.items()}
            cases["wmrlib.sweep, metrics included"] = sweep(method, RUNS, STEPS, one)
            if method == "polar_euler":
                cases["numpy"] = numpy_case()
                try:
                    cases["JAX"] = jax_case()
                except ImportError:
                    print("JAX is not installed: left out")
            seconds = in_turn(cases)
            limit = min((seconds[name] for name in libraries), default=None)
            section = f"10,000 gains by 300 steps on one core, {title}, against the fastest C"
            for name, value in seconds.items():
                rows.append(
                    Row(
                        section,
                        name,
                        1e9 * value / RUNS / STEPS,
                        "ns a step",
                        value / limit if limit else None,
                    )
                )
    return rows


def growth() -> list[Row]:
    with ThreadPoolExecutor(1) as one:
        sizes = [(n, 300) for n in (1000, 10_000, 100_000, 1_000_000)] + [
            (1000, n) for n in (3000, 30_000)
        ]
        seconds = in_turn({size: sweep("polar_euler", *size, one) for size in sizes}, repeat=3)
    each = {size: 1e9 * value / size[0] / size[1] for size, value in seconds.items()}
    section, base = "Growth, Euler on one core, against 10,000 runs of 300 steps", each[10_000, 300]
    rows = [
        Row(section, f"{n:,} runs of {k:,} steps", value, "ns a step", value / base)
        for (n, k), value in each.items()
    ]
    pools = {n: ThreadPoolExecutor(n) for n in (1, *((2,) if (os.cpu_count() or 1) > 1 else ()))}
    cores = in_turn(
        {f"{n} core{'s' * (n > 1)}": sweep("rk4", 100_000, 300, pool) for n, pool in pools.items()},
        repeat=7,
    )
    for pool in pools.values():
        pool.shutdown()
    return rows + [
        Row(
            "100,000 runs of 300 steps, Runge-Kutta, against one core",
            name,
            s,
            "s",
            s / cores["1 core"],
        )
        for name, s in cores.items()
    ]
