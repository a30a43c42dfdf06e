"""The page that a student reads: points, hints and answers, and nothing that can act."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Container, Iterator
from contextlib import suppress
from functools import cache, lru_cache
from html import escape
from pathlib import Path
from typing import Any

import jinja2
from cells import visible
from docutils.utils.math.latex2mathml import tex2mathml
from markupsafe import Markup
from nbconvert.exporters import Exporter
from nbconvert.filters import strip_ansi
from nbconvert.filters.markdown_mistune import IPythonRenderer, MarkdownWithMath
from nbformat import NotebookNode
from nbformat.v4 import new_output
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer

TEMPLATES = Path(__file__).parent / "templates"
MOST = 20_000  # letters of a cell that is formatted, ten times that of a notebook; else it is shown
MOST_SHOWN = 50_000  # letters of an output
MOST_TEX = 1_000  # letters of a formula
IMAGES = {"image/png", "image/jpeg"}
# What acts in a Markdown text: tags, the targets of links, and what MathJax makes HTML of.
ACTIVE = re.compile(r"<(?=[A-Za-z/!?])|\](?=[(:\[])|\\(?=href|style|class|cssId|require)")
BASE64 = re.compile(r"[A-Za-z0-9+/]+={0,2}")
DRAWING = re.compile(r'<img alt="" src="data:image/svg\+xml;base64,[A-Za-z0-9+/]+={0,2}">')
STYLED = re.compile(r' style="[^"<>]*"')  # the page's policy allows its own style sheet alone


def harmless(ran: NotebookNode, given: Container[str]) -> NotebookNode:
    """Take out what would act on whoever opens a notebook, in nbgrader's formgrader too.

    given: the texts of the release, which stay as they are.
    """
    for cell in ran.cells:
        cell.pop("attachments", None)
        if cell.cell_type == "code":
            cell.outputs = [output for each in cell.outputs for output in _shown(each)]
        elif cell.source not in given:
            cell.source = ACTIVE.sub(r"\g<0> ", cell.source)
    return ran


def page(notebook: NotebookNode, about: dict[str, Any]) -> str:
    """Return the page, of a notebook whose metadata have score, points and comment.

    about: notebook (its name), score, max_score, late_penalty.
    """
    most = MOST if sum(len(cell.source) for cell in notebook.cells) < 10 * MOST else 0
    cells = [_cell(cell, most) | {"place": f"cell-{k}"} for k, cell in enumerate(notebook.cells)]
    template, style, policy = _template()
    return template.render(cells=cells, about=about, style=style, policy=policy)


class Page(Exporter):
    """The same page for nbgrader's own commands."""

    file_extension = ".html"
    output_mimetype = "text/html"

    def from_notebook_node(self, nb: NotebookNode, resources: Any = None, **kw: Any) -> tuple:
        nb, resources = super().from_notebook_node(nb, resources, **kw)
        return page(nb, resources["nbgrader"]), resources


@cache
def source() -> bytes:
    """The text of all that a page is made by."""
    return b"".join(path.read_bytes() for path in (Path(__file__), *sorted(TEMPLATES.iterdir())))


@cache
def _template() -> tuple[jinja2.Template, Markup, str]:
    """The template, its style sheet, and the policy that allows this and pictures only."""
    folder = jinja2.FileSystemLoader(TEMPLATES)
    environment = jinja2.Environment(loader=folder, autoescape=True, trim_blocks=True)
    style = (TEMPLATES / "feedback.css").read_text(encoding="utf-8")
    style += HtmlFormatter().get_style_defs("pre")
    known = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    policy = f"default-src 'none'; img-src data:; style-src 'sha256-{known}'; "
    policy += "base-uri 'none'; form-action 'none'"
    return environment.get_template("feedback.html.j2"), Markup(style), policy


