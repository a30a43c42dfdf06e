"""Checks of one's own GPS log: a sentence's checksum, its coordinates, headings along a route."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import reduce
from operator import xor

import numpy as np

from wmrbook.grading._asking import ask_array, ask_number, ask_truth
from wmrbook.grading._hints import Hint, close, expect, own_work, rule_out, slip, spread
from wmrlib.geodesy import EARTH_RADIUS_M

DEGREE = math.radians(1.0) * EARTH_RADIUS_M  # of latitude, m
BODIES = (  # of the log in wmrbook/data; its receiver stood in northern Germany
    "GPRMC,104706.000,A,5405.6081,N,01049.4791,E,0.24,18.02,240709,,,A",
    "GPGGA,104706.000,5405.6081,N,01049.4791,E,1,08,1.1,40.8,M,43.6,M,,0000",
    "GPVTG,18.02,T,,M,0.24,N,0.4,K,A",
    "GPGSA,A,3,28,18,27,19,08,09,10,15,,,,,1.7,1.1,1.3",
    "GPTXT,01,01,02,ANTSTATUS=OK",
)


def checksum_known(checksum_fits: Callable) -> str:
    """checksum_fits(sentence) -> bool: whether it ends in the checksum of what it says."""
    own_work(checksum_fits)
    for body in (*BODIES, "GPTXT,01,01,02,A", "GPTXT,01,01,02,HW  UBX-G5xxx  00040005 "):
        value = _sum(body)
        for end in (f"{value:02X}", f"{value:02x}"):
            if not ask_truth(checksum_fits, f"${body}*{end}"):
                _explain_checksum(checksum_fits, body, end)
        hint = "a line ends in \\r\\n, which is neither of the two digits."
        expect(ask_truth(checksum_fits, f"${body}*{value:02X}\r\n"), hint)
        for bit in (1, 16, 36, 128):
            sentence = f"${body}*{value ^ bit:02X}"
            hint = f"'{sentence}' has a wrong checksum, and you say that it fits."
            expect(not ask_truth(checksum_fits, sentence), hint)
        hint = "a sentence without a `*` and two hexadecimal digits has no checksum that fits; "
        digits = f"{value:02X}"
        longer = (f"*{digits}{more}" for more in ("0", " A", "junk", f"*{digits}"))
        odd = (f"*0{digits}", f"*0x{digits}", f"* {value:X}", f"*+{value:X}", "*ZZ")
        for end in ("", "*", f"*{value:X}"[:2], *odd, *longer):
            sentence = f"${body}{end}"
            expect(not ask_truth(checksum_fits, sentence), f"{hint}'{sentence}' has none.")
    return "Real sentences pass, wrong and missing checksums do not."


def checksum_damage(checksum_fits: Callable) -> str:
    """A single changed character is always found."""
    own_work(checksum_fits)
    random, damaged = np.random.default_rng(121), 0
    for body in BODIES:
        end = f"*{_sum(body):02X}"
        hint = "a sentence as the receiver sent it must pass."
        expect(ask_truth(checksum_fits, f"${body}{end}"), hint)
        for place in range(len(body)):
            wrong = chr(random.choice([code for code in range(48, 91) if chr(code) != body[place]]))
            sentence = f"${body[:place]}{wrong}{body[place + 1 :]}{end}"
            hint = f"'{sentence}' is damaged (its character {place + 1}), and you say that it fits."
            expect(not ask_truth(checksum_fits, sentence), hint)
            damaged += 1
    swapped = BODIES[2].replace("18", "81")
    fooled = ask_truth(checksum_fits, f"${swapped}*{_sum(BODIES[2]):02X}")
    but = " Two swapped characters, 81 for 18, fool every such checksum." if fooled else ""
    return f"{damaged} damaged sentences found.{but}"


def degrees_known(degrees: Callable) -> str:
    """degrees(field, hemisphere): "5405.6081", "N" -> degrees; south and west are negative."""
    own_work(degrees)
    for field, hemisphere, right in [("5405.6081", "N", 54.09346833333333), *_fields(30)]:
        value = ask_number(degrees, field, hemisphere)
        if abs(value - right) * DEGREE < 1e-3:
            continue
        number, (whole, minutes) = float(field), divmod(float(field), 100.0)
        two, three = (float(field[:n]) + float(field[n:]) / 60.0 for n in (2, 3))
        cut = whole + math.floor(minutes) / 60.0
        signs, point = {1.0, math.copysign(1.0, right)}, "Count the minutes' from the point."
        example = f"'{field}', '{hemisphere}':"
        mistakes = {
            f"{example} south and west are negative, north and east are not.": -right,
            "degrees are asked for, not radians.": math.radians(right),
            f"{example[:-1]} is no number of degrees yet: "
            "the field is degrees and minutes, run together.": number,
            f"{example} the last digits before the point are minutes, "
            "and a degree has 60 of them.": number / 100.0,
            f"{example} only the last two digits before the point, "
            "and what follows it, are minutes.": number / 60.0,
            f"{example} a minute is not a degree.": whole + minutes,
            f"{example} a longitude has three digits of degrees. {point}": two,
            f"{example} a latitude has two digits of degrees. {point}": three,
            f"{example} the minutes are lost.": whole,
            f"{example} the decimals of the minutes are lost; they are metres.": cut,
        }
        hint = f"{example[:-1]} comes out {abs(value - right) * DEGREE:.3g} m beside the place."
        rule_out(
            value,
            mistakes,
            lambda a, b, signs=signs: any(close(a, s * b, 1e-9) for s in signs),
        )
        slip(value, right, within=0.0)
        raise Hint(hint)
    return "Thirty coordinates, in all four hemispheres, to the millimetre."


def degrees_steps(degrees: Callable) -> str:
    """A step of the last digit is equally long everywhere, across minutes and degrees too."""
    own_work(degrees)
    step = 1e-4 / 60.0
    for one, other, sides in [
        ("5405.9999", "5406.0000", "NS"),
        ("5459.9999", "5500.0000", "NS"),
        ("00959.9999", "01000.0000", "EW"),
    ]:
        for side, sign in zip(sides, (1.0, -1.0), strict=True):
            moved = sign * (ask_number(degrees, other, side) - ask_number(degrees, one, side))
            hint = f"from '{one}' to '{other}' ({side}) is one step of the last digit, "
            hint += f"{step * DEGREE:.3f} m; yours is {moved * DEGREE:.6g} m."
            expect(close(moved, step, 1e-4), hint)
    for field, side in (("0000.0000", "S"), ("00000.0000", "W")):
        zero = ask_number(degrees, field, side) == 0.0
        expect(zero, "the equator and the meridian of Greenwich are at 0 degrees.")
    west = ask_number(degrees, "18000.0", "W")
    expect(close(west, -180.0), "'18000.0', 'W' is the date line, at -180 degrees.")
    return f"The last of four decimals is {step * DEGREE:.3f} m north, everywhere."


def headings_known(headings: Callable) -> str:
    """headings(x, y): the first leg's, half-way through each turn, the last leg's."""
    own_work(headings)
    for k, (x, y) in enumerate(_routes(20)):
        value = ask_array(headings, (x.size,), x.copy(), y.copy())
        legs = np.arctan2(np.diff(y), np.diff(x))
        ways = np.exp(1j * legs)  # the sum of two points half-way between them
        right = np.angle(_ends(ways, ways[1:] + ways[:-1]))
        if _same_ways(value, right):
            continue
        between = "Between two legs half of the turn is done."
        chord = np.arctan2(y[2:] - y[:-2], x[2:] - x[:-2])
        mistakes = {
            "these are bearings, clockwise from north; "
            "headings count counter-clockwise from east.": math.pi / 2.0 - right,
            "these are degrees; radians are asked for.": np.degrees(right),
            "your robot drives the route backwards.": right + math.pi,
            f"this is the leg that follows each point. {between}": np.append(legs, legs[-1]),
            f"this is the leg that comes to each point. {between}": np.insert(legs, 0, legs[0]),
            "the mean of two angles fails where one is near pi and the other near -pi: "
            "how far is the turn, wrapped?": _ends(legs, 0.5 * (legs[1:] + legs[:-1])),
            "from the point before to the point after, the longer leg counts more. "
            "The legs' *directions* are to be bisected.": _ends(legs, chord),
        }
        rule_out(value, mistakes, _same_ways)
        slip(value, right, "the first point's heading first")
        hint = "this route comes back to a point of an earlier leg. "
        hint += "Only a point that equals the one *before it* makes no leg."
        expect(k % 3 != 1, hint)
        expect(k % 3 != 2, "a short leg is a leg: only a point that is *equal* makes none.")
        for end, which in (("first", slice(1)), ("last", slice(-1, None))):
            hint = f"at the {end} point the robot looks along the {end} leg."
            expect(_same_ways(value[which], legs[which]), hint)
        hint = "at a point in between, the robot does not look half-way between "
        expect(False, f"{hint}the two legs' directions.")
    along = "along the first leg, half-way through each turn, along the last leg."
    return f"Twenty routes: {along}"


def headings_properties(headings: Callable) -> str:
    """Mirrored, moved, driven back, with points entered twice; straight lines stay straight."""
    own_work(headings)
    for x, y in _routes(10):
        answer, same = ask_array(headings, (x.size,), x.copy(), y.copy()), "the same headings."
        quarter = "turn the route by a quarter, and every heading must turn by as much."
        back = "driven from its end to its start, every heading must be the opposite one."
        for changed, right, hint in [
            ((x, -y), -answer, "the mirrored route must have the mirrored headings."),
            ((x + 1000.0, y - 500.0), answer, f"somewhere else the same route must have {same}"),
            ((3.0 * x, 3.0 * y), answer, f"a route three times as large must have {same}"),
            ((-y, x), answer + math.pi / 2.0, quarter),
            ((x[::-1], y[::-1]), answer[::-1] + math.pi, back),
        ]:
            value = ask_array(headings, (x.size,), *map(np.array, changed))
            expect(_same_ways(value, right), hint)
        for count in (np.arange(x.size) % 3 + 1, np.arange(x.size)[::-1] % 2 + 1):
            value = ask_array(headings, (count.sum(),), np.repeat(x, count), np.repeat(y, count))
            hint = "a point that is entered again makes no leg: "
            hint += "it has the heading that it has when entered once."
            expect(_same_ways(value, np.repeat(answer, count)), hint)
    for direction in np.radians([0.0, 60.0, 90.0, 179.999, 180.0, -90.0, -135.0]).tolist():
        along = np.array([0.0, 1.0, 3.0, 3.5, 8.0])
        value = ask_array(headings, (5,), along * math.cos(direction), along * math.sin(direction))
        hint = f"a straight line at {math.degrees(direction):.0f} deg must keep its direction."
        expect(_same_ways(value, np.full(5, direction)), hint)
    two = ask_array(headings, (2,), np.array([1.0, 1.0]), np.array([2.0, 5.0]))
    hint = "a route of two points has one leg, and that one's direction twice."
    expect(_same_ways(two, np.full(2, math.pi / 2.0)), hint)
    changed = "Mirrored, shifted, enlarged, turned, driven back, with points entered twice"
    return f"{changed}: the headings follow."


def _sum(body: str) -> int:
    return reduce(xor, body.encode())


def _explain_checksum(checksum_fits: Callable, body: str, end: str) -> None:
    """The wrong sum that the function accepts is the one that it computes."""
    right, dollar, star = _sum(body), ord("$"), ord("*")
    tried = {
        "the `$` is not part of the sum: it begins after it.": f"{right ^ dollar:02X}",
        "the `*` is not part of the sum: it ends before it.": f"{right ^ star:02X}",
        "neither the `$` nor the `*` is part of the sum: "
        "it is made of what stands between them.": f"{right ^ dollar ^ star:02X}",
        "the characters are not added: each is combined with the others "
        "by an exclusive or, `^`.": f"{sum(body.encode()) % 256:02X}",
        "the two digits after the `*` are hexadecimal.": f"{right}",
    }
    if right < 16:
        hint = f"the checksum always has two digits: {right:02X}, not {right:X}."
        tried[hint] = f"{right:X}"
    tried["the two digits may be written in small letters, too."] = f"{right:02X}"
    for hint, value in tried.items():
        expect(not ask_truth(checksum_fits, f"${body}*{value}"), hint)
    hint = f"'${body}*{end}' is as a receiver sent it, "
    expect(False, f"{hint}and you say that its checksum does not fit.")


def _fields(count: int) -> list[tuple[str, str, float]]:
    random, fields = np.random.default_rng(122), []
    for k in range(count):
        most, width, sides = (89, 2, "NS") if k % 2 == 0 else (179, 3, "EW")
        decimals = 4 if k < 8 else int(random.integers(1, 9))
        whole, minutes = int(random.integers(0, most + 1)), random.uniform(0.0, 59.9)
        size, side = f"{minutes:0{3 + decimals}.{decimals}f}", k // 2 % 2
        right = (whole + float(size) / 60.0) * (1 - 2 * side)
        fields.append((f"{whole:0{width}d}{size}", sides[side], right))
    return fields


def _routes(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Routes of 4 to 9 points with turns of up to 140 deg; some turns pass the west.

    Every second of three comes back to its second point, every third has short legs too.
    """
    random, routes = np.random.default_rng(123), []
    for k in range(count):
        legs = int(random.integers(3, 9))
        direction = np.cumsum(random.uniform(-2.44, 2.44, legs)) + random.uniform(-3.0, 3.0)
        length, start = random.uniform(2.0, 40.0, legs), random.uniform(-50.0, 50.0, 2)
        length = np.array(spread(1e-6, 40.0, legs, seed=k)) if k % 3 == 2 else length
        steps = length * np.cos(direction), length * np.sin(direction)
        x, y = (np.cumsum(np.insert(s, 0, at)) for s, at in zip(steps, start, strict=True))
        routes.append((np.append(x, x[1]), np.append(y, y[1])) if k % 3 == 1 else (x, y))
    return routes


def _ends(legs: np.ndarray, between: np.ndarray) -> np.ndarray:
    return np.concatenate([legs[:1], between, legs[-1:]])


def _same_ways(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.allclose(np.exp(1j * one), np.exp(1j * other), rtol=0.0, atol=1e-7))
