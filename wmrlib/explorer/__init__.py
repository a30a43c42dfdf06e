"""The live panel: the robot under sliders, in a notebook, slides, or a page without a kernel."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from wmrlib import paper
from wmrlib._checks import book_extra, choice, instance, refusal, scalar
from wmrlib.gains import GENTLE_GAINS, Gains, KanayamaGains
from wmrlib.kinematics import Pose
from wmrlib.laws import LAWS
from wmrlib.runs import Trajectory
from wmrlib.simulation import simulate, track

with book_extra("wmrlib.explorer"):
    import ipywidgets as widgets

    from wmrlib.explorer import controls
    from wmrlib.explorer.controls import METHODS, SLIDERS, laws_for, widen
    from wmrlib.explorer.panel import Panel

VIEWS = ("time", "gains")
FEEDBACK = KanayamaGains(k_x=1.0, k_y=2.0, k_heading=2.0)
"""Well damped on the circle at every speed: k_heading/(2 sqrt(k_y)) = 0.71."""


def _tuned(name: str, kind: Any, says: str) -> property:
    return property(
        lambda self: kind(*(self.sliders[field].value for field in kind._fields)),
        lambda self, gains: self._set(_numbers(name, gains, kind)),
        doc=says,
    )


def _placed(name: str, says: str) -> property:
    return property(
        lambda self: Pose(*getattr(self.panel, name)),
        lambda self, pose: setattr(self.panel, name, _three(name, pose)),
        doc=says,
    )


class Explorer(widgets.VBox):
    """The robot on its way from `start` to `goal`, or after the paper's circle, under sliders.

    Everything but `trajectory` works without a kernel too.

    Parameters
    ----------
    start, goal, gains : Pose, Pose, Gains; by default the paper's.
    law : "corrected", "printed", "aicardi" or, if the goal moves, "kanayama".
    method : "arc" or "euler", see `simulate`.
    dt, duration, arrival_radius : float; s, s, m
    reference : None for a goal that stands still, "circle" (or `paper.circle`) for the moving one.
    feedback : KanayamaGains
    view : "time" or "gains", the gain landscape.

    Raises
    ------
    ValueError : for anything else.
    """

    def __init__(
        self,
        start: Pose | None = None,
        goal: Pose | None = None,
        gains: Gains | None = None,
        *,
        law: str = "corrected",
        method: str = "arc",
        dt: float = paper.TIME_STEP,
        duration: float = 60.0,
        arrival_radius: float = 0.05,
        reference=None,
        feedback: KanayamaGains = FEEDBACK,
        view: str = "time",
    ):
        moving = _moves(reference)
        outdoor = paper.outdoor()
        start = (paper.CIRCLE_START if moving else outdoor.start) if start is None else start
        gains = (paper.CIRCLE_GAINS if moving else outdoor.gains) if gains is None else gains
        place, duration = _place(law, moving), scalar("duration", duration, above=0.0)
        home = {
            "scenario": int(moving),
            "start": _three("start", start),
            "goal": _three("goal", outdoor.goal if goal is None else goal),
            **_numbers("gains", gains, Gains),
            **_numbers("feedback", feedback, KanayamaGains),
            "dt": _step(dt, duration),
            "pose_law": 0 if moving else place,
            "circle_law": place if moving else 0,
            "method": list(METHODS).index(choice("method", method, METHODS)),
        }
        self.panel = Panel(
            **home,
            **_displays(moving, place, choice("view", view, VIEWS) == "gains"),
            view=VIEWS.index(view),
            duration=duration,
            arrival_radius=scalar("arrival_radius", arrival_radius, low=0.0),
            home=home,
            presets=_presets(),
        )
        self.links: list = []
        self.sliders = {name: self._tied(name, controls.slider, "value") for name in SLIDERS}
        self.menus = {name: self._tied(name, controls.menu, "index") for name in controls.MENUS}
        box = widgets.Box([*self.sliders.values(), *self.menus.values()])
        box.add_class("wmr-controls")
        super().__init__([box, self.panel])
        self.add_class("wmr-explorer")

    @classmethod
    def circle(cls, **options) -> Explorer:
        """An Explorer of the paper's moving goal: a circle of 4 m radius, once round in 40 s."""
        return cls(reference="circle", **options)

    gains = _tuned("gains", Gains, "The gains that the sliders show; setting them moves these.")
    feedback = _tuned("feedback", KanayamaGains, "The same for the law with feed-forward.")
    start = _placed("start", "Where the robot starts; setting it moves its handle.")
    goal = _placed("goal", "The goal that stands still; setting it moves its handle.")

    dt = property(
        lambda self: self.sliders["dt"].value,
        lambda self, dt: self._set({"dt": _step(dt, self.panel.duration)}),
        doc="The time step, s, at most the duration; setting it moves the slider.",
    )

    @property
    def moving(self) -> bool:
        """Whether the goal is the paper's moving one."""
        return self.panel.scenario == 1

    @property
    def law(self) -> str:
        """The law in force, one that this goal allows; setting it moves the menu."""
        menu = self.menus["circle_law" if self.moving else "pose_law"]
        return laws_for(self.moving)[menu.index]["name"]

    @law.setter
    def law(self, law: str) -> None:
        place = _place(law, self.moving)
        trait = "circle_law" if self.moving else "pose_law"
        self.menus[trait].index = place
        setattr(self.panel, trait, place)

    def trajectory(self) -> Trajectory:
        """The run that the panel shows, by `wmrlib.simulate` or `wmrlib.track`."""
        method = list(METHODS)[self.menus["method"].index]
        how = {"law": self.law, "method": method, "dt": self.dt, "duration": self.panel.duration}
        if self.moving:
            gains = self.gains if LAWS[self.law].gains is Gains else self.feedback
            return track(paper.circle, self.start, gains, **how)
        radius = self.panel.arrival_radius
        return simulate(self.start, self.goal, self.gains, arrival_radius=radius, **how)

    def _set(self, values: dict[str, float]) -> None:
        # Both ends of the browser's link: there may be no browser yet, and neither may lag behind.
        for name, value in values.items():
            widen(self.sliders[name], value)
            self.sliders[name].value = value
            setattr(self.panel, name, value)

    def _tied(self, name: str, make: Callable, trait: str):
        control = make(name, getattr(self.panel, name))
        self.links.append(widgets.jslink((control, trait), (self.panel, name)))
        if display := controls.DISPLAYS.get(name):
            control.layout.display = getattr(self.panel, display)
            self.links.append(widgets.jslink((self.panel, display), (control.layout, "display")))
        return control


