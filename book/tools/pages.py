r"""A Sphinx extension: what readers of the pages need and the theme leaves out.

- A line of code that is too long for its window goes on below, marked; see book.css.
- A figure is a file of its own, and a second one in the colours of the dark theme.
- Code of cells in a row that show nothing is folded once, with that of the next.
- A section that names a scene of its chapter's stage has it as a class, stage-NAME, for docking.js.
- What ipywidgets' `interact` shows stands still where no kernel runs.
- A chapter's title has its number, and before its first section stands how to run the chapter.
- The search shows what stands around the words found, from a file beside it: a page that is opened
  from the disk may not fetch another.
- What a screen reader would stumble over in the theme's own HTML is mended.
- Of the theme's 2,000 icons, 1.5 MB, the page loads those that it shows.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from contextlib import suppress
from pathlib import Path
from urllib.parse import unquote
from xml.etree import ElementTree

import first_cell
from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from pygments.formatters import HtmlFormatter
from python_cells import CHAPTER
from reference import ancestors
from sphinx.highlighting import PygmentsBridge

from wmrbook.figures.style import SVG_URL, darkened

FIGURE = re.compile(
    rf'<img alt="(?P<alt>[^"]*)" width="\d+" src="{re.escape(SVG_URL)}(?P<svg>[^"]*)"'
    r'(?: data-motion="(?P<motion>[^"]*)")?>'
)
GITHUB = "https://github.com/"
SHOWN = "application/vnd.jupyter.widget-view+json"
WIDGETS = "application/vnd.jupyter.widget-state+json"
TAG = re.compile(r"<[^>]+>")
MODEL = re.compile(r'(?<=")[0-9a-f]{32}(?=": \{"model_name)')
EMPTY = r"<th\b[^>]*>\s*(?:<p></p>)?\s*</th>"
MENDED = (  # what the theme writes, and what axe-core finds nothing in
    # Its name is what it shows, with the keys.
    (r'(<button class="btn search-button-field[^>]*) aria-label="Search"', r"\1"),
    (r'<summary aria-label="Toggle hidden content">', "<summary>"),
    (r'<div id="pst-primary-sidebar"', r'\g<0> role="region" aria-label="The book"'),
    (r'role="doc-biblioentry"', 'role="listitem"'),
    (rf"<thead>\s*<tr[^>]*>(?:\s*{EMPTY})+\s*</tr>\s*</thead>", ""),
    (EMPTY, "<td></td>"),
)
# The theme loads all that a search asks, for a search as you type that is off.
ASKED = re.compile(r'\s*<script src="[^"]*(?:searchtools|language_data|searchindex)\.js"></script>')
DESIGN = re.compile(
    r"<link[^>]*sphinx-design[^>]*>|<script[^>]*design-tabs[^>]*></script>", re.IGNORECASE
)
# An icon in the theme's script: name: [width, height, [other names], code, path].
ICON = re.compile(r'"?([\w-]+)"?:\[\d+,\d+,(\[[^\]]*\]),"[0-9a-f]+",(?:"[^"]*"|\[[^\]]*\])\],?')
STATES = re.compile(
    r'(?<=<script type="application/vnd.jupyter.widget-state\+json">)(.*?)(?=</script>)', re.DOTALL
)
VIEW = re.compile(
    r'<script type="application/vnd.jupyter.widget-view\+json">\s*(\{.*?\})\s*</script>', re.DOTALL
)
# The theme's skip link leads to the text; a second one leads to the first panel.
SKIP = '<a href="#main-content">Skip to main content</a>'
TO_PANEL = '<a href="#first-panel">Skip to the first moving picture</a>'
PANEL = '<div id="first-panel" tabindex="-1"></div>'
STILL = re.compile(r'<img alt="(?P<alt>[^"]*)" .*?src="data:image/webp;base64,(?P<picture>[^"]*)"')
# From a page's HTML to the words to be found, with the sections that results lead to.
ARTICLE = re.compile(r'<article class="bd-article">(.*?)</article>', re.DOTALL)
BLOCK_ENDS = re.compile(r"(?=</(?:p|li|dt|h\d|t[dh]|figcaption)>)")
EXPLAINED = re.compile(r"<strong>([^<]*)</strong>")  # a term stands bold where it is explained
UNSPOKEN = re.compile(  # code and printouts too: a search shows a sentence
    r'<(script|style|svg|summary|pre)\b.*?</\1>|<a class="headerlink".*?</a>'
    r'|<div class="[^"]*\bmath\b.*?</div>'
    r"|<(?!/?section\b)[^>]+>",
    re.DOTALL,
)
FORMULA = re.compile(r"\\\((.*?)\\\)", re.DOTALL)
JOINED = {"mfrac": "/", "msub": "_", "msup": "^"}
ACCENTS = {ord("˙"): "\u0307", ord("¨"): "\u0308"}  # over the letter before


class Lines(HtmlFormatter):
    """Each line of code is an element of its own that knows its indentation."""

    def wrap(self, source):
        return super().wrap((is_code, _line(text) if is_code else text) for is_code, text in source)


def _line(text: str) -> str:
    plain = TAG.sub("", text)
    indent = len(plain) - len(plain.lstrip(" "))
    style = f' style="--indent: {indent}"' if indent else ""
    return f'<span class="line"{style}>{text}</span>'


def _cell_of(output: nodes.Node) -> nodes.Element:
    """The cell that printed it."""
    return next(it for it in ancestors(output) if "cell" in it.get("classes", ()))


def widen(app, doctree):
    """Give a panel, as a wide table, all the width that there is.

    The theme's script then hides the table of contents, which the front page hasn't.
    """
    if app.env.docname == "index":
        return
    for output in doctree.findall(nodes.raw):
        if "jupyter.widget-view+json" in output.astext():
            _cell_of(output)["classes"].append("full-width")
    for cell in doctree.findall(nodes.container):
        if "tag_full-width" in cell["classes"]:
            cell["classes"].append("full-width")


def show_figures(app, doctree):
    """Give each figure of a cell two files, of which the theme shows one, and its words."""
    for output in list(doctree.findall(nodes.raw)):
        if not (figure := FIGURE.fullmatch(output.astext().strip())):
            continue
        svg = unquote(figure["svg"])
        name = hashlib.sha256(svg.encode()).hexdigest()[:12]
        images = []
        for theme, text in (("light", svg), ("dark", darkened(svg))):
            path = Path(app.srcdir, "_figures", f"{name}-{theme}.svg")
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
            image = nodes.image(uri=f"/_figures/{path.name}", alt=html.unescape(figure["alt"]))
            image["width"] = "100%"  # of the column of text
            image["classes"] = [f"only-{theme}", "no-scaled-link"]
            image["loading"] = "lazy"  # hardly ever where the theme hides it; see figures.js
            images.append(image)
        if figure["motion"]:  # the kit's player.js plays it
            motion = html.unescape(figure["motion"])
            motion = f'<script type="application/json">{motion}</script>'
            images.append(nodes.raw("", motion, format="html"))
        # In a box of its own, since it scrolls in a narrow window.
        output.replace_self(nodes.container("", *images, classes=["figure-box"]))


def join_code(app, doctree):
    """Fold a cell's code that shows nothing with the code of the cell below it."""
    for cell in list(doctree.findall(nodes.container)):
        below = cell.next_node(descend=False, siblings=True)
        kinds = [getattr(it, "attributes", {}).get("hide_mode") for it in (cell, below)]
        silent = len(cell) == 1 and "cell_input" in cell[0].get("classes", ())
        if silent and kinds == ["input", "input"] and not isinstance(below[-1], nodes.raw):
            below[0].insert(0, cell[0].children)
            cell.parent.remove(cell)


