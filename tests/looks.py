"""What a figure looks like."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg


def pixels_of(picture) -> np.ndarray:
    """The red, green and blue of a Picture's pixels, from 0 to 1."""
    canvas = FigureCanvasAgg(picture.figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3] / 255.0


def heading_of(dart) -> float:
    """Where the arrowhead of a robot points, rad."""
    tip, tail = dart.get_xy()[0], dart.get_xy()[2]
    return math.atan2(tip[1] - tail[1], tip[0] - tail[0])
