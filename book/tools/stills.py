"""Take the pictures that stand in place of the panels where nothing runs.

    python book/tools/stills.py          # of panels that have none, or whose program has changed
    python book/tools/stills.py --all    # of all panels anew, after a change of their common parts

Each panel that a chapter stores, and each that the book offers, is opened in Chromium; when all
that moves by itself has come to its end, its picture and its words become a file of
book/wmrbook/panel/stills, and part of the chapters that show it. The panels' shared modules
may change without a new picture: take all of them anew before a release.
"""

from __future__ import annotations

import argparse
import base64
import io
import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import build
import first_cell
from pdf import find_browser
from PIL import Image

from wmrbook import live, stages
from wmrbook.panel import Explorer, Front, MyRobot, kit, stills

ROOT = Path(__file__).resolve().parents[2]
VIEW = "application/vnd.jupyter.widget-view+json"
STATE = "application/vnd.jupyter.widget-state+json"
WIDTH, COLOURS = 700, 32
LARGEST = 40_000  # bytes of a picture
LASTS = 30_000  # ms after which whatever moves by itself has ended
HOST = "http://localhost/"
PAGE = """<!doctype html><meta charset="utf-8"><style>body {{ margin: 0 }} {face}</style>
<script id="jupyter-config-data" type="application/json">{{"baseUrl": "/", "wmrKit": "kit/"}}
</script><body><script data-start="">{widgets}</script>"""
SHOW = """traits => widgets.show(
    document.body.appendChild(document.createElement('div')), widgets.modelOf(traits))"""
SETTLED = """() => document.querySelector('.wmr:not([data-moving])')
    && !document.querySelector('.my-robot:not([data-done=true])')
    && !document.querySelector('.wmr-map:not([hidden]):not([data-finished=true])')"""
ALT = """() => [...document.querySelectorAll('.wmr canvas')].filter(it => it.checkVisibility())
    .map(it => it.getAttribute('aria-label')).filter(Boolean).join(' ')"""
# The sentences and questions in sight, with the numbers that can be typed, and the answers.
WORDS = """() => {
    const kinds = '.live-question, .live-answers, .live-sentence, .stage-words, .front-words, '
        + '.wmr-status';
    const seen = it => it.checkVisibility({ opacityProperty: true, visibilityProperty: true });
    const chips = it => [...it.querySelectorAll('button:not(.live-quiet)')]
        .map(chip => chip.textContent);
    const words = it => it.nodeType === 3 ? it.data : it.matches('button') ? ''
        : it.matches('select') ? it.selectedOptions[0].text : it.value
        ?? [...it.childNodes].map(words).join('');
    const sentence = it => `${words(it)} ${chips(it).length > 1 ? chips(it).join(' / ') : ''}`
        .replace(/\\s+/g, ' ').trim();
    return [...document.querySelectorAll(kinds)].filter(seen).map(sentence).filter(Boolean)
        .map(it => /[.?!]$/.test(it) ? it : `${it}.`).join(' ');
}"""

Shown = tuple[str, dict[str, Any], dict[str, Any]]  # a panel's program, state and setup


def main(anew: bool) -> None:
    """Take the pictures, drop those of no panel, and put them into the chapters."""
    wanted = {stills.digest(*it): it for it in (*stored(), *offered())}
    stills.FOLDER.mkdir(exist_ok=True)
    kept = {path.stem: path for path in stills.FOLDER.glob("*.html")}
    for name in kept.keys() - wanted.keys():
        kept[name].unlink()
    missing = {name: it for name, it in wanted.items() if anew or name not in kept}
    for name, text in taken(missing):
        (stills.FOLDER / f"{name}.html").write_text(f"{text}\n", encoding="utf-8")
        print(f"{missing[name][0]}: {len(text) / 1000:.0f} kB", flush=True)
    for path in chapters():
        before = path.read_text(encoding="utf-8")
        text = json.dumps(with_stills(json.loads(before)), ensure_ascii=False, indent=1) + "\n"
        if text != before:
            path.write_text(text, encoding="utf-8")
            print(f"{path.name}: stored", flush=True)


def chapters() -> list[Path]:
    """The book's notebooks, in order."""
    return sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))


