"""The checks of chapter 11's exercises: right answers in other words pass, mistakes get the hint that explains them."""

import pytest
from graded import lost

CHAPTER = "ch11"
COMPASS = """
def heading_of(compass, declination):
    true = math.radians(compass + declination)
    return {}
"""
TICKS = """
def rolled(before, after, per_turn, radius):
    ticks, metre = (after - before + 32768) % 65536 - 32768, 2 * math.pi * radius / per_turn
    return {}
"""
SAFE = """
def wheel_speeds(x, y, heading, age, goal, gains, limits):
    if not all(map(math.isfinite, (x, y, heading, age))) or age < 0 or age > 0.5:
        return 0, 0
    seen = wmr.polar_error(wmr.Pose(x, y, heading), goal)
    v, omega = wmr.control_law(*seen, gains)
    share = min(1, limits.max_speed / max(1e-9, abs(v) + abs(omega) * limits.track_width / 2))
    left, right = wmr.twist_to_wheels(share * v, share * omega, limits.track_width)
    if seen.rho < 0.2:
        return 0, 0
    return {}
"""
RIGHT = {
    "by sine and cosine": ("compass", COMPASS.format("math.atan2(math.cos(true), math.sin(true))")),
    "by ifs": (
        "ticks",
        TICKS.format(
            "metre * (after - before - 65536 * (after - before > 32768) + 65536 * (after - before < -32768))"
        ),
    ),
    "scaled by hand": ("safe", SAFE.format("[left, right]")),
}
MISTAKES = [
    ("compass", COMPASS.format("true"), "still counts clockwise and from north"),
    (
        "compass",
        COMPASS.format("math.pi / 2 - math.radians(compass)"),
        "the declination does not count",
    ),
    ("compass", COMPASS.format("-math.pi / 2 - true"), "the other way round"),
    (
        "compass",
        COMPASS.format("math.pi / 2 - math.radians(compass) - abs(true - math.radians(compass))"),
        "west of north shows too much",
    ),
    (
        "compass",
        COMPASS.format("math.pi / 2 - math.radians(compass - declination)"),
        "which sign has the declination",
    ),
    ("compass", COMPASS.format("1.0"), "check north, east, south and west"),
    (
        "compass",
        COMPASS.format("(90 - math.degrees(true) + 180) % 360 - 180"),
        "this is the heading in degrees",
    ),
    ("compass", COMPASS.format("(math.pi / 2 - true) % (2 * math.pi)"), "not in (-pi, pi]"),
    ("compass", COMPASS.format("wmr.wrap_angle(math.pi / 2 - true)"), "asks for your own formula"),
    (
        "ticks",
        TICKS.format("metre * ((after - before + 32768) % 65535 - 32768)"),
        "how many different numbers",
    ),
    ("ticks", TICKS.format("-metre * ticks"), "forwards and backwards are swapped"),
    ("ticks", TICKS.format("2 * metre * ticks"), "twice as far as it rolled"),
    ("ticks", TICKS.format("radius / per_turn * ticks"), "how long is the way round"),
    ("ticks", TICKS.format("metre / radius * ticks"), "this is the angle"),
    ("ticks", TICKS.format("abs(metre * ticks)"), "forwards and backwards are swapped"),
    ("ticks", TICKS.format("0.1 * ticks / 123"), "yours says"),
    ("ticks", TICKS.format("abs(metre * ticks)"), "there and back"),
    ("safe", SAFE.format("left, right").replace("age < 0 or ", ""), "a clock that runs backwards"),
    (
        "safe",
        SAFE.format("left, right").replace("heading, age)))", "heading)))"),
        "an age that is not finite can't be trusted",
    ),
    (
        "safe",
        SAFE.format("left, right").replace("return 0, 0\n    seen", "return 1, 1\n    seen"),
        "a pose that is not finite is no pose",
    ),
    (
        "safe",
        SAFE.format("left, right").replace("age > 0.5", "age > 50"),
        "silence for more than 0.5 s",
    ),
    ("safe", SAFE.format("left, right").replace("age > 0.5", "age >= 0.5"), "it has no reason to"),
    (
        "safe",
        SAFE.format("left, right").replace("seen.rho < 0.2", "seen.rho < 0.05"),
        "within 0.2 m it has arrived",
    ),
    (
        "safe",
        SAFE.format("left, right").replace("seen.rho < 0.2", "seen.rho < 2"),
        "it has no reason to",
    ),
    (
        "safe",
        SAFE.format("left, right").replace("min(1, ", "(lambda a, b: 1)(1, "),
        "a wheel is asked for",
    ),
    ("safe", SAFE.format("share * v, share * omega"), "this is a twist"),
    ("safe", SAFE.format("left / 2, right / 2"), "which is not the corrected law"),
    (
        "safe",
        SAFE.format("left, right").replace("return 0, 0", "return None"),
        "two speeds are needed, whatever happens",
    ),
    (
        "safe",
        SAFE.format("left, right").replace("return 0, 0", "return math.nan, math.nan"),
        "the wheels get (nan, nan)",
    ),
]


@pytest.mark.parametrize("name", RIGHT)
def test_other_right_answers(name):
    assert lost(CHAPTER, *RIGHT[name]) == {}


@pytest.mark.parametrize(("cell", "source", "hint"), MISTAKES)
def test_mistakes(cell, source, hint):
    hints = lost(CHAPTER, cell, source)
    assert any(hint in each for each in hints.values()), hints
