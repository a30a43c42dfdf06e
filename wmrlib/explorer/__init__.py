"""The live panel: the paper's robot under sliders, in a notebook, an app, slides, or a page without a kernel."""

from __future__ import annotations

from wmrlib import paper
from wmrlib._checks import book_extra, choice, instance, scalar
from wmrlib.gains import GENTLE_GAINS, Gains, KanayamaGains
from wmrlib.kinematics import Pose
from wmrlib.runs import Trajectory
from wmrlib.simulation import simulate, track

with book_extra("wmrlib.explorer"):
    import ipywidgets as widgets

    from wmrlib.explorer.controls import DISPLAYS, MENUS, SLIDERS, menu, slider, widen
    from wmrlib.explorer.panel import Panel

POSE_LAWS = ("corrected", "printed", "aicardi")
CIRCLE_LAWS = (*POSE_LAWS, "kanayama")
METHODS = ("arc", "euler")
VIEWS = ("time", "gains")
FEEDBACK = KanayamaGains(k_x=1.0, k_y=2.0, k_heading=2.0)
"""Well damped on the circle at every speed: k_heading/(2 sqrt(k_y)) = 0.71."""


class Explorer(widgets.VBox):
    """The robot on its way from `start` to `goal` under sliders for its gains, or after the paper's circle.

    start, goal: Pose, the paper's outdoor pair by default; gains: Gains, the paper's by default. law: "corrected", "printed", "aicardi",
    and "kanayama" (with feed-forward) if the goal moves. method: "arc" or "euler", see `simulate`. dt, duration: s; arrival_radius: m.
    reference: None for a goal that stands still, "circle" (or `paper.circle`) for the paper's moving one. feedback: KanayamaGains.
    view: "time" or "gains", the landscape. Everything but `trajectory` works without a kernel too. Raises ValueError for anything else.
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
        chosen = choice("law", law, CIRCLE_LAWS if moving else POSE_LAWS)
        dt, duration = scalar("dt", dt, above=0.0), scalar("duration", duration, above=0.0)
        if not 0 < duration / dt <= 100_000 or dt > duration:
            raise ValueError(
                f"dt = {dt:g} is not allowed: from the duration/100000 to the duration, {duration:g}, is needed"
            )
        home = {
            "scenario": int(moving),
            "start": _three("start", start),
            "goal": _three("goal", outdoor.goal if goal is None else goal),
            **_numbers("gains", gains, Gains),
            **_numbers("feedback", feedback, KanayamaGains),
            "dt": dt,
            "pose_law": 0 if moving else POSE_LAWS.index(chosen),
            "circle_law": CIRCLE_LAWS.index(chosen) if moving else 0,
            "method": METHODS.index(choice("method", method, METHODS)),
        }
        self.panel = Panel(
            **home,
            **_displays(moving, chosen, choice("view", view, VIEWS) == "gains"),
            view=VIEWS.index(view),
            duration=duration,
            arrival_radius=scalar("arrival_radius", arrival_radius, low=0.0),
            home=home,
            presets=_presets(),
        )
        self.links = []
        self.sliders = {
            name: self._tied(name, slider(name, getattr(self.panel, name)), "value")
            for name in SLIDERS
        }
        self.menus = {
            name: self._tied(name, menu(name, getattr(self.panel, name)), "index") for name in MENUS
        }
        controls = widgets.Box([*self.sliders.values(), *self.menus.values()])
        controls.add_class("wmr-controls")
        super().__init__([controls, self.panel])
        self.add_class("wmr-explorer")

    @classmethod
    def circle(cls, **options) -> Explorer:
        """The paper's moving goal, on a circle of 4 m radius once round in 40 s; options as for Explorer."""
        return cls(reference="circle", **options)

    @property
    def gains(self) -> Gains:
        """The gains that the sliders show; setting them moves the sliders (and widens one whose range is too small)."""
        return Gains(*(self.sliders[name].value for name in Gains._fields))

    @gains.setter
    def gains(self, gains: Gains) -> None:
        self._set(_numbers("gains", gains, Gains))

    @property
    def feedback(self) -> KanayamaGains:
        """The gains of the law with feed-forward; setting them moves their sliders."""
        return KanayamaGains(*(self.sliders[name].value for name in KanayamaGains._fields))

    @feedback.setter
    def feedback(self, feedback: KanayamaGains) -> None:
        self._set(_numbers("feedback", feedback, KanayamaGains))

    @property
    def dt(self) -> float:
        """The time step, s; setting it moves the slider. Raises ValueError unless it is positive and at most the duration."""
        return self.sliders["dt"].value

    @dt.setter
    def dt(self, dt: float) -> None:
        self._set(
            {"dt": scalar("dt", dt, low=self.panel.duration / 100_000, high=self.panel.duration)}
        )

    @property
    def moving(self) -> bool:
        """Whether the goal is the paper's moving one."""
        return self.panel.scenario == 1

    @property
    def law(self) -> str:
        """The law in force; setting it moves the menu. Raises ValueError for one that this goal doesn't allow."""
        return CIRCLE_LAWS[self.menus["circle_law" if self.moving else "pose_law"].index]

    @law.setter
    def law(self, law: str) -> None:
        laws = CIRCLE_LAWS if self.moving else POSE_LAWS
        name = "circle_law" if self.moving else "pose_law"
        place = laws.index(choice("law", law, laws))
        self.menus[name].index = place
        setattr(self.panel, name, place)

    @property
    def start(self) -> Pose:
        """Where the robot starts; dragging its handle changes it, and setting it moves the handle."""
        return Pose(*self.panel.start)

    @start.setter
    def start(self, start: Pose) -> None:
        self.panel.start = _three("start", start)

    @property
    def goal(self) -> Pose:
        """The goal that stands still; dragging its handle changes it, and setting it moves the handle."""
        return Pose(*self.panel.goal)

    @goal.setter
    def goal(self, goal: Pose) -> None:
        self.panel.goal = _three("goal", goal)

    def trajectory(self) -> Trajectory:
        """The run that the panel shows, computed by `wmrlib.simulate`, or `wmrlib.track` if the goal moves."""
        how = {
            "law": self.law,
            "method": METHODS[self.menus["method"].index],
            "dt": self.dt,
            "duration": self.panel.duration,
        }
        if self.moving:
            return track(
                paper.circle,
                self.start,
                self.feedback if self.law == "kanayama" else self.gains,
                **how,
            )
        return simulate(
            self.start, self.goal, self.gains, arrival_radius=self.panel.arrival_radius, **how
        )

    def _set(self, values: dict[str, float]) -> None:
        # Both ends of the browser's link, for where there is no browser yet; they agree, so that neither overtakes the other.
        for name, value in values.items():
            widen(self.sliders[name], value)
            self.sliders[name].value = value
            setattr(self.panel, name, value)

    def _tied(self, name: str, control, trait: str):
        self._link((control, trait), (self.panel, name))
        if display := DISPLAYS.get(name):
            control.layout.display = getattr(self.panel, display)
            self._link((self.panel, display), (control.layout, "display"))
        return control

    def _link(self, source: tuple, target: tuple) -> None:
        self.links.append(widgets.jslink(source, target))


