"""Checks of one's own GPS log: a sentence's checksum, its coordinates, and headings along a route."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import reduce
from operator import xor

import numpy as np

from wmrbook.grading._hints import Passed, ask_array, ask_number, ask_truth, close, expect, own_work
from wmrlib.geodesy import EARTH_RADIUS_M

DEGREE = math.radians(1.0) * EARTH_RADIUS_M  # of latitude, m
BODIES = (  # of the log in notebooks/data; its receiver stood in northern Germany
    "GPRMC,104706.000,A,5405.6081,N,01049.4791,E,0.24,18.02,240709,,,A",
    "GPGGA,104706.000,5405.6081,N,01049.4791,E,1,08,1.1,40.8,M,43.6,M,,0000",
    "GPVTG,18.02,T,,M,0.24,N,0.4,K,A",
    "GPGSA,A,3,28,18,27,19,08,09,10,15,,,,,1.7,1.1,1.3",
    "GPTXT,01,01,02,ANTSTATUS=OK",
)


def checksum_known(checksum_fits: Callable) -> Passed:
    """checksum_fits(sentence) -> bool: True for what a receiver sent, False for another or no checksum."""
    own_work(checksum_fits)
    for body in (*BODIES, "GPTXT,01,01,02,A", "GPTXT,01,01,02,HW  UBX-G5xxx  00040005 "):
        value = reduce(xor, body.encode())
        for end in (f"{value:02X}", f"{value:02x}"):
            told = ask_truth(checksum_fits, f"${body}*{end}")
            if not told:
                _explain_checksum(checksum_fits, body, end)
        hint = "a line ends in \\r\\n, which is neither of the two digits."
        expect(ask_truth(checksum_fits, f"${body}*{value:02X}\r\n"), hint)
        for other in {value ^ bit for bit in (1, 16, 36, 128)}:
            hint = f"'${body}*{other:02X}' has a wrong checksum, and you say that it fits."
            expect(not ask_truth(checksum_fits, f"${body}*{other:02X}"), hint)
        expect(
            not ask_truth(checksum_fits, f"${body}"),
            "a sentence without a `*` and two digits has no checksum that could fit.",
        )
    return Passed("Real sentences pass, wrong and missing checksums do not.")


def checksum_damage(checksum_fits: Callable) -> Passed:
    """A single changed character is always found."""
    own_work(checksum_fits)
    random, damaged = np.random.default_rng(121), 0
    for body in BODIES:
        value = reduce(xor, body.encode())
        expect(
            ask_truth(checksum_fits, f"${body}*{value:02X}"),
            "a sentence as the receiver sent it must pass.",
        )
        for place in range(len(body)):
            wrong = chr(random.choice([each for each in range(48, 91) if chr(each) != body[place]]))
            sentence = f"${body[:place]}{wrong}{body[place + 1 :]}*{value:02X}"
            expect(
                not ask_truth(checksum_fits, sentence),
                f"'{sentence}' is damaged (its character {place + 1}), and you say that it fits.",
            )
            damaged += 1
    swapped = "GPVTG,81.02,T,,M,0.24,N,0.4,K,A"
    fooled = ask_truth(checksum_fits, f"${swapped}*{reduce(xor, BODIES[2].encode()):02X}")
    return Passed(
        f"{damaged} damaged sentences found."
        + (" Two swapped characters, 81 for 18, fool every such checksum." if fooled else "")
    )


def degrees_known(degrees: Callable) -> Passed:
    """degrees(field, hemisphere): "5405.6081", "N" -> degrees; south and west are negative."""
    own_work(degrees)
    for field, hemisphere, right in [("5405.6081", "N", 54.09346833333333), *_fields(30)]:
        value = ask_number(degrees, field, hemisphere)
        if abs(value - right) * DEGREE < 1e-3:
            continue
        seen, (whole, minutes) = f"'{field}', '{hemisphere}'", divmod(float(field), 100.0)
        for mistaken, hint in [
            (-right, f"{seen}: south and west are negative, north and east are not."),
            (math.radians(right), "degrees are asked for, not radians."),
            (
                float(field),
                f"{seen} is no number of degrees yet: the field is degrees and minutes, run together.",
            ),
            (
                float(field) / 100.0,
                f"{seen}: the last digits before the point are minutes, and a degree has 60 of them.",
            ),
            (
                float(field) / 60.0,
                f"{seen}: only the last two digits before the point, and what follows it, are minutes.",
            ),
            (whole + minutes, f"{seen}: a minute is not a degree."),
            (
                float(field[:2]) + float(field[2:]) / 60.0,
                f"{seen}: a longitude has three digits of degrees. Count the minutes' from the point.",
            ),
            (
                float(field[:3]) + float(field[3:]) / 60.0,
                f"{seen}: a latitude has two digits of degrees. Count the minutes' from the point.",
            ),
            (whole, f"{seen}: the minutes are lost."),
            (
                whole + math.floor(minutes) / 60.0,
                f"{seen}: the decimals of the minutes are lost; they are metres.",
            ),
        ]:
            expect(
                not any(
                    close(value, sign * mistaken, 1e-9)
                    for sign in ({1.0, math.copysign(1.0, right)})
                ),
                hint,
            )
        off = abs(value - right) * DEGREE
        expect(False, f"{seen} comes out {off:.3g} m beside the place.")
    return Passed("Thirty coordinates, in all four hemispheres, to the millimetre.")


def degrees_steps(degrees: Callable) -> Passed:
    """A step of the last digit is always equally long, across a whole minute and a whole degree too."""
    own_work(degrees)
    step = 1e-4 / 60.0
    for one, other, sides in [
        ("5405.9999", "5406.0000", "NS"),
        ("5459.9999", "5500.0000", "NS"),
        ("00959.9999", "01000.0000", "EW"),
    ]:
        for side, sign in zip(sides, (1.0, -1.0), strict=True):
            moved = sign * (ask_number(degrees, other, side) - ask_number(degrees, one, side))
            hint = f"from '{one}' to '{other}' ({side}) is one step of the last digit, {step * DEGREE:.3f} m; yours is {moved * DEGREE:.6g} m."
            expect(close(moved, step, 1e-4), hint)
    for field, side in (("0000.0000", "S"), ("00000.0000", "W")):
        expect(
            ask_number(degrees, field, side) == 0.0,
            "the equator and the meridian of Greenwich are at 0 degrees.",
        )
    expect(
        close(ask_number(degrees, "18000.0", "W"), -180.0),
        "'18000.0', 'W' is the date line, at -180 degrees.",
    )
    return Passed(f"The last of four decimals is {step * DEGREE:.3f} m north, everywhere.")


def headings_known(headings: Callable) -> Passed:
    """headings(x, y): one for each waypoint: the first leg's, half-way through each turn, the last leg's."""
    own_work(headings)
    for x, y in _routes(20):
        value, legs = (
            ask_array(headings, (x.size,), x.copy(), y.copy()),
            np.arctan2(np.diff(y), np.diff(x)),
        )
        right = _bisecting(legs)
        if _same(value, right):
            continue
        bearings = math.pi / 2.0 - right
        expect(
            not _same(value, bearings),
            "these are bearings, clockwise from north; headings count counter-clockwise from east.",
        )
        expect(not _same(value, np.degrees(right)), "these are degrees; radians are asked for.")
        expect(not _same(value, right + math.pi), "your robot drives the route backwards.")
        expect(
            not _same(value, np.append(legs, legs[-1])),
            "this is the leg that follows each point. Between two legs half of the turn is done.",
        )
        hint = (
            "this is the leg that comes to each point. Between two legs half of the turn is done."
        )
        expect(not _same(value, np.insert(legs, 0, legs[0])), hint)
        mean = np.concatenate([legs[:1], 0.5 * (legs[1:] + legs[:-1]), legs[-1:]])
        hint = "the mean of two angles fails where one is near pi and the other near -pi: how far is the turn, wrapped?"
        expect(not _same(value, mean), hint)
        chord = np.arctan2(y[2:] - y[:-2], x[2:] - x[:-2])
        hint = "from the point before to the point after, the longer leg counts more. The legs' *directions* are to be bisected."
        expect(not _same(value, np.concatenate([legs[:1], chord, legs[-1:]])), hint)
        expect(
            _same(value[:1], legs[:1]), "at the first point the robot looks along the first leg."
        )
        expect(
            _same(value[-1:], legs[-1:]), "at the last point the robot looks along the last leg."
        )
        expect(
            False,
            "at a point in between, the robot does not look half-way between the two legs' directions.",
        )
    return Passed(
        "Twenty routes: along the first leg, half-way through each turn, along the last leg."
    )


def headings_properties(headings: Callable) -> Passed:
    """Mirrored, shifted, enlarged, driven back, with points entered twice; a straight line keeps its direction."""
    own_work(headings)
    for x, y in _routes(10):
        found = ask_array(headings, (x.size,), x.copy(), y.copy())
        for changed, right, hint in [
            ((x.copy(), -y), -found, "the mirrored route must have the mirrored headings."),
            (
                (x + 1000.0, y - 500.0),
                found,
                "somewhere else the same route must have the same headings.",
            ),
            (
                (3.0 * x, 3.0 * y),
                found,
                "a route three times as large must have the same headings.",
            ),
            (
                (-y, x.copy()),
                found + math.pi / 2.0,
                "turn the route by a quarter, and every heading must turn by as much.",
            ),
            (
                (x[::-1].copy(), y[::-1].copy()),
                found[::-1] + math.pi,
                "driven from its end to its start, every heading must be the opposite one.",
            ),
        ]:
            expect(_same(ask_array(headings, (x.size,), *changed), right), hint)
        for count in (np.arange(x.size) % 3 + 1, np.arange(x.size)[::-1] % 2 + 1):
            value = ask_array(headings, (count.sum(),), np.repeat(x, count), np.repeat(y, count))
            expect(
                _same(value, np.repeat(found, count)),
                "a point that is entered again makes no leg: it has the heading that it has when entered once.",
            )
    for direction in np.radians([0.0, 60.0, 90.0, 179.999, 180.0, -90.0, -135.0]).tolist():
        along = np.array([0.0, 1.0, 3.0, 3.5, 8.0])
        value = ask_array(headings, (5,), along * math.cos(direction), along * math.sin(direction))
        hint = f"a straight line at {math.degrees(direction):.0f} deg must keep its direction."
        expect(_same(value, np.full(5, direction)), hint)
    two = ask_array(headings, (2,), np.array([1.0, 1.0]), np.array([2.0, 5.0]))
    expect(
        _same(two, np.full(2, math.pi / 2.0)),
        "a route of two points has one leg, and that one's direction twice.",
    )
    return Passed(
        "Mirrored, shifted, enlarged, turned, driven back, with points entered twice: the headings follow."
    )


def _explain_checksum(checksum_fits: Callable, body: str, end: str) -> None:
    """Which wrong sum does the function accept? Then that is what it computes."""
    sentence, data = f"'${body}*{end}'", body.encode()
    right = reduce(xor, data)
    tried = [
        (f"{right ^ ord('$'):02X}", "the `$` is not part of the sum: it begins after it."),
        (f"{right ^ ord('*'):02X}", "the `*` is not part of the sum: it ends before it."),
        (
            f"{right ^ ord('$') ^ ord('*'):02X}",
            "neither the `$` nor the `*` is part of the sum: it is made of what stands between them.",
        ),
        (
            f"{sum(data) % 256:02X}",
            "the characters are not added: each is combined with the others by an exclusive or, `^`.",
        ),
        (f"{right}", "the two digits after the `*` are hexadecimal."),
        *(
            [(f"{right:X}", f"the checksum always has two digits: {right:02X}, not {right:X}.")]
            if right < 16
            else []
        ),
        (f"{right:02X}", "the two digits may be written in small letters, too."),
    ]
    for value, hint in tried:
        expect(not ask_truth(checksum_fits, f"${body}*{value}"), hint)
    expect(
        False, f"{sentence} is as a receiver sent it, and you say that its checksum does not fit."
    )


def _fields(count: int) -> list[tuple[str, str, float]]:
    random, found = np.random.default_rng(122), []
    for k in range(count):
        top, width, sides = (89, 2, "NS") if k % 2 == 0 else (179, 3, "EW")
        whole, digits, side = (
            int(random.integers(0, top + 1)),
            int(random.integers(0, 600_000)),
            k // 2 % 2,
        )
        found.append(
            (
                f"{whole:0{width}d}{digits // 10000:02d}.{digits % 10000:04d}",
                sides[side],
                (whole + digits / 600_000) * (1 - 2 * side),
            )
        )
    return found


def _routes(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Routes of 4 to 9 points that turn by at most 140 deg at each; some of their turns pass the direction west."""
    random, found = np.random.default_rng(123), []
    for _ in range(count):
        legs = int(random.integers(3, 9))
        direction, length = (
            np.cumsum(random.uniform(-2.44, 2.44, legs)) + random.uniform(-3.0, 3.0),
            random.uniform(2.0, 40.0, legs),
        )
        found.append(
            tuple(
                np.cumsum(np.insert(length * f(direction), 0, random.uniform(-50, 50)))
                for f in (np.cos, np.sin)
            )
        )
    return found


def _bisecting(legs: np.ndarray) -> np.ndarray:
    """By unit vectors: the sum of two points half-way between them."""
    ways = np.exp(1j * legs)
    return np.angle(np.concatenate([ways[:1], ways[1:] + ways[:-1], ways[-1:]]))


def _same(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.allclose(np.exp(1j * one), np.exp(1j * other), rtol=0.0, atol=1e-7))
