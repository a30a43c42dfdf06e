"""The panel's picture as a widget: its traits, and the JavaScript that draws it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import anywidget
import traitlets

from wmrlib._checks import refusal
from wmrlib.explorer.controls import METHODS, PANEL_LAWS

_PARTS = Path(__file__).parent / "js"
# One module out of several files: a page without a kernel can load no second one.
_MODEL = "model", "simulate"
_PICTURE = "style", "surface", "settings", "figures", "scene", "handles", "charts", "gain_map"
_ORDER = *_MODEL, *_PICTURE, "explorer"


def javascript() -> str:
    """The panel's ES module, put together from the files in wmrlib/explorer/js."""
    return "\n".join((_PARTS / f"{name}.js").read_text(encoding="utf-8") for name in _ORDER)


class _Finite(traitlets.Float):
    """A Float without NaN and infinity, which JSON can't carry to the browser."""

    def validate(self, obj, value):
        number = super().validate(obj, value)
        if math.isfinite(number):
            return number
        raise refusal(str(self.name), value, "a finite number")


def _synced(count: int, kind: Callable, *default: Any, **bounds: int) -> Iterator[Any]:
    return (kind(*default, **bounds).tag(sync=True) for _ in range(count))


class Panel(anywidget.AnyWidget):
    """The picture: canvases, figures and buttons, without the sliders.

    Each menu is a number, the place of the choice in its list. `laws` and `methods` are those of
    `controls`.
    """

    _esm = traitlets.Unicode(javascript()).tag(sync=True)
    _css = traitlets.Unicode((_PARTS / "panel.css").read_text(encoding="utf-8")).tag(sync=True)
    start, goal = _synced(2, traitlets.List, _Finite(), [0.0, 0.0, 0.0], minlen=3, maxlen=3)
    k_rho, k_alpha, h, v_max, k_x, k_y, k_heading = _synced(7, _Finite)
    dt, duration, arrival_radius = _synced(3, _Finite)
    scenario, preset, pose_law, circle_law, method = _synced(5, traitlets.Int, min=0)
    view, metric, axes = _synced(3, traitlets.Int, min=0)
    gains_display, limit_display, feedback_display = _synced(3, traitlets.Unicode)
    pose_law_display, circle_law_display, map_display = _synced(3, traitlets.Unicode)
    home = traitlets.Dict().tag(sync=True)
    presets: traitlets.List = traitlets.List().tag(sync=True)
    laws = traitlets.List(PANEL_LAWS).tag(sync=True)
    methods = traitlets.List(list(METHODS)).tag(sync=True)
