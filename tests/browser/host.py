"""A page with an Explorer's panel and nothing else."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from urllib.parse import urlsplit

from wmrbook.panel.kit import KIT, sources

PARTS = (Path(__file__).parents[2] / "book/_static/widgets.js", Path(__file__).with_name("host.js"))
HOST = "\n".join(part.read_text(encoding="utf-8") for part in PARTS)
PAGE = Path(__file__).with_suffix(".html")
URL = "http://localhost/"
SETTLED = """async () => {
    const frames = () => new Promise(done =>
        requestAnimationFrame(() => requestAnimationFrame(done)));
    const begin = performance.now();
    await frames();
    while (document.querySelector('[data-moving]')) await frames();
    while (panel.get('state').view === 'gains'
        && document.querySelector('.wmr-map').dataset.finished !== 'true') {
        if (performance.now() > begin + 30e3) throw new Error('the map is not done');
        await frames();
    }
}"""
PUT = """([name, value]) => {
    const row = document.querySelector(`[data-control=${name}]`);
    if (row.hidden) throw new Error(`${name} is hidden`);
    const input = row.querySelector('select, .wmr-typed');
    input.value = value;
    if (input.value !== String(value)) throw new Error(`${name} does not offer ${value}`);
    input.dispatchEvent(new Event('change'));
}"""
SET = "changes => panel.set('state', { ...panel.get('state'), ...changes })"
PIXELS = """() => [...document.querySelectorAll('.wmr canvas:not([hidden])')]
    .map(each => each.toDataURL())"""
COLOURS = """() => [...document.querySelectorAll('.wmr canvas:not([hidden])')].map(each => {
    const image = each.getContext('2d').getImageData(0, 0, each.width, each.height);
    return new Set(new Uint32Array(image.data.buffer)).size;
})"""
FIGURES = """() => Object.fromEntries([...document.querySelectorAll('[data-figure]')]
    .map(it => [it.dataset.figure, it.children[1].textContent]))"""
RESULTS = """() => JSON.stringify(document.querySelector('.live, .my-robot').found,
    (_, it) => ArrayBuffer.isView(it) ? Array.from(it) : it)"""
TRAITS = ("program", "contract", "state", "setup", "_esm")


def served(page, url=URL):
    """Open an empty page of a server that has the kit too."""

    def answer(route):
        path = urlsplit(route.request.url).path
        route.fulfill(path=KIT.parent / path[1:] if path.startswith("/kit/") else PAGE)

    page.goto("about:blank")  # forgets what was there before
    page.unroute(f"{URL}**")
    page.route(f"{URL}**", answer)
    page.goto(url)


def mounted(page, explorer, width=1280, height=720, url=URL, texts=None, motion="reduce"):
    """Show the explorer in the page and return the Panel that drives it, once it is drawn.

    Its program are the `texts`, by default those that a kernel sends; `motion` is what the reader
    wants of things that move by themselves, "reduce" or "no-preference".
    """
    page.set_viewport_size({"width": width, "height": height})
    page.emulate_media(reduced_motion=motion)
    served(page, url)
    page.add_script_tag(content=HOST)
    given = [explorer.get_state(TRAITS), texts or sources(explorer.program)]
    page.evaluate("([traits, texts]) => mount(traits, texts)", given)
    return Panel(page).settled()


class Panel:
    """The panel in the page, and hands for it."""

    def __init__(self, page):
        self.page = page

    def settled(self):
        """Wait until everything is drawn, the map included."""
        self.page.evaluate(SETTLED)
        return self

    def put(self, name, value):
        """Move a slider or a menu, as a hand does: by its input."""
        self.page.evaluate(PUT, [name, value])
        return self.settled()

    def set(self, **values):
        """Change the state, as Python does."""
        self.page.evaluate(SET, values)
        return self.settled()

    def state(self) -> dict:
        return self.page.evaluate("() => panel.get('state')")

    def get(self, name):
        return self.state().get(name)

    def control(self, name):
        return self.reached(self.page.locator(f"[data-control={name}]"))

    def slider(self, name):
        return self.control(name).locator(".wmr-slider")

    def reached(self, locator):
        """What may be behind "More", once that is open."""
        locator.evaluate("it => it.closest('.wmr-more')?.setAttribute('open', '')")
        return locator

    def picture(self) -> str:
        """A fingerprint of the pixels of the canvases that are shown."""
        return hashlib.sha256("".join(self.page.evaluate(PIXELS)).encode()).hexdigest()

    def colours(self) -> list[int]:
        """How many colours each canvas that is shown has: a blank one has one."""
        return self.page.evaluate(COLOURS)

    def figures(self) -> dict[str, str]:
        return self.page.evaluate(FIGURES)

    def results(self) -> dict:
        """What the panel has found for its state."""
        return json.loads(self.page.evaluate(RESULTS))

    def status(self) -> str:
        return self.page.locator(".wmr-status").inner_text()

    def troubled(self) -> bool:
        return self.page.locator(".wmr-trouble").count() > 0

    def click(self, act: str):
        self.reached(self.page.locator(f"[data-do={act}]")).click()
        return self.settled()

    def press(self, name: str):
        """Press the button of this name."""
        self.page.get_by_role("button", name=name).click()
        return self.settled()

    def type(self, field, text: str, done: str = "Tab"):
        """Type into a field, and leave it."""
        field.fill(text)
        field.press(done)
        return self.settled()

    def handle(self, pose: str, part: str):
        return self.page.locator(f".wmr-handle[data-pose={pose}][data-part={part}]")

    def drag(self, locator, across: float, down: float, steps: int = 5):
        box = locator.bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        self.page.mouse.move(x, y)
        self.page.mouse.down()
        self.page.mouse.move(x + across, y + down, steps=steps)
        self.page.mouse.up()
        return self.settled()
