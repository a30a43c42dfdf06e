"""A test whose tool is missing skips and says what to install; where CI is set, it fails."""

from types import SimpleNamespace

import pytest


@pytest.mark.parametrize(
    ("ci", "outcome"), [("", pytest.skip.Exception), ("true", pytest.fail.Exception)]
)
@pytest.mark.parametrize(
    ("marks", "fixtures", "install"),
    [
        (["compiler"], [], "apt install gcc"),
        (["npm", "compiler"], [], "apt install gcc"),
        (["npm"], [], "apt install npm"),
        ([], ["browser_page", "browser"], "apt install chromium"),
        ([], ["site"], "apt install npm"),
    ],
)
def test_a_missing_tool(monkeypatch, request, ci, outcome, marks, fixtures, install):
    plugins = request.config.pluginmanager.get_plugins()
    conftest = next(each for each in plugins if hasattr(each, "lacking"))
    monkeypatch.setattr(conftest, "command", lambda tool: None)
    monkeypatch.setenv("CI", ci)
    monkeypatch.delenv("BOOK_HTML", raising=False)
    item = SimpleNamespace(
        fixturenames=fixtures, iter_markers=lambda name: [pytest.mark.needs(*marks).mark]
    )
    with pytest.raises(outcome, match=f"needs .*{install}"):
        conftest.pytest_runtest_setup(item)
    monkeypatch.setattr(conftest, "command", lambda tool: "/usr/bin/it")
    conftest.pytest_runtest_setup(item)
