"""A Sphinx extension: the API reference, made of docstrings, and the links to it.

- The directive ``library`` shows what `import wmrlib as wmr` offers from one module, in the order
  of its source, and ``robot`` what `import wmrrobot as wr` does. A page with them needs no change
  when a name is added or renamed. Each module of wmrlib has a page, ``api_geodesy`` and so on.
- A name in a sentence, such as ``wmr.simulate`` or ``simulate(start, ...)``, links to its entry,
  and so does each ``wmr.simulate`` in a code cell or an example.
"""

from __future__ import annotations

import inspect
import itertools
import re
from functools import cache
from importlib import import_module
from pathlib import Path

from docutils import nodes
from sphinx.pycode import ModuleAnalyzer
from sphinx.util.docutils import SphinxDirective

PAGES = {"wmrlib": "api", "wmrrobot": "api_robot"}
SHORT = {"wmr": "wmrlib", "wr": "wmrrobot"}
SHORT |= {"figures": "wmrbook.figures", "routes": "wmrbook.chapters.routes"}
SHORT |= {"symbolic": "wmrlib.symbolic"}
FIELDS = ("Parameters", "Attributes", "Raises")
NAME = re.compile(rf"(?:({'|'.join([*SHORT, *PAGES])})\.)?([A-Za-z_][\w.]*)(?:\(.*\))?", re.DOTALL)
# Code as Pygments marks it up: the module in an import, and wmr.simulate or paper.outdoor.
MODULE = re.compile(r'<span class="nn">(wmrlib|wmrrobot)(?:\.\w+)*</span>')
DOT = r'<span class="o">\.</span>'
MEMBER = re.compile(
    rf'<span class="n">({"|".join([*SHORT, "paper", "estimation"])})</span>'
    rf'{DOT}<span class="n">(\w+)</span>(?:{DOT}<span class="n">(\w+)</span>)?'
)


@cache
def homes(package: str) -> dict[str, str]:
    """The module of each name that a package offers, as its stub has it."""
    file = import_module(package).__file__
    stub = Path(file).with_name("__init__.pyi").read_text(encoding="utf-8")
    return {name: module for module, name in re.findall(r"from \.(\w+) import (\w+) as", stub)}


class Library(SphinxDirective):
    """``library:: geodesy`` gives an entry to each of wmrlib's names that are at home there."""

    required_arguments = 1
    package = "wmrlib"

    def run(self) -> list[nodes.Node]:
        (home,) = self.arguments
        module = import_module(f"{self.package}.{home}")
        names = [name for name in vars(module) if homes(self.package).get(name) == home]
        names.sort(key=lambda name: made_elsewhere(module, name))
        entries = (entry(self.package, module, name) for name in names)
        return self.parse_text_to_nodes("\n\n".join(entries))


class RobotsLibrary(Library):
    """``robot:: drive``, likewise of wmrrobot."""

    package = "wmrrobot"


def made_elsewhere(module, name: str) -> bool:
    """Whether a module only passes a name on; such names come last."""
    return getattr(getattr(module, name), "__module__", module.__name__) != module.__name__


def entry(package: str, module, name: str) -> str:
    """The autodoc directive of a name; a constant's text is in the source only."""
    value, name_there = getattr(module, name), f"{package}.{name}"
    if inspect.isclass(value):
        return f".. autoclass:: {name_there}\n   :members:"
    if callable(value):
        return f".. autofunction:: {name_there}"
    lines = ModuleAnalyzer.for_module(module.__name__).find_attr_docs()["", name]
    return f".. py:data:: {name_there}\n   :value: {value!r}\n\n   " + "\n   ".join(lines)


def skip_fields(app, kind, name, value, skip, options):
    """Leave out the fields of a NamedTuple: its docstring describes them."""
    return True if type(value).__name__ == "_tuplegetter" else None


def keep_bars(app, kind, name, value, options, lines):
    """Let |v| be an absolute value, and not one of reStructuredText's substitutions."""
    lines[:] = [line if "``" in line else line.replace("|", r"\|") for line in lines]


def link_names(app, doctree, docname):
    """Turn the names in sentences into links, and a docstring's other `names` into code."""
    for name in [*doctree.findall(nodes.literal), *doctree.findall(nodes.title_reference)]:
        parents = (nodes.title, nodes.reference, nodes.raw)
        if any(isinstance(parent, parents) for parent in ancestors(name)):
            continue
        match = NAME.fullmatch(name.astext())
        code = nodes.literal("", name.astext())
        if match and (address := address_in(app, docname, match[1], match[2])):
            code = nodes.reference("", "", code, refuri=address, internal=True)
        name.replace_self(code)


def split_fields(app, what, name, obj, options, lines):
    """Give "dt : float, s" two lines, name and text: napoleon would take one line for a type."""
    split, section = [], ""
    for line, below in itertools.zip_longest(lines, lines[1:], fillvalue=""):
        section = line if below.startswith("---") else section
        field, colon, text = line.partition(" : ")
        cut = colon and not line.startswith(" ") and section in FIELDS
        split += [field, f"    {text}"] if cut else [line]
    lines[:] = split


def link_code(app, docname, template, context, doctree):
    """Turn the library's names in code cells into links, and each import into one to the page."""

    def link(code: re.Match) -> str:
        package = code[1] if code[1] in SHORT else None
        names = [name for name in code.groups() if name and name != package]
        for count in (2, 1):
            if names and (address := address_in(app, docname, package, ".".join(names[:count]))):
                return f'<a href="{address}">{code[0]}</a>'
        return code[0]

    def link_module(code: re.Match) -> str:
        page = app.builder.get_relative_uri(docname, PAGES[code[1]])
        return f'<a href="{page}">{code[0]}</a>'

    if "body" in context:
        body = context["body"]
        if not docname.startswith(tuple(PAGES.values())):  # there, an import is nothing to look up
            body = MODULE.sub(link_module, body)
        context["body"] = MEMBER.sub(link, body)


def address_in(app, docname: str, package: str | None, name: str) -> str:
    """Where a name of a package has its entry, of either package if it is None."""
    packages = [SHORT.get(package, package)] if package else PAGES
    addresses = (address_of(app, docname, f"{package_name}.{name}") for package_name in packages)
    return next(filter(None, addresses), "")


def address_of(app, docname: str, name: str) -> str:
    """Where a name has its entry, seen from a page, or an empty string."""
    target = app.env.domains.python_domain.objects.get(name)
    if not target:
        return ""
    address = f"{app.builder.get_relative_uri(docname, target.docname)}#{target.node_id}"
    return address[address.rindex("#") :] if address.startswith("#") else address  # one page


def ancestors(node: nodes.Node):
    while node.parent is not None:
        node = node.parent
        yield node


def setup(app):
    app.setup_extension("sphinx.ext.autodoc")
    app.setup_extension("sphinx.ext.napoleon")
    app.add_directive("library", Library)
    app.add_directive("robot", RobotsLibrary)
    app.connect("autodoc-skip-member", skip_fields)
    app.connect("autodoc-process-docstring", keep_bars)
    app.connect("autodoc-process-docstring", split_fields, priority=400)  # before napoleon
    app.connect("doctree-resolved", link_names)
    app.connect("html-page-context", link_code)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
