"""What all small things to move are made of: knobs, a sentence, a prediction, and a drawing."""

from __future__ import annotations

from typing import Any, NamedTuple

from wmrbook.live.scenes import SCENES
from wmrbook.panel.kit import Panel
from wmrlib.checks import choice, refusal, scalar
from wmrlib.kinematics import Pose


class Knob(NamedTuple):
    """A number that a reader moves: in steps, or, without a step, by the round numbers."""

    value: float
    low: float
    high: float
    step: float | None
    says: str  # to those who can't see it, and on the slider where there is no symbol
    unit: str = ""
    symbol: str = ""  # as in a formula, k_alpha
    label: str = ""  # on the slider in place of a symbol
    plays: float = 0.0  # s from low to high, for a knob with a button that moves it
    auto: bool = False  # and it moves when it is first seen

    def allowed(self, name: str, value: Any) -> float:
        """Return the value, or refuse it by name."""
        return scalar(name, value, low=self.low, high=self.high)

    def shown(self, value: float) -> str:
        """Return the value with its unit."""
        return f"{value:g}{self.unit and ('' if self.unit == '°' else ' ')}{self.unit}"


class Choice(NamedTuple):
    """A choice among a few, by name, with the words that stand for it in the sentence."""

    value: str
    choices: dict[str, str]
    says: str
    label: str = ""  # beside the choices of a stage

    def allowed(self, name: str, value: Any) -> str:
        """Return the value, or refuse it by name."""
        return choice(name, value, self.choices)

    def shown(self, value: str) -> str:
        """Return the words that stand for the value."""
        return self.choices[value]


class Ask(NamedTuple):
    """A prediction that is asked for before anything is shown.

    By its kind: "choose" one of `options`, whose `key` is a number, with what is `wrong` about each
    of the others; "turn" an arrow that stands
    `at` a point of a `pane` (the `key` is its angle, rad); "sketch" a path that starts there.
    After it the knobs go to the places of `asked`, one after the other: from what the question
    gives to what it asks about.
    """

    kind: str
    question: str
    why: str
    key: float | None = None
    options: tuple[str, ...] = ()
    wrong: tuple[str, ...] = ()
    asked: tuple[dict[str, float | str], ...] = ()
    pane: str = ""
    at: tuple[float, float] | None = None


def between(start: Pose, goal: Pose, **more: Any) -> dict[str, Any]:
    """Return the data of a drive from one pose to another, and what else its drawing needs."""
    return {"start": list(start), "goal": list(goal), **more}


def choose(
    question: str, why: str, answers: dict[str, bool], wrong: tuple[str, ...], asked: tuple = ()
) -> Ask:
    """Return the choice of an answer; `answers` says of each whether it is so."""
    key = [*answers.values()].index(True)
    return Ask("choose", question, why, key, (*answers,), wrong, asked)


def nearest(value: float, answers: dict[str, float]) -> dict[str, bool]:
    """Return which answer is so, of some that each stand for a number."""
    best = min(answers.values(), key=lambda number: abs(number - value))
    return {words: number == best for words, number in answers.items()}


class Knobs(Panel):
    """A panel whose knobs are read and set by name: `thing["k_alpha"] = 2`."""

    _knobs: dict[str, Knob | Choice]

    def rows(self) -> list[dict[str, Any]]:
        """Return the knobs as the page has them."""
        listed = []
        for name, knob in self._knobs.items():
            row: dict[str, Any] = {"name": name, **knob._asdict()}
            if isinstance(knob, Choice):
                row["choices"] = [*map(list, knob.choices.items())]
            listed.append(row)
        return listed

    def places(self) -> dict[str, float | str]:
        """Return where the knobs stand at first."""
        return {name: knob.allowed(name, knob.value) for name, knob in self._knobs.items()}

    def __getitem__(self, name: str) -> float | str:
        return self.state[self._named(name)]

    def __setitem__(self, name: str, value: float | str) -> None:
        value = self._knobs[self._named(name)].allowed(name, value)
        self.state = self.state | {name: value}

    def settable(self) -> str:
        return ", ".join([*(f"[{name!r}]" for name in self._knobs), super().settable()])

    def _named(self, name: str) -> str:
        if name not in self._knobs:
            raise refusal("knob", name, f"one of {', '.join(self._knobs)}")
        return name


class Live(Knobs):
    """A small thing to move; `book/wmrbook/panel/kit/live/NAME.js` says what is drawn.

    Parameters
    ----------
    name : the drawing's file, and of the prediction in what the browser remembers
    sentence : str with {knob} or {result} where a number goes ({knob!} in a formula: without its
        symbol and unit), *symbol* for a coloured symbol, and [formula] for what stays in one line
    knobs : Knob or Choice, by name
    data : what the drawing needs that does not move: numbers, lists and texts
    ask : Ask or None

    `thing["k_alpha"]` is where a knob stands, and can be set.

    Raises
    ------
    ValueError : a knob that it does not have, or a value that the knob does not allow
    """

    def __init__(
        self,
        name: str,
        sentence: str,
        knobs: dict[str, Knob | Choice],
        *,
        data: dict[str, Any] | None = None,
        ask: Ask | None = None,
    ):
        self._knobs = knobs
        steps = [step._asdict() for step in SCENES.get(name, ())]
        for step in steps:
            step["to"] = {it: self._knobs[it].allowed(it, to) for it, to in step["to"].items()}
        setup = {
            "sentence": sentence,
            "knobs": self.rows(),
            "data": data or {},
            "ask": ask and {"name": name, **ask._asdict()},
            "steps": steps,
        }
        super().__init__(f"live/{name}", self.places() | {"guess": None}, setup)

    def __repr__(self) -> str:
        """Where the knobs stand; the sentence needs numbers that the page finds."""
        stands = (f"{it.says}: {it.shown(self[name])}" for name, it in self._knobs.items())
        return f"A live figure, which begins with {'; '.join(stands)}."
