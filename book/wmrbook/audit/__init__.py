"""Yousif and Ali's paper, line by line: what it says, what holds, and by which computation.

>>> from wmrbook import audit
>>> [row.verdict.value for row in audit.rows("equations")[:2]]
['✓ holds', '✓ holds']

Every verdict follows from a computation made when `rows` is called; the rules are `equation_row`
(equations), `fits` (numbers) and `depends`: what rests on numbers that nobody published is computed
with several choices of them, and cannot be reproduced if they disagree.
"""

from __future__ import annotations

from wmrbook.audit import equations, figures, numbers, proof, statements
from wmrbook.audit.proof import circle_residual, slope, steering
from wmrbook.audit.row import Row, Verdict, depends, equation_row, equivalent, fits
from wmrbook.audit.table import Place, Table, missing, places, tally
from wmrlib._checks import choice

__all__ = [
    "GROUPS",
    "Place",
    "Row",
    "Table",
    "Verdict",
    "circle_residual",
    "depends",
    "equation_row",
    "equivalent",
    "fits",
    "missing",
    "places",
    "rows",
    "slope",
    "steering",
    "tally",
]

_PARTS = {
    "equations": lambda: [*equations.rows(), *proof.rows()],
    "figures": figures.rows,
    "numbers": numbers.rows,
    "statements": statements.rows,
}
GROUPS = tuple(_PARTS)
"""The four kinds of things that a paper says, in the order of `rows`."""


def rows(group: str | None = None) -> list[Row]:
    """The rows of one group of GROUPS, or of all, computed in some seconds.

    Equations (1) to (26), figures 1 to 12, the numbers of `PUBLISHED`, and statements.
    Raises ValueError for an unknown group.
    """
    if group is not None:
        return _PARTS[choice("group", group, GROUPS)]()
    return [row for part in _PARTS.values() for row in part()]
