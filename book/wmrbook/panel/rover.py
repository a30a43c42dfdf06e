"""The panel of the page "A body with mass": a rover of MuJoCo beside the kinematic robot.

It is driven in the page, by `kit/rover.js`; book/robot/rover.py drives the same one.
"""

from __future__ import annotations

from wmrbook import rover_model
from wmrbook.panel.kit import Panel
from wmrbook.rover_model import PAGE_DRIVE, PAGE_GAINS

# name: (label, unit, lowest, highest, step)
SLIDERS = {
    "load": ("load", "kg", 2.0, 80.0, 2.0),
    "height": ("height of the load", "m", 0.1, 0.5, 0.02),
    "friction": ("grip (grass: 0.3)", "", 0.1, 1.2, 0.05),
    "slope_deg": ("slope", "°", 0.0, 20.0, 1.0),
    "downhill_deg": ("downhill, from east", "°", -180.0, 180.0, 15.0),
    "castor_deg": ("castor at the start", "°", 0.0, 175.0, 5.0),
    "k_rho": ("k_rho", "1/m", 0.1, 2.0, 0.1),
    "k_alpha": ("k_alpha", "1/s", 0.1, 6.0, 0.1),
    "h": ("h", "", 0.0, 5.0, 0.1),
    "v_max": ("v_max", "m/s", 0.5, 4.0, 0.1),
}


class Rover(Panel):
    """The panel; `state` is where its sliders are."""

    def __init__(self) -> None:
        start, goal = PAGE_DRIVE
        rover = rover_model.Rover()._asdict()
        state = {name: (rover | PAGE_GAINS._asdict())[name] for name in SLIDERS}
        setup = {
            "text": rover_model.TEXT,
            "rover": rover,
            "start": list(start),
            "goal": list(goal),
            "sliders": [[name, *row] for name, row in SLIDERS.items()],
            "period": rover_model.PERIOD,
            "radius": rover_model.WHEEL_RADIUS,
            "track": rover_model.TRACK_WIDTH,
            "fastest": rover_model.FASTEST,
            "gravity": rover_model.GRAVITY,
            "arrival": rover_model.ARRIVAL,
            "longest": rover_model.LONGEST,
        }
        super().__init__("rover", state, setup)
