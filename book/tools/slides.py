"""Make a reveal.js deck of each chapter, as book/deck/NN.md has written it.

With --lecturer the last slide's notes have the exercises and their solutions. With --questions
make one deck of the concept questions instead, with their answers in the notes. Both are for the
lecturer alone, in folders of their own, since the other decks are for everybody.

In a deck's source each `# claim` begins a slide. A line `figure: CELL` below it shows what that
cell of the chapter has stored, a figure or a panel (`03/CELL`: of chapter 3), or the situation of a
concept question (`question/four-moves`). A panel may begin elsewhere,
`figure: CELL theta=90 law=printed`, and without its prediction: `figure: CELL open`.
A stage begins with one of its scenes, `figure: CELL scene=near h=0 start=0,-4,90`: the knobs and
poses (metres and degrees) stand so in this scene. The items of a list of `+` or `1)` appear one
by one, and words below a question appear after it.
What follows `note:` is for the speaker. OUTPUT/index.html lists the decks; all open from the disk,
with no network.
"""

from __future__ import annotations

import html
import json
import math
import re
import shutil
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import NamedTuple
from urllib.parse import quote, unquote

import nbformat
from build import BOOK, NPM_FILES, ROOT, arguments, copy_javascript, install_javascript
from jinja2 import Environment, FileSystemLoader
from kit import bundle
from markdown_it import MarkdownIt
from markdown_it.rules_core import StateCore
from mdit_py_plugins.dollarmath import dollarmath_plugin
from nbformat import NotebookNode

from wmrbook.figures.style import NARROWEST, SVG_URL, darkened

REVEAL_FILES = (
    "reveal.js/dist/re*.css",
    "reveal.js/dist/reveal.js",
    "reveal.js/plugin/notes/notes.js",
    "reveal.js/LICENSE",
)
BESIDE = ("mathjax.js", "_static/widgets.js", "deck/deck.css", "deck/deck.js")
FOLDED = re.compile(
    r"<details><summary>(Hint|Solution)</summary>\n\n(.*?)\n\n</details>", re.DOTALL
)
SLIDE = re.compile(r"# (?P<title>.*)\n+(?:figure: (?P<figure>.*)\n+)?(?P<words>[\s\S]*?)"
                   r"(?:^note: (?P<notes>[\s\S]*))?\Z", re.MULTILINE)  # fmt: skip
FRACTION = re.compile(r"\\frac(?!\d\d)")  # not a half
KIND = "application/vnd.jupyter.widget"
SAFE = r"\u003c"  # in a script an HTML tag could end it
VIEW, STATE = f"{KIND}-view+json", f"{KIND}-state+json"


class Slide(NamedTuple):
    """A slide: what it claims, its words and notes as Markdown, and its picture as HTML."""

    title: str
    words: str = ""
    picture: str = ""
    notes: str = ""


def main(output: Path, chapters: list[str], lecturer: bool = False) -> None:
    """Write the decks of the chapters given by number, or of all, what they load, and a list."""
    paths = {path.name[:2]: path for path in sorted((ROOT / "notebooks").glob("[01]*.ipynb"))}
    if missing := sorted(set(chapters) - set(paths)):
        raise SystemExit(
            f"no chapter {', '.join(missing)}: two digits each, such as 00 04, are needed, "
            "and OUTPUT before --chapters"
        )
    lay_out(output)
    for stale in output.glob("*.slides.html") if not chapters else ():
        stale.unlink()
    for number, path in paths.items():
        if not chapters or number in chapters:
            title, slides = deck(number)
            if lecturer:
                slides[-1] = slides[-1]._replace(notes=f"{slides[-1].notes}\n\n{solved(number)}")
            write(output / f"{path.stem}.slides.html", title, slides, int(number))
    decks = sorted(output.glob("*.slides.html"))
    (output / "index.html").write_text(contents(decks), encoding="utf-8")
    print(output / "index.html")


def questions(output: Path) -> None:
    """Write the deck of the concept questions."""
    from wmrbook.questions import deck, made

    lay_out(output)
    slides = [
        Slide(title, words, pictured(picture._repr_mimebundle_(), {}, ()) if picture else "", notes)
        for title, words, picture, notes in deck.slides(made())
    ]
    write(output / "questions.html", deck.TITLE, slides)


