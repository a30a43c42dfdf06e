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


def drawn(axes, kind) -> list:
    """The robots, or the starts and goals ("pose"), in the order in which they were drawn."""
    return [patch for patch in axes.patches if patch.get_gid() == kind]


def heading_of(patch) -> float:
    """Where a robot's nose or a goal's arrow points, rad."""
    corners = patch.get_path().vertices
    apart = np.hypot(*(corners - corners.mean(axis=0)).T) + 1e-3 * np.hypot(*corners.T)
    ends = corners[np.argmax(apart)]  # the nose, or the arrow's end
    return math.atan2(ends[1], ends[0])


def place_of(patch) -> np.ndarray:
    """Where its middle is, in metres."""
    middle = patch.get_transform().transform((0.0, 0.0))
    return patch.axes.transData.inverted().transform(middle)
