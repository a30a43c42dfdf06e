"""The law as C: one header without dependencies, in float or in double, for the robot's own processor."""

from __future__ import annotations

import re
from pathlib import Path

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.precedence import PRECEDENCE

from wmrlib.geodesy import EARTH_RADIUS_M
from wmrlib.symbolic._formulas import C_FORMULAS, GEODESY, Formula

C_HEADER = Path(__file__).parent / "c" / "wmr_law.h"
_FRAME = C_HEADER.with_name("frame.h")
_FUNCTIONS = ("sin", "cos", "sqrt", "atan2", "expm1")


class _Printer(C99CodePrinter):
    """Numbers in WMR_C(...) and functions in WMR_F(...), which the header defines for float and for double."""

    def __init__(self):
        library = {name: f"WMR_F({name})" for name in _FUNCTIONS} | {
            "Abs": "WMR_F(fabs)",
            "decay": "wmr_decay",
        }
        super().__init__({"user_functions": library})

    def _print_Float(self, expr):  # noqa: N802 (sympy's name)
        return f"WMR_C({float(expr)!r})"

    def _print_Integer(self, expr):  # noqa: N802
        return f"WMR_C({int(expr)}.0)"

    def _print_Rational(self, expr):  # noqa: N802
        return f"WMR_C({float(expr)!r})"  # each is a half: exact

    def _print_Pi(self, expr):  # noqa: N802
        return "WMR_C(3.14159265358979323846)"

    def _print_Pow(self, expr):  # noqa: N802
        base = self.parenthesize(expr.base, PRECEDENCE["Mul"])
        if expr.exp == 2:
            return f"({base}*{base})"
        if expr.exp == sp.Rational(1, 2):
            return f"WMR_F(sqrt)({self._print(expr.base)})"
        if expr.exp == -1:
            return f"WMR_C(1.0)/{base}"
        raise ValueError(f"{expr} is not allowed: a power of 2, 1/2 or -1 is needed")


def c_function(name: str, formula: Formula, real: str = "WMR_REAL") -> str:
    """One formula as a static C function wmr_`name` of numbers of type `real`; with "double" it is always in double precision."""
    body = re.sub(r"\s+", " ", _Printer().doprint(formula.value))
    body = re.sub(
        r"(?<![\w)])\((WMR_C\([\d.]+\))\)", r"\1", body
    )  # a number needs no brackets of its own
    if real == "double":
        body = re.sub(r"WMR_[CF]\(([^()]+)\)", r"\1", body)
    arguments = ", ".join(f"{real} {each}" for each in formula.arguments)
    return f"/* {formula.says} */\nstatic inline {real} wmr_{name}({arguments}) {{\n  return {body};\n}}\n"


def c_header() -> str:
    """The text of ``wmr_law.h``: ``frame.h`` with the functions of `C_FORMULAS` and `GEODESY` in their places."""
    law = "\n".join(c_function(name, formula) for name, formula in C_FORMULAS.items())
    geodesy = "\n".join(c_function(name, formula, "double") for name, formula in GEODESY.items())
    text = _FRAME.read_text(encoding="utf-8").partition("*/\n")[2]  # what frame.h says of itself
    places = {
        "/* @LAW@ */\n": law,
        "/* @GEODESY@ */\n": geodesy,
        "@EARTH_RADIUS_M@": repr(EARTH_RADIUS_M),
    }
    for place, printed in places.items():
        if text.count(place) != 1:
            raise ValueError(
                f"frame.h has {place.strip()} {text.count(place)} times: once is needed"
            )
        text = text.replace(place, printed)
    return text
