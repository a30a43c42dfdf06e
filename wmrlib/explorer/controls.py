"""The panel's laws and methods, and its sliders and menus: ordinary ipywidgets."""

from __future__ import annotations

import math

import ipywidgets as widgets

from wmrlib.laws import LAWS

# name: (label, lowest, highest); linear scales where 0 is worth a look, a logarithmic one for dt
SLIDERS = {
    "k_rho": ("k_rho [1/m]", 0.0, 5.0),
    "k_alpha": ("k_alpha [1/s]", 0.0, 10.0),
    "h": ("h [1]", 0.0, 5.0),
    "v_max": ("v_max [m/s]", 0.1, 10.0),
    "k_x": ("k_x [1/s]", 0.0, 5.0),
    "k_y": ("k_y [1/m²]", 0.05, 20.0),
    "k_heading": ("k_heading [1/m]", 0.0, 10.0),
    "dt": ("dt [s]", 0.01, 1.0),
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


# name: (label, choices)
MENUS = {
    "preset": ("Preset", ("your own", "the paper, outdoors", "the paper, circle", "gentle gains")),
    "pose_law": ("Law", tuple(law["title"] for law in laws_for(False))),
    "circle_law": ("Law", tuple(law["title"] for law in laws_for(True))),
    "method": ("Motion", tuple(METHODS.values())),
    "view": ("View", ("time charts", "gain landscape")),
    "metric": ("Map shows", ("heading error", "arrival time", "peak |omega|")),
    "axes": ("Map over", ("k_alpha and h", "k_rho and h")),
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
_TIPS = {
    "k_rho": "how near the goal the robot slows down",
    "k_alpha": "steering towards the goal",
    "h": "weight of the final heading",
    "v_max": "speed limit",
    "k_x": "closing in along the heading",
    "k_y": "steering against the distance to the side",
    "k_heading": "steering against the heading error",
    "dt": "time from one command to the next",
    "preset": "gains and scenes to start from",
    "pose_law": "what turns the error into speed and turning rate",
    "circle_law": "what turns the error into speed and turning rate",
    "method": "how the robot moves while a command is held",
    "view": "what stands beside the path",
    "metric": "what the colours mean",
    "axes": "which gains the map spans",
}


def slider(name: str, value: float):
    """The slider of that name at that value, wide enough for it; its number can be typed over."""
    text, low, high = SLIDERS[name]
    common = {"description": text, "tooltip": _TIPS[name], "layout": {"width": "auto"}}
    if name == "dt":
        made = widgets.FloatLogSlider(
            min=math.log10(low), max=math.log10(high), step=0.02, readout_format=".3f", **common
        )
    else:
        made = widgets.FloatSlider(
            min=low, max=high, value=low, step=0.01, readout_format=".2f", **common
        )
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
    text, options = MENUS[name]
    return widgets.Dropdown(
        description=text,
        options=options,
        index=index,
        tooltip=_TIPS[name],
        layout={"width": "auto"},
    )