def _cell(cell: NotebookNode, most: int) -> dict[str, Any]:
    """What the template shows of a cell."""
    about = cell.metadata.get("nbgrader", {})
    code = cell.cell_type == "code"
    body = f"<pre>{escape(visible(cell.source))}</pre>"
    if len(cell.source) < most:
        colours = PythonLexer(), HtmlFormatter(cssclass="code")
        body = highlight(visible(cell.source), *colours) if code else _text(cell.source)
    shown = [output for each in cell.get("outputs", ()) for output in _shown(each)]
    comment = _text(about["comment"]) if about.get("comment") else ""
    return {
        "id": about.get("grade_id", ""),
        "graded": about.get("grade"),
        "answer": about.get("solution"),
        "score": about.get("score"),
        "points": about.get("points"),
        "body": Markup(body),
        "comment": Markup(comment),
        "outputs": [Markup(_html(each)) for each in shown],
    }


def _shown(output: NotebookNode) -> Iterator[NotebookNode]:
    """An output as text or as a picture; nothing else is kept of it."""
    kind = output.output_type
    if kind == "stream":
        yield new_output("stream", name=output.name, text=_cut(output.text))
    elif kind == "error":
        trace = _cut("\n".join(map(str, output.traceback))).split("\n")
        yield new_output("error", ename=output.ename, evalue=_cut(output.evalue), traceback=trace)
    elif data := dict(_kept(output.data)):
        yield new_output(kind, data)


def _kept(data: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """The kinds of an output that are shown; a drawing becomes a picture, in which nothing acts."""
    for kind, value in data.items():
        if kind == "text/plain":
            yield kind, _cut(value)
        elif kind in IMAGES and BASE64.fullmatch(whole := "".join(str(value).split())):
            yield kind, whole
        elif kind == "image/svg+xml":
            drawn = base64.b64encode("".join(value).encode(errors="replace")).decode()
            yield "text/html", f'<img alt="" src="data:image/svg+xml;base64,{drawn}">'
        elif kind == "text/html" and DRAWING.fullmatch(value):
            yield kind, value


def _html(output: NotebookNode) -> str:
    """An output that is shown, in HTML."""
    data = output.get("data", {})
    if "text/html" in data:
        return data["text/html"]
    for kind in IMAGES & data.keys():
        return f'<img alt="" src="data:{kind};base64,{data[kind]}">'
    text = data.get("text/plain", output.get("text"))
    text = "\n".join(output.traceback) if text is None else text
    return f"<pre>{escape(visible(strip_ansi(text)))}</pre>"


def _cut(text: Any) -> str:
    text = str(text)
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}\n[... cut]"


def _text(source: str) -> str:
    """A Markdown text, with formulas in MathML, and without HTML of its own."""
    return STYLED.sub("", MarkdownWithMath(renderer=_Renderer()).render(visible(source)))


class _Renderer(IPythonRenderer):
    def __init__(self) -> None:
        super().__init__(True, allow_harmful_protocols=False, exclude_anchor_links=True)

    def block_code(self, code: str, info: str | None = None) -> str:
        return f"<pre>{escape(code)}</pre>"

    def image(self, text: str, url: str, title: str | None = None) -> str:
        return f"<em>{escape(text)}</em>"

    def inline_math(self, body: str) -> str:
        return _formula(body)

    def block_math(self, body: str) -> str:
        return _formula(body, block=True)

    def latex_environment(self, name: str, body: str) -> str:
        return _formula(f"\\begin{{{name}}}{body}\\end{{{name}}}", block=True)


@lru_cache(maxsize=1000)
def _formula(tex: str, block: bool = False) -> str:
    """A formula in MathML, which browsers draw themselves; or its TeX, if that is out of reach."""
    if len(tex) <= MOST_TEX:
        with suppress(Exception):  # what a formula raises depends on where it is wrong
            return tex2mathml(re.sub(r"\\dots\b", r"\\ldots", tex), as_block=block)
    return f"<code>{escape(tex)}</code>"
