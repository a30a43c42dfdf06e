"""The examples of the library's pages, each by itself, as a reader copies it."""

import doctest
import re
from importlib import import_module

import pytest
from assignments import ROOT

import wmrlib as wmr

PAGES = sorted(path for path in (ROOT / "book").glob("api*.md") if path.stem != "api_robot")
EXAMPLE = re.compile(r"```python\n(.*?)```", re.DOTALL)
PRINTED = re.compile(r"^print\(.*\)\s+# (.*)$", re.MULTILINE)
INDEX = (ROOT / "book" / "api.md").read_text(encoding="utf-8")
WISHES = INDEX.partition("## I want")[2].partition("\n## ")[0].split("\n### ")


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_an_example_alone_prints_what_its_comment_says(path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    examples = EXAMPLE.findall(path.read_text(encoding="utf-8"))
    assert examples
    for code in examples:
        exec(code, {})
        assert capsys.readouterr().out.splitlines() == PRINTED.findall(code)


def test_every_wish_in_the_table_leads_to_its_example():
    table, *sections = WISHES
    anchors = re.findall(r"\]\(#([\w-]+)\) \|$", table, re.MULTILINE)
    titles = [section.partition("\n")[0] for section in sections]
    assert anchors == [title.lower().replace(" ", "-") for title in titles]
    assert len(anchors) == 7
    assert all(len(EXAMPLE.findall(section)) == 1 for section in sections)


@pytest.mark.parametrize("module", ["wmrbook.figures.paths", "wmrbook.chapters.routes"])
def test_the_examples_of_the_book_s_functions_on_these_pages_print_what_they_say(module):
    outcome = doctest.testmod(import_module(module))
    assert outcome.attempted > 0
    assert outcome.failed == 0


def test_every_function_and_type_that_the_library_offers_has_an_example():
    stub = (ROOT / "wmrlib" / "__init__.pyi").read_text(encoding="utf-8")
    offered = {name: getattr(wmr, name) for name in re.findall(r"from \.\w+ import (\w+)", stub)}
    called = [name for name, value in offered.items() if callable(value)]
    assert len(called) > 30
    assert [name for name in called if ">>> " not in offered[name].__doc__] == []


def test_the_pages_show_each_module_that_has_public_names_once():
    stub = (ROOT / "wmrlib" / "__init__.pyi").read_text(encoding="utf-8")
    shown = re.findall(r"library:: (\w+)", "".join(path.read_text("utf-8") for path in PAGES))
    assert sorted(shown) == sorted(set(re.findall(r"from \.(\w+) import", stub)))