def _moves(reference) -> bool:
    moving = reference is paper.circle or (isinstance(reference, str) and reference == "circle")
    if moving or reference is None:
        return moving
    raise refusal("reference", reference, "None, 'circle' or wmrlib.paper.circle")


def _place(law: str, moving: bool) -> int:
    names = [each["name"] for each in laws_for(moving)]
    return names.index(choice("law", law, names))


def _step(dt: float, duration: float) -> float:
    return scalar("dt", dt, low=duration / 100_000, high=duration)


def _three(name: str, pose: Pose) -> list[float]:
    return list(_numbers(name, pose, Pose).values())


def _numbers(name: str, value, kind: type) -> dict[str, float]:
    fields = instance(name, value, kind)._asdict()
    return {f: scalar(f"{name}.{f}", each, low=-1e6, high=1e6) for f, each in fields.items()}


def _presets() -> list[dict]:
    outdoor = paper.outdoor()
    still, moving = {"scenario": 0, "pose_law": 0}, {"scenario": 1, "circle_law": 0}
    poses = {"start": _three("start", outdoor.start), "goal": _three("goal", outdoor.goal)}
    circle = {"start": _three("start", paper.CIRCLE_START), "dt": paper.TIME_STEP}
    return [
        still | poses | outdoor.gains._asdict() | {"dt": outdoor.dt},
        moving | circle | paper.CIRCLE_GAINS._asdict(),
        still | GENTLE_GAINS._asdict() | {"dt": paper.TIME_STEP},
    ]


def _displays(moving: bool, place: int, mapped: bool) -> dict[str, str]:
    # As displaysOf in settings.js, for the moment before it runs.
    gains = laws_for(moving)[place]["gains"]
    shown = {"gains": "k_rho" in gains, "limit": "v_max" in gains, "feedback": "k_x" in gains}
    shown |= {"pose_law": not moving, "circle_law": moving, "map": mapped}
    return {f"{name}_display": "flex" if on else "none" for name, on in shown.items()}
