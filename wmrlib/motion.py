"""How the robot moves and sees its goal, one number at a time; equations (3) to (9)."""

from __future__ import annotations

from wmrlib.compilation import formula
from wmrlib.elementary import TURN, direction, distance, sinc, sincos, whole, within, wrap


@formula
def polar_from_pose(x, y, heading, goal_x, goal_y, goal_heading):
    east, north = goal_x - x, goal_y - y
    sight = direction(north, east)
    return distance(east, north), wrap(sight - heading), wrap(sight - goal_heading)


@formula
def keep_branch(theta, before, hysteresis):
    """theta, on the branch that it had `before` until it is there over pi + hysteresis."""
    continued = theta + TURN * whole((before - theta) / TURN)
    return within(continued, 0.5 * TURN + hysteresis, theta)


@formula
def pose_of_error(rho, alpha, theta, goal_x, goal_y, goal_heading):
    """The inverse: the pose that sees its goal so."""
    sight = theta + goal_heading
    sine, cosine = sincos(sight)
    return goal_x - rho * cosine, goal_y - rho * sine, wrap(sight - alpha)


@formula
def polar_closing_rate(rho, alpha, v_over_rho, omega):
    """(7)-(9) with v/rho, so that nothing is divided by zero at the goal."""
    sin_alpha, cos_alpha = sincos(alpha)
    turning = v_over_rho * sin_alpha
    return -v_over_rho * rho * cos_alpha, turning - omega, turning


@formula
def euler_step(x, y, heading, v, omega, dt):
    sin_heading, cos_heading = sincos(heading)
    return x + v * cos_heading * dt, y + v * sin_heading * dt, wrap(heading + omega * dt)


@formula
def arc_step(x, y, heading, v, omega, dt):
    """The arc's chord points half the turn aside and is sinc(half the turn) times as long."""
    half_turn = 0.5 * omega * dt
    sin_chord, cos_chord = sincos(heading + half_turn)
    chord = v * dt * sinc(half_turn)
    return x + chord * cos_chord, y + chord * sin_chord, wrap(heading + 2.0 * half_turn)


@formula
def wheel_speeds(v, omega, track_width):
    """The inverse of (1) and (2)."""
    return v - omega * (track_width / 2.0), v + omega * (track_width / 2.0)


STEPS = {"euler": euler_step, "arc": arc_step}
"""How the robot moves while a twist is held, by name."""
