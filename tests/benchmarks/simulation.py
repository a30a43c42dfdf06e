"""How long things take, side by side in one run: python tests/benchmarks/simulation.py

Machines differ and are noisy, so the ratios are what to quote. Each figure is the best of several repetitions.
"""

import math
import os
import platform
import subprocess
import sys
import tempfile
import time
import timeit

import control
import numpy as np
from scipy.integrate import solve_ivp

import wmrlib as wmr
from wmrlib.control import CORRECTED, pose_law
from wmrlib.kinematics import polar_closing_rate

STEPS, DT = 300, 0.1
START, GOAL, GAINS = (
    wmr.paper.outdoor().start,
    wmr.Pose(900.0, 900.0, 0.3),
    wmr.paper.OUTDOOR_GAINS,
)  # too far to arrive: all steps are taken


def best(function, repeat=5, at_least=0.05):
    function()
    once = timeit.timeit(function, number=1)
    number = max(1, int(at_least / max(once, 1e-9)))
    return min(timeit.repeat(function, number=number, repeat=repeat)) / number


def process(statement, **environment):
    """Seconds of a fresh Python process for one statement, timed inside, without Python's own start."""
    code = f"import time; begin = time.perf_counter(); {statement}; print(time.perf_counter() - begin)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=os.environ | environment)
    return float(run.stdout)


def python_control():
    """The same law as a NonlinearIOSystem in polar coordinates; the formula is wmrlib's compiled one, so that only the tool differs."""

    def update(t, state, inputs, params):
        pull, omega = pose_law(state[0], state[1], state[2], GAINS, CORRECTED)
        return polar_closing_rate(state[0], state[1], pull, omega)

    robot = control.nlsys(update, None, inputs=0, states=3, outputs=3)
    t = DT * np.arange(STEPS + 1)
    first = list(wmr.polar_error(START, GOAL))
    return lambda: control.input_output_response(robot, t, 0, first)


def scipy_alone():
    def rate(t, state):
        pull, omega = pose_law(state[0], state[1], state[2], GAINS, CORRECTED)
        return polar_closing_rate(state[0], state[1], pull, omega)

    t = DT * np.arange(STEPS + 1)
    first = list(wmr.polar_error(START, GOAL))
    return lambda: solve_ivp(rate, (0.0, t[-1]), first, t_eval=t)


def plain_python():
    """The Euler loop as one writes it by hand."""
    k_rho, k_alpha, h, v_max = GAINS

    def wrap(angle):
        return (angle + math.pi) % (2 * math.pi) - math.pi

    def run():
        x, y, heading = START
        path = []
        for _ in range(STEPS + 1):
            rho, sight = math.hypot(GOAL.x - x, GOAL.y - y), math.atan2(GOAL.y - y, GOAL.x - x)
            alpha, theta = wrap(sight - heading), wrap(sight - GOAL.heading)
            v = v_max * (1 - math.exp(-k_rho * rho)) * math.cos(alpha)
            shape = math.sin(alpha) / alpha if alpha else 1.0
            omega = k_alpha * alpha + v / rho * shape * (alpha + h * theta)
            path.append((x, y, heading, rho, alpha, theta, v, omega, 0.5 * (rho * rho + alpha * alpha + h * theta * theta)))
            x, y, heading = x + v * math.cos(heading) * DT, y + v * math.sin(heading) * DT, wrap(heading + omega * DT)
        return np.array(path)

    return run


def main():
    print(f"{platform.processor() or platform.machine()}, Python {platform.python_version()}, {os.cpu_count()} cores\n")
    duration = STEPS * DT
    rows = {
        f"simulate, {method}": lambda m=method: wmr.simulate(START, GOAL, GAINS, method=m, duration=duration) for method in ("euler", "arc")
    }
    rows["plain Python loop"] = plain_python()
    rows["scipy solve_ivp (RK45)"] = scipy_alone()
    rows["python-control input_output_response"] = python_control()
    rows["simulate, continuous (tolerance 1e-10)"] = lambda: wmr.simulate(START, GOAL, GAINS, method="continuous", duration=duration)
    seconds = {name: best(function) for name, function in rows.items()}
    base = seconds["simulate, arc"]
    print(f"one run of {STEPS} steps                          time        against arc")
    for name, value in seconds.items():
        print(f"  {name:40} {1e3 * value:9.4f} ms {value / base:10.1f}")

    case = "import wmrlib as w; w.simulate(w.Pose(0, 0, 0), w.Pose(9, 9, 1), w.Gains(2, 1, 0.3))"
    with tempfile.TemporaryDirectory() as cache:
        begin = {
            "import wmrlib": min(process("import wmrlib") for _ in range(3)),
            "import numba, for comparison": min(process("import numba") for _ in range(3)),
            "import and first simulate, nothing cached": process(case, NUMBA_CACHE_DIR=cache),
            "import and first simulate, cached": min(process(case, NUMBA_CACHE_DIR=cache) for _ in range(3)),
        }
    print("\nstarting, in a fresh process")
    for name, value in begin.items():
        print(f"  {name:42} {value:7.3f} s")

    k_alpha, h = np.meshgrid(np.linspace(0.2, 5.0, 50), np.linspace(0.0, 4.0, 50))
    grid = wmr.Gains(0.2, k_alpha, h)
    case = wmr.paper.outdoor()
    swept = best(lambda: wmr.sweep(case.start, case.goal, grid, duration=30.0), repeat=3)
    print(f"\nsweep of 50 x 50 gains, up to 300 steps each: {1e3 * swept:.0f} ms")


if __name__ == "__main__":
    started = time.perf_counter()
    main()
    print(f"\nmeasured in {time.perf_counter() - started:.0f} s")