def prepare(app, docname, source):
    """Give a heading whose cell names a scene of the stage a class for it, and show `interact`."""
    if not CHAPTER.match(docname):
        return
    notebook = json.loads(source[0])
    models = notebook["metadata"].get("widgets", {}).get(WIDGETS, {}).get("state", {})
    for cell in notebook["cells"]:
        if name := cell["metadata"].get("stage"):
            cell["source"] = [f"{{.stage-{name}}}\n", *cell["source"]]
        for output in cell.get("outputs", ()):
            model = models.get(output.get("data", {}).get(SHOWN, {}).get("model_id"), {})
            if "widget-interact" in model.get("state", {}).get("_dom_classes", ()):
                del output["data"][SHOWN]  # without a kernel they stand still
                cell["outputs"].insert(0, _still_sliders(model["state"], models))
    source[0] = json.dumps(notebook)


def _still_sliders(box: dict, models: dict) -> dict:
    """The sliders of `interact`, as an output that shows where they stand."""
    names = (child.removeprefix("IPY_MODEL_") for child in box["children"])
    rows = []
    for slider in (models[name]["state"] for name in names):
        if "max" in slider:
            ends = " ".join(f'{end}="{slider[end]}"' for end in ("min", "max", "step", "value"))
            rows.append(
                f"<label>{slider['description']} "
                f'<input type="range" disabled {ends}> {slider["value"]:.2f}</label>'
            )
    text = f'<div class="still-sliders">{"".join(rows)}</div>'
    return {"output_type": "display_data", "metadata": {}, "data": {"text/html": [text]}}


