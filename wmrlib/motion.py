"""The motion of the robot and its polar error, as formulas of numbers; equations (3) to (9)."""

from __future__ import annotations

from wmrlib.compilation import formula
from wmrlib.elementary import TURN, direction, distance, sinc, sincos, whole, within, wrap


@formula
def polar_from_pose(x, y, heading, goal_x, goal_y, goal_heading):
    """The polar error (rho, alpha, theta) of a pose; m and rad."""
    east, north = goal_x - x, goal_y - y
    sight = direction(north, east)
    return distance(east, north), wrap(sight - heading), wrap(sight - goal_heading)


@formula
def keep_branch(theta, before, hysteresis):
    """Theta on the branch of its last value, `before`, up to pi + hysteresis from 0; rad."""
    continued = theta + TURN * whole((before - theta) / TURN)
    return within(continued, 0.5 * TURN + hysteresis, theta)


@formula
def pose_of_error(rho, alpha, theta, goal_x, goal_y, goal_heading):
    """The pose (x, y, heading) with this polar error: the inverse of `polar_from_pose`."""
    sight = theta + goal_heading
    sine, cosine = sincos(sight)
    return goal_x - rho * cosine, goal_y - rho * sine, wrap(sight - alpha)


@formula
def polar_closing_rate(rho, alpha, v_over_rho, omega):
    """The rates (7) to (9) from v/rho [1/s], so that nothing is divided by zero at the goal."""
    sin_alpha, cos_alpha = sincos(alpha)
    turning = v_over_rho * sin_alpha
    return -v_over_rho * rho * cos_alpha, turning - omega, turning


@formula
def euler_step(x, y, heading, v, omega, dt):
    """The pose after Euler's step: dt seconds of a constant twist, along the tangent."""
    sin_heading, cos_heading = sincos(heading)
    return x + v * cos_heading * dt, y + v * sin_heading * dt, wrap(heading + omega * dt)


@formula
def arc_step(x, y, heading, v, omega, dt):
    """The pose after dt seconds of a constant twist: exactly, along the arc.

    The arc's chord is turned by half the turn, and is sinc(half the turn) times as long.
    """
    half_turn = 0.5 * omega * dt
    sin_chord, cos_chord = sincos(heading + half_turn)
    chord = v * dt * sinc(half_turn)
    return x + chord * cos_chord, y + chord * sin_chord, wrap(heading + 2.0 * half_turn)


@formula
def wheel_speeds(v, omega, track_width):
    """The ground speeds of the left and the right wheel, m/s: (1) and (2) solved for them."""
    return v - omega * (track_width / 2.0), v + omega * (track_width / 2.0)


STEPS = {"euler": euler_step, "arc": arc_step}
"""The two motions of a robot whose twist is held, by name."""
