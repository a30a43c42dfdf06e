"""The questions as slides to vote by: each, then its answer and the mistakes behind the rest."""

from __future__ import annotations

from collections.abc import Iterator

from wmrbook.questions import LETTERS, Question

TITLE = "From two GPS points to a parked robot: questions to vote on"


def slides(questions: tuple[Question, ...]) -> Iterator[tuple[str, str]]:
    """Yield (type, text) of each cell, as slide types and Markdown."""
    yield "slide", f"# {TITLE}\n\nVote alone, talk to your neighbour, vote again. Then watch."
    for number, question in enumerate(questions, start=1):
        options = "\n".join(f"<li>{option.text}</li>" for option in question.options)
        ask = f"{question.ask}\n\n<ol type='A'>\n{options}\n</ol>"
        yield "slide", f"## {number}. {question.title}\n\n{ask}"
        wrong = "\n".join(
            f"- {letter}: {option.mistake}"
            for letter, option in zip(LETTERS, question.options, strict=True)
            if option.mistake
        )
        right = dict(zip(LETTERS, question.options, strict=True))[question.key].text
        answer = f"## {number}. {question.key}: {right}\n\n{question.why}\n\n{wrong}"
        yield "subslide", answer
        yield "notes", f"Chapter {question.chapter}, {question.section!r}. Line: {question.id}"
