"""The questions as slides to vote by: each, then its answer and the mistakes behind the rest.

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
TITLE = "From two GPS points to a parked robot: questions to vote on"


def slides(questions: tuple[Question, ...]) -> Iterator[tuple[str, str, Picture | None, str]]:
    """Yield each slide's title, its words and notes as Markdown, and its picture."""
    yield TITLE, "Vote alone, talk to your neighbour, vote again. Then watch.", None, ""
    yield "What the letters mean", ANGLES, names_of_angles(), ""
    yield "The law, and its gains", GAINS, None, ""
    for number, question in enumerate(questions, start=1):
        options = "\n".join(f"<li>{option.text}</li>" for option in question.options)
        ask = f"{question.ask}\n\n<ol type='A'>\n{options}\n</ol>"
        yield f"{number}. {question.title}", ask, scene_of(question.id), ""
        wrong = "\n".join(
            f"- {letter}: {option.mistake}"
            for letter, option in zip(LETTERS, question.options, strict=True)
            if option.mistake
        )
        right = dict(zip(LETTERS, question.options, strict=True))[question.key].text
        notes = f"Chapter {question.chapter}, {question.section!r}. Line: {question.id}"
        untested = f". Not in the test: {question.untested}" if question.untested else ""
        answer = f"{number}. {question.key}: {right}"
        yield answer, f"{question.why}\n\n{wrong}", None, notes + untested
