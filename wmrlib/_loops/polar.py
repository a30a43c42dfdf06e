"""The closed loop in polar coordinates, and fixed steps of it.

Runs stand side by side in a block, so that the inner loop does one step of all of them and LLVM
computes four or eight with each instruction (see `_vecmath`). No step needs an arc tangent: the
heading error is theta - alpha. Throughout, `polar` is (rho, alpha, theta) and `loop` is (gains,
law, wheels), which closes the loop.
"""

from __future__ import annotations

from wmrlib import kinematics, laws
from wmrlib._compile import compiled, formula
from wmrlib._vecmath import vectorised
from wmrlib.gains import GainsFields
from wmrlib.laws import saturation_scale

RK4, EULER = range(2)
# The rows of a block. LEFT is the number of steps to go; its sign turns when the next step would
# end the run.
RHO, ALPHA, THETA, LEFT, PEAK, LENGTH, K_RHO, K_ALPHA, H, V_MAX, ROWS = range(11)

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
    polar = block[RHO, i], block[ALPHA, i], block[THETA, i]
    gains = GainsFields(block[K_RHO, i], block[K_ALPHA, i], block[H, i], block[V_MAX, i])
    return polar, block[LEFT, i], block[PEAK, i], block[LENGTH, i], gains


@formula
def advance(block, used, method, law, wheels, dt, arrival_radius):
    """One step of each run, unless it is over, or would arrive or diverge in the step."""
    for i in range(used):
        polar, left, peak, length, gains = read(block, i)
        new, rolled, turning = step_of(method, polar, (gains, law, wheels), dt)
        taken = (left > 0.0) & (new[0] > arrival_radius) & finite(new)
        block[RHO, i] = new[0] if taken else polar[0]
        block[ALPHA, i] = new[1] if taken else polar[1]
        block[THETA, i] = new[2] if taken else polar[2]
        block[PEAK, i] = turning if taken & (turning > peak) else peak
        block[LENGTH, i] = length + rolled if taken else length
        block[LEFT, i] = left - 1.0 if taken else -abs(left)


@compiled
def last_step(method, polar, loop, dt, arrival_radius):
    """The length of the step that ends on the arrival radius, by the Illinois method."""
    low, high, above = 0.0, dt, polar[0] - arrival_radius
    below = one_step(method, polar, loop, dt)[0][0] - arrival_radius
    tau = dt
    for _ in range(60):
        tau = (low * below - high * above) / (below - above)
        miss = one_step(method, polar, loop, tau)[0][0] - arrival_radius
        if abs(miss) <= 1e-14 * polar[0]:
            break
        if miss > 0.0:
            low, above, below = tau, miss, 0.5 * below
        else:
            high, below, above = tau, miss, 0.5 * above
    return tau
