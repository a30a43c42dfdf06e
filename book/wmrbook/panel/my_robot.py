"""The panel of the page "My robot": two points and a data sheet go in, a robot's numbers come out.

It computes in the page, by `kit/sheet.js`; `wmrrobot.sheets` is its twin.
"""

from __future__ import annotations

from wmrbook.panel.kit import Panel
from wmrlib import EARTH_RADIUS_M, LastTurn, gains_for, longest_step
from wmrrobot import Rules, exports, sheets
from wmrrobot.sheets import BOUNDS, RECEIVERS, Robot

# What a reader fills in: the title of each group, and its fields, by their names for readers.
GROUPS = {
    "Two points": {
        "start_lat": "start, latitude",
        "start_lon": "start, longitude",
        "goal_lat": "goal, latitude",
        "goal_lon": "goal, longitude",
        "bearing": "faces at the goal, from north",
    },
    "The robot": {
        "track_width": "track width",
        "max_speed": "fastest wheel",
        "acceleration": "acceleration of a wheel",
        "dead_band": "dead band of a wheel",
        "period": "period of the loop",
        "delay": "delay of the pose",
    },
    "The receiver and the compass": {
        "sigma": "error of a position, sigma",
        "memory": "memory of that error",
        "fix_period": "time between fixes",
        "compass": "error of the compass, sigma",
    },
}
NUMBERS = ("spare", "brake", "nearest", "moves", "coarse", "margin", "far", "golden")
NUMBERS += ("compass", "runs", "seed", "share")


class MyRobot(Panel):
    """The panel; `robot` is what is filled in, to begin with the one that is given."""

    def __init__(self, robot: Robot | None = None):
        rules = {
            "bounds": BOUNDS,
            "shape": sheets.SHAPE,
            "step": longest_step(gains_for(1.0, **sheets.SHAPE)),
            "leave": LastTurn().leave,
            "usual": Rules()._asdict(),
            "earth": EARTH_RADIUS_M,
            "fresh": sheets.NEW,
        }
        rules |= {name: getattr(sheets, name.upper()) for name in NUMBERS}
        groups = [[title, [*fields.items()]] for title, fields in GROUPS.items()]
        setup = {"groups": groups, "receivers": [*RECEIVERS.items()], "rules": rules}
        state = {name: float(value) for name, value in (robot or Robot())._asdict().items()}
        super().__init__("my_robot", state, setup | {"files": exports.templates()})

    robot = property(lambda self: Robot(**self.state), doc="What is filled in now.")

    def __repr__(self) -> str:
        return f"MyRobot({self.robot})"
