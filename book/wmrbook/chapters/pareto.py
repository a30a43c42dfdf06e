"""Choices that no other one beats in every respect (chapter 6)."""

from __future__ import annotations

import numpy as np

from wmrlib.checks import floats


def pareto(*costs: np.ndarray) -> np.ndarray:
    """Which choices no other one dominates: as cheap in every cost and cheaper in one.

    costs: arrays of one shape, of which less is better. Returns booleans in that shape, False where
    a cost is infinite or NaN.
    """
    table = [floats(f"costs[{i}]", cost, "an array of numbers") for i, cost in enumerate(costs)]
    shapes = [cost.shape for cost in table]
    if len(set(shapes)) != 1:
        needed = "at least one, all of one shape, is needed"
        raise ValueError(f"costs of shape {shapes} are not allowed: {needed}")
    points = np.stack(table, axis=-1)
    chosen = np.array(np.isfinite(points).all(axis=-1))
    left = points[chosen]
    chosen[chosen] = [
        not ((left <= one).all(axis=1) & (left < one).any(axis=1)).any() for one in left
    ]
    return chosen
