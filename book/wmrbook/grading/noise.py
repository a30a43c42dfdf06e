"""Checks of a noisy receiver: its scatter, its arrival radius, and what averaging leaves."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from wmrbook.grading._asking import ask_number, ask_numbers
from wmrbook.grading._hints import close, expect, explain, own_work, rule_out, slip, spread
from wmrbook.scatter import stationary_scatter
from wmrlib.geodesy import EARTH_RADIUS_M, GeoPoint, point_at

DEGREE = math.radians(1.0) * EARTH_RADIUS_M  # of latitude, m
_near = partial(np.allclose, rtol=1e-4)


def scatter_known(scatter: Callable) -> str:
    """scatter(lat, lon) -> (mean_lat, mean_lon, std_east, std_north): degrees and metres."""
    own_work(scatter)
    for lat, lon in _logs(12):
        right = stationary_scatter(GeoPoint(lat=lat, lon=lon))
        mean_lat, mean_lon, *stds = value = ask_numbers(scatter, 4, lat.copy(), lon.copy())
        hint = "the mean longitude comes first; the latitude is asked for first."
        expect(not close(mean_lat, right.mean.lon, 1e-9), hint)
        order = "(mean_lat, mean_lon, std_east, std_north)" * (abs(mean_lat - right.mean.lat) > 1.0)
        slip(value, (right.mean.lat, right.mean.lon, right.std_east, right.std_north), order, 0.0)
        for name, value, mean in (
            ("latitude", mean_lat, right.mean.lat),
            ("longitude", mean_lon, right.mean.lon),
        ):
            off = abs(value - mean)
            hint = f"the mean {name} is {off * DEGREE:.3g} m off; it is a plain mean, in degrees."
            expect(off < 2e-9, hint)
        if not _near(stds, (right.std_east, right.std_north)):
            _explain_scatter(stds, lat, lon, right)
    return "Twelve receivers from the equator to 70 deg: mean and scatter are right."


def scatter_properties(scatter: Callable) -> str:
    """The same elsewhere and in another order; twice the error is twice the scatter."""
    own_work(scatter)
    for lat, lon in _logs(5):
        spread = np.array(ask_numbers(scatter, 4, lat.copy(), lon.copy())[2:])
        expect(bool((spread > 0.0).all()), "a standard deviation is positive.")
        doubled = 2.0 * lat - lat.mean(), 2.0 * lon - lon.mean()
        for changed, times, hint in [
            ((lat, lon - 30.0), 1.0, "30 deg further west the same receiver must scatter as much."),
            ((-lat, lon), 1.0, "on the other hemisphere the same receiver must scatter as much."),
            ((lat[::-1], lon[::-1]), 1.0, "the order of the looks must not count."),
            (doubled, 2.0, "twice as far from the mean must be twice the standard deviation."),
        ]:
            stds = ask_numbers(scatter, 4, *map(np.array, changed))[2:]
            expect(np.allclose(stds, times * spread, rtol=1e-6), hint)
    lon = np.array([-1e-5, 0.0, 1e-5, 2e-5])
    east, north = ask_numbers(scatter, 4, 60.0 + lon, lon)[2:]
    hint = "at 60 deg of latitude a degree of longitude is half as long as one of latitude."
    expect(close(2.0 * east, north, 1e-4), hint)
    step = 1e-5 * DEGREE
    north = f"At 60 deg, a step of 1e-5 deg is {step:.2f} m to the north"
    return f"{north} and {0.5 * step:.2f} m to the east."


def radius_share(arrival_radius: Callable) -> str:
    """arrival_radius(share, looks, sigma): this share of simulated robots on the goal stops."""
    own_work(arrival_radius)
    random = np.random.default_rng(91)
    for share, looks in ((0.5, 1), (0.9, 1), (0.5, 10), (0.9, 5), (0.99, 20), (0.1, 3)):
        sigma = random.uniform(0.3, 3.0)
        value = ask_number(arrival_radius, share, looks, sigma)
        expect(value > 0.0, f"a radius of {value:.3g} m: a radius is positive.")
        nearest = np.hypot(*random.standard_normal((2, 40_000, looks))).min(axis=1) * sigma
        stopped = float((nearest < value).mean())
        if abs(stopped - share) > 0.012:
            hint = f"with your radius {100 * stopped:.1f} % of 40 000 robots stop "
            hint += f"(looks: {looks}); {100 * share:.0f} % were wanted."
            _explain_radius(value, share, looks, sigma, hint)
    return "40 000 simulated robots, six times: the wanted share of them stops."


def radius_properties(arrival_radius: Callable) -> str:
    """Proportional to sigma; half of it with four times the looks; larger for a larger share."""
    own_work(arrival_radius)
    for share, looks, sigma in ((0.2, 2, 0.5), (0.5, 7, 1.5), (0.95, 12, 2.5)):
        value = ask_number(arrival_radius, share, looks, sigma)
        noisy = ask_number(arrival_radius, share, looks, 3.0 * sigma)
        expect(close(noisy, 3.0 * value), "three times the noise needs three times the radius.")
        hint = "with four times the looks half of the radius does: how often are all looks outside?"
        expect(close(2.0 * ask_number(arrival_radius, share, 4 * looks, sigma), value), hint)
        larger = ask_number(arrival_radius, 0.5 + 0.5 * share, looks, sigma)
        expect(larger > value, "a larger share needs a larger radius.")
    value = ask_number(arrival_radius, 0.9, 10, 0.5)
    noise = f"Half a metre of noise, ten looks: {value:.2f} m"
    return f"{noise} stop 90 % of the robots on the goal."


def mean_white(scatter_of_mean: Callable) -> str:
    """scatter_of_mean(sigma, n, correlation) for independent looks."""
    own_work(scatter_of_mean)
    for sigma, n in ((0.5, 1), (0.5, 2), (1.5, 9), (3.0, 100)):
        value, right = ask_number(scatter_of_mean, sigma, n, 0.0), sigma / math.sqrt(n)
        if not close(value, right):
            alike = sigma / n if n > 1 else math.inf
            mistakes = {
                "this is the variance, in m^2; its root is asked for.": right**2,
                "independent errors do not add up like equal ones: their variances do.": alike,
            }
            hint = f"{n} independent looks of {sigma:g} m: "
            hint += f"the mean comes out with {value:.4g} m."
            explain(value, mistakes, hint, right=right)
    return "Nine independent looks: a third of the scatter of one."


def mean_correlated(scatter_of_mean: Callable) -> str:
    """The same for looks that are alike: against the sum over all pairs, and the limits."""
    own_work(scatter_of_mean)
    random, sizes = np.random.default_rng(93), (2, 3, 5, 9, 30, 200)
    cases = [
        (random.uniform(0.3, 3.0), sizes[k % 6], 1.0 - unlike)
        for k, unlike in enumerate(spread(1e-4, 0.8, 24))
    ]
    for sigma, n, c in [*cases, *((1.0, n, c) for n in (3, 4, 9) for c in (-0.5, -0.9, 0.0))]:
        value, apart = ask_number(scatter_of_mean, sigma, n, c), np.arange(n)
        right = sigma / n * math.sqrt((c ** np.abs(apart[:, None] - apart)).sum())
        if not close(value, right, 1e-6):
            hint = f"{n} looks of {sigma:.3g} m, neighbours correlated by {c:.4g}: "
            hint += f"the mean comes out with {value:.4g} m. Write the variance of the sum as a "
            hint += "sum over all pairs of looks, and count how many pairs are k apart."
            _explain_mean(value, sigma, n, c, right, hint)
    for n in (1, 5, 50):
        hint = "errors that are all the same (correlation 1) do not average out at all."
        expect(close(ask_number(scatter_of_mean, 0.8, n, 1.0), 0.8), hint)
    value = ask_number(scatter_of_mean, 1.0, 9, 0.9)
    remark = f"the mean keeps {100 * value:.0f} % of the scatter, where white noise keeps 33 %."
    return f"Nine looks, neighbours alike by 0.9: {remark}"


def _explain_scatter(stds: list[float], lat: np.ndarray, lon: np.ndarray, right) -> None:
    n, middle = lat.size, right.mean.lat
    east, north = spreads = right.std_east, right.std_north
    cos, fewer = math.cos(math.radians(middle)), math.sqrt((n - 1) / n)
    lat_std, lon_std, degree = lat.std(ddof=1), lon.std(ddof=1), math.degrees(1.0)
    in_degrees = "the scatter is in degrees; metres are asked for."
    steps = "an arc is the radius times an angle in radians, not in degrees."
    narrow = "a degree of longitude is not as long as one of latitude: "
    narrow += "where is the latitude in your std_east?"
    wrong = "the cosine stands at the wrong one of the two: "
    wrong += "which circles get smaller towards the poles?"
    for mistaken, hint in (
        ((north, east), "east and north are swapped."),
        ((lon_std, lat_std), in_degrees),
        ((lon_std * cos, lat_std), in_degrees),
        ((east * degree, north * degree), steps),
        ((east / cos, north), narrow),
        ((east / cos, north * cos), wrong),
        ((east / cos * abs(math.cos(middle)), north), "a cosine was given degrees."),
        ((east**2, north**2), "these are variances, in m^2; their roots are asked for."),
    ):
        for share in (1.0, fewer):
            rule_out(stds, {hint: np.multiply(mistaken, share)}, _near)
    small = f"of {n} looks the scatter comes out {100 * (1 - fewer):.1f} % too small: "
    hint = "the mean was computed from the same looks. How many are left?"
    expect(not _near(stds, np.multiply(spreads, fewer)), small + hint)
    hint = "nearly right: is the radius 6371 km, and the cosine that of the mean latitude?"
    expect(not np.allclose(stds, spreads, rtol=5e-3), hint)
    for name, value, correct in zip(("east", "north"), stds, spreads, strict=True):
        hint = f"std_{name} is wrong: {n} looks come out with {value:.4g} m."
        expect(close(value, correct, 1e-4), hint)


def _explain_radius(value: float, share: float, looks: int, sigma: float, hint: str) -> None:
    missed = -2.0 * math.log1p(-share)  # (R/sigma)^2 for one look
    right, several = sigma * math.sqrt(missed / looks), 1.0 if looks > 1 else math.inf
    single = sigma * math.sqrt(missed) * several
    stay = sigma * math.sqrt(-2.0 * math.log(share) / looks)
    mistakes = {
        "the number of looks does not count in your radius: this is for one look.": single,
        "more looks need a smaller radius, not a larger one.": right * looks * several,
        "this is for the robots that do *not* stop: share or 1 - share?": stay,
        "look at the 2 in (9.1).": right / math.sqrt(2.0),
        "(9.1) holds R^2: is there a root missing?": sigma * missed / looks,
        "chances do not simply add up over the looks: what is the chance that *none* of them "
        "stops the robot?": sigma * math.sqrt(-2.0 * math.log1p(-share / looks)),
    }
    explain(value, mistakes, hint)


def _explain_mean(value: float, sigma: float, n: int, c: float, right: float, hint: str) -> None:
    k, white = np.arange(1, n), sigma / math.sqrt(n)

    def mean(pairs: float) -> float:
        return white * math.sqrt(max(0.0, 1.0 + pairs))

    rule_out(value, {"this is the variance, in m^2; its root is asked for.": right**2})
    many, near = white * math.sqrt((1.0 + c) / (1.0 - c)), mean(2.0 * c * (n - 1) / n)
    mistakes = {
        "the correlation does not count in your result: "
        "neighbours that are alike tell less than two strangers.": white,
        "each pair of looks stands in the square of the sum twice: "
        "once as (i, j), once as (j, i).": mean(float((c**k * (1.0 - k / n)).sum())),
        "there are n - k pairs that are k apart, not n.": mean(2.0 * float((c**k).sum())),
        "this holds for very many looks; the first and the last have fewer neighbours.": many,
        "not only neighbours are alike: what about looks that are two or three apart?": near,
    }
    explain(value, mistakes, hint, right=right)


def _logs(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Latitudes and longitudes of receivers that stand still; the last is on the equator."""
    random, logs = np.random.default_rng(90), []
    for k in range(count):
        lat = random.uniform(35.0, 70.0) * (1.0 if k % 2 == 0 else -1.0)
        at = GeoPoint(lat=lat, lon=random.uniform(-120.0, 150.0))
        at = GeoPoint(lat=0.02, lon=10.0) if k == count - 1 else at
        n, spread = int(random.integers(4, 30)), random.uniform(0.3, 4.0, 2)
        points = point_at(at, *(spread[:, None] * random.standard_normal((2, n))))
        logs.append((np.array(points.lat), np.array(points.lon)))
    return logs
