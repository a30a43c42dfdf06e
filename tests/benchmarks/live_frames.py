"""What moves in which chapter, and what each costs a frame: python tests/benchmarks/live_frames.py

A frame's own work is the time that the page's script takes to compute and to draw it, without the
browser's. Each control walks from end to end some times, and of each place the quickest frame
counts, so that neither a compiler that warms up nor another program does: the median of the places
of the dearest control, and the worst place of all. `ready` is the time from the module's text to
the first picture.
"""

from __future__ import annotations

import re
import statistics
import sys

from playwright.sync_api import sync_playwright
from timing import ROOT

from wmrbook import live

sys.path[:0] = [str(ROOT / "tests" / "browser"), str(ROOT / "book" / "tools")]
from conftest import FLAGS  # noqa: E402
from host import HOST, PAGE, TRAITS  # noqa: E402
from pdf import find_browser  # noqa: E402

STEPS, ROUNDS = 20, 3
# Counts what callbacks of frames take, from before the widget is there.
STOPWATCH = """() => {
    const next = window.requestAnimationFrame.bind(window);
    window.took = [];
    window.requestAnimationFrame = callback => next(now => {
        const begin = performance.now();
        callback(now);
        took.push(performance.now() - begin);
    });
}"""
MOUNT = """async traits => {
    const begin = performance.now();
    await mount(traits);
    while (!took.length) await new Promise(done => setTimeout(done));
    return performance.now() - begin;
}"""
WALK = """async ([knob, values, rounds]) => {
    const settled = () => new Promise(done => setTimeout(() => requestAnimationFrame(done), 20));
    const least = values.map(() => Infinity);
    for (let round = 0; round < rounds; round += 1) {
        for (const [place, value] of values.entries()) {
            took.length = 0;
            panel.set('state', { ...panel.get('state'), [knob]: value });
            await settled();
            least[place] = Math.min(least[place], took.reduce((sum, it) => sum + it, 0));
        }
    }
    return least;
}"""


def places() -> dict[str, list[str]]:
    """The chapters and pages that show each."""
    found: dict[str, list[str]] = {}
    for path in (*sorted(ROOT.glob("notebooks/*.ipynb")), *sorted(ROOT.glob("book/*.md"))):
        for name in {*re.findall(r"\blive\.([a-z_]+)\(", path.read_text(encoding="utf-8"))}:
            found.setdefault(name, []).append(path.name[:2] if path.name[0] in "01" else path.stem)
    return found


def main() -> None:
    where = places()
    print(
        f"{'':16}{'in':9}{'predict':9}{'median':>8}{'worst':>7} ms{'ready':>7} ms{'KB':>6}  moves"
    )
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=find_browser(), args=FLAGS)
        for name in sorted(set(live.__all__) - live.PARTS):
            thing = getattr(live, name)()
            traits = thing.get_state(TRAITS)
            traits["state"] = traits["state"] | {"guess": 0}  # open
            page = chromium.new_page(viewport={"width": 1366, "height": 768})
            page.goto(PAGE.as_uri())
            page.add_script_tag(content=HOST)
            page.evaluate(STOPWATCH)
            ready, walks = page.evaluate(MOUNT, traits), []
            for knob in thing.setup["knobs"]:
                if "choices" in knob:
                    values = [value for value, _ in knob["choices"]]
                else:
                    span = knob["high"] - knob["low"]
                    values = [knob["low"] + span * k / STEPS for k in range(STEPS + 1)]
                rounds = ROUNDS * max(STEPS // len(values), 1)  # else a choice of two stays cold
                walks.append(page.evaluate(WALK, [knob["name"], values, rounds]))
                page.evaluate("state => panel.set('state', state)", traits["state"])
            asked = thing.setup["ask"]
            dearest, worst = max(map(statistics.median, walks)), max(map(max, walks))
            print(
                f"{name:16}{' '.join(where.get(name, '-')):9}{asked['kind'] if asked else '-':9}"
                f"{dearest:8.2f}{worst:7.2f}   {ready:7.0f}   "
                f"{len(traits['_esm'] + traits['_css']) / 1000:6.0f}  "
                f"{', '.join(knob['name'] for knob in thing.setup['knobs'])}"
            )
            page.close()
        chromium.close()


if __name__ == "__main__":
    main()
