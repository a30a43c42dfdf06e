"""What stands in place of a panel where nothing runs: its picture as it opens, with its words.

On GitHub, in an e-mail, in a page that nbconvert writes and in a notebook that has not been run
yet a panel can't move. Each picture is a file in the folder `stills`, named by the digest of what
the panel shows; `book/tools/stills.py` takes them.
"""

from __future__ import annotations

import hashlib
import html
import json
import re
from pathlib import Path
from typing import Any

KIT, FOLDER = (Path(__file__).with_name(name) for name in ("kit", "stills"))
RUN_IT = "Run this cell to move it."


def digest(program: str, state: dict[str, Any], setup: dict[str, Any]) -> str:
    """A hash of a panel's program and of what it shows, to six digits of each number."""
    text = (KIT / f"{program}.js").read_text(encoding="utf-8")
    shown = json.dumps([program, text, _rounded([state, setup])], sort_keys=True)
    return hashlib.sha256(shown.encode()).hexdigest()[:16]


def _rounded(value: Any) -> Any:
    """The value as JSON has it, without the last digits, in which processors differ."""
    if isinstance(value, dict):
        return {name: _rounded(it) for name, it in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(it) for it in value]
    if isinstance(value, float):
        return f"{value:.6g}" if abs(value) > 1e-9 else "0"
    return f"{value}" if isinstance(value, int) and not isinstance(value, bool) else value


def still(program: str, state: dict[str, Any], setup: dict[str, Any]) -> str:
    """The picture and the words of a panel as HTML, in one line; empty if it has no picture."""
    path = FOLDER / f"{digest(program, state, setup)}.html"
    return path.read_text(encoding="utf-8").strip() if path.exists() else ""


def written(image: str, alt: str, words: str, where: str) -> str:
    """The HTML of a still: `image` is its address, `where` says in HTML where the panel moves."""
    return (
        f'<div class="wmr-still"><img alt="{html.escape(alt)}" width="700" src="{image}">'
        f"<p>{html.escape(words)}</p><p><em>{where}</em></p></div>"
    )


def words_of(text: str) -> str:
    """The words of a still, without its picture."""
    return html.unescape(re.sub(r"<[^>]*>", "", text.replace("</p><p>", " "))).strip()
