"""What a reader of the built book can't see or use on a page.

Code lines, formulas, tables and figures that are cut, and what axe-core finds in the light and in
the dark.
"""

from __future__ import annotations

from pathlib import Path

from build import MODULES, install_javascript

SIZES = ((390, 844), (1366, 768), (1920, 1080))
MEASURE = Path(__file__).with_suffix(".js").read_text(encoding="utf-8")
# Nothing may be seen halfway, such as a colour on its way from light to dark.
UNFOLD = """() => {
    document.querySelectorAll('article details').forEach(it => { it.open = true; });
    document.head.append(Object.assign(document.createElement('style'),
        {textContent: '* { transition: none !important; animation: none !important; }'}));
}"""
PANEL = '<script type="application/vnd.jupyter.widget-view+json">'
WIDER = """() => [...document.querySelectorAll('.figure-box')]
    .filter(it => it.scrollWidth > it.clientWidth + 1)
    .map(it => it.querySelector('img').alt.slice(0, 60))"""
# How a figure, with its buttons, stands to its caption and to the text around it, in pixels.
FIGURES = """() => [...document.querySelectorAll('.figure-caption')].flatMap(caption => {
    const cell = caption.previousElementSibling;
    const image = [...cell.querySelectorAll('.figure-box img')].find(it => it.checkVisibility());
    const bottom = Math.max(...[...cell.querySelectorAll('.figure-box, .figure-size, .wmr-control')]
        .filter(it => it.checkVisibility()).map(it => it.getBoundingClientRect().bottom));
    const figure = image.getBoundingClientRect(), words = caption.getBoundingClientRect();
    const below = Math.round(words.top - bottom), beside = Math.round(words.left - figure.left);
    const name = caption.textContent.slice(0, 12), wanting = Math.round(words.width - figure.width);
    return [
        [below < 0 || below > 24, `caption ${below} px below ${name}`],
        [Math.abs(beside) > 1, `caption ${beside} px beside ${name}`],
        [wanting > 1, `${name} ${wanting} px narrower than the text`],
    ].filter(([wrong]) => wrong).map(([, text]) => text);
})"""
FRAME = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
# What scrolls has been given a key, as the theme does 300 ms after the last change of the page;
# a live figure that is slow to find its headline changes it late.
REACHED = """() => [...document.querySelectorAll(
        'pre, .cell_output > .output, .jp-RenderedHTMLCommon, .pst-scrollable-table-container')]
    .every(it => it.tabIndex === 0 ||
        it.scrollWidth <= it.clientWidth && it.scrollHeight <= it.clientHeight)"""
# Else axe-core takes minutes: of the code tokens of a kind it sees the first, and no formulas,
# which have been looked at.
THIN = """() => {
    const seen = new Set();
    for (const token of document.querySelectorAll('pre span[class]:not(.line, a span)')) {
        if (seen.has(token.className)) token.replaceWith(...token.childNodes);
        seen.add(token.className);
    }
    document.querySelectorAll('pre').forEach(it => it.normalize());
    document.querySelectorAll('mjx-container').forEach(it => it.replaceWith('formula'));
}"""
ASK = """([root, only]) => axe.run(root,
    {resultTypes: ['violations'], preload: false, ...only}).then(
    it => it.violations.flatMap(rule => rule.nodes.map(
        node => [rule.id, node.target.join(' ')])))"""
CROWDED = """([root, least]) => [...document.querySelectorAll(`${root}, ${root} *`)]
    .filter(it => it.checkVisibility() && !it.closest('.wmr-aside')).filter(it => {
        const { left, right, width, height } = it.getBoundingClientRect();
        const small = it.matches('button, input, select') && Math.min(width, height) < least;
        return small || left < -1 || right > innerWidth + 1;
    }).map(it => it.outerHTML.slice(0, 90))"""


def crowded(page, root: str, least: int = 24) -> list[str]:
    """What sticks out of the window, and what is smaller than so many pixels and to be pressed."""
    return page.evaluate(CROWDED, [root, least])


def violations(page, root: str = "html", **only) -> list[tuple[str, str]]:
    """What axe-core, which npm fetches in a fresh clone, finds in a part of a page."""
    if not page.evaluate("'axe' in window"):
        install_javascript()
        page.add_script_tag(path=MODULES / "axe-core" / "axe.min.js")
    return page.evaluate(ASK, [root, only])


def misplaced(page, sizes=SIZES) -> list[str]:
    """Captions that do not stand right below their figures, and figures narrower than the text."""
    faults = []
    for width, height in sizes:
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_function("width => innerWidth === width", arg=width)
        page.evaluate(FRAME)
        faults += [f"{width}: {fault}" for fault in page.evaluate(FIGURES)]
    return faults


def of_page(page, sizes=SIZES, themes=("light", "dark")) -> list[tuple[str, str]]:
    """The faults of a page that is drawn, as pairs of kind and place; it is spoiled then."""
    faults = []
    page.evaluate(UNFOLD)
    for width, height in sizes:
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_function("width => innerWidth === width", arg=width)
        page.evaluate(FRAME)
        for kind, places in page.evaluate(MEASURE).items():
            faults += [(f"{kind}, {width}x{height}", place) for place in places]
        cut = f"figures that are not seen whole, {width}x{height}"
        faults += [(cut, place) for place in page.evaluate(WIDER)]
    page.wait_for_function(REACHED)
    page.evaluate(THIN)
    for theme in themes:
        only = {} if theme == themes[0] else {"runOnly": ["color-contrast"]}
        page.emulate_media(color_scheme=theme)
        page.evaluate(FRAME)
        faults += [(f"axe, {theme}: {rule}", at) for rule, at in violations(page, **only)]
    return faults
