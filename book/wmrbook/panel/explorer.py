"""The Explorer: the robot under sliders, in a notebook, slides, or a page without a kernel."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import traitlets

from wmrbook.panel.controls import FOLDED, MENUS, METHODS, PANEL_LAWS, SLIDERS, VIEWS, laws_for
from wmrbook.panel.derived import Derived, State, refusing
from wmrbook.panel.kit import Panel
from wmrlib import paper
from wmrlib.body import Wheels, checked_wheels
from wmrlib.checks import choice, instance, refusal, scalar
from wmrlib.gains import GENTLE_GAINS, Gains, KanayamaGains
from wmrlib.kinematics import Pose
from wmrlib.laws import LAWS
from wmrlib.runs import Trajectory
from wmrlib.simulation import simulate, track

FEEDBACK = KanayamaGains(k_x=1.0, k_y=2.0, k_heading=2.0)
"""Well damped on the circle at every speed: k_heading/(2 sqrt(k_y)) = 0.71."""


def _tuned(kind: Any, says: str) -> Derived:
    return Derived(
        lambda state: kind(*(state[field] for field in kind._fields)),
        lambda name, gains, _: _numbers(name, gains, kind),
        says,
    )


def _gain(name: str) -> Derived:
    """One of the gains. It is synced, so that `jslink` and `jsdlink` take it."""
    label, tip, *_ = SLIDERS[name]

    def written(_, value: float, __) -> dict[str, float]:
        Gains(**{**GENTLE_GAINS._asdict(), name: value})  # raises for a negative one, for example
        return {name: scalar(name, value, high=1e6)}

    unit = label.partition("[")[2].rstrip("]")
    says = f"{tip.capitalize()} ({unit}); setting it moves the slider."
    return Derived(lambda state: float(state[name]), written, says).tag(sync=True)


def _placed(name: str, says: str) -> Derived:
    return Derived(
        lambda state: Pose(*state[name]), lambda name, pose, _: {name: _three(name, pose)}, says
    )


def _menu(name: str) -> Derived:
    _, tip, choices = MENUS[name]
    return Derived(
        lambda state: state[name],
        lambda name, value, _: {name: choice(name, value, choices)},
        f"{tip.capitalize()}; setting it moves the menu.",
    )


class Explorer(Panel):
    """The robot on its way from `start` to `goal`, or after the paper's circle, under sliders.

    Everything but `trajectory` works without a kernel too. All that can be set is a trait and
    follows the panel: `observe` it, or `link` it with a widget of your own; k_rho, k_alpha, h and
    v_max also by `jslink`.

    Parameters
    ----------
    start, goal, gains : Pose, Pose, Gains; by default the paper's.
    law : a law of `simulate` or, if the goal moves, "kanayama" too.
    method : "arc", "euler" or "continuous", see `simulate`.
    dt, duration, arrival_radius : float; s, s, m
    reference : None for a goal that stands still, "circle" (or `paper.circle`) for the moving one.
    feedback : KanayamaGains
    view : "time" or "gains", the gain landscape.
    at : float or None, s: where on the run the panel opens; by default at 30 % of it.
    wheels : Wheels with a track width, an acceleration, a lag and a dead band; by default ideal
        ones. Continuous motion knows none.
    zoom : float or None, m round the goal that the picture opens on; by default the whole path.

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
        at: float | None = None,
        zoom: float | None = None,
        wheels: Wheels = Wheels(0.5),  # noqa: B008 (it can't change)
    ):
        moving = _moves(reference)
        outdoor = paper.outdoor()
        start = (paper.CIRCLE_START if moving else outdoor.start) if start is None else start
        gains = (paper.CIRCLE_GAINS if moving else outdoor.gains) if gains is None else gains
        duration = scalar("duration", duration, above=0.0)
        home: dict[str, Any] = {
            "moving": moving,
            "start": _three("start", start),
            "goal": _three("goal", outdoor.goal if goal is None else goal),
            **_numbers("gains", gains, Gains),
            **_numbers("feedback", feedback, KanayamaGains),
            "dt": _step(dt, duration),
            "duration": duration,
            "arrival_radius": scalar("arrival_radius", arrival_radius, low=0.0),
            "law": choice("law", law, laws_for(moving)),
            "method": choice("method", method, METHODS),
            "view": choice("view", view, VIEWS),
            "metric": "headingError",
            "axes": "k_alpha",
            "time": None if at is None else scalar("at", at, low=0.0),
            "zoom": None,
            **_rolling(wheels),
        }
        if zoom is not None:
            middle = paper.circle(at or 0.0)[:2] if moving else home["goal"][:2]
            home["zoom"] = [*map(float, middle), scalar("zoom", zoom, low=0.005, high=1e6)]
        # Lists, for a stored notebook keeps the order of no mapping.
        menus = [(name, *row, [*choices.items()]) for name, (*row, choices) in MENUS.items()]
        sliders = [(name, *row) for name, row in SLIDERS.items()]
        setup = {"home": home, "presets": _presets(), "laws": PANEL_LAWS}
        setup |= {"sliders": sliders, "menus": menus, "folded": [*FOLDED.items()]}
        self._announced: dict[str, Any] = {}
        super().__init__("explorer", home, setup)

    def __repr__(self) -> str:
        return f"Explorer(law={self.law!r}, method={self.method!r})"

    @classmethod
    def circle(cls, **options) -> Explorer:
        """An Explorer of the paper's moving goal: a circle of 4 m radius, once round in 40 s."""
        return cls(reference="circle", **options)

    state = State().tag(sync=True)

    @traitlets.validate("state")
    def _checked(self, proposal: dict[str, Any]) -> dict[str, Any]:
        """What a page, or a cell, sets: of the kinds that the panel was made with."""
        state, home = proposal["value"], self.setup["home"]
        with refusing():
            if state.keys() != home.keys():
                raise refusal("state", state, f"a dict of {', '.join(home)}")
            for name, usual in home.items():
                _check_kind(name, state[name], usual, laws_for(state["moving"] is True))
            for name, trait in self._derived().items():
                value = trait.read(state)
                if trait.written and value is not None:  # the checks of a cell are a page's too
                    trait.written(name, value, state)
        return state

    @traitlets.observe("state")
    def _announce(self, _) -> None:
        """Notify of the traits whose values have changed, once, even if an observer sets one."""
        for name, trait in self._derived().items():
            before, now = self._announced.get(name), trait.read(self.state)
            if now != before:
                self._announced[name] = now
                self._notify_trait(name, before, now)

    gains = _tuned(Gains, "The gains that the sliders show; setting them moves these.")
    k_rho, k_alpha, h, v_max = map(_gain, Gains._fields)
    feedback = _tuned(KanayamaGains, "The same for the law with feed-forward.")
    start = _placed("start", "Where the robot starts; setting it moves its handle.")
    goal = _placed("goal", "The goal that stands still; setting it moves its handle.")
    wheels = Derived(
        lambda state: _rolled(state),
        lambda _, wheels, __: _rolling(wheels),
        "The wheels that the sliders show, None if they are ideal or the motion continuous.",
    )
    dt = Derived(
        lambda state: state["dt"],
        lambda _, dt, state: {"dt": _step(dt, state["duration"])},
        "The time step, s, at most the duration; setting it moves the slider.",
    )
    duration = Derived(
        lambda state: state["duration"],
        lambda _, duration, state: _lasting(duration, state["dt"]),
        "The longest time of a run, s, at least dt and at most 100,000 dt.",
    )
    arrival_radius = Derived(
        lambda state: state["arrival_radius"],
        lambda name, radius, _: {name: scalar(name, radius, low=0.0)},
        "How near the goal the robot stops, m; setting it moves the slider.",
    )
    law = Derived(
        lambda state: state["law"],
        lambda _, law, state: {"law": choice("law", law, laws_for(state["moving"]))},
        "The law in force, one that this goal allows; setting it moves the menu.",
    )
    method, view, metric, axes = map(_menu, ("method", "view", "metric", "axes"))
    moving = Derived(lambda state: state["moving"], says="Whether the goal is the circle's.")

    def trajectory(self) -> Trajectory:
        """The run that the panel shows, by `wmrlib.simulate` or `wmrlib.track`."""
        options = {name: getattr(self, name) for name in ("law", "method", "dt", "duration")}
        options["wheels"] = self.wheels
        if self.moving:
            gains = self.gains if LAWS[self.law].gains is Gains else self.feedback
            return track(paper.circle, self.start, gains, **options)
        options["arrival_radius"] = self.arrival_radius
        return simulate(self.start, self.goal, self.gains, **options)


