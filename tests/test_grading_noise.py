"""The checks of chapter 9's exercises: right answers in other words pass, mistakes get the hint that explains them."""

import pytest
from graded import lost

CHAPTER = "ch09"
SCATTER = """
def scatter(lat, lon):
    mean, metre = (np.mean(lat), np.mean(lon)), math.radians(1) * 6_371_000
    cos, east, north = math.cos(math.radians(mean[0])), np.std(lon, ddof=1) * metre, np.std(lat, ddof=1) * metre
    return {}
"""
RADIUS = """
def arrival_radius(share, looks, sigma):
    return {}
"""
MEAN = """
def scatter_of_mean(sigma, n, c):
    white, k = sigma / math.sqrt(n), np.arange(1, n)
    return {}
"""
RIGHT = {
    "scaled at the end": ("scatter", SCATTER.format("np.array([*mean, east * cos, north])")),
    "in place": (
        "scatter",
        """
def scatter(lat, lon):
    mean = lat.mean(), lon.mean()
    lat -= mean[0]
    lon -= mean[1]
    lat *= 6_371_000 * math.pi / 180
    lon *= 6_371_000 * math.pi / 180 * math.cos(math.radians(mean[0]))
    return *mean, lon.std(ddof=1), lat.std(ddof=1)
""",
    ),
    "one look's chance first": (
        "radius",
        RADIUS.format("sigma * np.sqrt(-2 * np.log((1 - share) ** (1 / looks)))"),
    ),
    "the whole matrix": (
        "averaging",
        MEAN.format(
            "sigma / n * np.sqrt((float(c) ** abs(np.subtract.outer(range(n), range(n)))).sum())"
        ),
    ),
    "a power of each pair": (
        "averaging",
        MEAN.format("white * np.sqrt(1 + 2 * np.sum((1 - k / n) * c**k))"),
    ),
}
MISTAKES = [
    (
        "scatter",
        SCATTER.format("mean[1], mean[0], east * cos, north"),
        "the latitude is asked for first",
    ),
    (
        "scatter",
        SCATTER.format("mean[0] + 1e-6, mean[1], east * cos, north"),
        "the mean latitude is 0.111 m off",
    ),
    (
        "scatter",
        SCATTER.format("np.radians(mean[0]), mean[1], east * cos, north"),
        "plain mean, in degrees",
    ),
    ("scatter", SCATTER.format("*mean, north, east * cos"), "east and north are swapped"),
    (
        "scatter",
        SCATTER.format("*mean, math.degrees(east * cos), math.degrees(north)"),
        "an angle in radians, not in degrees",
    ),
    ("scatter", SCATTER.format("*mean, east, north * cos"), "which circles get smaller"),
    ("scatter", SCATTER.format("*mean, (east * cos) ** 2, north**2"), "these are variances"),
    ("scatter", SCATTER.format("*mean, 1.001 * east * cos, 1.001 * north"), "nearly right"),
    ("scatter", SCATTER.format("*mean, east * cos, 1.0"), "std_north is wrong"),
    ("scatter", SCATTER.format("*mean, 1.0, north"), "std_east is wrong"),
    ("scatter", SCATTER.format("mean"), "4 numbers"),
    (
        "scatter",
        "import wmrlib\ndef scatter(lat, lon):\n    return wmrlib.stationary_scatter(lat)",
        "asks for your own formula",
    ),
    (
        "radius",
        RADIUS.format("sigma * math.sqrt(-2 * math.log(1 - share) * looks)"),
        "more looks need a smaller radius",
    ),
    (
        "radius",
        RADIUS.format("sigma * math.sqrt(-math.log(1 - share) / looks)"),
        "look at the 2 in (9.1)",
    ),
    (
        "radius",
        RADIUS.format("sigma * -2 * math.log(1 - share) / looks"),
        "is there a root missing",
    ),
    ("radius", RADIUS.format("0.46 * sigma"), "robots stop (looks: 1)"),
    ("radius", RADIUS.format("-sigma"), "a radius is positive"),
    ("radius", RADIUS.format("0.5"), "three times the noise"),
    (
        "radius",
        RADIUS.format("sigma * math.sqrt(-2 * math.log(1 - 0.5) / looks)"),
        "a larger share needs",
    ),
    ("averaging", MEAN.format("sigma / n"), "do not add up like equal ones"),
    ("averaging", MEAN.format("sigma"), "2 independent looks of 0.5 m"),
    ("averaging", MEAN.format("white * math.sqrt((1 + c) / (1 - c))"), "for very many looks"),
    ("averaging", MEAN.format("white * math.sqrt(1 + 2 * c * (n - 1) / n)"), "two or three apart"),
    ("averaging", MEAN.format("white * (1 + c)"), "sum over all pairs"),
    (
        "averaging",
        MEAN.format(
            "sigma / n * math.sqrt(n + 2 * (n * c - c - n * c**2 + c ** (n + 1)) / (1 - c) ** 2)"
        ),
        "stops with ZeroDivision",
    ),
]


@pytest.mark.parametrize("name", RIGHT)
def test_other_right_answers(name):
    assert lost(CHAPTER, *RIGHT[name]) == {}


@pytest.mark.parametrize(("cell", "source", "hint"), MISTAKES)
def test_mistakes(cell, source, hint):
    hints = lost(CHAPTER, cell, source)
    assert any(hint in each for each in hints.values()), hints
