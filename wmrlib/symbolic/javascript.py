"""The formulas as JavaScript, for the book's panels."""

from __future__ import annotations

import json
import re
import textwrap

import sympy as sp
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.precedence import PRECEDENCE

from wmrlib import _dop853, laws, motion
from wmrlib.symbolic.formulas import Formula, panel_formulas

_HEADER = "// Printed from wmrlib's formulas by symbolic.javascript: change those.\n"


class _Printer(JavascriptCodePrinter):
    def _print_Float(self, expr):  # noqa: N802 (sympy's name)
        return repr(float(expr))

    def _print_Pow(self, expr):  # noqa: N802
        if expr.exp != 2:
            return super()._print_Pow(expr)
        base = self.parenthesize(expr.base, PRECEDENCE["Mul"])
        return f"({base}*{base})"  # rounded once, where Math.pow promises nothing

    def line(self, expression: sp.Expr) -> str:
        """The expression as JavaScript on one line."""
        return re.sub(r"\s+", " ", self.doprint(expression))


_OURS = {name: name for name in ("sinc", "decay", "wrap")} | {"turned_back": "turnedBack"}
_REST = [(lambda *_: True, lambda number, period: f"({number} % ({period}))")]
_PRINTER = _Printer({"user_functions": _OURS | {"expm1": "Math.expm1", "fmod": _REST}})


def javascript_name(name: str) -> str:
    """The name in camelCase, as `javascript` prints it."""
    return re.sub("_(.)", lambda part: part[1].upper(), name)


def _function(name: str, formula: Formula) -> str:
    structure = [f"{{ {', '.join(map(str, formula.gains))} }}"] if formula.gains else []
    arguments = [*map(str, formula.arguments), *structure]
    lines = [f"const {symbol} = {_PRINTER.line(value)};" for symbol, value in formula.locals_]
    values = ", ".join(_PRINTER.line(value) for value in formula.values)
    lines.append(f"return {values};" if len(formula.values) == 1 else f"return [{values}];")
    body = "".join(f"{_wrapped(f'  {line}')}\n" for line in lines)
    head = _wrapped(f"export function {javascript_name(name)}({', '.join(arguments)}) {{")
    return f"\n// {formula.says}\n{head}\n{body}}}\n"


def _wrapped(line: str) -> str:
    return textwrap.fill(line, 100, subsequent_indent="    ", break_long_words=False)


def _law(name: str, row: laws.Law) -> str:
    parts = {
        "formula": javascript_name(f"{name}_law"),
        "value": javascript_name(row.value.__name__),
        "modes": "null" if row.needs_reference else javascript_name(f"{name}_modes"),
        "gains": str(list(row.gains._fields)),
        "needsReference": str(row.needs_reference).lower(),
    }
    row_text = ", ".join(f"{key}: {part}" for key, part in parts.items())
    return _wrapped(f"  {name}: {{ {row_text} }},") + "\n"


def javascript() -> str:
    """The text of ``model.js``: `panel_formulas` as functions, and the laws and methods by name."""
    functions = "".join(_function(name, formula) for name, formula in panel_formulas().items())
    table = "".join(_law(name, row) for name, row in laws.LAWS.items())
    steps = ", ".join(f"{name}: {javascript_name(f.__name__)}" for name, f in motion.STEPS.items())
    rows = {"stages": _dop853.STAGES, "weights": _dop853.WEIGHTS}
    rows |= {"fifth": _dop853.FIFTH.tolist(), "third": _dop853.THIRD.tolist()}
    rule = json.dumps(rows).replace('"', "")
    tables = f"export const STEPS = {{ {steps} }};\n{_wrapped(f'export const RULE = {rule};')}\n"
    return f"{_HEADER}{functions}\nexport const LAWS = {{\n{table}}};\n{tables}"
