"""What moves in the text keeps its size, fits a screen, and has sliders that a hand can hold.

All live figures are shown in one page, each in a frame of its own width.
"""

from __future__ import annotations

import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from host import HOST, TRAITS, mounted, served

from wmrbook import live
from wmrbook.panel import Explorer

NAMES = sorted(set(live.__all__) - live.PARTS)
DESK, TELEPHONE, BAR = (1366, 768), (390, 844), 56  # px; BAR, the head of the pages
WIDTHS = 1050, 930, 700  # px, of the text, of JupyterLab, and of the text beside a margin
HIGHEST, LONG = 640, 240  # px, of a panel and of its sliders
SHOW = """async all => {
    document.head.insertAdjacentHTML('beforeend', '<link rel=stylesheet href=/kit/panel.css>');
    globalThis.wmrPanels = {};
    await Promise.all(all.map(async ([, { program }]) => {
        wmrPanels[program] = (await import(`/kit/${program}.js`)).default;
    }));
    for (const [name, traits] of all) {
        const place = document.body.appendChild(document.createElement('div'));
        place.className = 'place';
        place.dataset.name = name;
        const inner = place.appendChild(document.createElement('div'));
        await widgets.show(inner, widgets.modelOf(traits));
    }
    document.head.insertAdjacentHTML('beforeend', '<style>' +
        '.place { width: var(--width); margin-bottom: 20px; }</style>');
    window.frames = async count => {
        for (let k = 0; k < count; k += 1) await new Promise(done => requestAnimationFrame(done));
    };
    window.box = it => it.getBoundingClientRect();
    window.each = found => Object.fromEntries([...document.querySelectorAll('.place')]
        .map(it => [it.dataset.name, found(it.querySelector('.wmr'))]));
}"""
WIDTH = """async width => {
    document.body.style.setProperty('--width', width);
    await frames(3);
    for (let k = 0; k < 600 && document.querySelector('.live:not([data-settled])'); k += 1)
        await frames(1);
    await frames(3);
}"""
HEIGHTS = "() => each(it => box(it).height)"
PICTURES = (
    "() => each(it => [...it.querySelectorAll('canvas')].map(a => [box(a).width, box(a).height]))"
)
SLIDERS = (
    "() => each(it => [...it.querySelectorAll('.live-rows .wmr-slider')].map(a => box(a).width))"
)
# Of the picture with the fewest: pixels of a colour that axes, their titles and a lawn do not have.
MARKS = """() => each(it => Math.min(...[...it.querySelectorAll('canvas')].map(a => {
    const { data } = a.getContext('2d').getImageData(0, 0, a.width, a.height);
    let marks = 0;
    for (let k = 0; k < data.length; k += 4) {
        const blueish = data[k + 2] - data[k];
        if (Math.abs(blueish) > 40 || (blueish > 8 && data[k] > 200)) marks += 1;
    }
    return marks;
})))"""
ANSWER = """async k => {
    for (const chips of document.querySelectorAll('.live[data-open=false] .live-answers'))
        chips.querySelectorAll('button:not(:disabled)')[k]?.click();
    await frames(3);
}"""
AGAIN = """async () => {
    for (const again of document.querySelectorAll('.live[data-open=true] .live-again'))
        again.click();
    await frames(3);
}"""
# From the top of the main picture to the foot of the last slider, and whether that is below it.
TOGETHER = """() => each(it => {
    const scene = box(it.querySelector('.live-main, .wmr-plane'));
    const sliders = [...it.querySelectorAll('.live-rows .wmr-slider, .wmr-gain .wmr-slider')]
        .filter(a => a.checkVisibility()).map(box);
    return [Math.max(...sliders.map(a => a.bottom)) - scene.top,
        Math.min(...sliders.map(a => a.top)) - scene.bottom];
})"""


@pytest.fixture(scope="module")
def figures(module_page):
    """A page with all live figures; each test leaves them as they were opened."""
    page = module_page
    page.troubles.clear()
    page.set_viewport_size({"width": DESK[0], "height": DESK[1]})
    page.emulate_media(reduced_motion="reduce")
    served(page)
    page.add_script_tag(content=HOST)
    things = {name: getattr(live, name)() for name in NAMES}
    page.evaluate(SHOW, [(name, it.get_state(TRAITS)) for name, it in things.items()])
    page.asks = {name: it.setup["ask"] for name, it in things.items() if it.setup["ask"]}
    yield page
    page.assert_quiet()


