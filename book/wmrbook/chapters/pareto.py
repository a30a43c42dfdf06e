"""Choices that no other one beats in every respect (chapter 6)."""

from __future__ import annotations

import numpy as np

from wmrlib.checks import as_array, refusal


def pareto(*costs: np.ndarray) -> np.ndarray:
    """Which choices no other one dominates: as cheap in every cost and cheaper in one.

    costs: arrays of one shape, of which less is better. Returns booleans in that shape, False where
    a cost is infinite or NaN.
    """
    table = [as_array(cost) for cost in costs]
    if any(cost.dtype.kind not in "iuf" for cost in table):
        raise refusal("costs", costs, "arrays of numbers")
    shapes = [cost.shape for cost in table]
    if len(set(shapes)) != 1:
        needed = "at least one, all of one shape, is needed"
        raise ValueError(f"costs of shape {shapes} are not allowed: {needed}")
    points = np.stack(table, axis=-1).astype(float)
    chosen = np.array(np.isfinite(points).all(axis=-1))
    left = points[chosen]
    chosen[chosen] = [
        not ((left <= one).all(axis=1) & (left < one).any(axis=1)).any() for one in left
    ]
    return chosen
