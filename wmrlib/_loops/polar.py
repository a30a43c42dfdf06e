"""The closed loop in polar coordinates, for runs side by side (see `_vecmath`).

No step needs an arc tangent: the heading error is theta - alpha. Throughout, `polar` is (rho,
alpha, theta) and `loop` is (gains, law, wheels), which closes the loop.
"""

from __future__ import annotations

from wmrlib import kinematics, laws
from wmrlib._compile import formula
from wmrlib._vecmath import vectorised
from wmrlib.laws import saturation_scale

pose_law = vectorised(laws.pose_law)
polar_closing_rate = vectorised(kinematics.polar_closing_rate)


@formula
def steered(polar, loop):
    """(v/rho, omega) under one of the pose laws and the wheel limits."""
    gains, law, wheels = loop
    v_over_rho, omega = pose_law(*polar, gains, law)
    share = saturation_scale(v_over_rho * polar[0], omega, wheels)
    return share * v_over_rho, share * omega


@formula
def closed_loop(polar, loop):
    """(rho', alpha', theta', v, omega): (7)-(9) under the law and the limits."""
    v_over_rho, omega = steered(polar, loop)
    rates = polar_closing_rate(polar[0], polar[1], v_over_rho, omega)
    return rates[0], rates[1], rates[2], v_over_rho * polar[0], omega
