"""The law as one C header without dependencies, in float or double, for the robot's processor."""

from __future__ import annotations

import re
import textwrap
from pathlib import Path

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.precedence import PRECEDENCE

from wmrlib.geodesy import EARTH_RADIUS_M
from wmrlib.symbolic.formulas import Formula, c_formulas, c_laws

C_HEADER = Path(__file__).parent / "c" / "wmr_law.h"
_FUNCTIONS = "sin cos tan atan atan2 sinh cosh tanh exp log floor fmod"
_OURS = {name: f"wmr_{name}" for name in ("sinc", "decay", "wrap", "turned_back", "expm1")}


class _Printer(C99CodePrinter):
    """Numbers in WMR_C(...) and functions in WMR_F(...), which the header has for both types."""

    def _print_Float(self, expr):  # noqa: N802 (sympy's name)
        return f"WMR_C({float(expr)!r})"

    _print_Integer = _print_Rational = _print_Float  # noqa: N815

    def _print_Pi(self, expr):  # noqa: N802
        return "WMR_C(3.14159265358979323846)"

    _print_sinc = C99CodePrinter._print_Function  # where sympy prints cases

    def _print_Pow(self, expr):  # noqa: N802
        factor, base = self.parenthesize(expr.base, PRECEDENCE["Mul"]), self._print(expr.base)
        own = {2: f"({factor}*{factor})", sp.S.Half: f"WMR_F(sqrt)({base})", -1: f"1/{factor}"}
        return own.get(expr.exp) or f"WMR_F(pow)({base}, {self._print(expr.exp)})"

    def line(self, expression: sp.Expr) -> str:
        """The expression as C on one line."""
        text = re.sub(r"\s+", " ", self.doprint(expression)).replace("*", " * ")
        return re.sub(r"(?<![\w)])\((WMR_C\([\d.]+\))\)", r"\1", text)  # brackets of its own


_LIBRARY = {name: f"WMR_F({name})" for name in _FUNCTIONS.split()} | {"Abs": "WMR_F(fabs)"}
_PRINTER = _Printer({"user_functions": _LIBRARY | _OURS})


def c_function(name: str, formula: Formula) -> str:
    """One formula as a static C function.

    Parameters
    ----------
    name, formula : its name without the ``wmr_``; of `c_formulas` or `c_laws`, or one of your own

    Returns
    -------
    str
    """
    arguments, kind = [f"WMR_REAL\xa0{symbol}" for symbol in formula.arguments], "WMR_REAL"
    lines = [
        f"const WMR_REAL {symbol} = {_PRINTER.line(value)};" for symbol, value in formula.locals_
    ]
    values = [_PRINTER.line(value) for value in formula.values]
    if formula.gains:
        used = sp.Tuple(*formula.expanded()).free_symbols
        state = [
            f"{symbol}\xa0=\xa0error.{symbol}" for symbol in formula.arguments if symbol in used
        ]
        gains = [f"{symbol}\xa0=\xa0gains.{symbol}" for symbol in formula.gains]
        lines = [f"const WMR_REAL {', '.join(symbol)};" for symbol in (state, gains)] + lines
        lines.append(f"const WMR_REAL omega = {values[1]};")
        arguments, kind = ["wmr_polar error", "wmr_gains gains"], "wmr_twist"
        values = [f"wmr_checked(error, gains, {values[0]}, omega)"]
    if len(values) > 1 and not formula.gains:  # into an array
        arguments, kind = [*arguments, f"WMR_REAL\xa0out[{len(values)}]"], "void"
        ends = [f"out[{count}] = {value};" for count, value in enumerate(values)]
    else:
        ends = [f"return {values[0]};"]
    body = [wrapped(f"  {line}") for line in [*lines, *ends]]
    head = wrapped(f"static inline {kind} wmr_{name}({', '.join(arguments)}) {{", 6)
    return "\n".join([wrapped(f"/* {formula.says} */", 3), head, *body, "}\n"])


def wrapped(line: str, indent: int | None = None) -> str:
    """Wrap a line to the width of the book's pages, with an indent of 4 or the given one."""
    spaces = " " * (len(line) - len(line.lstrip()) + 4 if indent is None else indent)
    filled = textwrap.fill(line, 88, subsequent_indent=spaces, break_long_words=False)
    return filled.replace("\xa0", " ")


def c_functions(table: dict[str, Formula]) -> str:
    """The formulas of a table as C functions, by their names in it."""
    return "\n".join(c_function(name, formula) for name, formula in table.items())


def filled(frame: Path, printed: dict[str, str]) -> str:
    """The text of a frame with printed lines in its places, ``/* @PLACE@ */``."""
    text = frame.read_text(encoding="utf-8")
    text = text.partition("*/\n")[2]  # without the frame's own comment
    for place, lines in printed.items():
        assert text.count(f"/* @{place}@ */\n") == 1, place
        text = text.replace(f"/* @{place}@ */\n", lines)
    return text


def c_header() -> str:
    """The text of ``wmr_law.h``: ``frame.h`` with the printed functions in their places."""
    printed = {"FORMULAS": c_functions(c_formulas()), "LAWS": c_functions(c_laws())}
    text = filled(C_HEADER.with_name("frame.h"), printed)
    return text.replace("@EARTH_RADIUS_M@", repr(EARTH_RADIUS_M))
