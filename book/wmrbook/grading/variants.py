"""Numbers of a student's own, from a hash of the name: what is passed on fits nobody else.

The grader makes the same numbers from the same name. It says who handed in, and who else is in
the class, by the environment variables WMR_STUDENT and WMR_CLASS (names with commas between); where
it does not, nbgrader's folder autograded/NAME/ASSIGNMENT does.

Five tasks have numbers: drives to be tuned (0.3, 7.3, 8.3) and states to be found (4.4, 10.1). The
others ask for a formula or a function that is right for all numbers: there is nothing to vary.
"""

from __future__ import annotations

import cmath
import hashlib
import math
import os
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from random import Random
from typing import Any
from unicodedata import normalize

import numpy as np

from wmrbook.grading._asking import gains_of
from wmrbook.grading._hints import Hint, expect
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.metrics import arrival
from wmrlib.paper import outdoor
from wmrlib.runs import Arrival, Trajectory
from wmrlib.simulation import simulate
from wmrlib.sweeping import sweep


@dataclass(frozen=True)
class Window:
    """Where a student's own alpha has to lie, rad."""

    name: str
    low: float
    high: float

    def __repr__(self) -> str:
        return f"alpha is to be between {self.low:.3f} and {self.high:.3f} rad"

    def expect(self, alpha: float) -> None:
        """Raise Hint unless the angle lies there."""
        inside = self.low - 1e-9 <= alpha <= self.high + 1e-9
        expect(inside, f"alpha is {alpha:.4g} rad; with your numbers, {self}.")


@dataclass(frozen=True)
class Drive:
    """A student's own robot, drive and specification.

    It is the paper's outdoor drive turned, perhaps mirrored, and told in other units of length and
    time (`metre` and `second`), so that it is as hard as everybody else's.
    """

    name: str
    start: Pose
    goal: Pose
    metre: float
    second: float
    v_max: float  # m/s; of the slow robot's wheels
    time: float  # s; this and the next two are limits
    heading_deg: float
    omega: float  # rad/s
    dt: float | None = None  # s; without it the law acts all the time

    @property
    def arrival_radius(self) -> float:
        return 0.05 * self.metre

    @property
    def track_width(self) -> float:
        return 0.5 * self.metre

    def __repr__(self) -> str:
        places = (
            f"({each.x:.1f}, {each.y:.1f}) m, looking {math.degrees(each.heading):.0f} deg"
            for each in (self.start, self.goal)
        )
        radius = 100.0 * self.arrival_radius
        limits = f"{radius:.1f} cm, {self.heading_deg:g} deg, {self.time:.1f} s"
        robot = f"at most {self.v_max:.1f} m/s and {self.omega:.2f} rad/s"
        if self.dt:
            wheels = f"wheels {self.track_width:.2f} m apart that do {self.v_max:.1f} m/s"
            robot = f"sampled every {self.dt:.3f} s, {wheels}"
        return f"from {' to '.join(places)}: {limits}; {robot}"

    def broken(self, end: Arrival) -> list[str]:
        """Return the limits of time and heading that the drive does not keep."""
        off, broken = abs(math.degrees(end.heading_error)), []
        if end.time > self.time:
            broken = [f"it takes {end.time:.1f} s, where {self.time:.3g} s are allowed"]
        if off > (most := self.heading_deg):
            broken += [f"the heading is {off:.2f} deg off, where {most:.3g} deg are allowed"]
        return broken

    def gains(self, name: str, value: Any) -> Gains:
        """Return the value if it is gains that this robot can have, or raise Hint."""
        gains = gains_of(name, value)
        hint = f"v_max = {gains.v_max:g} m/s: your robot can do no more than {self.v_max:.1f} m/s."
        expect(gains.v_max <= self.v_max + 1e-9, hint)
        return gains

    def run(self, gains: Gains) -> tuple[Trajectory, Arrival]:
        """The drive with these gains."""
        how = {"dt": self.dt} if self.dt else {"method": "continuous"}
        limits = {"duration": 60.0 * self.second, "arrival_radius": self.arrival_radius}
        run = simulate(self.start, self.goal, gains, **how, **limits)
        return run, arrival(run)

    def elsewhere(self, gains: Gains, side: float, seconds: float, **options) -> Any:
        """Sweep over 20 starts round the goal and their mirror images.

        They look at most `side` rad beside the goal, and drive for so many of the drive's seconds.
        """
        low, high = (20.0, -math.pi, -side), (60.0, math.pi, side)
        far, way, beside = np.random.default_rng(7).uniform(low, high, (20, 3)).T
        x, y = -far * self.metre * np.array([np.cos(way), np.sin(way)])
        heading = way + beside
        starts = Pose(np.append(x, x), np.append(y, -y), np.append(heading, -heading))
        options |= {"duration": seconds * self.second, "arrival_radius": self.arrival_radius}
        return sweep(starts, Pose(0.0, 0.0, 0.0), gains, progress=False, **options)

    def parked(self, ends: Arrival, seconds: float) -> str:
        """Say how the other starts have ended; raise Hint unless they have parked in time."""
        late = np.sum(~ends.arrived)
        hint = f"of 40 other starts, {late} have not arrived after {seconds * self.second:.0f} s."
        expect(late == 0, hint)
        off, most = np.abs(np.degrees(ends.heading_error)), 2.0 * self.heading_deg
        hint = f"of 40 other starts, {np.sum(off > most)} end more than {most:g} deg off, "
        expect(off.max() <= most, f"{hint}the worst {off.max():.0f} deg.")
        starts = "40 other starts, 20 and their mirror images"
        return f"{starts}: all arrive, the worst {off.max():.1f} deg off"

    def rim(self, run: Any) -> np.ndarray:
        """The speed of the faster wheel."""
        return np.abs(run.v) + 0.5 * self.track_width * np.abs(run.omega)


