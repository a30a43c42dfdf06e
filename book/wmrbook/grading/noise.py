"""Checks of a noisy receiver: its scatter in metres, the arrival radius it asks for, and what averaging leaves of it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrbook.grading._hints import Passed, ask_number, ask_numbers, close, expect, own_work
from wmrlib.geodesy import EARTH_RADIUS_M, GeoPoint, point_at
from wmrlib.tracks import stationary_scatter

DEGREE = math.radians(1.0) * EARTH_RADIUS_M  # of latitude, m


def scatter_known(scatter: Callable) -> Passed:
    """scatter(lat, lon) -> (mean_lat, mean_lon, std_east, std_north): degrees in, degrees and metres out."""
    own_work(scatter)
    for lat, lon in _logs(12):
        right = stationary_scatter(GeoPoint(lat=lat, lon=lon))
        mean_lat, mean_lon, east, north = ask_numbers(scatter, 4, lat.copy(), lon.copy())
        expect(
            not close(mean_lat, right.mean.lon, 1e-9),
            "the mean longitude comes first; the latitude is asked for first.",
        )
        for name, value, wanted in (
            ("latitude", mean_lat, right.mean.lat),
            ("longitude", mean_lon, right.mean.lon),
        ):
            expect(
                abs(value - wanted) < 2e-9,
                f"the mean {name} is {abs(value - wanted) * DEGREE:.3g} m off; it is a plain mean, in degrees.",
            )
        _expect_scatter(east, north, lat, lon, right)
    return Passed("Twelve receivers from the equator to 70 deg: mean and scatter are right.")


def scatter_properties(scatter: Callable) -> Passed:
    """Another longitude, the other hemisphere, another order: the same scatter; twice the error, twice the scatter."""
    own_work(scatter)
    for lat, lon in _logs(5):
        found = np.array(ask_numbers(scatter, 4, lat.copy(), lon.copy())[2:])
        expect(bool((found > 0.0).all()), "a standard deviation is positive.")
        for changed, hint in [
            ((lat, lon - 30.0), "30 deg further west the same receiver must scatter as much."),
            ((-lat, lon), "on the other hemisphere the same receiver must scatter as much."),
            ((lat[::-1], lon[::-1]), "the order of the looks must not count."),
        ]:
            expect(
                np.allclose(ask_numbers(scatter, 4, *map(np.array, changed))[2:], found, rtol=1e-6),
                hint,
            )
        doubled = ask_numbers(scatter, 4, 2.0 * lat - lat.mean(), 2.0 * lon - lon.mean())[2:]
        expect(
            np.allclose(doubled, 2.0 * found, rtol=1e-6),
            "twice as far from the mean must be twice the standard deviation.",
        )
    lon = np.array([-1e-5, 0.0, 1e-5, 2e-5])
    east, north = ask_numbers(scatter, 4, 60.0 + lon, lon)[2:]
    expect(
        close(2.0 * east, north, 1e-4),
        "at 60 deg of latitude a degree of longitude is half as long as one of latitude.",
    )
    return Passed(
        f"At 60 deg, a step of 1e-5 deg is {1e-5 * DEGREE:.2f} m to the north and {0.5e-5 * DEGREE:.2f} m to the east."
    )


def radius_share(arrival_radius: Callable) -> Passed:
    """arrival_radius(share, looks, sigma): of 40 000 simulated robots on the goal, this share stops within so many looks."""
    own_work(arrival_radius)
    random = np.random.default_rng(91)
    for share, looks in ((0.5, 1), (0.9, 1), (0.5, 10), (0.9, 5), (0.99, 20), (0.1, 3)):
        sigma = random.uniform(0.3, 3.0)
        value = ask_number(arrival_radius, share, looks, sigma)
        expect(value > 0.0, f"a radius of {value:.3g} m: a radius is positive.")
        nearest = np.hypot(*random.standard_normal((2, 40_000, looks))).min(axis=1) * sigma
        stopped = float((nearest < value).mean())
        if abs(stopped - share) > 0.012:
            _explain_radius(value, share, looks, sigma)
            hint = f"with your radius {100 * stopped:.1f} % of 40 000 robots stop (looks: {looks}); {100 * share:.0f} % were wanted."
            expect(False, hint)
    return Passed("40 000 simulated robots, six times: the wanted share of them stops.")


def radius_properties(arrival_radius: Callable) -> Passed:
    """Proportional to sigma; half of it with four times the looks; larger for a larger share."""
    own_work(arrival_radius)
    for share, looks, sigma in ((0.2, 2, 0.5), (0.5, 7, 1.5), (0.95, 12, 2.5)):
        value = ask_number(arrival_radius, share, looks, sigma)
        expect(
            close(ask_number(arrival_radius, share, looks, 3.0 * sigma), 3.0 * value),
            "three times the noise needs three times the radius.",
        )
        hint = "with four times the looks half of the radius does: how often are all looks outside?"
        expect(close(2.0 * ask_number(arrival_radius, share, 4 * looks, sigma), value), hint)
        expect(
            ask_number(arrival_radius, 0.5 + 0.5 * share, looks, sigma) > value,
            "a larger share needs a larger radius.",
        )
    value = ask_number(arrival_radius, 0.9, 10, 0.5)
    return Passed(
        f"Half a metre of noise, ten looks: {value:.2f} m stop 90 % of the robots on the goal."
    )


def mean_white(scatter_of_mean: Callable) -> Passed:
    """scatter_of_mean(sigma, n, correlation) for independent looks."""
    own_work(scatter_of_mean)
    for sigma, n in ((0.5, 1), (0.5, 2), (1.5, 9), (3.0, 100)):
        value, right = ask_number(scatter_of_mean, sigma, n, 0.0), sigma / math.sqrt(n)
        expect(
            not close(value, right**2) or close(value, right),
            "this is the variance, in m^2; its root is asked for.",
        )
        expect(
            not close(value, sigma / n) or n == 1,
            "independent errors do not add up like equal ones: their variances do.",
        )
        expect(
            close(value, right),
            f"{n} independent looks of {sigma:g} m: the mean comes out with {value:.4g} m.",
        )
    return Passed("Nine independent looks: a third of the scatter of one.")


def mean_correlated(scatter_of_mean: Callable) -> Passed:
    """The same for looks that are alike: against the sum over all pairs, and the limits."""
    own_work(scatter_of_mean)
    random = np.random.default_rng(93)
    cases = [
        (float(random.uniform(0.3, 3.0)), n, float(c))
        for n, c in zip((2, 3, 5, 9, 30, 200), random.uniform(0.2, 0.98, 6), strict=True)
    ]
    for sigma, n, c in [*cases, (1.0, 4, -0.5)]:
        value, apart = ask_number(scatter_of_mean, sigma, n, c), np.arange(n)
        right = sigma / n * math.sqrt((c ** np.abs(apart[:, None] - apart)).sum())
        if not close(value, right, 1e-6):
            _explain_mean(value, sigma, n, c, right)
            hint = f"{n} looks of {sigma:.3g} m, neighbours correlated by {c:.2f}: the mean comes out with {value:.4g} m. Write the variance "
            expect(
                False,
                hint
                + "of the sum as a sum over all pairs of looks, and count how many pairs are k apart.",
            )
    for n in (1, 5, 50):
        expect(
            close(ask_number(scatter_of_mean, 0.8, n, 1.0), 0.8),
            "errors that are all the same (correlation 1) do not average out at all.",
        )
    value = ask_number(scatter_of_mean, 1.0, 9, 0.9)
    return Passed(
        f"Nine looks, neighbours alike by 0.9: the mean keeps {100 * value:.0f} % of the scatter, where white noise keeps 33 %."
    )


def _expect_scatter(east: float, north: float, lat: np.ndarray, lon: np.ndarray, right) -> None:
    n, middle = lat.size, right.mean.lat
    wanted = right.std_east, right.std_north
    if np.allclose((east, north), wanted, rtol=1e-4):
        return
    cos, fewer = math.cos(math.radians(middle)), math.sqrt((n - 1) / n)
    shapes = [
        ((wanted[1], wanted[0]), "east and north are swapped."),
        ((lon.std(ddof=1), lat.std(ddof=1)), "the scatter is in degrees; metres are asked for."),
        (
            (lon.std(ddof=1) * cos, lat.std(ddof=1)),
            "the scatter is in degrees; metres are asked for.",
        ),
        (
            (wanted[0] * math.degrees(1.0), wanted[1] * math.degrees(1.0)),
            "an arc is the radius times an angle in radians, not in degrees.",
        ),
        (
            (wanted[0] / cos, wanted[1]),
            "a degree of longitude is not as long as one of latitude: where is the latitude in your std_east?",
        ),
        (
            (wanted[0] / cos, wanted[1] * cos),
            "the cosine stands at the wrong one of the two: which circles get smaller towards the poles?",
        ),
        ((wanted[0] / cos * abs(math.cos(middle)), wanted[1]), "a cosine was given degrees."),
        (
            (wanted[0] ** 2, wanted[1] ** 2),
            "these are variances, in m^2; their roots are asked for.",
        ),
    ]
    for (mistaken_east, mistaken_north), hint in shapes:
        for share in (1.0, fewer):
            expect(
                not np.allclose(
                    (east, north), (mistaken_east * share, mistaken_north * share), rtol=1e-4
                ),
                hint,
            )
    small = f"of {n} looks the scatter comes out {100 * (1 - fewer):.1f} % too small"
    hint = f"{small}: the mean was computed from the same looks. How many are left?"
    expect(not np.allclose((east, north), (wanted[0] * fewer, wanted[1] * fewer), rtol=1e-4), hint)
    expect(
        not np.allclose((east, north), wanted, rtol=5e-3),
        "nearly right: is the radius 6371 km, and the cosine that of the mean latitude?",
    )
    for name, value, correct in (("east", east, wanted[0]), ("north", north, wanted[1])):
        expect(
            close(value, correct, 1e-4),
            f"std_{name} is wrong: {n} looks come out with {value:.4g} m.",
        )


def _explain_radius(value: float, share: float, looks: int, sigma: float) -> None:
    right = sigma * math.sqrt(-2.0 * math.log1p(-share) / looks)
    expect(
        not close(value, right * math.sqrt(looks)) or looks == 1,
        "the number of looks does not count in your radius: this is for one look.",
    )
    expect(not close(value, right * looks), "more looks need a smaller radius, not a larger one.")
    expect(
        not close(value, sigma * math.sqrt(-2.0 * math.log(share) / looks)),
        "this is for the robots that do *not* stop: share or 1 - share?",
    )
    expect(not close(value, right / math.sqrt(2.0)), "look at the 2 in (9.1).")
    expect(
        not close(value, sigma * (right / sigma) ** 2), "(9.1) holds R^2: is there a root missing?"
    )
    mistaken = sigma * math.sqrt(-2.0 * math.log1p(-share / looks))
    expect(
        not close(value, mistaken),
        "chances do not simply add up over the looks: what is the chance that *none* of them stops the robot?",
    )


def _explain_mean(value: float, sigma: float, n: int, c: float, right: float) -> None:
    k, white = np.arange(1, n), sigma / math.sqrt(n)
    expect(not close(value, right**2), "this is the variance, in m^2; its root is asked for.")
    expect(
        not close(value, white),
        "the correlation does not count in your result: neighbours that are alike tell less than two strangers.",
    )
    once = white * math.sqrt(max(0.0, 1.0 + float((c**k * (1.0 - k / n)).sum())))
    expect(
        not close(value, once),
        "each pair of looks stands in the square of the sum twice: once as (i, j), once as (j, i).",
    )
    every = white * math.sqrt(max(0.0, 1.0 + 2.0 * float((c**k).sum())))
    expect(not close(value, every), "there are n - k pairs that are k apart, not n.")
    many = white * math.sqrt((1.0 + c) / (1.0 - c))
    expect(
        not close(value, many),
        "this holds for very many looks; the first and the last have fewer neighbours.",
    )
    alone = white * math.sqrt(max(0.0, 1.0 + 2.0 * c * (n - 1) / n))
    expect(
        not close(value, alone),
        "not only neighbours are alike: what about looks that are two or three apart?",
    )


def _logs(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Latitudes and longitudes of receivers that stand still, the first one at a middle latitude."""
    random, found = np.random.default_rng(90), []
    for k in range(count):
        at = GeoPoint(
            lat=random.uniform(35.0, 70.0) * (1.0 if k % 2 == 0 else -1.0),
            lon=random.uniform(-120.0, 150.0),
        )
        at = GeoPoint(lat=0.02, lon=10.0) if k == count - 1 else at
        n, spread = int(random.integers(4, 30)), random.uniform(0.3, 4.0, 2)
        points = point_at(at, *(spread[:, None] * random.standard_normal((2, n))))
        found.append((np.array(points.lat), np.array(points.lon)))
    return found
