"""The panel's picture as a widget: its traits, and the JavaScript that draws it."""

from __future__ import annotations

import math
from pathlib import Path

import anywidget
import traitlets

from wmrlib.explorer.controls import METHODS, PANEL_LAWS

_PARTS = Path(__file__).parent / "js"
# One module out of several files: a page without a kernel can load no second one.
_ORDER = (
    "model",
    "simulate",
    "style",
    "surface",
    "settings",
    "figures",
    "scene",
    "handles",
    "charts",
    "gain_map",
    "explorer",
)


def javascript() -> str:
    """The panel's ES module, put together from the files in wmrlib/explorer/js."""
    return "\n".join((_PARTS / f"{name}.js").read_text(encoding="utf-8") for name in _ORDER)


class _Finite(traitlets.Float):
    """A Float without NaN and infinity, which JSON can't carry to the browser."""

    def validate(self, obj, value):
        number = super().validate(obj, value)
        if not math.isfinite(number):
            raise ValueError(f"{self.name} = {value!r} is not allowed: a finite number is needed")
        return number


def _finite(value: float):
    return _Finite(value).tag(sync=True)


def _index():
    return traitlets.Int(0, min=0).tag(sync=True)


def _pose():
    return traitlets.List(_Finite(), minlen=3, maxlen=3, default_value=[0.0, 0.0, 0.0]).tag(
        sync=True
    )


def _shown(value: str = "flex"):
    return traitlets.Unicode(value).tag(sync=True)


class Panel(anywidget.AnyWidget):
    """The picture: canvases, figures and buttons, without the sliders.

    Each menu is a number, the place of the choice in its list. `laws` and `methods` are those of
    `controls`.
    """

    _esm = traitlets.Unicode(javascript()).tag(sync=True)
    _css = traitlets.Unicode((_PARTS / "panel.css").read_text(encoding="utf-8")).tag(sync=True)
    start, goal = _pose(), _pose()
    k_rho, k_alpha, h, v_max = _finite(2.0), _finite(1.0), _finite(0.3), _finite(4.0)
    k_x, k_y, k_heading = _finite(1.0), _finite(2.0), _finite(2.0)
    dt, duration, arrival_radius = _finite(0.1), _finite(60.0), _finite(0.05)
    scenario, pose_law, circle_law, method, view, metric, axes, preset = (
        _index() for _ in range(8)
    )
    gains_display, limit_display, feedback_display = _shown(), _shown(), _shown("none")
    pose_law_display, circle_law_display, map_display = _shown(), _shown("none"), _shown("none")
    home = traitlets.Dict().tag(sync=True)
    presets = traitlets.List().tag(sync=True)
    laws = traitlets.List(PANEL_LAWS).tag(sync=True)
    methods = traitlets.List(list(METHODS)).tag(sync=True)
