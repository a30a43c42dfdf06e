"""One run in continuous time by a method of others, and what a law commands for a moving goal."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

import wmrlib as wmr
from wmrlib import laws
from wmrlib.elementary import elementwise


def commanded(rho, alpha, theta, v_ref, omega_ref, gains, law):
    """The twist (v, omega) that any of the laws commands, as the compiled loops ask for it."""
    tuned = laws.tuning_of(gains, law, laws.TRACKING_LAWS)
    state = rho, alpha, theta, v_ref, omega_ref
    return elementwise(lambda *values: laws.command(*values, *tuned), *state)


def integrated(start, goal, gains, *, law, wheels, arrival_radius, duration, dt=0.1):
    """(arrived, time, heading error, peak omega, length, distance), whatever dt is.

    By scipy at a tolerance of 1e-12, with the laws written out once more.
    """
    k_rho, k_alpha, h, v_max = gains

    def twist(rho, alpha, theta):
        v, omega = wmr.control_law(np.maximum(rho, 0.0), alpha, theta, gains, law=law)
        return wmr.limit_wheels(v, omega, wheels) if wheels else (v, omega)

    def rates(_, state):
        rho, alpha, theta = max(state[0], 1e-300), state[1], state[2]
        sine, cosine = math.sin(alpha), math.cos(alpha)
        pull = k_rho if law == "aicardi" else -v_max * math.expm1(-k_rho * rho) / rho
        needed = pull * cosine * (sine / alpha if alpha else 1.0) * (alpha + h * theta)
        omega = k_alpha * alpha + needed * (cosine * sine if law == "printed" else 1.0)
        v, share = pull * rho * cosine, 1.0
        if wheels:
            fastest = abs(v) + 0.5 * abs(omega) * wheels.track_width
            share = min(1.0, wheels.max_speed / max(fastest, 1e-300))
        turning = share * pull * cosine * sine
        return [-share * v * cosine, turning - share * omega, turning, abs(share * v)]

    def there(_, state):
        return state[0] - arrival_radius

    there.terminal = True
    begin = [*wmr.polar_error(start, goal), 0.0]
    if begin[0] <= arrival_radius:
        peak = abs(float(twist(*begin[:3])[1]))
        return True, 0.0, wmr.wrap_angle(begin[2] - begin[1]), peak, 0.0, begin[0]
    options = {"events": there, "dense_output": True, "rtol": 1e-12, "atol": 1e-13}
    run = solve_ivp(rates, (0.0, duration), begin, "DOP853", **options)
    t = np.unique(np.concatenate([np.linspace(a, b, 200) for a, b in pairwise(run.t)]))
    for _ in range(3):  # the largest |omega|, closer and closer
        i = np.abs(twist(*run.sol(t)[:3])[1]).argmax()
        peak = np.abs(twist(*run.sol(t)[:3])[1])[i]
        t = np.linspace(t[max(i - 1, 0)], t[min(i + 1, t.size - 1)], 200)
    rho, alpha, theta, length = run.y[:, -1]
    time = run.t[-1] if run.status else math.inf
    return bool(run.status), time, wmr.wrap_angle(theta - alpha), peak, length, rho