def _check_kind(name: str, value: Any, usual: Any, laws: list[str]) -> None:
    named = f"state[{name!r}]"
    if name in MENUS:
        choice(named, value, laws if name == "law" else MENUS[name][2])
    elif isinstance(usual, bool):
        if not isinstance(value, bool):
            raise refusal(named, value, "True or False")
    elif name in ("start", "goal", "zoom"):
        if isinstance(value, list | tuple) and len(value) == 3:
            for number in value:
                scalar(named, number)
        elif value is not None or name != "zoom":
            raise refusal(named, value, "a list of three numbers" + " or None" * (name == "zoom"))
    elif value is not None or name != "time":
        scalar(named, value)


def _moves(reference) -> bool:
    moving = reference is paper.circle or (isinstance(reference, str) and reference == "circle")
    if moving or reference is None:
        return moving
    raise refusal("reference", reference, "None, 'circle' or wmrlib.paper.circle")


def _step(dt: float, duration: float) -> float:
    return scalar("dt", dt, low=duration / 100_000, high=duration)


def _lasting(duration: float, dt: float) -> dict[str, float]:
    return {"duration": scalar("duration", duration, low=dt, high=100_000 * dt)}


def _three(name: str, pose: Pose) -> list[float]:
    return list(_numbers(name, pose, Pose).values())


