"""The checks of chapter 12's exercises: right answers in other words pass, mistakes get the hint that explains them."""

from pathlib import Path

import pytest
from graded import lost

from wmrbook.grading import routes

CHAPTER = "ch12"
CHECKSUM = """
def checksum_fits(sentence):
    body, star, digits = sentence.strip().removeprefix("$").partition("*")
    value = 0
    for code in {}.encode():
        value ^= code
    return {}
"""
DEGREES = """
def degrees(field, hemisphere):
    whole, minutes = divmod(float(field), 100)
    sign = -1 if hemisphere in "SW" else 1
    return {}
"""
HEADINGS = """
def headings(x, y):
    points = x + 1j * y
    new = np.insert(np.diff(points) != 0, 0, True)
    way = np.exp(1j * np.angle(np.diff(points[new])))
    middle = np.angle(np.concatenate([way[:1], way[1:] + way[:-1], way[-1:]]))
    middle = middle[new.cumsum() - 1]
    return {}
"""
RIGHT = {
    "int with a base": (
        "checksum",
        CHECKSUM.format("body", "star == '*' and np.True_ & (int(digits, 16) == value)"),
    ),
    "divmod": ("degrees", DEGREES.format("sign * (whole + minutes / 60)")),
    "unit vectors": ("headings", HEADINGS.format("middle.tolist()")),
    "in place": (
        "headings",
        HEADINGS.format("middle").replace("points = ", "x -= x[0]; y -= y[0]; points = "),
    ),
    "wmrlib's own, written out": (
        "headings",
        HEADINGS.format("np.where(middle <= -math.pi, math.pi, middle)"),
    ),
    "a loop, a turn more": (
        "headings",
        """
def headings(x, y):
    found, legs, last = [], np.column_stack([np.diff(x), np.diff(y)]).tolist(), len(x) - 1
    for k in range(last + 1):
        before = [leg for leg in legs[:k] if any(leg)]
        after = [leg for leg in legs[k:] if any(leg)]
        come, leave = (before or after)[-1 if before else 0], (after or before)[0 if after else -1]
        come, leave = (math.atan2(north, east) for east, north in (come, leave))
        found.append(come + math.remainder(leave - come, 2 * math.pi) / 2 + 2 * math.pi)
    return found
""",
    ),
}
FITS = "star == '*' and digits.upper() == f'{value:02X}'"
MISTAKES = [
    ("checksum", CHECKSUM.format("(body + '*')", FITS), "the `*` is not part of the sum"),
    ("checksum", CHECKSUM.format("('$' + body + '*')", FITS), "neither the `$` nor the `*`"),
    ("checksum", CHECKSUM.format("body", "star == '*' and digits == str(value)"), "hexadecimal"),
    ("checksum", CHECKSUM.format("body", FITS.replace(".upper()", "")), "in small letters"),
    (
        "checksum",
        CHECKSUM.format("body", "digits.upper() in ('', f'{value:02X}')"),
        "has no checksum that could fit",
    ),
    ("checksum", CHECKSUM.format("body", "False"), "is as a receiver sent it"),
    ("checksum", CHECKSUM.format("body", "value"), "True or False is needed"),
    ("checksum", CHECKSUM.format("body[:1]", "star == '*'"), "you say that it fits"),
    ("checksum", CHECKSUM.format("body", "star == '*' and len(digits) == 2"), "is damaged"),
    ("degrees", DEGREES.format("float(field)"), "run together"),
    ("degrees", DEGREES.format("math.radians(sign * (whole + minutes / 60))"), "not radians"),
    ("degrees", DEGREES.format("sign * float(field) / 60"), "only the last two digits"),
    ("degrees", DEGREES.format("sign * (whole + minutes)"), "a minute is not a degree"),
    (
        "degrees",
        DEGREES.format("sign * (float(field[:3]) + float(field[3:]) / 60)"),
        "a latitude has two digits",
    ),
    ("degrees", DEGREES.format("sign * whole"), "the minutes are lost"),
    ("degrees", DEGREES.format("sign * (whole + int(minutes) / 60)"), "they are metres"),
    ("degrees", DEGREES.format("sign * (whole + minutes / 60.01)"), "beside the place"),
    ("degrees", DEGREES.format("sign * round(whole + minutes / 60, 6)"), "beside the place"),
    ("degrees", DEGREES.format("-sign * (whole + minutes / 60)"), "south and west are negative"),
    ("degrees", DEGREES.format("str(whole)"), "one number is needed"),
    ("checksum", CHECKSUM.format("body", FITS.replace("02X", "X")), "two digits: 0C, not C"),
    (
        "headings",
        HEADINGS.format("middle").replace(
            "np.diff(points) != 0", "np.diff(points) == np.diff(points)"
        ),
        "makes no leg",
    ),
    ("headings", HEADINGS.format("np.angle(way)"), "numbers are needed"),
    ("headings", HEADINGS.format("middle + math.pi"), "drives the route backwards"),
    ("headings", HEADINGS.format("np.degrees(middle)"), "these are degrees"),
    (
        "headings",
        HEADINGS.format("np.angle(np.insert(way, 0, way[0]))"),
        "that comes to each point",
    ),
    ("headings", HEADINGS.format("np.append(middle[:-1], 0)"), "along the last leg"),
    ("headings", HEADINGS.format("np.insert(middle[1:], 0, 0)"), "along the first leg"),
    (
        "headings",
        HEADINGS.format("np.concatenate([middle[:1], 0 * middle[1:-1], middle[-1:]])"),
        "half-way between",
    ),
    ("headings", HEADINGS.format("0 * middle"), "turn the route by a quarter"),
    ("headings", HEADINGS.format("1 + 0 * middle"), "the mirrored headings"),
]


@pytest.mark.parametrize("name", RIGHT)
def test_other_right_answers(name):
    assert lost(CHAPTER, *RIGHT[name]) == {}


@pytest.mark.parametrize(("cell", "source", "hint"), MISTAKES)
def test_mistakes(cell, source, hint):
    hints = lost(CHAPTER, cell, source)
    assert any(hint in each for each in hints.values()), hints


def test_the_sentences_are_those_of_the_log():
    log = (
        Path(__file__)
        .parents[1]
        .joinpath("notebooks/data/ublox5-standing.nmea")
        .read_text(encoding="utf-8", errors="replace")
    )
    assert all(f"${body}*" in log for body in routes.BODIES)
