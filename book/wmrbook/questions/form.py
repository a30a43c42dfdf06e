"""The pre- and post-test as one HTML file, which works from the disk and keeps no key."""

from __future__ import annotations

from pathlib import Path

from wmrbook import lines
from wmrbook.questions import LETTERS, Question, fingerprint
from wmrbook.questions._formulas import as_html
from wmrbook.questions.classes import OPEN

_PAGE = Path(__file__).with_name("form.html")


def form(questions: tuple[Question, ...]) -> str:
    """Return the page of the form."""
    asked = "\n".join(_asked(number, it) for number, it in enumerate(questions, start=1))
    parts = {
        "<!-- questions -->": asked,
        "/* script */": lines.SCRIPT.read_text(encoding="utf-8"),
        "QUESTIONS = 0, MARK = ''": f"QUESTIONS = {len(questions)}, "
        f"MARK = '{fingerprint(questions)}'",
    }
    page = _PAGE.read_text(encoding="utf-8")
    for place, text in parts.items():
        page = page.replace(place, text)
    return page


def _asked(number: int, question: Question) -> str:
    options = [
        f'<label><input type="radio" name="q{number}" value="{letter}"> '
        f"<span><b>{letter}</b>&ensp;{as_html(option.text)}</span></label>"
        for letter, option in zip(LETTERS, question.options, strict=True)
    ]
    options.append(
        f'<label><input type="radio" name="q{number}" value="{OPEN}"> I would only guess</label>'
    )
    ask = f"<legend>{number}. {as_html(question.ask)}</legend>"
    return "\n".join(["<fieldset>" + ask, *options, "</fieldset>"])
