"""The kit: ES modules that panels are made of, and how a page gets at them.

A notebook stores of a panel the name of its program, the contract of what it stores, what it stores
and a still picture; not the program. `loader.js` finds it in the page, where the book's own pages
and slides have all of the kit as one script, on a Jupyter server that says where it serves the kit,
or else in the kernel, which sends the modules.
"""

from __future__ import annotations

import hashlib
import html
import json
from pathlib import Path
from typing import Any

import anywidget
import traitlets

from wmrbook.panel import stills
from wmrbook.panel.derived import Derived
from wmrbook.panel.stills import KIT

STYLE = KIT / "panel.css"
LOADER = Path(__file__).with_name("loader.js").read_text(encoding="utf-8")


def programs() -> list[str]:
    """The names of the programs: the panels', each live figure's and each stage's."""
    return [
        "explorer",
        "front",
        "my_robot",
        *(
            f"{path.parent.name}/{path.stem}"
            for folder in ("live", "stages")
            for path in sorted(KIT.glob(f"{folder}/*.js"))
        ),
    ]


def sources(program: str) -> dict[str, str]:
    """The texts that a page needs for a program, by their paths in the kit."""
    paths = [*sorted(KIT.glob("*.js")), KIT / f"{program}.js", STYLE]
    return {path.relative_to(KIT).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def contract(state: dict[str, Any], setup: dict[str, Any]) -> str:
    """A hash of what is stored by which names: a program that knows others can't show it."""
    names = [sorted(state), sorted(setup), sorted(setup.get("data", ()))]
    return hashlib.sha256(json.dumps(names).encode()).hexdigest()[:8]


class Panel(anywidget.AnyWidget):
    """A widget whose program is a module of the kit, by its name there."""

    _esm = traitlets.Unicode(LOADER).tag(sync=True)
    program = traitlets.Unicode().tag(sync=True)
    contract = traitlets.Unicode().tag(sync=True)
    state = traitlets.Dict().tag(sync=True)
    setup = traitlets.Dict().tag(sync=True)
    still = traitlets.Unicode().tag(sync=True)

    def __init__(self, program: str, state: dict[str, Any], setup: dict[str, Any]):
        stored = {"contract": contract(state, setup), "state": state, "setup": setup}
        super().__init__(program=program, **stored)
        self.add_class("jupyter-widgets")
        self.on_msg(self._answer)

    def _repr_mimebundle_(self, **kwargs: Any) -> tuple[dict, dict]:
        """The panel, and what stands in its place where it can't run: see `stills`."""
        self.still = stills.still(self.program, self.state, self.setup)
        data, metadata = super()._repr_mimebundle_(**kwargs)
        there = self.still or f"<p>{html.escape(repr(self))}</p><p>{stills.RUN_IT}</p>"
        return data | {"text/html": there, "text/plain": stills.words_of(there)}, metadata

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_") and not hasattr(type(self), name):
            kind = type(self).__name__
            raise AttributeError(f"{kind} has no attribute {name!r}; you can set {self.settable()}")
        super().__setattr__(name, value)

    def settable(self) -> str:
        """The names of what can be set, for messages."""
        names = [name for name, it in self._derived().items() if not it.read_only]
        return ", ".join([*names, "layout"])

    @classmethod
    def _derived(cls) -> dict[str, Derived]:
        return {name: it for name, it in cls.class_traits().items() if isinstance(it, Derived)}

    def _answer(self, _, content: Any, buffers: Any) -> None:
        if content == "kit":
            self.send(sources(self.program))
