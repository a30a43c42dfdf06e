"""The closed loop in polar coordinates, many runs at once: the compiled loops over time of a sweep.

The runs stand side by side in a block, so that the inner loop does one step of all of them and LLVM computes four or eight runs with
each instruction (see `_vecmath`). Whoever arrives gives its place to the next run. No step needs an arc tangent: the heading error is
theta - alpha.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from wmrlib import kinematics, laws
from wmrlib._compile import compiled, formula
from wmrlib._loops.rows import (
    ALPHA,
    ARRIVED,
    DIVERGED,
    HEADING,
    OMEGA,
    RHO,
    THETA,
    TIMED_OUT,
    V,
    X,
    Y,
)
from wmrlib._vecmath import vector_sincos, vectorised, widest_vectors
from wmrlib.gains import NO_LIMITS, GainsFields
from wmrlib.kinematics import polar_from_pose, wrap
from wmrlib.laws import saturation_scale

RK4, EULER = range(2)
BLOCK = 256  # runs side by side: a power of two whose block stays in the first-level cache
_ROUND = 16  # steps between two looks at who has finished
# The rows of a block. _LEFT counts the steps still to do; its sign turns in the step that would end the run.
_RHO, _ALPHA, _THETA, _LEFT, _PEAK, _LENGTH, _K_RHO, _K_ALPHA, _H, _V_MAX = range(10)
ROWS = 10

pose_law, polar_closing_rate = (
    vectorised(laws.pose_law),
    vectorised(kinematics.polar_closing_rate),
)


@formula
def closed_loop(rho, alpha, theta, gains, law, wheels):
    """(rho', alpha', theta', v, omega): equations (7)-(9) under one of the pose laws and the wheel limits."""
    v_over_rho, omega = pose_law(rho, alpha, theta, gains, law)
    share = saturation_scale(v_over_rho * rho, omega, wheels)
    rho_rate, alpha_rate, theta_rate = polar_closing_rate(rho, alpha, share * v_over_rho, share * omega)
    return rho_rate, alpha_rate, theta_rate, share * v_over_rho * rho, share * omega


@compiled
def lagging_loop(rho, alpha, theta, v, omega, gains, law, wheels, lag):
    """(rho', alpha', theta', v', omega') when the wheels, and so v and omega, follow the command as first-order systems."""
    _, _, _, v_wanted, omega_wanted = closed_loop(rho, alpha, theta, gains, law, wheels)
    rho_rate, alpha_rate, theta_rate = polar_closing_rate(rho, alpha, v / rho, omega)
    return rho_rate, alpha_rate, theta_rate, (v_wanted - v) / lag, (omega_wanted - omega) / lag


@formula
def euler_step(rho, alpha, theta, gains, law, wheels, dt):
    """(rho, alpha, theta, metres rolled, |omega| at the beginning) of one step along the tangent."""
    d_rho, d_alpha, d_theta, v, omega = closed_loop(rho, alpha, theta, gains, law, wheels)
    return rho + dt * d_rho, alpha + dt * d_alpha, theta + dt * d_theta, dt * abs(v), abs(omega)


@formula
def rk4_step(rho, alpha, theta, gains, law, wheels, dt):
    """The same by the classical Runge-Kutta method of order 4, the metres rolled included."""
    half, sixth = 0.5 * dt, dt / 6.0
    r1, a1, t1, v1, omega = closed_loop(rho, alpha, theta, gains, law, wheels)
    r2, a2, t2, v2, _ = closed_loop(
        rho + half * r1, alpha + half * a1, theta + half * t1, gains, law, wheels
    )
    r3, a3, t3, v3, _ = closed_loop(
        rho + half * r2, alpha + half * a2, theta + half * t2, gains, law, wheels
    )
    r4, a4, t4, v4, _ = closed_loop(
        rho + dt * r3, alpha + dt * a3, theta + dt * t3, gains, law, wheels
    )
    rho += sixth * (r1 + 2.0 * (r2 + r3) + r4)
    alpha += sixth * (a1 + 2.0 * (a2 + a3) + a4)
    theta += sixth * (t1 + 2.0 * (t2 + t3) + t4)
    return rho, alpha, theta, sixth * (abs(v1) + 2.0 * (abs(v2) + abs(v3)) + abs(v4)), abs(omega)


@compiled
def one_step(method, rho, alpha, theta, gains, law, wheels, dt):
    if method == RK4:
        return rk4_step(rho, alpha, theta, gains, law, wheels, dt)
    return euler_step(rho, alpha, theta, gains, law, wheels, dt)


@formula
def finite(rho, alpha, theta):
    total = rho + alpha + theta
    return total - total == 0.0


@formula
def advance(block, i, method, law, wheels, dt, arrival_radius):
    """One step of the run in place i, if it is still under way and neither arrives nor leaves the range of numbers in it."""
    rho, alpha, theta, left = block[_RHO, i], block[_ALPHA, i], block[_THETA, i], block[_LEFT, i]
    peak, length = block[_PEAK, i], block[_LENGTH, i]
    gains = GainsFields(block[_K_RHO, i], block[_K_ALPHA, i], block[_H, i], block[_V_MAX, i])
    if method == RK4:
        new_rho, new_alpha, new_theta, rolled, turning = rk4_step(
            rho, alpha, theta, gains, law, wheels, dt
        )
    else:
        new_rho, new_alpha, new_theta, rolled, turning = euler_step(
            rho, alpha, theta, gains, law, wheels, dt
        )
    going = left > 0.0
    taken = going & (new_rho > arrival_radius) & finite(new_rho, new_alpha, new_theta)
    block[_RHO, i] = new_rho if taken else rho
    block[_ALPHA, i] = new_alpha if taken else alpha
    block[_THETA, i] = new_theta if taken else theta
    block[_PEAK, i] = turning if taken & (turning > peak) else peak
    block[_LENGTH, i] = length + rolled if taken else length
    block[_LEFT, i] = left - 1.0 if taken else (-left if going else left)


@compiled
def last_step(method, rho, alpha, theta, gains, law, wheels, dt, arrival_radius):
    """How long the step must be that ends on the arrival radius: the root of rho - radius by the Illinois method; 0 <= it <= dt."""
    low, high, above = 0.0, dt, rho - arrival_radius
    below = one_step(method, rho, alpha, theta, gains, law, wheels, dt)[0] - arrival_radius
    tau = dt
    for _ in range(60):
        tau = (low * below - high * above) / (below - above)
        miss = one_step(method, rho, alpha, theta, gains, law, wheels, tau)[0] - arrival_radius
        if abs(miss) <= 1e-15 * rho:
            break
        if miss > 0.0:
            low, above, below = tau, miss, 0.5 * below
        else:
            high, below, above = tau, miss, 0.5 * above
    return tau


@compiled
def begin(runs, steps, arrival_radius, states):
    """The state of each run at its beginning, with the rows of a block; `runs` as in `_kernels.survey`."""
    for i in range(runs.shape[1]):
        rho, alpha, theta = polar_from_pose(
            runs[0, i], runs[1, i], runs[2, i], runs[3, i], runs[4, i], runs[5, i]
        )
        (
            states[_RHO, i],
            states[_ALPHA, i],
            states[_THETA, i],
            states[_PEAK, i],
            states[_LENGTH, i],
        ) = rho, alpha, theta, 0.0, 0.0
        states[_LEFT, i] = steps if rho > arrival_radius else -steps
        for k in range(4):
            states[_K_RHO + k, i] = runs[6 + k, i]


@lru_cache
def survey_of(method, law, limited):
    """The loop that takes every run to its last step, for one method and law, with or without wheel limits.

    Each is compiled by itself: asking for the law in every step would cost more than the step.
    """

    def survey(states, wheels, dt, arrival_radius):
        widest_vectors()
        limits = wheels if limited else NO_LIMITS
        runs = states.shape[1]
        block, inside = np.zeros((ROWS, BLOCK)), np.full(BLOCK, -1)
        waiting = busy = min(BLOCK, runs)
        for i in range(busy):
            inside[i] = i
            for row in range(ROWS):
                block[row, i] = states[row, i]
        while busy > 0:
            for _ in range(_ROUND):
                for i in range(
                    BLOCK
                ):  # the loop that LLVM vectorises; in a function of its own it would not know the law
                    advance(block, i, method, law, limits, dt, arrival_radius)
            for i in range(BLOCK):
                if inside[i] >= 0 and block[_LEFT, i] <= 0.0:
                    for row in range(ROWS):
                        states[row, inside[i]] = block[row, i]
                    inside[i] = waiting if waiting < runs else -1
                    if waiting < runs:
                        for row in range(ROWS):
                            block[row, i] = states[row, waiting]
                        waiting += 1
                    else:
                        busy -= 1

    return compiled(survey)


@compiled
def conclude(states, law, wheels, method, dt, steps, arrival_radius, summary):
    """What each run amounts to, as in `_kernels.survey`; the step in which it arrives is shortened so that it ends on the radius."""
    for i in range(states.shape[1]):
        rho, alpha, theta, left = (
            states[_RHO, i],
            states[_ALPHA, i],
            states[_THETA, i],
            states[_LEFT, i],
        )
        gains = GainsFields(
            states[_K_RHO, i], states[_K_ALPHA, i], states[_H, i], states[_V_MAX, i]
        )
        peak, length, time, outcome = (
            states[_PEAK, i],
            states[_LENGTH, i],
            (steps - abs(left)) * dt,
            TIMED_OUT,
        )
        new_rho, new_alpha, new_theta, _, turning = one_step(
            method, rho, alpha, theta, gains, law, wheels, dt
        )
        peak = max(peak, turning) if math.isfinite(turning) else peak
        if rho <= arrival_radius:
            outcome = ARRIVED
        elif left < 0.0:
            outcome = DIVERGED
            if finite(new_rho, new_alpha, new_theta):
                tau = last_step(method, rho, alpha, theta, gains, law, wheels, dt, arrival_radius)
                rho, alpha, theta, rolled, _ = one_step(
                    method, rho, alpha, theta, gains, law, wheels, tau
                )
                turning = one_step(method, rho, alpha, theta, gains, law, wheels, 0.0)[4]
                peak, length, time, outcome = (
                    max(peak, turning),
                    length + rolled,
                    time + tau,
                    ARRIVED,
                )
        summary[0, i], summary[1, i], summary[2, i] = outcome, time, wrap(theta - alpha)
        summary[3, i], summary[4, i], summary[5, i] = peak, length, rho


@compiled
def record(runs, law, wheels, method, dt, arrival_radius, samples):
    """Row by row (see `_kernels`) the same runs sample by sample, up to the last one before arrival; what follows stays as it was."""
    for run in range(runs.shape[1]):
        goal_x, goal_y, goal_heading = runs[3, run], runs[4, run], runs[5, run]
        gains = GainsFields(runs[6, run], runs[7, run], runs[8, run], runs[9, run])
        rho, alpha, theta = polar_from_pose(
            runs[0, run], runs[1, run], runs[2, run], goal_x, goal_y, goal_heading
        )
        for k in range(samples.shape[2]):
            _, _, _, v, omega = closed_loop(rho, alpha, theta, gains, law, wheels)
            sine, cosine = vector_sincos(theta + goal_heading)
            samples[X, run, k], samples[Y, run, k] = goal_x - rho * cosine, goal_y - rho * sine
            samples[HEADING, run, k] = wrap(theta - alpha + goal_heading)
            samples[RHO, run, k], samples[ALPHA, run, k], samples[THETA, run, k] = rho, alpha, theta
            samples[V, run, k], samples[OMEGA, run, k] = v, omega
            new_rho, new_alpha, new_theta, _, _ = one_step(
                method, rho, alpha, theta, gains, law, wheels, dt
            )
            if (
                rho <= arrival_radius
                or new_rho <= arrival_radius
                or not finite(new_rho, new_alpha, new_theta)
            ):
                break
            rho, alpha, theta = new_rho, new_alpha, new_theta
