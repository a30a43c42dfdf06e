"""What all figures have in common: colours by role, line styles, axes, darts and a text.

The colours are those of Okabe and Ito, which colour-blind readers can tell apart, some darker where
they colour text. Whatever a colour says, a line style, a marker or a label says too. What the live
panel shows as well has the same hue there, in explorer/js/panel.css.
"""

from __future__ import annotations

import base64
import html
import io
import math
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from wmrlib.kinematics import Pose

COLOURS = {
    "path": "#0072B2",
    "start": "#009E73",
    "goal": "#D55E00",
    "rho": "#222222",
    "alpha": "#A8447F",
    "theta": "#7D7000",
    "robot": "#56B4E9",
    "v": "#0072B2",
    "omega": "#CC79A7",
    "x_error": "#0072B2",
    "y_error": "#E69F00",
    "V": "#0072B2",
    "V_rising": "#D40000",
    "ink": "#222222",
}
STYLE: dict[Any, float] = {
    "font.size": 12,
    "axes.grid": True,
    "grid.alpha": 0.35,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 2.0,
}
LINES = ("-", "--", ":", "-.")


class Picture:
    """A figure and its alternative text, which Jupyter shows as a PNG image with that text.

    Parameters
    ----------
    figure : matplotlib's Figure, to change or save
    alt : str, for readers who don't see the figure, and for tests
    """

    def __init__(self, figure: Figure, alt: str) -> None:
        self.figure = figure
        self.alt = alt

    def __repr__(self) -> str:
        return f"<Picture: {self.alt}>"

    def png(self, dots_per_inch: float = 108.0) -> bytes:
        """Return a PNG file of 256 colours, a third of the full size, with the text inside."""
        buffer, file, text = io.BytesIO(), io.BytesIO(), PngInfo()
        self.figure.savefig(buffer, format="png", dpi=dots_per_inch)
        text.add_itxt("Description", self.alt)
        few = Image.open(buffer).convert("RGB").quantize(256, dither=Image.Dither.NONE)
        few.save(file, "PNG", optimize=True, pnginfo=text)
        return file.getvalue()

    def _repr_mimebundle_(self, include=None, exclude=None):
        """As HTML first: JupyterLab gives a bare image/png no text. As PNG for a printed book."""
        png, width = self.png(), round(self.figure.get_figwidth() * 72)
        source = f"data:image/png;base64,{base64.b64encode(png).decode()}"
        image = f'<img alt="{html.escape(self.alt)}" width="{width}" src="{source}">'
        bundle = {"text/html": image, "image/png": png, "text/plain": repr(self)}
        return bundle, {"image/png": {"alt": self.alt, "width": width}}


def new_figure(width: float, height: float, rows: int = 1, mosaic=None) -> tuple:
    """A figure (inches) outside pyplot, which would show it twice, and its rows or mosaic."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        if mosaic:
            return figure, figure.subplot_mosaic(mosaic, width_ratios=[1.0, 1.1])
        return figure, figure.subplots(rows, sharex=True)


def dart(axes: Axes, pose: Pose, size: float, fill: str, edge: str = "ink", **looks) -> None:
    """Draw a pose as a dart 2 `size` long; fill and edge are roles in COLOURS, or colours."""
    shape = np.array([[1.3, 0.0], [-0.9, 0.6], [-0.5, 0.0], [-0.9, -0.6]]) * size
    cos, sin = math.cos(pose.heading), math.sin(pose.heading)
    corners = shape @ np.array([[cos, sin], [-sin, cos]]) + np.array([pose.x, pose.y])
    fill, edge = (COLOURS.get(each, each) for each in (fill, edge))
    axes.add_patch(Polygon(corners, closed=True, fc=fill, ec=edge, **looks))


def equal_scales(axes: Axes, x: np.ndarray, y: np.ndarray, room: float = 0.08) -> None:
    """Show the points in a square of equal scales, with `room` of its width on each side."""
    half = 0.5 * max(np.ptp(x), np.ptp(y), 1.0) * (1.0 + 2.0 * room)
    middle_x, middle_y = 0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max())
    xlim, ylim = (middle_x - half, middle_x + half), (middle_y - half, middle_y + half)
    axes.set(xlim=xlim, ylim=ylim, aspect="equal")
