"""The formulas of the questions' texts in HTML: a form has no room for MathJax."""

from __future__ import annotations

import html
import re

_GREEK = "alpha", "beta", "theta", "rho", "omega"
_WORDS = {rf"\{name}": f"&{name};" for name in _GREEK} | {
    r"\cos": "cos&nbsp;",
    r"\sin": "sin&nbsp;",
    r"\ln": "ln",
    r"\cdot": "&middot;",
    r"\to": "&rarr;",
    r"\pm": "&plusmn;",
}
_FORMULA = re.compile(r"\$([^$]+)\$")


def as_html(text: str) -> str:
    """Return the text in HTML; raises ValueError for a formula that it can't write."""
    return _FORMULA.sub(lambda formula: _written(formula[1]), html.escape(text, quote=False))


def _written(formula: str) -> str:
    text = re.sub(r"\\dot\s*(\\?[A-Za-z]+)", r"\1&prime;", formula)
    text = re.sub(r"\\sqrt\s*(\w)", r"&radic;\1", text)
    text = text.replace(r"_{\max}", "<sub>max</sub>")
    text = re.sub(r"\\[a-z]+", lambda it: _known(it[0], formula), text)
    text = re.sub(r"_\{(&\w+;|\w+)\}|_(&\w+;|\w)", r"<sub>\1\2</sub>", text)
    text = re.sub(r"\^\{([^}]*)\}", r"<sup>\1</sup>", text)
    if set(text) & set("\\{}^_"):
        raise ValueError(f"${formula}$ is not allowed: a form can't write it")
    return f"<i>{text.replace('-', '&minus;')}</i>"


def _known(word: str, formula: str) -> str:
    if word not in _WORDS:
        raise ValueError(f"${formula}$ is not allowed: a form can't write {word}")
    return _WORDS[word]
