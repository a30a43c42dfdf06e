"""Positions of one segment judged among their neighbours: first their times, then their places."""

import math
from array import array
from bisect import bisect_left
from collections.abc import Callable

import numpy as np

from wmrlib.geodesy import EARTH_RADIUS_M, GeoPoint, great_circle_angle, haversine_distance

_DAY = 86400.0  # s
_FASTEST, _ROOM = 340.0, 100.0  # m/s of any vehicle, and m that a receiver's errors may add
DISAGREEING = "of an epoch in which two positions are more than 20 m apart"


def disagree(lat: float, lon: float, lat2: float, lon2: float) -> bool:
    """Whether two positions of one epoch are more than 20 m apart: two receivers, perhaps."""
    angles = map(math.radians, (lat, lat2, lat2 - lat, lon2 - lon))
    return EARTH_RADIUS_M * great_circle_angle(*angles) > 20.0


def null_island(lat: np.ndarray, lon: np.ndarray) -> np.ndarray:
    """Which positions are (0, 0), as of a receiver without a fix, in a file from elsewhere."""
    zero = np.maximum(abs(lat), abs(lon)) < 1e-6
    others = np.maximum(abs(lat), abs(lon))[~zero]
    return zero & (not others.size or np.median(others) > 1.0)


def newest_first(time: np.ndarray) -> bool:
    """Whether the times fall, with hardly an exception, and they are more than a few."""
    steps = np.diff(time[~np.isnan(time)])
    return (steps < 0.0).sum() > max(3, 9 * (steps > 0.0).sum())


def without_seconds(time: np.ndarray) -> np.ndarray:
    """Which positions have the time of the one before, if the clock shows minutes or stands."""
    timed = np.flatnonzero(~np.isnan(time))
    steps = np.diff(time[timed])
    coarse = not (steps % 60.0).any() and 4 * (steps == 0.0).sum() >= max(16, 3 * steps.size)
    return timed[1:][steps == 0.0] if coarse else timed[:0]


def copies(places: np.ndarray, segment: np.ndarray) -> np.ndarray:
    """Which rows (latitude, longitude, time) an earlier segment has too; without a time, none."""
    _, first, same = np.unique(places, axis=0, return_index=True, return_inverse=True)
    return segment != segment[first[same.ravel()]]


def alternate(lat: np.ndarray, lon: np.ndarray) -> bool:
    """Whether positions are near those after the next, but not near the next."""
    if lat.size < 20:
        return False
    parts = [GeoPoint(lat=lat[k:][: lat.size - 2], lon=lon[k:][: lat.size - 2]) for k in range(3)]
    to_next, to_second = (float(np.mean(haversine_distance(parts[0], p))) for p in parts[1:])
    return to_next > max(1.0, 2.0 * to_second)


def with_its_date_right(time: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """The times as if the date had been right from the start, and which positions are in doubt.

    The clock goes on while a date is put right, and a log that is written once a day has no such
    step. A step of more than a year is of a clock that had not been set.
    """
    timed = np.flatnonzero(~np.isnan(time))
    steps = np.diff(time[timed])
    short = steps[(steps > 0.0) & (steps < 0.5 * _DAY)]
    if not short.size or short.size == steps.size:
        return time, {}
    usual = float(np.median(short))
    soon = max(1.5 * usual, min(10.0 * usual, 100.0)) if usual <= 600.0 else 0.0
    days = np.round(steps / _DAY) * _DAY
    rest = steps - days
    wrong = (days != 0.0) & (rest > 0.0) & (rest < soon)
    waited = ~wrong & (steps > max(_DAY, 100.0 * usual))
    years = np.flatnonzero(waited & (steps > 366.0 * _DAY))
    unset = timed[: years[-1] + 1] if years.size else timed[:0]
    time = time.copy()
    time[timed[1:]] -= np.cumsum(np.where(wrong, days, 0.0))
    time[unset] = math.nan
    waited[: unset.size] = False
    return time, {
        "after a step of whole days, which t leaves out": timed[1:][wrong],
        "after more than a day without a position": timed[1:][waited],
        "with a time more than a year before the others, which t leaves out": unset,
    }


def second_best(time: np.ndarray, trusted: Callable[[int], int]) -> np.ndarray:
    """Which of neighbours with one time are not the first of the most trusted."""
    timed, again = np.flatnonzero(~np.isnan(time)), np.zeros(time.size, bool)
    epochs = np.append(0, np.cumsum(np.diff(time[timed]) != 0.0))
    if not timed.size or epochs[-1] + 1 == timed.size:
        return again
    trust = [trusted(i) for i in timed.tolist()]
    order = np.lexsort((-np.array(trust), epochs))  # stable
    again[timed[order[1:]]] = np.diff(epochs[order]) == 0
    return again


def late(time: np.ndarray) -> np.ndarray:
    """Which positions are outside the longest run whose times increase."""
    timed, left = np.flatnonzero(~np.isnan(time)), np.zeros(time.size, bool)
    if (np.diff(time[timed]) > 0.0).all():
        return left
    # Patience sorting, from the last to the first.
    falling, ends = array("d", -time[timed]), array("d")
    lengths = array("q", timed)  # of the longest run that begins there, less one
    for i in reversed(range(timed.size)):
        lengths[i] = bisect_left(ends, falling[i])
        ends[lengths[i] : lengths[i] + 1] = array("d", [falling[i]])
    # Of runs as long, the one that begins first and then goes on with the nearest times.
    last = lengths.index(len(ends) - 1)
    left[timed], left[timed[last]] = True, False
    for i in np.lexsort((time[timed], np.negative(lengths))).tolist():
        if i > last and falling[i] < falling[last]:
            left[timed[i]], last = False, i
    return left


def unreachable(lat: np.ndarray, lon: np.ndarray, time: np.ndarray) -> tuple[np.ndarray, bool]:
    """Which positions no vehicle reaches from the others in the time, and whether they are few.

    The longest stretch without a jump is right, and before and after it all that can be reached.
    """
    far, timed = np.zeros(time.size, bool), np.flatnonzero(~np.isnan(time))

    def jump(i: np.ndarray, j: np.ndarray) -> np.ndarray:
        a, b = (GeoPoint(lat=lat[k], lon=lon[k]) for k in (i, j))
        return haversine_distance(a, b) > _ROOM + _FASTEST * abs(time[j] - time[i])

    jumps = np.flatnonzero(jump(timed[:-1], timed[1:])) + 1
    if not jumps.size:
        return far, True
    stretches = np.split(timed, jumps)
    longest = int(np.argmax([stretch.size for stretch in stretches]))
    for way in (stretches[longest:], [part[::-1] for part in stretches[longest::-1]]):
        last = way[0][-1]
        for stretch in way[1:]:
            far[stretch] = jump(last, stretch[0])
            last = last if far[stretch[0]] else stretch[-1]
    return far, 4 * far.sum() <= timed.size


def strays(points: GeoPoint) -> np.ndarray:
    """Which positions of a receiver at rest are far outside the scatter of the others.

    They are more than a metre from the median, and ten times as far as three quarters of all.
    """
    lat, lon = np.broadcast_arrays(np.radians(points.lat), np.radians(points.lon))
    vectors = np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)
    x, y, z = (np.median(values) for values in vectors)  # right at the date line and at the poles
    lat, lon = np.degrees(np.arctan2(z, np.hypot(x, y))), np.degrees(np.arctan2(y, x))
    far = np.asarray(haversine_distance(GeoPoint(lat=lat, lon=lon), points))
    return far > max(1.0, 10.0 * np.quantile(far, 0.75, method="lower"))
