"""The closed loop in polar coordinates, many runs at once: the compiled loops of a sweep.

The runs stand side by side in a block, so that the inner loop does one step of all of them and LLVM
computes four or eight with each instruction (see `_vecmath`). A run that arrives gives its place to
the next. No step needs an arc tangent: the heading error is theta - alpha. Throughout, `polar` is
(rho, alpha, theta) and `loop` is (gains, law, wheels), which closes the loop.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from wmrlib import kinematics, laws
from wmrlib._compile import compiled, formula
from wmrlib._loops import rows
from wmrlib._vecmath import vector_sincos, vectorised, widest_vectors
from wmrlib.gains import NO_LIMITS, GainsFields
from wmrlib.kinematics import polar_from_pose, wrap
from wmrlib.laws import saturation_scale

RK4, EULER = range(2)
BLOCK = 256  # runs side by side: a power of two whose block stays in the first-level cache
_ROUND = 16  # steps between two looks at who has finished
# The rows of a block. _LEFT counts the steps to do; its sign turns when the next would end the run.
_RHO, _ALPHA, _THETA, _LEFT, _PEAK, _LENGTH, _K_RHO, _K_ALPHA, _H, _V_MAX = range(10)
_ROWS = 10

pose_law = vectorised(laws.pose_law)
polar_closing_rate = vectorised(kinematics.polar_closing_rate)


@formula
def closed_loop(polar, loop):
    """(rho', alpha', theta', v, omega): (7)-(9) under one of the pose laws and the wheel limits."""
    rho, alpha, theta = polar
    gains, law, wheels = loop
    v_over_rho, omega = pose_law(rho, alpha, theta, gains, law)
    share = saturation_scale(v_over_rho * rho, omega, wheels)
    rho_rate, alpha_rate, theta_rate = polar_closing_rate(
        rho, alpha, share * v_over_rho, share * omega
    )
    return rho_rate, alpha_rate, theta_rate, share * v_over_rho * rho, share * omega


@compiled
def lagging_loop(polar, v, omega, loop, lag):
    """(rho', alpha', theta', v', omega') when v and omega lag behind the command."""
    _, _, _, v_wanted, omega_wanted = closed_loop(polar, loop)
    rho_rate, alpha_rate, theta_rate = polar_closing_rate(polar[0], polar[1], v / polar[0], omega)
    return rho_rate, alpha_rate, theta_rate, (v_wanted - v) / lag, (omega_wanted - omega) / lag


@formula
def moved(polar, rates, dt):
    return polar[0] + dt * rates[0], polar[1] + dt * rates[1], polar[2] + dt * rates[2]


@formula
def simpson(first, second, third, fourth):
    return first + 2.0 * (second + third) + fourth


@formula
def step_of(method, polar, loop, dt):
    """The state after a step, the metres rolled in it, and |omega| at its beginning."""
    r1, a1, t1, v1, omega = closed_loop(polar, loop)
    if method == EULER:
        return moved(polar, (r1, a1, t1), dt), dt * abs(v1), abs(omega)
    half, sixth = 0.5 * dt, dt / 6.0
    r2, a2, t2, v2, _ = closed_loop(moved(polar, (r1, a1, t1), half), loop)
    r3, a3, t3, v3, _ = closed_loop(moved(polar, (r2, a2, t2), half), loop)
    r4, a4, t4, v4, _ = closed_loop(moved(polar, (r3, a3, t3), dt), loop)
    rates = simpson(r1, r2, r3, r4), simpson(a1, a2, a3, a4), simpson(t1, t2, t3, t4)
    rolled = sixth * simpson(abs(v1), abs(v2), abs(v3), abs(v4))
    return moved(polar, rates, sixth), rolled, abs(omega)


@compiled
def one_step(method, polar, loop, dt):
    return step_of(method, polar, loop, dt)


@formula
def finite(polar):
    total = polar[0] + polar[1] + polar[2]
    return total - total == 0.0


@formula
def read(block, i):
    """The state of the run in place i, its counters and its gains."""
    polar = block[_RHO, i], block[_ALPHA, i], block[_THETA, i]
    gains = GainsFields(block[_K_RHO, i], block[_K_ALPHA, i], block[_H, i], block[_V_MAX, i])
    return polar, block[_LEFT, i], block[_PEAK, i], block[_LENGTH, i], gains


@formula
def advance(block, i, method, law, wheels, dt, arrival_radius):
    """One step of the run in place i, unless it is over, or would arrive or diverge in the step."""
    polar, left, peak, length, gains = read(block, i)
    new, rolled, turning = step_of(method, polar, (gains, law, wheels), dt)
    going = left > 0.0
    taken = going & (new[0] > arrival_radius) & finite(new)
    block[_RHO, i] = new[0] if taken else polar[0]
    block[_ALPHA, i] = new[1] if taken else polar[1]
    block[_THETA, i] = new[2] if taken else polar[2]
    block[_PEAK, i] = turning if taken & (turning > peak) else peak
    block[_LENGTH, i] = length + rolled if taken else length
    block[_LEFT, i] = left - 1.0 if taken else (-left if going else left)


@compiled
def last_step(method, polar, loop, dt, arrival_radius):
    """The length of the step that ends on the arrival radius, by the Illinois method."""
    low, high, above = 0.0, dt, polar[0] - arrival_radius
    below = one_step(method, polar, loop, dt)[0][0] - arrival_radius
    tau = dt
    for _ in range(60):
        tau = (low * below - high * above) / (below - above)
        miss = one_step(method, polar, loop, tau)[0][0] - arrival_radius
        if abs(miss) <= 1e-15 * polar[0]:
            break
        if miss > 0.0:
            low, above, below = tau, miss, 0.5 * below
        else:
            high, below, above = tau, miss, 0.5 * above
    return tau


@compiled
def begin(runs, steps, arrival_radius):
    """The state of each run at its beginning, with the rows of a block."""
    states = np.empty((_ROWS, runs.shape[1]))
    for i in range(runs.shape[1]):
        start, goal, gains = rows.run_of(runs, i)
        rho, alpha, theta = polar_from_pose(*start, *goal)
        states[_RHO, i], states[_ALPHA, i], states[_THETA, i] = rho, alpha, theta
        states[_LEFT, i] = steps if rho > arrival_radius else -steps
        states[_PEAK, i], states[_LENGTH, i] = 0.0, 0.0
        states[_K_RHO, i], states[_K_ALPHA, i], states[_H, i], states[_V_MAX, i] = gains
    return states


@lru_cache
def survey_of(method, law, limited):
    """The loop that takes every run to its last step, for one method and law.

    Each is compiled by itself: asking for the law in every step would cost more than the step.
    """

    def survey(states, wheels, dt, arrival_radius):
        widest_vectors()
        limits = wheels if limited else NO_LIMITS
        runs = states.shape[1]
        block, inside = np.zeros((_ROWS, BLOCK)), np.full(BLOCK, -1)  # -1: empty
        waiting = done = 0
        while True:
            for i in range(BLOCK):
                if inside[i] >= 0 and block[_LEFT, i] <= 0.0:
                    for row in range(_ROWS):
                        states[row, inside[i]] = block[row, i]
                    inside[i] = -1
                    done += 1
                if inside[i] < 0 and waiting < runs:
                    inside[i] = waiting
                    for row in range(_ROWS):
                        block[row, i] = states[row, waiting]
                    waiting += 1
            if done == runs:
                return
            for _ in range(_ROUND):
                # LLVM vectorises this loop; in a function of its own it would not know the law.
                for i in range(BLOCK):
                    advance(block, i, method, law, limits, dt, arrival_radius)

    return compiled(survey)


@compiled
def conclude(states, law, wheels, method, dt, steps, arrival_radius):
    """Sum up each run; the step in which it arrives is shortened to end on the radius."""
    summary = np.empty((rows.DISTANCE + 1, states.shape[1]))
    for i in range(states.shape[1]):
        polar, left, peak, length, gains = read(states, i)
        loop = gains, law, wheels
        outcome, time = rows.TIMED_OUT, (steps - abs(left)) * dt
        new, _, turning = one_step(method, polar, loop, dt)
        peak = max(peak, turning) if math.isfinite(turning) else peak
        if polar[0] <= arrival_radius:
            outcome = rows.ARRIVED
        elif left < 0.0 and not finite(new):
            outcome = rows.DIVERGED
        elif left < 0.0:
            outcome, tau = rows.ARRIVED, last_step(method, polar, loop, dt, arrival_radius)
            polar, rolled, _ = one_step(method, polar, loop, tau)
            peak = max(peak, one_step(method, polar, loop, 0.0)[2])
            time, length = time + tau, length + rolled
        error = wrap(polar[2] - polar[1])
        rows.summarise(summary, i, outcome, time, error, peak, length, polar[0])
    return summary


def survey(runs, law, wheels, method, dt, samples, arrival_radius):
    """Sum up many runs, as `plane.survey` does."""
    steps = float(samples - 1)
    states = begin(runs, steps, arrival_radius)
    survey_of(method, law, wheels.max_speed < math.inf)(states, wheels, dt, arrival_radius)
    return conclude(states, law, wheels, method, dt, steps, arrival_radius)


@compiled
def record(runs, law, wheels, method, dt, samples, arrival_radius):
    """The same runs sample by sample up to the last one before arrival, as `plane.record` does."""
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples), np.nan)
    for i in range(runs.shape[1]):
        start, goal, gains = rows.run_of(runs, i)
        polar, loop = polar_from_pose(*start, *goal), (gains, law, wheels)
        for k in range(samples):
            rho, alpha, theta = polar
            _, _, _, v, omega = closed_loop(polar, loop)
            sine, cosine = vector_sincos(theta + goal[2])
            records[rows.X, i, k] = goal[0] - rho * cosine
            records[rows.Y, i, k] = goal[1] - rho * sine
            records[rows.HEADING, i, k] = wrap(theta - alpha + goal[2])
            records[rows.RHO, i, k], records[rows.ALPHA, i, k] = rho, alpha
            records[rows.THETA, i, k] = theta
            records[rows.V, i, k], records[rows.OMEGA, i, k] = v, omega
            new = one_step(method, polar, loop, dt)[0]
            if rho <= arrival_radius or new[0] <= arrival_radius or not finite(new):
                break
            polar = new
    return records
