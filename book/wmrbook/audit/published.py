"""The numbers that the paper prints, as data."""

from __future__ import annotations

import math
from typing import NamedTuple


class Published(NamedTuple):
    """A number that the paper prints: its value, its unit, and where it stands."""

    value: float
    unit: str
    place: str


PUBLISHED = {
    "earth_radius": Published(6371.0, "km", "section 2, below (11)"),
    "sphere_error": Published(0.5, "%", "section 2, above (11)"),
    "inner_loop": Published(10.0, "times faster", "section 3, below (26)"),
    "circle_period": Published(40.0, "s", "section 4"),
    "circle_radius": Published(4.0, "m", "section 4, x_r and y_r"),
    "circle_x_error": Published(1.0, "m", "section 4, Fig. 4"),
    "circle_y_error": Published(2.0, "m", "section 4, Fig. 4"),
    "circle_reference_heading": Published(math.pi / 2.0, "rad", "section 4"),
    "circle_start_heading": Published(0.0, "rad", "section 4"),
    "circle_k_rho": Published(1.9, "1/m", "section 4"),
    "circle_k_alpha": Published(1.0, "1/s", "section 4"),
    "circle_h": Published(0.05, "", "section 4"),
    "circle_residual": Published(0.1, "m", "section 4, Fig. 5"),
    "lqr_y_advantage": Published(0.52, "%", "section 1, of Cornejo et al. (2018)"),
    "lqr_x_advantage": Published(7.52, "%", "section 1, of Cornejo et al. (2018)"),
    "start_longitude": Published(44.373160, "deg", "section 4"),
    "start_latitude": Published(33.273572, "deg", "section 4"),
    "goal_longitude": Published(44.373264, "deg", "section 4"),
    "goal_latitude": Published(33.274087, "deg", "section 4"),
    "distance": Published(58.07, "m", "section 4"),
    "bearing": Published(9.4, "deg", "section 4"),
    "start_heading": Published(2.0 * math.pi / 5.0, "rad", "section 4"),
    "goal_heading": Published(-2.0 * math.pi / 6.0, "rad", "section 4"),
    "x_error_at_start": Published(57.0, "m", "section 4, Fig. 11"),
    "y_error_at_start": Published(8.0, "m", "section 4, Fig. 12"),
    "outdoor_k_rho": Published(2.0, "1/m", "section 4"),
    "outdoor_k_alpha": Published(1.0, "1/s", "section 4"),
    "outdoor_h": Published(0.3, "", "section 4"),
    "time_step": Published(0.1, "s", "section 4"),
    "speed_limit": Published(4.0, "m/s", "section 4, Fig. 9"),
}
"""Every number the paper prints of its own work, and two that it quotes, in order."""