def begin_chapter(app, doctree):
    """Number a chapter's title, and say below it how the chapter is run."""
    chapter = CHAPTER.match(app.env.docname)
    title = doctree.next_node(nodes.title)
    if not chapter or title is None:
        return
    title.insert(0, nodes.Text(f"{int(chapter[1])}. "))
    run_it = how_to_run(f"{app.env.docname}.ipynb", first_cell.address())
    below = title.parent.next_node(nodes.section, descend=True)  # the first screen is the stage's
    title.parent.insert(title.parent.index(below), nodes.raw("", run_it, format="html"))


def how_to_run(name: str, repository: str) -> str:
    """The sentence below a chapter's title; for a repository on GitHub, with a link to Colab."""
    colab = f"https://colab.research.google.com/github/{repository[len(GITHUB) :]}/blob/main/{name}"
    button = f'<a class="colab" href="{colab}">open it in Colab</a>, '
    return (
        f'<p class="run-it">Run it yourself: {button if repository.startswith(GITHUB) else ""}'
        f'<a href="../_sources/{name}" download>download this '
        f'chapter</a>, or <a href="../use.html#as-notebooks">open them all</a> with '
        f"<code>jupyter lab {name}</code>.</p>"
    )


def mend(app, exception):
    """Mend the pages that are written, and keep their words for the search."""
    if exception or app.builder.name != "html":
        return
    words, terms = {}, {}
    for name in (*sorted(app.env.found_docs), "genindex", "search"):
        path = Path(app.outdir, f"{name}.html")
        text = path.read_text(encoding="utf-8")
        for theirs, ours in MENDED:
            text = re.sub(theirs, ours, text)
        if name != "search":
            text = ASKED.sub("", text)
        if 'class="sd-' not in text:  # nothing here is sphinx-design's
            text = DESIGN.sub("", text)
        for count, model in enumerate(dict.fromkeys(MODEL.findall(text)), 1):  # named at random
            text = text.replace(model, f"widget-{count:03}")
        if VIEW.search(text):
            text = VIEW.sub(rf"{PANEL}\g<0>", text.replace(SKIP, SKIP + TO_PANEL), count=1)
        text = with_stills(text, Path(app.outdir), "../" * name.count("/"))
        path.write_text(text, encoding="utf-8")
        if name in app.env.found_docs:
            article = BLOCK_ENDS.sub("\n", re.sub(r"\s+", " ", ARTICLE.search(text)[1]))
            plain = FORMULA.sub(_in_letters, UNSPOKEN.sub("", article))
            terms[name] = re.sub(r"\s+", " ", " | ".join(EXPLAINED.findall(article))).lower()
            words[name] = re.sub(r"\s*\n\s*", "\n", re.sub(r" +", " ", plain))
    _thin_icons(Path(app.outdir))
    script = "".join(
        f"const {name} = {json.dumps(table, ensure_ascii=False)};\n"
        for name, table in {"PAGES": words, "TERMS": terms}.items()
    )
    Path(app.outdir, "_static", "words.js").write_text(script, encoding="utf-8")


