"""The speeds of the wheels that a drive commands, by its state."""

from __future__ import annotations

from wmrlib.body import hurry, turn_rate
from wmrlib.compilation import formula
from wmrlib.laws import pose_law, saturation_scale
from wmrlib.motion import wheel_speeds
from wmrrobot.monitor import DRIVE, TURN


@formula
def commanded(m, rho, alpha, theta, gains, law, wheels, end):
    """The left and the right wheel's speed: by the law, or of the last turn, and else none."""
    v = omega = 0.0
    if m.state == DRIVE:
        v_over_rho, omega = pose_law(rho, alpha, theta, gains, law)
        more = hurry(v_over_rho * rho, alpha, wheels.min_speed)
        v, omega = v_over_rho * rho * more, omega * more
    elif m.state == TURN and abs(m.remaining_turn) > end.tolerance:
        omega = turn_rate(m.remaining_turn, end.gain, end.min_rate, end.max_rate)
    scale = saturation_scale(v, omega, wheels)
    return wheel_speeds(v * scale, omega * scale, wheels.track_width)