def _numbers(name: str, value, kind: type) -> dict[str, float]:
    fields = instance(name, value, kind)._asdict()
    return {f: scalar(f"{name}.{f}", number, low=-1e6, high=1e6) for f, number in fields.items()}


def _rolling(wheels: Wheels) -> dict[str, float]:
    """The wheels as sliders have them, where an acceleration of 0 stands for any."""
    given = checked_wheels(instance("wheels", wheels, Wheels))
    fields = {name: getattr(given, name) for name in FOLDED["Wheels"]}
    if given != Wheels(**fields):
        raise refusal("wheels", wheels, f"nothing but {', '.join(fields)}")
    return fields | {"acceleration": 0.0 if given.acceleration == math.inf else given.acceleration}


def _rolled(state: Mapping[str, Any]) -> Wheels | None:
    width, most, lag, dead = (state[name] for name in FOLDED["Wheels"])
    given = Wheels(width, acceleration=most or math.inf, lag=lag, dead_band=dead)
    chosen = checked_wheels(given)
    ideal = chosen == Wheels(width) or state["method"] == "continuous"
    return None if ideal else chosen


def _presets() -> list[dict]:
    outdoor = paper.outdoor()
    still, moving = ({"moving": moves, "law": "corrected"} for moves in (False, True))
    poses = {"start": _three("start", outdoor.start), "goal": _three("goal", outdoor.goal)}
    circle = {"start": _three("start", paper.CIRCLE_START), "dt": paper.TIME_STEP}
    return [
        still | poses | outdoor.gains._asdict() | {"dt": outdoor.dt},
        moving | circle | paper.CIRCLE_GAINS._asdict(),
        still | GENTLE_GAINS._asdict(),  # of any step: a reader shortens it, then compares
    ]