def with_stills(text: str, site: Path, up: str) -> str:
    """Let the pictures of a page's panels be files, for a browser without JavaScript."""
    stills = {}

    def without(states: re.Match) -> str:
        stored = json.loads(states[0])
        for model, it in stored["state"].items():
            stills[model] = STILL.search(it["state"].pop("still", ""))
        return json.dumps(stored).replace("</", "<\\/")

    def pictured(view: re.Match) -> str:
        if not (still := stills.get(json.loads(view[1])["model_id"])):
            return view[0]
        picture = base64.b64decode(still["picture"])
        name = f"_images/still-{hashlib.sha256(picture).hexdigest()[:12]}.webp"
        (site / name).parent.mkdir(exist_ok=True)
        (site / name).write_bytes(picture)
        return f'{view[0]}<noscript><img alt="{still["alt"]}" src="{up}{name}"></noscript>'

    return VIEW.sub(pictured, STATES.sub(without, text))


def _in_letters(formula: re.Match) -> str:
    r"""A formula without TeX: 1/2, k_ρ and V̇ for \tfrac12, k_\rho and \dot V."""
    tex = html.unescape(formula[1]).replace("°", r"\text{°}").replace(r"\dots", r"\ldots")
    tex = re.sub(r"\\big\b", "", re.sub(r"(frac\s*)(\d)(\d)", r"\1{\2}{\3}", tex))
    with suppress(Exception):  # what docutils raises differs from one command to the next
        written = tex2mathml(tex).replace("&ApplyFunction;", " ")
        return html.escape(_plain(ElementTree.fromstring(written)))
    return ""


def _plain(part: ElementTree.Element) -> str:
    kind = part.tag.rpartition("}")[2]
    text = JOINED.get(kind, "").join(map(_plain, part)) or part.text or ""
    return f"√({text})" if kind == "msqrt" else text.translate(ACCENTS)


def _thin_icons(site: Path) -> None:
    """Leave in the theme's script those icons that a page or another script names."""
    scripts = site / "_static" / "scripts"
    icons = scripts / "fontawesome.js"
    others = (path for path in scripts.glob("*.js") if path != icons)
    texts = (path.read_text(encoding="utf-8") for path in (*site.rglob("*.html"), *others))
    used = {name for text in texts for name in re.findall(r"\bfa-([a-z0-9-]+)", text)}

    def kept_icon(icon: re.Match) -> str:
        return icon[0] if used & {icon[1], *re.findall(r"[a-z][\w-]*", icon[2])} else ""

    icons.write_text(ICON.sub(kept_icon, icons.read_text(encoding="utf-8")), encoding="utf-8")


def add_words(app, docname, template, context, doctree):
    """Load the words of all pages where they are searched; the front page has no side bar."""
    if docname == "index":
        context["theme_article_header_start"] = ["search-button-field.html"]
    if docname == "search":
        app.add_js_file("words.js")
        app.add_js_file("search.js")


def setup(app):
    PygmentsBridge.html_formatter = Lines
    for change in (show_figures, widen, begin_chapter):
        app.connect("doctree-read", change, priority=400)  # before Sphinx collects images, titles
    app.connect("source-read", prepare)
    app.connect("doctree-read", join_code, priority=410)  # after python_cells
    app.connect("html-page-context", add_words)
    app.connect("build-finished", mend)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
