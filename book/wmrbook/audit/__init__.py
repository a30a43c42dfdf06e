"""Yousif and Ali's paper, line by line: what it says, what holds, and by which computation.

>>> from wmrbook import audit
>>> [row.verdict.value for row in audit.rows("equations")[:2]]
['✓ holds', '✓ holds']

What is judged is a converted text of the paper, without its figures. Every verdict follows from a
computation made when `rows` is called; the rules are `judge` (equations), `fits` (numbers) and
`decide`: what rests on a threshold of ours, or on what nobody published, is computed with several
of them, and is not decided if they disagree.
"""

from __future__ import annotations

from wmrbook.audit import claims, equations, proof
from wmrbook.audit.claims import STEPS, slowest_pole
from wmrbook.audit.equations import polar_rates
from wmrbook.audit.proof import near_goal, slope, steering
from wmrbook.audit.published import PUBLISHED
from wmrbook.audit.row import THRESHOLDS, Row, Verdict, decide, equivalent, fits
from wmrbook.audit.slips import one_slip
from wmrbook.audit.table import SOURCE, Place, Table, missing, places, tally
from wmrbook.audit.wrapping import unwrapped
from wmrlib.checks import choice

__all__ = [
    "GROUPS",
    "PUBLISHED",
    "SOURCE",
    "STEPS",
    "THRESHOLDS",
    "Place",
    "Table",
    "Verdict",
    "decide",
    "equivalent",
    "fits",
    "missing",
    "near_goal",
    "one_slip",
    "places",
    "polar_rates",
    "rows",
    "slope",
    "slowest_pole",
    "steering",
    "tally",
    "unwrapped",
]

_PARTS = {
    "equations": lambda: [*equations.rows(), *proof.rows()],
    "numbers": claims.numbers,
    "statements": claims.statements,
}
GROUPS = tuple(_PARTS)
"""The three kinds of things that a paper says, in the order of `rows`."""


def rows(group: str | None = None) -> list[Row]:
    """The rows of one group of GROUPS, or of all, computed in some seconds.

    Equations (1) to (26), two brackets without a number and two undefined symbols, the numbers of
    `PUBLISHED` that can be checked, and statements.
    Raises ValueError for an unknown group.
    """
    if group is not None:
        return _PARTS[choice("group", group, GROUPS)]()
    return [row for part in _PARTS.values() for row in part()]
