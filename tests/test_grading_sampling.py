"""The checks of chapter 8's exercises: right answers in other words pass, mistakes get the hint that explains them."""

import pytest
from graded import lost

CHAPTER = "ch08"
STEP = """
def longest_euler_step(poles):
    poles = [complex(pole) for pole in poles]
    if max(pole.real for pole in poles) >= 0:
        raise ValueError("unstable")
    return {}
"""
WHEEL = """
def wheel_gains(a, g, times):
    return {}
"""
RIGHT = {
    "by the angle of the pole": (
        "step",
        STEP.format(
            "min(2 * math.cos(math.pi - abs(math.atan2(p.imag, p.real))) / abs(p) for p in poles)"
        ),
    ),
    "as a float of numpy": (
        "step",
        STEP.format("np.min([-2 / (p.real + p.imag**2 / p.real) for p in poles])"),
    ),
    "by trial, to 0.05 %": (
        "step",
        STEP.format("0.9995 * min(-2 * p.real / abs(p) ** 2 for p in poles)"),
    ),
    "one gain from the other": (
        "wheel",
        WHEEL.format("np.array([times * a / g - a / g, times * a / g])"),
    ),
    "other gains": ("slow", "gains = wmr.Gains(0.4, 1.5, 2.0, 1.88)"),
}
MISTAKES = [
    (
        "step",
        STEP.format("min(2 * p.real / abs(p) ** 2 for p in poles)"),
        "a step must be positive",
    ),
    ("step", STEP.format("2 / max(-p.real for p in poles)"), "this is right for real poles"),
    (
        "step",
        STEP.format("(lambda p: -2 * p.real / abs(p) ** 2)(max(poles, key=abs))"),
        "One that is slower, but swings",
    ),
    (
        "step",
        STEP.format("0.9 * min(-2 * p.real / abs(p) ** 2 for p in poles)"),
        "it is not the longest",
    ),
    ("step", STEP.format("1.1 * min(-2 * p.real / abs(p) ** 2 for p in poles)"), "in each step"),
    ("step", STEP.format("None"), "does it end in `return`?"),
    ("step", STEP.format("poles[0]"), "one number is needed"),
    ("step", STEP.format("wmr.longest_step(paper.OUTDOOR_GAINS)"), "asks for your own formula"),
    ("step", "longest_euler_step = 0.05", "a function is needed"),
    ("step", STEP.format("0.05"), "it is not the longest"),
    (
        "wheel",
        WHEEL.format("(times * a / g, (times + 1) * a / g)"),
        "the motor's own `a` slows the wheel, too",
    ),
    ("wheel", WHEEL.format("(times, times + a / g)"), "it turns rad/s into volts"),
    ("wheel", WHEEL.format("((times - 1) * a / g, times)"), "which voltage keeps a constant speed"),
    ("wheel", WHEEL.format("((1 - times) * a / g, a / g)"), "runs away"),
    ("wheel", WHEEL.format("((times - 1) * a * g, times * a / g)"), "was asked for"),
    (
        "wheel",
        WHEEL.format("((times - 1) * a / g, (times + 1) * a / g)"),
        "when the speed is right and constant",
    ),
    ("wheel", WHEEL.format("((times - 1) * a / g, 1)"), "when the speed is right and constant"),
    ("wheel", WHEEL.format("times * a / g"), "2 numbers"),
    ("wheel", WHEEL.format("(a / g, a / g)"), "needs no feedback"),
    ("slow", "gains = paper.OUTDOOR_GAINS", "in all for up to 4."),
    ("slow", "gains = wmr.Gains(0.4, 1.5, 1.0, 1.85)", "where 3 deg are allowed"),
    ("slow", "gains = wmr.Gains(0.4, 1.5, 2.0, 1.5)", "where 42 s are allowed"),
    ("slow", "gains = wmr.Gains(0.4, 1.5, 2.0, 0.5)", "has not arrived after 60 s"),
    ("slow", "gains = wmr.Gains(0.4, 1.5, 2.0, 0.2)", "of 40 other starts"),
    ("slow", "gains = wmr.Gains(0.5, 2.0, 2.0, 1.75)", "end more than 6 deg off"),
    ("slow", "gains = 3", "`wmr.Gains("),
]


@pytest.mark.parametrize("name", RIGHT)
def test_other_right_answers(name):
    assert lost(CHAPTER, *RIGHT[name]) == {}


@pytest.mark.parametrize(("cell", "source", "hint"), MISTAKES)
def test_mistakes(cell, source, hint):
    hints = lost(CHAPTER, cell, source)
    assert any(hint in each for each in hints.values()), hints
