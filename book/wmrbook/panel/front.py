"""The picture of the book's front page: a drive with the paper's gains, and with gentler ones.

It is drawn and driven in the page, by `kit/front.js`.
"""

from __future__ import annotations

from wmrbook.panel.kit import Panel
from wmrlib import GENTLE_GAINS, paper


class Front(Panel):
    """The picture; `state["share"]` goes from the paper's gains, 0, to gentle ones, 1."""

    def __init__(self) -> None:
        start, goal, gains, _ = paper.outdoor()
        setup = {"start": list(start), "goal": list(goal)}
        setup |= {"paper": gains._asdict(), "gentle": GENTLE_GAINS._asdict()}
        super().__init__("front", {"share": 0.0}, setup)
