"""The panel's laws and methods, and its sliders and menus: ordinary ipywidgets."""

from __future__ import annotations

import math
from typing import Any

import ipywidgets as widgets

from wmrlib.laws import LAWS

# name: (label, tip, lowest, highest); the scale of dt is logarithmic, as 0 is not worth a look
SLIDERS = {
    "k_rho": ("k_rho [1/m]", "how near the goal the robot slows down", 0.0, 5.0),
    "k_alpha": ("k_alpha [1/s]", "steering towards the goal", 0.0, 10.0),
    "h": ("h [1]", "weight of the final heading", 0.0, 5.0),
    "v_max": ("v_max [m/s]", "speed limit", 0.1, 10.0),
    "k_x": ("k_x [1/s]", "closing in along the heading", 0.0, 5.0),
    "k_y": ("k_y [1/m²]", "steering against the distance to the side", 0.05, 20.0),
    "k_heading": ("k_heading [1/m]", "steering against the heading error", 0.0, 10.0),
    "dt": ("dt [s]", "time from one command to the next", 0.01, 1.0),
}
PANEL_LAWS = [
    {
        "name": name,
        "title": law.title,
        "needs_reference": law.needs_reference,
        "gains": [gain for gain in law.gains._fields if gain not in law.ignores],
    }
    for name, law in LAWS.items()
    if SLIDERS.keys() >= set(law.gains._fields)
]
"""The laws whose gains have sliders: what the panel and its menus know of them."""
METHODS = {"arc": "arcs, exact", "euler": "straight steps (Euler)"}


def laws_for(moving: bool) -> list[dict]:
    """The laws for a goal that moves, or for one that stands still."""
    return [law for law in PANEL_LAWS if moving or not law["needs_reference"]]


_LAW = "Law", "what turns the error into speed and turning rate"
_PRESETS = "your own", "the paper, outdoors", "the paper, circle", "gentle gains"
_METRICS = "heading error", "arrival time", "peak |omega|"
# name: (label, tip, choices)
MENUS = {
    "preset": ("Preset", "gains and scenes to start from", _PRESETS),
    "pose_law": (*_LAW, tuple(law["title"] for law in laws_for(False))),
    "circle_law": (*_LAW, tuple(law["title"] for law in laws_for(True))),
    "method": ("Motion", "how the robot moves while a command is held", tuple(METHODS.values())),
    "view": ("View", "what stands beside the path", ("time charts", "gain landscape")),
    "metric": ("Map shows", "what the colours mean", _METRICS),
    "axes": ("Map over", "which gains the map spans", ("k_alpha and h", "k_rho and h")),
}
# The trait of the panel that says whether a control applies.
DISPLAYS = {
    **dict.fromkeys(("k_rho", "k_alpha", "h"), "gains_display"),
    "v_max": "limit_display",
    **dict.fromkeys(("k_x", "k_y", "k_heading"), "feedback_display"),
    "pose_law": "pose_law_display",
    "circle_law": "circle_law_display",
    **dict.fromkeys(("metric", "axes"), "map_display"),
}


def slider(name: str, value: float):
    """The slider of that name at that value, wide enough for it; its number can be typed over."""
    text, tip, low, high = SLIDERS[name]
    common: dict[str, Any] = {"description": text, "tooltip": tip, "layout": {"width": "auto"}}
    if name == "dt":
        common |= {"min": math.log10(low), "max": math.log10(high), "readout_format": ".3f"}
        made = widgets.FloatLogSlider(step=0.02, **common)
    else:
        common |= {"min": low, "max": high, "value": low, "readout_format": ".2f"}
        made = widgets.FloatSlider(step=0.01, **common)
    widen(made, value)
    made.value = value
    return made


def widen(made, value: float) -> None:
    """Make room for a value beyond the slider's ends, which it would otherwise cut to them."""
    low = high = value
    if isinstance(made, widgets.FloatLogSlider):  # its ends are powers of ten
        low, high = math.floor(math.log10(value)), math.ceil(math.log10(value))
    made.max, made.min = max(made.max, high), min(made.min, low)


def menu(name: str, index: int):
    """The menu of that name at that choice."""
    text, tip, options = MENUS[name]
    common: dict[str, Any] = {"description": text, "tooltip": tip, "layout": {"width": "auto"}}
    return widgets.Dropdown(options=options, index=index, **common)
