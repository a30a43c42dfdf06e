"""What the panel's sliders and menus are called and offer, and the laws and methods behind them."""

from __future__ import annotations

from typing import Any

from wmrlib.laws import LAWS

# name: (label, tip, lowest, highest, step); without a step, the round numbers of each decade
SLIDERS = {
    "k_rho": ("k_rho [1/m]", "how near the goal the robot slows down", 0.0, 5.0, 0.05),
    "k_alpha": ("k_alpha [1/s]", "steering towards the goal", 0.0, 10.0, 0.05),
    "h": ("h [1]", "weight of the final heading", 0.0, 5.0, 0.05),
    "v_max": ("v_max [m/s]", "speed limit", 0.1, 10.0, 0.1),
    "k_x": ("k_x [1/s]", "closing in along the heading", 0.0, 5.0, 0.05),
    "k_y": ("k_y [1/m²]", "steering against the distance to the side", 0.2, 20.0, 0.2),
    "k_heading": ("k_heading [1/m]", "steering against the heading error", 0.0, 10.0, 0.1),
    "dt": ("dt [s]", "time from one command, or sample, to the next", 0.01, 1.0, None),
    "arrival_radius": ("arrival [m]", "how near the goal the robot stops", 0.01, 1.0, None),
    "track_width": ("track_width [m]", "from wheel to wheel", 0.1, 2.0, 0.05),
    "acceleration": ("acceleration [m/s²]", "of a wheel at most; 0: any", 0.0, 5.0, 0.1),
    "lag": ("lag [s]", "with which a wheel follows", 0.0, 1.0, 0.02),
    "dead_band": ("dead_band [m/s]", "a wheel that is told less stands", 0.0, 0.5, 0.01),
}
FOLDED = {"Wheels": ("track_width", "acceleration", "lag", "dead_band")}
"""Sliders that are out of sight until their group is opened."""
PANEL_LAWS: list[dict[str, Any]] = [
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
METHODS = {"arc": "arcs, exact", "euler": "straight steps (Euler)", "continuous": "continuous"}
VIEWS = {"time": "time charts", "gains": "gain landscape"}
_METRICS = {"headingError": "heading error", "time": "arrival time", "peakOmega": "peak |omega|"}
PRESETS = "your own", "paper, outdoors", "paper, circle", "gentle gains"
# name: (label, tip, choices)
MENUS: dict[str, tuple[str, str, dict[Any, str]]] = {
    "preset": ("Preset", "gains and scenes to start from", dict(enumerate(PRESETS))),
    "law": ("Law", "what turns the error into speed and turning rate", {}),
    "method": ("Motion", "how the robot moves between two commands, or none is held", METHODS),
    "view": ("View", "what stands beside the path", VIEWS),
    "metric": ("Map shows", "what the colours mean", _METRICS),
    "axes": (
        "Map over",
        "which gains the map spans",
        {"k_alpha": "k_alpha and h", "k_rho": "k_rho and h"},
    ),
}


def laws_for(moving: bool) -> list[str]:
    """The laws for a goal that moves, or for one that stands still."""
    return [law["name"] for law in PANEL_LAWS if moving or not law["needs_reference"]]
