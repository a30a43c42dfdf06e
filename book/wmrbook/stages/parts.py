"""What every stage is made of: its scenes, a question that a scene may ask, its knobs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from wmrbook.live.parts import Choice, Knob, Knobs
from wmrlib import GENTLE_GAINS, paper
from wmrlib.checks import choice
from wmrlib.gains import Gains
from wmrlib.kinematics import Pose

LOOKS = "whole", "near", "other"


class Question(NamedTuple):
    """What a scene asks before it shows: two to four answers, of which one is so.

    Each answer comes with its verdict, a sentence in which {results} stand for numbers; `then` is
    where the knobs go when an answer is given.
    """

    question: str
    answers: Mapping[str, str]
    key: str
    then: Mapping[str, float | str] = {}


class Scene(NamedTuple):
    """A state of a stage: what is said, seen and drawn, and where the knobs stand for it.

    says : str; *k_rho* is a symbol, {seconds} a number that follows from the knobs
    look : "whole", "near" for the last metre, or "other", as the stage's drawing says
    shows : names of what is drawn beside the robot and its path
    to : the knobs that do not stand as they do at first
    ask : Question or None
    still : whether the robot waits at its start; with a question, at the end of its drive
    empty : whether there is no robot yet
    until : the share of the drive after which the film of this scene ends
    moved : what is said instead once a hand has moved a knob or a pose; "" where `says` stays true
    handles : names of the knobs that it shows; None for all of them
    """

    says: str
    look: str = "whole"
    shows: tuple[str, ...] = ()
    to: Mapping[str, float | str] = {}
    ask: Question | None = None
    still: bool = False
    empty: bool = False
    until: float = 1.0
    moved: str = ""
    handles: tuple[str, ...] | None = None


class Stage(Knobs):
    """A chapter's stage; `book/wmrbook/panel/kit/stages/NAME.js` says what drives on it.

    `stage["k_alpha"]` is where a knob stands, and can be set.

    Parameters
    ----------
    name : the drawing's file
    knobs : Knob or Choice, by name
    scenes : Scene, by name
    scene : the one that it opens with
    start, goal : Pose or None
    hands : which of the two a hand may move
    data : what the drawing needs that does not move

    Raises
    ------
    ValueError : a scene or a knob that it does not have, or a value that a knob does not allow
    """

    def __init__(
        self,
        name: str,
        knobs: Mapping[str, Knob | Choice],
        scenes: Mapping[str, Scene],
        scene: str,
        *,
        start: Pose | None = None,
        goal: Pose | None = None,
        hands: tuple[str, ...] = ("start", "goal"),
        data: Mapping[str, Any] | None = None,
    ):
        self._knobs = dict(knobs)
        self._scenes = dict(scenes)
        choice("scene", scene, scenes)
        both = {"start": start, "goal": goal}
        poses = {name: list(pose) for name, pose in both.items() if pose is not None}
        setup = {
            "knobs": self.rows(),
            "scenes": [self._listed(key, it) for key, it in scenes.items()],
            "poses": poses,
            "hands": [hand for hand in hands if hand in poses],
            "far": goal is None or all(it.look == "other" for it in scenes.values()),
            "data": dict(data or {}),
        }
        state = self.places() | poses | {"scene": scene, "answer": None}
        super().__init__(f"stages/{name}", state, setup)

    def __repr__(self) -> str:
        """Where the knobs stand."""
        stands = (f"{it.says}: {it.shown(self[name])}" for name, it in self._knobs.items())
        return f"A stage, which begins with {'; '.join(stands)}."

    def _listed(self, key: str, scene: Scene) -> dict[str, Any]:
        """Return a scene as the page has it."""
        choice(f"look of {key!r}", scene.look, LOOKS)
        row = scene._asdict() | {"name": key, "to": self._moved(scene.to)}
        if scene.handles is None:
            del row["handles"]
        else:
            row["handles"] = [self._named(name) for name in scene.handles]
        if scene.ask is not None:
            answers = [*map(list, scene.ask.answers.items())]
            right = [*scene.ask.answers].index(choice("key", scene.ask.key, scene.ask.answers))
            then = self._moved(scene.ask.then)
            row["ask"] = scene.ask._asdict() | {"answers": answers, "key": right, "then": then}
        return row

    def _moved(self, to: Mapping[str, float | str]) -> dict[str, float | str]:
        return {name: self._knobs[self._named(name)].allowed(name, it) for name, it in to.items()}


def gain_knobs(gains: Gains) -> dict[str, Knob]:
    """Return the three gain sliders, the same in every chapter, where these gains put them."""
    k_rho, k_alpha, h, _ = gains
    return {
        "k_rho": Knob(
            k_rho, 0.05, 4.0, 0.05, "how near the goal it slows down", "1/m", symbol="k_rho"
        ),
        "k_alpha": Knob(
            k_alpha, 0.1, 6.0, 0.1, "how fast it turns towards the goal", "1/s", symbol="k_alpha"
        ),
        "h": Knob(h, 0.0, 6.0, 0.1, "how much the final heading counts", symbol="h"),
    }


GENTLE, PAPER = (
    {name: getattr(gains, name) for name in ("k_rho", "k_alpha", "h")}
    for gains in (GENTLE_GAINS, paper.OUTDOOR_GAINS)
)
"""Where the sliders stand for the gentle gains and for the paper's."""


def paper_drive() -> dict[str, Pose]:
    """Return the start and the goal of the paper's drive outdoors."""
    start, goal, _, _ = paper.outdoor()
    return {"start": start, "goal": goal}


def off_heading(run) -> float:
    """Return how far off its heading a run ends, in degrees from 0 to 180."""
    return math.degrees(abs(run.heading_error[-1]))
