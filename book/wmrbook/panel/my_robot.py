"""The panel of the page "My robot": two points and a data sheet go in, a robot's numbers come out.

It computes in the page, by `kit/sheet.js`; `wmrbook.robot_sheet` is its twin.
"""

from __future__ import annotations

from wmrbook import robot_io, robot_sheet
from wmrbook.panel.kit import Panel
from wmrbook.robot_sheet import BOUNDS, RECEIVERS, Robot
from wmrlib import EARTH_RADIUS_M, LastTurn, Rules, gains_for, longest_step

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
            "shape": robot_sheet.SHAPE,
            "step": longest_step(gains_for(1.0, **robot_sheet.SHAPE)),
            "leave": LastTurn().leave,
            "usual": Rules()._asdict(),
            "earth": EARTH_RADIUS_M,
            "fresh": robot_sheet.NEW,
        }
        rules |= {name: getattr(robot_sheet, name.upper()) for name in NUMBERS}
        groups = [[title, [*fields.items()]] for title, fields in GROUPS.items()]
        setup = {"groups": groups, "receivers": [*RECEIVERS.items()], "rules": rules}
        state = {name: float(value) for name, value in (robot or Robot())._asdict().items()}
        super().__init__("my_robot", state, setup | {"files": robot_io.templates()})

    robot = property(lambda self: Robot(**self.state), doc="What is filled in now.")

    def __repr__(self) -> str:
        return f"MyRobot({self.robot})"
