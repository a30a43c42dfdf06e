"""The questions as slides, each with its answer and the mistakes behind the rest in its notes.

Before them two slides say what the symbols mean. A question that describes a situation shows it,
unless a picture would be the answer.
"""

from __future__ import annotations

from collections.abc import Iterator

from wmrbook.figures.scenes import names_of_angles, scene_of
from wmrbook.figures.style import Picture
from wmrbook.questions import LETTERS, Question

ANGLES = r"""- $\rho$: how far the goal is
- $\alpha$: from the robot's heading to the line of sight
- $\theta$: from the goal's heading to it; $\beta = -\theta$
- left is positive: here $\alpha < 0$, $\theta > 0$
"""
GAINS = r"""$$ v = v_{\max}(1 - e^{-k_\rho\rho})\cos\alpha, \qquad
\omega = k_\alpha\alpha + \frac{v}{\rho}\,\frac{\sin\alpha}{\alpha}\,(\alpha + h\theta) $$

- $v_{\max}$: the speed limit, in m/s
- $k_\rho$: how near the goal it slows down, per m
- $k_\alpha$: steering towards the goal, per s
- $h$: weight of the goal's heading
- under this law, the corrected one, $V = \frac12\rho^2 + \frac12(\alpha^2 + h\theta^2)$ falls
"""
TITLE = "From two GPS points to a parked robot: concept questions"


def slides(questions: tuple[Question, ...]) -> Iterator[tuple[str, str, Picture | None, str]]:
    """Yield each slide's title, its words and notes as Markdown, and its picture."""
    yield TITLE, "Decide alone, talk to your neighbour, decide again. Then watch.", None, ""
    yield "What the letters mean", ANGLES, names_of_angles(), ""
    yield "The law, and its gains", GAINS, None, ""
    for number, question in enumerate(questions, start=1):
        options = "\n".join(f"<li>{option.text}</li>" for option in question.options)
        ask = f"{question.ask}\n\n<ol type='A'>\n{options}\n</ol>"
        yield f"{number}. {question.title}", ask, scene_of(question.id), _notes(question)


def _notes(question: Question) -> str:
    """The key with its reason, and the mistake behind each other option."""
    options = dict(zip(LETTERS, question.options, strict=True))
    wrong = [f"- {letter}: {it.mistake}" for letter, it in options.items() if it.mistake]
    reason = f"**{question.key}: {options[question.key].text}.** {question.why}"
    where = f"Chapter {question.chapter}, {question.section!r}."
    return "\n".join([reason, "", *wrong, "", where])
