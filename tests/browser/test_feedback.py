"""What a student writes into a hand-in can't change what its page says, or what runs beside it."""

import base64
import copy
import re

import feedback
import nbformat
import pytest
from live import ROOT
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output, new_raw_cell

DONE = "document.documentElement.dataset.done=1"
SCRIPT = f"<script>{DONE}</script>"
EVENT = f'<img src="data:," onerror="{DONE}">'
HIDE = "<style>* { display: none !important }</style>"
OVER = '<div style="position: fixed; inset: 0; background: white; z-index: 9">Score: 11 / 11</div>'
META = '<meta http-equiv="refresh" content="0; url=data:text/html,gone">'
FRAME = f'<iframe srcdoc="{SCRIPT.replace("document", "parent.document")}"></iframe>'
LINK = f'<a id="click" href="javascript:{DONE}">click</a>'
FORM = '<form action="http://example.com"><input autofocus><button>send</button></form>'
BASE = '<base href="http://example.com/"><link rel="stylesheet" href="http://example.com/a.css">'
SVG = f'<svg xmlns="http://www.w3.org/2000/svg" onload="{DONE}">{SCRIPT}<rect/></svg>'
CLOSE = "</pre></div></section></main></body></html>" + OVER
HTML = [SCRIPT, EVENT, HIDE, OVER, META, FRAME, LINK, FORM, BASE, SVG, CLOSE]
MARKDOWN = [
    *HTML,
    f"[click](javascript:{DONE})",
    f"[click](java\tscript:{DONE}) <javascript:{DONE}>",
    f"[click][1]\n\n[1]: javascript:{DONE}",
    "![](http://example.com/seen.png)",
    f"```mermaid\n{SCRIPT}\n```\n\n```html\n{SCRIPT}\n```",
    f"$\\href{{javascript:{DONE}}}{{click}}$ $\\text{{{SCRIPT}}}$ $\\style{{position:fixed}}{{x}}$",
    r"$$\hspace{-90em}\rule{200em}{200em}\Huge{Score: 11 / 11}$$",
    f"$\\begin{{{SCRIPT}}}$ \\begin{{a}}{SCRIPT}\\end{{a}}",
    "# cell-1\n\n# top\n\n<a name=cell-1>\n\n| a |\n|--:|\n| b |",
    "\u202e11 / 11 :erocS\x1b[2J",
]
KINDS = [f"image/{kind}" for kind in ("svg+xml", "png", "jpeg")]
KINDS += [f"text/{kind}" for kind in ("html", "markdown", "latex", "plain")]
KINDS += [f"application/{kind}" for kind in ("javascript", "pdf", "vnd.jupyter.widget-view+json")]


def hostile() -> dict[str, nbformat.NotebookNode]:
    """Cells by what they try."""
    cells = {}
    for k, text in enumerate(MARKDOWN):
        cells[f"text {k}"] = new_markdown_cell(text)
        cells[f"raw {k}"] = new_raw_cell(text)
        cells[f"code {k}"] = new_code_cell(text)
    for k, text in enumerate(HTML):
        for kind in KINDS:
            data = {kind: text, "text/plain": "shown"}
            cells[f"{kind} {k}"] = new_code_cell(outputs=[new_output("display_data", data)])
        png, alt = {"image/png": f'iVBORw0KGgo="> {text}'}, {"image/png": {"alt": text}}
        outputs = [
            new_output("display_data", png, metadata=alt),
            new_output("stream", name=text, text=f"\x1b]8;;{text}\x07{text}"),
            new_output("error", ename=text, evalue=text, traceback=[f"\x1b[31m{text}"]),
        ]
        cells[f"picture {k}"] = new_code_cell(outputs=outputs)
    return cells


def notebook(cells) -> nbformat.NotebookNode:
    """A hand-in with a check that it does not pass and an answer, before and after such cells."""
    check = {"grade_id": "check", "grade": True, "solution": False, "score": 0.0, "points": 11.0}
    answer = {"grade_id": "why", "grade": False, "solution": True, "comment": "see **me**"}
    first = new_code_cell("check()", metadata={"nbgrader": check})
    last = new_code_cell("answer = 1", metadata={"nbgrader": answer})
    return new_notebook(cells=copy.deepcopy([first, *cells, last]))