def _moves(reference) -> bool:
    if reference is None:
        return False
    if reference is paper.circle or (isinstance(reference, str) and reference == "circle"):
        return True
    raise ValueError(
        f"reference = {reference!r} is not allowed: None, 'circle' or wmrlib.paper.circle is needed"
    )


def _three(name: str, pose: Pose) -> list[float]:
    return [
        scalar(f"{name}.{field}", value, low=-1e6, high=1e6)
        for field, value in instance(name, pose, Pose)._asdict().items()
    ]


def _numbers(name: str, gains, kind: type) -> dict[str, float]:
    fields = instance(name, gains, kind)._asdict()
    return {field: scalar(f"{name}.{field}", value, high=1e6) for field, value in fields.items()}


def _presets() -> list[dict]:
    outdoor, circle_start = paper.outdoor(), _three("start", paper.CIRCLE_START)
    start, goal = _three("start", outdoor.start), _three("goal", outdoor.goal)
    return [
        {
            "scenario": 0,
            "start": start,
            "goal": goal,
            **outdoor.gains._asdict(),
            "dt": outdoor.dt,
            "pose_law": 0,
        },
        {
            "scenario": 1,
            "start": circle_start,
            **paper.CIRCLE_GAINS._asdict(),
            "dt": paper.TIME_STEP,
            "circle_law": 0,
        },
        {"scenario": 0, **GENTLE_GAINS._asdict(), "dt": paper.TIME_STEP, "pose_law": 0},
    ]


def _displays(moving: bool, law: str, mapped: bool) -> dict[str, str]:
    # As displaysOf in settings.js, for the moment before it runs.
    forward = law == "kanayama"
    shown = {"gains": not forward, "limit": not forward and law != "aicardi", "feedback": forward}
    shown |= {"pose_law": not moving, "circle_law": moving, "map": mapped}
    return {f"{name}_display": "flex" if on else "none" for name, on in shown.items()}
