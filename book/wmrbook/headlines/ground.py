"""Headlines of chapters 0 to 3: the first drive, the globe, the wheels, the angles."""

from __future__ import annotations

import wmrlib as wmr
from wmrbook.headlines import headline
from wmrlib import paper


@headline(
    "00",
    "The paper's distance of 58.07 m settles the order of its coordinates",
    at_most=0.01,
    unit="m",
    radius=(6_371_000.0, 6_371_009.0),
)
def distance_off(radius: float) -> float:
    a, b = paper.GPS_POINT_1, paper.GPS_POINT_2
    return abs(wmr.haversine_distance(a, b, radius=radius) - 58.07)
