"""Results as a table: one style for all chapters, in JupyterLab and on the book's pages."""

from __future__ import annotations

import html
import math
import re
from collections.abc import Iterable, Mapping
from numbers import Number
from typing import Any

from wmrbook.face import in_symbols
from wmrlib.checks import instance

_MINUS, _NOTHING = "\N{MINUS SIGN}", "\N{EN DASH}"
_FORMULA = re.compile(r"\$([^$]+)\$")


class Results:
    """A table that `table` has made, which Jupyter shows; its `repr` is the same in plain text."""

    def __init__(self, columns: dict[str, list[str]], numeric: set[str], caption: str) -> None:
        self.columns = columns
        self.numeric = numeric
        self.caption = caption

    def __repr__(self) -> str:
        columns = []
        for k, (name, texts) in enumerate(self.columns.items()):
            width = max(map(len, (name, *texts)))
            right = k > 0 and name in self.numeric
            columns.append(
                [f"{it:>{width}}" if right else f"{it:{width}}" for it in (name, *texts)]
            )
        lines = ("  ".join(row).rstrip() for row in zip(*columns, strict=True))
        return "\n".join([*filter(None, [self.caption]), *lines])

    def _repr_html_(self) -> str:
        names = list(self.columns)
        head = "".join(self._cell(name, name, "th", "col") for name in names)
        body = []
        for first, *others in zip(*self.columns.values(), strict=True):
            cells = [self._cell(names[0], first, "th", "row")]
            cells += map(self._cell, names[1:], others)
            body.append(f"<tr>{''.join(cells)}</tr>")
        caption = f"<caption>{_typeset(self.caption)}</caption>\n" if self.caption else ""
        rows = "\n".join(body)
        return (
            f'<table class="results">\n{caption}<thead><tr>{head}</tr></thead>\n'
            f"<tbody>\n{rows}\n</tbody>\n</table>"
        )

    def _cell(self, column: str, text: str, tag: str = "td", scope: str = "") -> str:
        if scope == "col" and not text:
            return "<td></td>"  # the corner, which heads nothing
        scope = f' scope="{scope}"' if scope else ""
        right = column in self.numeric and column != next(iter(self.columns))
        side = "right" if right else "left"
        text = re.sub(r"^-(?=[\d∞])", _MINUS, text) if right else text
        return f'<{tag}{scope} style="text-align: {side}">{_typeset(text)}</{tag}>'


def table(
    columns: Mapping[str, Iterable[Any]],
    formats: str | Mapping[str, str] = "",
    caption: str = "",
) -> Results:
    r"""Make a table of columns, to be shown as the result of a cell.

    The first column names the rows. Numbers are aligned to the right; an infinite one is shown as
    ∞, NaN and None as a dash, True and False as yes and no. In headings and texts, symbols take the
    place of names such as k_rho, and formulas may stand between dollars.

    Parameters
    ----------
    columns : from a heading, with its unit, to the numbers or texts below it, one a row
    formats : str, how numbers are written, such as ".1f", or a mapping from headings to such texts.
        A column that it does not name has as many decimals as give its largest number three digits,
        or fewer where they would be zeros; the first has those that its numbers need.
    caption : str, what the table shows

    Returns
    -------
    Results

    Raises
    ------
    ValueError
        if columns is no mapping or empty, or if they are not equally long; if formats names no
        column, or is no format of a number

    >>> table({"gains": ["the paper's", "gentle"], "heading error [deg]": [-27.21, 2.1]})
    gains        heading error [deg]
    the paper's                -27.2
    gentle                       2.1
    """
    columns = {name: list(values) for name, values in instance("columns", columns, Mapping).items()}
    if not columns:
        raise ValueError("columns = {} is not allowed: a table has at least one column")
    rows = len(next(iter(columns.values())))
    for name, values in columns.items():
        if len(values) != rows:
            needed = f"{rows} are needed, as in the first column"
            raise ValueError(f"columns[{name!r}] has {len(values)} values: {needed}")
    if isinstance(formats, str):
        formats = dict.fromkeys(columns, formats)
    for name in formats:
        if name not in columns:
            raise ValueError(f"formats[{name!r}] is not allowed: columns has {', '.join(columns)}")
    texts, numeric = {}, set()
    for name, values in columns.items():
        numbers = [value for value in values if _is_number(value) and math.isfinite(value)]
        if any(map(_is_number, values)):
            numeric.add(name)
        form = formats.get(name) or (_three_digits(numbers) if texts else "g")
        texts[name] = [_written(value, form, name) for value in values]
    return Results(texts, numeric, caption)


def _is_number(value: Any) -> bool:
    return isinstance(value, Number) and not isinstance(value, bool)


def _three_digits(numbers: list[Any]) -> str:
    """The format of a column: three digits for the largest number, no decimals that are all 0."""
    largest = max(map(abs, numbers), default=0.0) or 1.0
    decimals = min(max(2 - math.floor(math.log10(largest)), 0), 6)
    while decimals and all(abs(it - round(it, decimals - 1)) < 1e-9 for it in numbers):
        decimals -= 1
    return f".{decimals}f"


def _written(value: Any, form: str, column: str) -> str:
    if value is None or (_is_number(value) and math.isnan(value)):
        return _NOTHING
    if not _is_number(value):
        return {"True": "yes", "False": "no"}.get(str(value), str(value))
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    try:
        text = format(value, form)
    except ValueError:
        needed = 'a format of a number is needed, such as ".1f"'
        raise ValueError(f"formats[{column!r}] = {form!r} is not allowed: {needed}") from None
    return text[1:] if re.fullmatch(r"-0\.?0*", text) else text  # a zero has no sign


def _typeset(text: str) -> str:
    """The text as HTML, its formulas for MathJax, in Jupyter and on a page."""
    words = _FORMULA.split(text)  # every second one is a formula
    words[::2] = map(in_symbols, words[::2])
    words[1::2] = (f"${formula}$" for formula in words[1::2])
    formula = r'<span class="math notranslate nohighlight">\\(\1\\)</span>'
    return _FORMULA.sub(formula, html.escape("".join(words)))