def deck(number: str) -> tuple[str, list[Slide]]:
    """Return a chapter's title and slides."""
    text = (BOOK / "deck" / f"{number}.md").read_text(encoding="utf-8")
    slides = []
    for source in re.split(r"^(?=# )", text, flags=re.MULTILINE)[1:]:
        parts = SLIDE.match(source).groupdict(default="")
        figure = parts.pop("figure")
        picture = picture_of(number, *figure.split()) if figure else ""
        slides.append(Slide(picture=picture, **{name: it.strip() for name, it in parts.items()}))
    return chapter(number).cells[0].source.splitlines()[0][2:], slides


@cache
def chapter(number: str) -> NotebookNode:
    """Return a chapter's notebook by its number, of two digits."""
    (path,) = (ROOT / "notebooks").glob(f"{number}_*.ipynb")
    return nbformat.read(path, as_version=4)


def picture_of(number: str, name: str, *settings: str) -> str:
    """Return the figure or panel of a cell; a panel as it is set by NAME=VALUE and `open`."""
    number, name = name.split("/") if "/" in name else (number, name)
    if number == "question":
        return situation(name)
    notebook = chapter(number)
    data = [
        output.data
        for cell in notebook.cells
        if cell.id == name
        for output in cell.get("outputs", ())
        if VIEW in output.get("data", {}) or "<img" in output.get("data", {}).get("text/html", "")
    ]
    if len(data) != 1:
        raise SystemExit(f"chapter {number} has {len(data)} pictures at cell {name!r}: 1 is needed")
    return pictured(data[0], notebook.metadata.get("widgets", {}).get(STATE, {}), settings)


def situation(question: str) -> str:
    """Return the picture of what a concept question asks about."""
    from wmrbook.figures.scenes import SCENES, scene_of

    if question not in SCENES:
        raise SystemExit(f"no picture of the question {question!r}, only {', '.join(SCENES)}")
    return pictured(scene_of(question)._repr_mimebundle_(), {}, ())


def pictured(data: dict, stored: dict, settings: Iterable[str]) -> str:
    """Return the HTML of an output: a panel with its state, or a figure for light and dark."""
    if VIEW in data:
        model = json.loads(json.dumps(stored["state"][data[VIEW]["model_id"]]))
        model["state"].pop("still", None)  # a deck has nothing that can't run
        place(model["state"]["state"], model["state"]["setup"], settings)
        scripts = (
            f'<script type="{kind}">{json.dumps(it).replace("<", SAFE)}</script>'
            for kind, it in ((VIEW, {"model_id": "it"}), (STATE, {"state": {"it": model}}))
        )
        named = f'data-program="{model["state"]["program"]}"'
        named += " data-asks" * asks(model["state"]["state"], model["state"]["setup"])
        return f'<div class="panel" data-prevent-swipe {named}>{"".join(scripts)}</div>'
    image = data["text/html"]
    source = re.search(r'src="(.*?)"', image)[1]
    dark = SVG_URL + quote(darkened(unquote(source.removeprefix(SVG_URL))), safe=" ='/:;,()")
    return f"{image}{image.replace(source, dark)}" if source.startswith(SVG_URL) else image


def place(state: dict, setup: dict, settings: Iterable[str]) -> None:
    """Set a panel's knobs, each to a value that it allows, and where a stage begins."""
    knobs = {knob["name"]: knob for knob in setup.get("knobs", ())}
    scenes = {scene["name"]: scene for scene in setup.get("scenes", ())}
    moved = {}
    for setting in settings:
        name, _, text = setting.partition("=")
        if setting == "open":
            setup["ask"] = None
        elif name == "scene" and scenes:
            if text not in scenes:
                raise SystemExit(f"{setting}: only {', '.join(scenes)}")
            state[name] = text
        elif name in setup.get("poses", ()):
            x, y, heading = map(float, text.split(","))
            setup["poses"][name] = state[name] = [x, y, math.radians(heading)]
        elif name not in knobs:
            raise SystemExit(f"{setting}: no knob {name!r}, only {', '.join(knobs)}")
        elif "choices" in knobs[name]:
            if text not in (allowed := [value for value, _ in knobs[name]["choices"]]):
                raise SystemExit(f"{setting}: only {', '.join(allowed)}")
            moved[name] = text
        elif knobs[name]["low"] <= float(text) <= knobs[name]["high"]:
            moved[name] = float(text)
        else:
            raise SystemExit(f"{setting}: not from {knobs[name]['low']} to {knobs[name]['high']}")
    state |= moved
    if scenes:  # a stage sets its knobs anew when a scene begins
        scene = scenes[state["scene"]]
        scene["to"] |= moved
        if "open" in settings:
            scene["ask"], scene["still"] = None, False