def stored() -> Iterator[Shown]:
    """The panels of the chapters."""
    for path in chapters():
        for _, model in panels(json.loads(path.read_text(encoding="utf-8"))):
            yield model["program"], model["state"], model["setup"]


def offered() -> Iterator[Shown]:
    """The panels that a reader gets by their names."""
    named = ((module, name) for module in (live, stages) for name in module.__all__)
    made = [getattr(module, name)() for module, name in named if name not in module.PARTS]
    for it in (Explorer(), Explorer.circle(), Front(), MyRobot(), *made):
        yield it.program, it.state, it.setup


def panels(notebook: dict) -> Iterator[tuple[dict, dict]]:
    """The outputs that show a panel, each with what it stores of it."""
    states = notebook["metadata"].get("widgets", {}).get(STATE, {}).get("state", {})
    for cell in notebook["cells"]:
        for output in cell.get("outputs", ()):
            view = output.get("data", {}).get(VIEW, {})
            model = states.get(view.get("model_id"), {}).get("state", {})
            if "program" in model:
                yield output, model


def with_stills(notebook: dict) -> dict:
    """The notebook with the pictures of now, as a run would store them."""
    for output, model in panels(notebook):
        text = stills.still(model["program"], model["state"], model["setup"])
        if text:
            data = output["data"] | {"text/html": [text], "text/plain": [stills.words_of(text)]}
            output["data"] = dict(sorted(data.items()))
            traits = dict(sorted({**model, "_esm": kit.LOADER, "still": text}.items()))
            model.clear()
            model.update(traits)
    return notebook


def where() -> str:
    """Where the panel moves, as HTML; with the address of the book's pages, if there is one."""
    home = first_cell.address("Homepage")
    book = f' You can move it <a href="{home}">in the book</a> too.' if home else ""
    return f"{stills.RUN_IT}{book}"


def taken(wanted: dict[str, Shown]) -> Iterator[tuple[str, str]]:
    """Open the panels one after the other; yield the stills by the names of the panels."""
    if not wanted:
        return
    from playwright.sync_api import sync_playwright

    browser = find_browser()
    build.install_javascript()
    with tempfile.TemporaryDirectory() as folder:
        build.write_face(sheet := Path(folder) / "face.css")
        face = sheet.read_text(encoding="utf-8")
    widgets = (build.BOOK / "_static" / "widgets.js").read_text(encoding="utf-8")
    text = PAGE.format(face=face, widgets=widgets)

    def answer(route):
        path = urlsplit(route.request.url).path
        if path.startswith("/kit/"):
            route.fulfill(path=stills.KIT.parent / path[1:])
        else:
            route.fulfill(body=text, content_type="text/html")

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=browser, args=["--no-sandbox", "--disable-gpu"]
        )
        for name, (program, state, setup) in wanted.items():
            page = chromium.new_page(viewport={"width": WIDTH, "height": 900}, color_scheme="light")
            page.route(f"{HOST}**", answer)
            page.clock.install(time=0)
            page.goto(HOST)
            traits = {"program": program, "state": state, "setup": setup, "_esm": kit.LOADER}
            contract = kit.contract(state, setup)
            page.evaluate(SHOW, traits | {"contract": contract})
            page.evaluate("document.fonts.ready")
            page.wait_for_timeout(300)  # until it is seen, and begins to move
            page.clock.run_for(LASTS)
            page.wait_for_function(SETTLED, timeout=120_000)
            page.clock.run_for(1000)
            shot = page.locator(".wmr").first.screenshot()
            alt, words = page.evaluate(ALT), page.evaluate(WORDS)
            yield name, stills.written(packed(shot), alt, words or alt, where())
            page.close()
        chromium.close()


def packed(shot: bytes) -> str:
    """A picture as an address, in few colours."""
    image = Image.open(io.BytesIO(shot)).convert("RGB")
    for colours in (COLOURS, COLOURS // 2, COLOURS // 4):
        few = image.quantize(colours, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
        few.convert("RGB").save(file := io.BytesIO(), "WEBP", lossless=True, method=6)
        if len(file.getvalue()) <= LARGEST:
            return f"data:image/webp;base64,{base64.b64encode(file.getvalue()).decode()}"
    raise SystemExit(f"a picture has {len(file.getvalue())} bytes: at most {LARGEST} are allowed")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--all", action="store_true", help="of all panels anew")
    main(parser.parse_args().all)
