r"""A Sphinx extension: plain text in the notebooks becomes anchors, numbers and links.

JupyterLab shows the notebooks too, so they can't hold Sphinx's own syntax.

- A displayed formula with ``\tag{4.2, paper 24}`` becomes the book's equation (4.2) and the home of
  the paper's (24).
- A bare ``(24)`` or ``(4.2)`` in a sentence becomes a link to that equation; an unknown number is a
  warning, and so an error.
- A paragraph that begins with a bold ``Figure 4.2.`` is the caption of the figure above it; on the
  book's own pages it is ``Figure 2.``
- A link to the DOI or the address of a work in references.bib becomes a link to its entry in the
  bibliography; so does a link to the bibliography whose text is "Torge and Mueller (2012)".
"""

from __future__ import annotations

import re
from pathlib import Path

from docutils import nodes
from pybtex.database import parse_file
from reference import ancestors
from sphinx.util import logging

TAG = re.compile(r"\\tag\{(?P<number>\d+\.\d+)(?:, (?P<relation>paper|corrects) (?P<paper>\d+))?\}")
# Not after a letter, as in f(2), nor a bracket that closes.
MENTION = re.compile(r"(?<![\w)\]])\((\d{1,2}|\d{1,2}\.\d{1,2})\)(?!\w)")
CAPTION = re.compile(r"Figure (\d+(?:\.\d+)?)\.")
CITED = "bibliography"
NO_SENTENCE = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.reference)
NO_SENTENCE += (nodes.title, nodes.raw, nodes.comment)

log = logging.getLogger(__name__)


def number_equations(app, doctree):
    """Give each tagged formula its anchors, and remember where they are."""
    places = equations(app.env)
    for block in doctree.findall(nodes.math_block):
        formula = block.astext().strip()
        tag = TAG.search(formula)
        if not tag:
            if r"\tag" in formula:
                log.warning(
                    "a tag is 4.2, or 4.2, paper 24, or 4.2, corrects 24; not as in %s",
                    formula,
                    location=block,
                )
            continue
        names = [tag["number"], *([tag["paper"]] if tag["relation"] == "paper" else [])]
        for name in names:
            if name in places:
                log.warning("equation (%s) is numbered twice", name, location=block)
            places[name] = app.env.docname
        block["ids"] = [anchor(name) for name in names]
        # Sphinx would put several lines into `split`, where no tag may stand.
        block["no-wrap"] = block["nowrap"] = True
        block.children = [nodes.Text(f"\\begin{{equation}}\n{formula}\n\\end{{equation}}")]


def mark_captions(app, doctree):
    """Give each figure's caption a class, for its looks, and an anchor."""
    for paragraph in doctree.findall(nodes.paragraph):
        label = next((child for child in paragraph.children if child.astext()), None)
        if isinstance(label, nodes.strong) and (number := CAPTION.fullmatch(label.astext())):
            paragraph["classes"].append("figure-caption")
            paragraph["ids"].append(f"figure-{number[1].replace('.', '-')}")


def link_mentions(app, doctree, docname):
    """Turn (24) and (4.2) in running text into links."""
    places = equations(app.env)
    for text in list(doctree.findall(nodes.Text)):
        if not MENTION.search(text) or any(isinstance(it, NO_SENTENCE) for it in ancestors(text)):
            continue
        parts, end = [], 0
        for mention in MENTION.finditer(text):
            if mention[1] not in places:
                log.warning(
                    "equation (%s) is nowhere in the book", mention[1], location=text.parent
                )
                continue
            page = app.builder.get_relative_uri(docname, places[mention[1]])
            address = f"{page}#{anchor(mention[1])}"
            link = nodes.reference("", mention[0], internal=True, refuri=address)
            parts += [nodes.Text(text[end : mention.start()]), link]
            end = mention.end()
        text.parent.replace(text, [*parts, nodes.Text(text[end:])])


def link_citations(app, doctree, docname):
    """Turn links to the works in references.bib into links to the bibliography."""
    works = cited_works(Path(app.confdir) / "references.bib")
    if docname == CITED:
        return
    page = app.builder.get_relative_uri(docname, CITED)
    for link in doctree.findall(nodes.reference):
        address, words = link.get("refuri", ""), re.findall(r"\w+", link.astext())
        name = f"{words[0]} {words[-1]}" if words and address == page else address
        if key := works.get(name):
            link["refuri"] = f"{page}#cite-{key}"
            link["internal"] = True


def cited_works(path: Path) -> dict[str, str]:
    """From the address of a work, its DOI's or its own, or else "Torge 2012", to its key."""
    entries = parse_file(path).entries
    names = {}
    for key, it in entries.items():
        name = f"{it.persons['author'][0].last_names[0]} {it.fields.get('year')}"
        doi = f"https://doi.org/{it.fields['doi']}" if "doi" in it.fields else ""
        names[doi or it.fields.get("url", name)] = key
    return names


def anchor(number: str) -> str:
    return f"equation-{number.replace('.', '-')}" if "." in number else f"paper-{number}"


def equations(env) -> dict[str, str]:
    """From an equation's number, ours or the paper's, to the page it is on."""
    if not hasattr(env, "book_equations"):
        env.book_equations = {}
    return env.book_equations


def forget(app, env, docname):
    env.book_equations = {name: place for name, place in equations(env).items() if place != docname}


def merge(app, env, docnames, other):
    theirs = {name: place for name, place in equations(other).items() if place in docnames}
    for name in equations(env).keys() & theirs:
        log.warning("equation (%s) is numbered on two pages", name)
    env.book_equations |= theirs


def setup(app):
    app.connect("doctree-read", number_equations)
    app.connect("doctree-read", mark_captions)
    app.connect("doctree-resolved", link_mentions)
    app.connect("doctree-resolved", link_citations)
    app.connect("env-purge-doc", forget)
    app.connect("env-merge-info", merge)
    return {"parallel_read_safe": True, "parallel_write_safe": True, "env_version": 2}