def asks(state: dict, setup: dict) -> bool:
    """Whether a panel begins with a question."""
    scenes = {scene["name"]: scene for scene in setup.get("scenes", ())}
    return bool(scenes[state["scene"]].get("ask") if scenes else setup.get("ask"))


def solved(number: str) -> str:
    """Return a chapter's exercises with their solutions."""
    text = "\n\n".join(it.source for it in chapter(number).cells if it.cell_type == "markdown")
    parts = re.split(r"^(?=### Exercise |## )", text, flags=re.MULTILINE)
    exercises = (part.replace("#### Solution\n", "") for part in parts if "### Exercise " in part)
    return "\n\n".join(FOLDED.sub(r"**\1.** \2", exercise) for exercise in exercises)


def write(path: Path, title: str, slides: list[Slide], number: int | None = None) -> None:
    """Write one deck."""
    pages = Environment(loader=FileSystemLoader(BOOK / "deck"), autoescape=True)
    written = MarkdownIt("commonmark", {"typographer": True})
    written.enable(["table", "replacements", "smartquotes"])
    written.use(dollarmath_plugin, renderer=formula, double_inline=True)
    written.core.ruler.push("stepwise", stepwise)
    pages.filters |= {"words": written.render, "line": written.renderInline, "wide": wide}
    page = pages.get_template("index.html.j2")
    path.write_text(page.render(title=title, slides=slides, number=number), encoding="utf-8")
    print(path, flush=True)


def stepwise(state: StateCore) -> None:
    """Let the items of some lists appear one by one."""
    for token in state.tokens:
        if token.type == "list_item_open" and token.markup in ("+", ")"):
            token.attrJoin("class", "fragment")


def formula(text: str, options: dict) -> str:
    """Return a formula as MathJax finds it, with fractions of letters in full size."""
    text = FRACTION.sub(r"\\dfrac", text)
    return html.escape(f"$${text}$$" if options["display_mode"] else f"${text}$")


def wide(slide: Slide) -> bool:
    """Whether a slide's picture takes the width, with words below it: it is made for a page's."""
    width = re.search(r'width="(\d+)"', slide.picture)
    return "panel" in slide.picture or (bool(width) and int(width[1]) >= 96 * NARROWEST)


def lay_out(output: Path) -> None:
    """Put what every deck loads into the folder."""
    install_javascript()
    copy_javascript(output / "vendor", NPM_FILES | {"reveal": REVEAL_FILES})
    bundle(output / "vendor" / "panels.js")
    for name in BESIDE:
        shutil.copy(BOOK / name, output)


def contents(decks: list[Path]) -> str:
    """The page that lists the decks and says which keys they know."""
    items = []
    for path in decks:
        title = re.search("<title>(.*?)</title>", path.read_text(encoding="utf-8"))[1]
        items.append(f'<li>{int(path.name[:2])}. <a href="{path.name}">{title}</a></li>')
    page = (BOOK / "deck" / "contents.html").read_text(encoding="utf-8")
    return page.replace("<!-- decks -->", "\n".join(items))


if __name__ == "__main__":
    parser = arguments(__doc__, BOOK / "_build" / "slides")
    text = "only these, such as 00 04"
    parser.add_argument("--chapters", nargs="+", default=[], metavar="NN", help=text)
    text = "the concept questions, into book/_build/questions by default"
    parser.add_argument("--questions", action="store_true", help=text)
    given = parser.parse_args()
    output = given.output
    if output == parser.get_default("output") and (given.questions or given.lecturer):
        output = BOOK / "_build" / ("questions" if given.questions else "lecturer/slides")
    if given.questions:
        questions(output.resolve())
    else:
        main(output.resolve(), given.chapters, given.lecturer)