def opened(page, tmp_path, hand_in) -> str:
    """Open the page of a hand-in; return what its head says, as it is seen there."""
    about = {"notebook": "ch01", "score": 0.0, "max_score": 11.0, "late_penalty": 0}
    path = tmp_path / "page.html"
    path.write_text(feedback.page(hand_in, about), encoding="utf-8")
    page.goto(path.as_uri())
    return page.evaluate(
        """() => {
            const { x, y, width, height } = document.querySelector('h1').getBoundingClientRect();
            const seen = document.elementFromPoint(x + width / 4, y + height / 2);
            return seen?.closest('h1')?.innerText;
        }"""
    )


def test_nothing_in_a_hand_in_acts_or_covers_what_its_page_says(browser_page, tmp_path):
    hand_in = notebook(hostile().values())
    for made in hand_in, feedback.harmless(copy.deepcopy(hand_in), ()):
        assert opened(browser_page, tmp_path, made) == "ch01 (Score: 0 / 11)"
        assert browser_page.locator("main a:not([href^=http])").count() or made is not hand_in
        for link in browser_page.locator("main a:not([href^=http])").all():
            link.click()
        browser_page.wait_for_timeout(200)
        assert browser_page.url.split("#")[0].endswith("page.html")
        assert not browser_page.evaluate("document.documentElement.dataset.done")
        active = "script, iframe, form, svg, base, [style], [onload]"
        assert not browser_page.locator(active).count()
        text = browser_page.inner_text("body")
        assert not re.search("[\x1b\u202e]", text)
        bar = browser_page.locator(".bar").first.inner_text()
        assert re.fullmatch(r"Check: check\s+Score: 0 / 11", bar)
        assert re.search(r"Comment:\s+see me", text)
    assert browser_page.troubles == []


@pytest.mark.parametrize("policy", [True, False])
def test_policy_and_rendering_each_hold_alone(browser_page, tmp_path, monkeypatch, policy):
    """With one of the two taken away, the other still holds."""
    if policy:
        monkeypatch.setattr(feedback, "_text", lambda source: source)  # as HTML, which it is
    else:
        template, style, _ = feedback._template()
        monkeypatch.setattr(feedback, "_template", lambda: (template, style, ""))
    cells = [new_markdown_cell(text) for text in (SCRIPT, EVENT, FRAME, LINK)]
    assert opened(browser_page, tmp_path, notebook(cells)) == "ch01 (Score: 0 / 11)"
    for link in browser_page.locator("main a:not([href^=http])").all():
        link.click()
    assert not browser_page.evaluate("document.documentElement.dataset.done")
    assert bool(browser_page.troubles) == policy  # it was tried, and refused
    browser_page.troubles.clear()


def test_a_page_shows_formulas_pictures_and_colours_without_a_script(browser_page, tmp_path):
    dot = base64.b64encode(ROOT.joinpath("book/explorer.png").read_bytes()).decode()
    drawing = '<svg xmlns="http://www.w3.org/2000/svg" width="30" height="20"><rect/></svg>'
    data = {"image/png": dot}, {"image/svg+xml": drawing}
    shown = new_code_cell("import math  # a", outputs=[new_output("display_data", x) for x in data])
    hand_in = notebook([shown, new_markdown_cell(r"$\frac{a}{2}$ and $\nothing$")])
    opened(browser_page, tmp_path, feedback.harmless(hand_in, ()))
    sizes = "[...document.images].map((it) => it.naturalWidth)"
    browser_page.wait_for_function(f"{sizes}.every((it) => it > 0)")
    assert browser_page.evaluate(sizes)[1] == 30
    fraction = browser_page.locator("mfrac").bounding_box()
    assert fraction["height"] > 1.3 * browser_page.locator("mfrac mn").bounding_box()["height"]
    assert browser_page.locator("code").all_inner_texts() == [r"\nothing"]
    keyword = browser_page.locator(".code .kn")
    assert keyword.evaluate("(it) => getComputedStyle(it).color") != "rgb(34, 34, 34)"


def test_what_is_stored_holds_nothing_that_acts_in_the_formgrader():
    stored = feedback.harmless(notebook(hostile().values()), ())
    sources = [cell.source for cell in stored.cells if cell.cell_type != "code"]
    assert not re.search(r"<[A-Za-z/!?]|\]\(|\\href", "".join(sources))
    data = [it.get("data", {}) for cell in stored.cells for it in cell.get("outputs", ())]
    assert {kind for each in data for kind in each} == {"text/plain", "text/html"}
    whole = [each["text/html"] for each in data if "text/html" in each]
    assert all(feedback.DRAWING.fullmatch(each) for each in whole)
    nbformat.validate(stored)
    kept = new_markdown_cell("<b>given</b>")
    (same,) = feedback.harmless(new_notebook(cells=[kept]), {kept.source}).cells
    assert same.source == "<b>given</b>"
