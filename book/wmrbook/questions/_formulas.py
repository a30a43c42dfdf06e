"""The formulas of the questions' texts in HTML: a form has no room for MathJax."""

from __future__ import annotations

import html
import re

_WORDS = {
    r"\alpha": "α",
    r"\beta": "β",
    r"\theta": "θ",
    r"\rho": "ρ",
    r"\omega": "ω",
    r"\cos": "cos ",
    r"\ln": "ln ",
    r"\to": " → ",
    r"\approx": " ≈ ",
    r"\infty": "∞",
}
_FORMULA = re.compile(r"\$([^$]+)\$")


def as_html(text: str) -> str:
    """Return the text in HTML; raises ValueError for a formula that it can't write."""
    return _FORMULA.sub(lambda formula: _written(formula[1]), html.escape(text, quote=False))


def _written(formula: str) -> str:
    text = re.sub(r"\\dot\s*(\\?[A-Za-z]+)", r"\1′", formula)
    text = re.sub(r"\\sqrt\s*(\w)", r"√\1", text)
    text = text.replace(r"_{\max}", "<sub>max</sub>")
    text = re.sub(r"\\[a-z]+\s*", lambda it: _known(it[0].strip(), formula), text)
    text = re.sub(r"_(\w)", r"<sub>\1</sub>", text)
    text = re.sub(r"\^\{([^}]*)\}", r"<sup>\1</sup>", text)
    if set(text) & set("\\{}^_"):
        raise ValueError(f"${formula}$ is not allowed: a form can't write it")
    return f"<i>{text.replace('-', '−')}</i>"


def _known(word: str, formula: str) -> str:
    if word not in _WORDS:
        raise ValueError(f"${formula}$ is not allowed: a form can't write {word}")
    return _WORDS[word]
