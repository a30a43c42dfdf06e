"""One run of 300 steps: wmrlib against python-control, scipy and loops written by hand."""

from __future__ import annotations

import math

import control
import numpy as np
from scipy.integrate import solve_ivp
from timing import Row, in_turn

import wmrlib as wmr
from wmrlib.laws import POSE_LAWS, pose_law
from wmrlib.motion import polar_closing_rate

STEPS, DT = 300, 0.1
TIMES = DT * np.arange(STEPS + 1)
START, GOAL, GAINS, _ = wmr.paper.outdoor()
NEVER = {"duration": STEPS * DT, "arrival_radius": 0.0}  # all steps are taken


def rate(t, state, *_):
    """The closed loop with wmrlib's formula, so that only the tool differs."""
    v_over_rho, omega = pose_law(state[0], state[1], state[2], GAINS, POSE_LAWS["corrected"])
    return polar_closing_rate(state[0], state[1], v_over_rho, omega)


def python_control():
    robot = control.nlsys(rate, None, inputs=0, states=3, outputs=3)
    first = list(wmr.polar_error(START, GOAL))
    return lambda: control.input_output_response(robot, TIMES, 0, first)


def scipy_alone():
    first = list(wmr.polar_error(START, GOAL))
    return lambda: solve_ivp(rate, (0.0, TIMES[-1]), first, t_eval=TIMES)


def loop_of(module):
    """The Euler loop as one writes it by hand, with the sines of `math` or of numpy."""
    k_rho, k_alpha, h, v_max = GAINS
    sin, cos, exp, hypot, atan2 = module.sin, module.cos, module.exp, module.hypot, module.atan2

    def wrap(angle):
        return (angle + math.pi) % (2 * math.pi) - math.pi

    def run():
        x, y, heading = START
        path = []
        for _ in range(STEPS + 1):
            rho, sight = hypot(GOAL.x - x, GOAL.y - y), atan2(GOAL.y - y, GOAL.x - x)
            alpha, theta = wrap(sight - heading), wrap(sight - GOAL.heading)
            v = v_max * (1 - exp(-k_rho * rho)) * cos(alpha)
            shape = sin(alpha) / alpha if alpha else 1.0
            v_over_rho = v / rho if rho else v_max * k_rho * cos(alpha)
            omega = k_alpha * alpha + v_over_rho * shape * (alpha + h * theta)
            value = 0.5 * (rho * rho + alpha * alpha + h * theta * theta)
            path.append((x, y, heading, rho, alpha, theta, v, omega, value))
            x, y = x + v * cos(heading) * DT, y + v * sin(heading) * DT
            heading = wrap(heading + omega * DT)
        return np.array(path)

    return run


def rows() -> list[Row]:
    cases = {
        f"simulate, {method}": lambda m=method: wmr.simulate(START, GOAL, GAINS, method=m, **NEVER)
        for method in ("arc", "euler")
    }
    cases["a loop in plain Python"] = loop_of(math)
    cases["a loop over numpy scalars"] = loop_of(np)
    cases["scipy solve_ivp (RK45)"] = scipy_alone()
    cases["python-control input_output_response"] = python_control()
    for name, end in (("", NEVER), (", to arrival within 5 cm", {})):
        options = {"method": "continuous"} | end
        title = f"simulate, continuous (tolerance 1e-10){name}"
        cases[title] = lambda options=options: wmr.simulate(START, GOAL, GAINS, **options)
    seconds = in_turn(cases)
    section, one = "One run of 300 steps, against simulate", seconds["simulate, arc"]
    return [Row(section, name, 1e3 * s, "ms", s / one) for name, s in seconds.items()]
