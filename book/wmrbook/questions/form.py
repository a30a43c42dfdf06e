"""The pre- and post-test as one HTML file, which works from the disk and keeps no key."""

from __future__ import annotations

from pathlib import Path

from wmrbook import lines
from wmrbook.questions import LETTERS, Question, fingerprint
from wmrbook.questions._formulas import as_html
from wmrbook.questions.classes import OPEN

_PAGE = Path(__file__).with_name("form.html")
_WORDS = (
    r"Words: the goal lies $\rho$ metres away. $\alpha$ turns from the robot's heading to the line "
    r"of sight, $\theta$ from the goal's heading, left is positive. A law commands the speed "
    r"$v$ and the turning rate $\omega$. The corrected one is "
    r"$v = v_{\max}(1 - e^{-k_\rho\rho})\cos\alpha$, "
    r"$\omega = k_\alpha\alpha + (v/\rho)(\sin\alpha/\alpha)(\alpha + h\theta)$. "
    r"$V$ is $\rho^{2}/2 + (\alpha^{2} + h\theta^{2})/2$, and $\dot V$ its rate."
)


def form(questions: tuple[Question, ...]) -> str:
    """Return the page of the form."""
    asked = "\n".join(_asked(number, it) for number, it in enumerate(questions, start=1))
    parts = {
        "<!-- words -->": f"<p>{as_html(_WORDS)}</p>",
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
