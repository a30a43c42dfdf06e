"""The deck that vote.py serves, and the questions on its slides."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import NamedTuple

import slides
from build import BOOK
from kit import bundled

from wmrbook.figures.style import in_symbols
from wmrbook.questions import LETTERS, deck, made
from wmrbook.questions.form import as_html


class Question(NamedTuple):
    """What is asked on a slide, in HTML."""

    ask: str
    options: tuple[str, ...]


def question_of(slide: slides.Slide) -> Question | None:
    """Return what a slide asks, if it gives options to choose."""
    ask, listed, options = slide.words.partition("<ol type='A'>")
    if listed:
        return Question(
            as_html(ask.strip()), tuple(map(as_html, re.findall("<li>(.*)</li>", options)))
        )
    for text in re.findall(r">(\{.*?\})</script>", slide.picture)[1:]:
        asked = json.loads(text)["state"]["it"]["state"]["setup"].get("ask")
        if asked and asked["kind"] == "choose":
            texts = (as_html(in_symbols(it)) for it in (asked["question"], *asked["options"]))
            return Question(next(texts), tuple(texts))
    return None


def make(folder: Path, which: str, address: str) -> tuple[str, dict[int, Question]]:
    """Make a deck to vote by in a folder; return its page, and its questions by slide."""
    if which == "questions":
        slides.vote(folder)
        page, all_slides = "questions.html", [slides.Slide(*it[:2]) for it in deck.slides(made())]
    else:
        slides.main(folder, [which])
        (path,), (_, all_slides) = folder.glob("*.slides.html"), slides.deck(which)
        page = path.name
    asked = {at: it for at, slide in enumerate(all_slides) if (it := question_of(slide))}
    bundled("import './vote.js';", BOOK / "deck", folder / "vote.js", "vote", "--loader:.css=text")
    told = {
        "address": address,
        "letters": LETTERS,
        "questions": {k: it.options for k, it in asked.items()},
    }
    script = json.dumps(told).replace("<", slides.SAFE)
    text = (folder / page).read_text(encoding="utf-8")
    for place, added in (
        ("</head>", '<link rel="icon" href="data:,">'),  # else the server is asked for one
        ("</body>", f'<script>window.VOTE = {script};</script><script src="vote.js"></script>'),
    ):
        text = text.replace(place, added + place)
    (folder / page).write_text(text, encoding="utf-8")
    return page, asked
