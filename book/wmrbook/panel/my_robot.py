"""The panel of the page "My robot": two points and a data sheet go in, a robot's numbers come out.

It computes in the page, by `kit/sheet.js`; `wmrrobot.sheets` is its twin.
"""

from __future__ import annotations

from wmrbook.panel.kit import Panel
from wmrlib import EARTH_RADIUS_M, LastTurn, gains_for, longest_step, receiver
from wmrrobot import Rules, exports, sheets, trials
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
        "quality": "least quality of a fix, by NMEA",
        "compass": "error of the compass, sigma",
        "antenna_ahead": "antenna, ahead of the wheels' middle",
        "antenna_left": "antenna, left of the middle",
    },
}
# By the number that NMEA has for it: what the certificate presumes of a fix.
QUALITIES = (
    "one of GPS or better",
    "a differential one (SBAS, DGPS) or better",
    "a PPS one or better",
    "RTK fixed",
    "RTK float or fixed",
)
NUMBERS = ("spare", "brake", "nearest", "moves", "coarse", "margin", "steady", "close", "leg")
NUMBERS += ("scatter", "side", "lag", "swing", "surest", "far", "golden", "runs", "seed", "share")


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
            "streams": {"compass": receiver.COMPASS, "scatter": trials.SCATTER},
        }
        rules |= {name: getattr(sheets, name.upper()) for name in NUMBERS}
        groups = [[title, [*fields.items()]] for title, fields in GROUPS.items()]
        setup = {"groups": groups, "receivers": [*RECEIVERS.items()], "qualities": QUALITIES}
        setup |= {"rules": rules}
        state = {name: float(value) for name, value in (robot or Robot())._asdict().items()}
        super().__init__("my_robot", state, setup | {"files": exports.templates()})

    robot = property(lambda self: Robot(**self.state), doc="What is filled in now.")

    def __repr__(self) -> str:
        return f"MyRobot({self.robot})"