def assert_keeps_its_size(page) -> None:
    before, options = page.evaluate(HEIGHTS), [len(it["options"]) for it in page.asks.values()]
    for k in range(max(options) + 1):  # and "Just show me"
        page.evaluate(ANSWER, k)
        for act in ("an answer", "trying again"):
            after = page.evaluate(HEIGHTS)
            changed = {it: after[it] - before[it] for it in NAMES}
            assert not {it: by for it, by in changed.items() if abs(by) > 0.01}, act
            page.evaluate(AGAIN)


@pytest.mark.parametrize("width", WIDTHS)
def test_a_figure_fits_the_screen_and_keeps_its_size_at_each_answer(figures, width):
    figures.evaluate(WIDTH, f"{width}px")
    assert max(figures.evaluate(HEIGHTS).values()) <= HIGHEST
    assert min(min(them) for them in figures.evaluate(SLIDERS).values()) >= LONG
    for name, pictures in figures.evaluate(PICTURES).items():
        most = 2 if len(pictures) == 1 else 1.5  # on its own a map has its content's shape
        for across, high in pictures:
            assert 1 / 1.51 <= across / high <= most + 0.01, name
    if width != 930:  # between the others
        assert_keeps_its_size(figures)


def test_no_picture_is_empty_before_an_answer(figures):
    figures.evaluate(WIDTH, "1050px")
    assert not {name: few for name, few in figures.evaluate(MARKS).items() if few < 60}


def test_on_a_telephone_sliders_and_main_picture_are_on_one_screen_which_keeps_its_size(figures):
    figures.set_viewport_size({"width": TELEPHONE[0], "height": TELEPHONE[1]})
    figures.evaluate(WIDTH, "auto")
    for name, (together, below) in figures.evaluate(TOGETHER).items():
        assert together <= TELEPHONE[1] - BAR, name
        assert below >= 0, name
    assert_keeps_its_size(figures)
    figures.set_viewport_size({"width": DESK[0], "height": DESK[1]})


def test_an_arrow_that_is_hardly_turned_is_wrong(figures):
    turns = [name for name, ask in figures.asks.items() if ask["kind"] == "turn"]
    assert turns
    for name in turns:
        it = figures.locator(f".place[data-name={name}]")
        arrow = it.get_by_role("slider", name="the angle of the arrow")
        arrow.press("ArrowRight")
        it.get_by_role("button", name="That's it", disabled=False).press("Enter")
        assert it.locator(".live-verdict:visible").inner_text().startswith("No: "), name
        it.get_by_role("button", name="Try again").press("Enter")


def test_an_arrow_begins_two_steps_of_a_key_beside_any_answer(figures):
    close = """async () => {
        const { TOLERANCE, begunAt } = await import('/kit/gate.js');
        const { wrap } = await import('/kit/model.js');
        return Array.from({ length: 721 }, (_, k) => (k - 360) * Math.PI / 360).filter(key =>
            Math.abs(wrap(begunAt(key) - key)) < TOLERANCE + Math.PI / 18);
    }"""
    assert figures.evaluate(close) == []


def test_the_explorer_fits_the_screen_and_its_gains_are_long_and_below_the_picture(emptied_page):
    widths = "() => [...document.querySelectorAll('.wmr-gain .wmr-slider')]"
    widths += ".filter(it => it.checkVisibility()).map(it => it.clientWidth)"
    resize = "width => { document.querySelector('.wmr').parentElement.style.width = width; }"
    for explorer in (Explorer(), Explorer.circle(law="kanayama")):
        panel = mounted(emptied_page, explorer, *DESK)
        for width in WIDTHS:
            emptied_page.evaluate(resize, f"{width}px")
            panel.settled()
            assert emptied_page.locator(".wmr").bounding_box()["height"] <= HIGHEST
            assert len(lengths := emptied_page.evaluate(widths)) == 3
            assert min(lengths) >= LONG
    mounted(emptied_page, Explorer(), *TELEPHONE)
    boxes = [emptied_page.locator(it) for it in (".wmr-plane", ".wmr-gain >> nth=2")]
    scene, last = (it.bounding_box() for it in boxes)
    assert last["y"] + last["height"] - scene["y"] <= TELEPHONE[1] - BAR
    assert last["y"] >= scene["y"] + scene["height"] - 1
    assert min(emptied_page.evaluate(widths)) > 0.55 * scene["width"]
