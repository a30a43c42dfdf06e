"""A rover with mass: two driven wheels, a castor, motors with friction, and a slope.

`rover_model.xml` is its text for MuJoCo. The page fills in the same text, in `kit/rover.js`.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, NamedTuple

from wmrlib import GENTLE_GAINS, Pose
from wmrlib.checks import instance, scalar

TEXT = Path(__file__).with_suffix(".xml").read_text(encoding="utf-8")
STORED = Path(__file__).with_name("rover.json")
TRACK_WIDTH, WHEEL_RADIUS = 0.5, 0.1  # m, as in the text
FASTEST = 5.0  # m/s, of a wheel
PERIOD = 0.05  # s, of the law
ARRIVAL, LONGEST = 0.05, 90.0  # m and s, of a drive
GRAVITY = 9.81  # m/s^2
PAGE_DRIVE = Pose(0.0, 0.0, math.radians(72.0)), Pose(6.0, 9.0, math.radians(-60.0))
PAGE_GAINS = GENTLE_GAINS._replace(k_rho=0.4, v_max=2.0)
DRY, WET_GRASS = 0.8, 0.3  # friction of rubber on concrete, and on wet grass


class Rover(NamedTuple):
    """What can be varied.

    Parameters
    ----------
    load : float, kg, of a box 0.5 m long whose centre is 0.1 m behind the axle
    height : float, m, of that centre above the ground
    friction : float, of the wheels on the ground
    slope_deg, downhill_deg : float, degrees; the slope, and where it leads down, from east
    castor_deg : float, degrees; 0 trails as after driving ahead, 180 as after backing up
    dry : float, N m, friction in each motor, whose dead band is WHEEL_RADIUS dry/servo
    servo, torque : float, N m s and N m; a motor's torque is servo times what its wheel lacks in
        rad/s, and no larger than `torque`
    acceleration : float, m/s^2; v grows no faster, and omega is obeyed at once. Motors at
        their limit can't steer, and a mass behind the axle then turns the rover round.
    wheel : float, kg, of each driven wheel
    timestep : float, s, of MuJoCo
    """

    load: float = 18.0
    height: float = 0.2
    friction: float = DRY
    slope_deg: float = 0.0
    downhill_deg: float = 0.0
    castor_deg: float = 0.0
    dry: float = 0.5
    servo: float = 5.0
    torque: float = 6.0
    acceleration: float = 1.5
    wheel: float = 0.8
    timestep: float = 0.002


LIMITS: dict[str, tuple[float, float]] = {
    "load": (0.01, 200.0),
    "height": (0.08, 1.0),
    "friction": (0.05, 100.0),
    "slope_deg": (0.0, 30.0),
    "downhill_deg": (-360.0, 360.0),
    "castor_deg": (-180.0, 180.0),
    "dry": (0.0, 5.0),
    "servo": (0.1, 1000.0),
    "torque": (0.1, 1000.0),
    "acceleration": (0.1, 1000.0),
    "wheel": (0.001, 20.0),
    "timestep": (0.0001, 0.005),
}


def stored() -> dict[str, Any]:
    """What book/robot/rover.py has measured: it writes the file that is read here."""
    return json.loads(STORED.read_text(encoding="utf-8"))


def mjcf(rover: Rover = Rover()) -> str:  # noqa: B008
    """The rover as MuJoCo reads it; ValueError names a field that is out of its `LIMITS`."""
    fields = instance("rover", rover, Rover)._asdict()
    for name, (low, high) in LIMITS.items():
        scalar(f"rover.{name}", fields[name], low=low, high=high)
    slope, downhill = math.radians(rover.slope_deg), math.radians(rover.downhill_deg)
    flat = math.sin(slope) * math.cos(downhill), math.sin(slope) * math.sin(downhill)
    down = " ".join(f"{GRAVITY * share!r}" for share in (*flat, -math.cos(slope)))
    return TEXT.format(down=down, **fields)