def checked(
    make: Callable[[str], Any], *parts: Callable[[Any, Any], str]
) -> list[Callable[[Any, Any], str]]:
    """Return the checks of a task with numbers: its parts, which see first whose the answer is.

    A part takes the answer and the numbers that `make` makes of a name; of what a notebook hands
    over only the name counts. Raises Hint if the name is missing or another's, or if all parts
    hold with a classmate's numbers, and not with these.
    """

    def right(answer: Any, numbers: Any) -> bool:
        with suppress(Hint):
            return all(part(answer, numbers) for part in parts)
        return False

    def check(part: Callable[[Any, Any], str]) -> Callable[[Any, Any], str]:
        @wraps(part)
        def whole(answer: Any, mine: Any) -> str:
            (student, others), mine = _class(), make(getattr(mine, "name", ""))
            expect(bool(mine.name), "your name is missing at the top: it makes your numbers.")
            hint = f"`name` is '{mine.name}', but '{student}' handed this in, who has others."
            expect(student in ("", mine.name), hint)
            if not right(answer, mine):
                for name in others:
                    hint = f"this is right with the numbers of {name}, and not with yours."
                    expect(not right(answer, make(name)), hint)
            return part(answer, mine)

        return whole

    return [check(part) for part in parts]


def home(name: str) -> Drive:
    """The way back of task 0.3."""
    return _drive(home, name, back=True, v_max=4.0, time=22.0, heading_deg=5.0, omega=1.6)


def tuned(name: str) -> Drive:
    """The drive of task 6.3."""
    return _drive(tuned, name, v_max=4.0, time=19.0, heading_deg=2.0, omega=1.0)


def slow(name: str) -> Drive:
    """The drive of task 8.3; its v_max is that of the wheels."""
    return _drive(slow, name, v_max=2.0, time=42.0, heading_deg=3.0, omega=math.inf, dt=0.25)


def right(name: str) -> Window:
    """The angle of task 4.4, with the goal on the right."""
    return _window(right, name, -1.1, -0.6)


def left(name: str) -> Window:
    """The angle of task 10.1, with the goal on the left."""
    return _window(left, name, 0.3, 0.8)


def _window(make: Callable[[str], Window], name: str, low: float, high: float) -> Window:
    name, random = _drawn(make, name)
    start = round(random.uniform(low, high - 0.01), 3)
    return Window(name, start, round(start + 0.01, 3))


def _drive(make: Callable, name: str, *, back: bool = False, dt: float = 0.0, **paper) -> Drive:
    name, random = _drawn(make, name)
    metre = round(math.exp(random.uniform(-0.5, 0.5)), 2)
    v_max = round(paper["v_max"] * metre * math.exp(random.uniform(-0.5, 0.5)), 1)
    second = paper["v_max"] * metre / v_max
    side, turn = math.copysign(1.0, random.random() - 0.5), random.uniform(-math.pi, math.pi)
    case, poses = outdoor(), []
    for pose in (case.goal, case.start) if back else (case.start, case.goal):
        place = metre * complex(pose.x, side * pose.y) * cmath.exp(1j * turn)
        heading = wrap_angle(side * pose.heading + turn)
        poses.append(Pose(place.real + 0.0, place.imag + 0.0, heading))
    time, omega = math.ceil(10.0 * paper["time"] * second) / 10.0, paper["omega"] / second
    omega = math.ceil(100.0 * omega) / 100.0 if omega < math.inf else omega
    limits = (v_max, time, paper["heading_deg"], omega, dt * second or None)
    return Drive(name, *poses, metre, second, *limits)


def _drawn(make: Callable, name: str) -> tuple[str, Random]:
    """The name that counts, and what is drawn from it, for each task other numbers.

    By Python's own generator, which the book's pages have too.
    """
    expect(isinstance(name, str), f"`name` is {name!r}; a text is needed, in quotation marks.")
    name = _plain(name) or _class()[0]
    seed = hashlib.sha256(f"{make.__name__} {name}".encode()).digest()
    return name, Random(int.from_bytes(seed, "big"))


def _class() -> tuple[str, list[str]]:
    """Who handed in, and all who did, as far as the grader tells; '' and [] if nobody does."""
    folder, others = Path.cwd().parent, os.environ.get("WMR_CLASS", "").split(",")
    student = os.environ.get("WMR_STUDENT", "")
    if not student and folder.parent.name == "autograded":
        student, others = folder.name, [each.name for each in folder.parent.iterdir()]
    return _plain(student), sorted(filter(None, map(_plain, others)))


def _plain(name: str) -> str:
    return normalize("NFC", name).strip().casefold()
