"""The formulas as JavaScript, for the panel."""

from __future__ import annotations

import json
import re
from pathlib import Path

import sympy as sp
from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.precedence import PRECEDENCE

from wmrlib import _dop853, laws, motion
from wmrlib.symbolic.formulas import FORMULAS, Formula

MODEL_JS = Path(__file__).parents[1] / "explorer" / "js" / "model.js"
_HEADER = "// Printed from wmrlib's formulas by python -m wmrlib.symbolic: change those.\n"


class _Printer(JavascriptCodePrinter):
    def _print_Float(self, expr):  # noqa: N802 (sympy's name)
        return repr(float(expr))

    def _print_Pow(self, expr):  # noqa: N802
        if expr.exp != 2:
            return super()._print_Pow(expr)
        base = self.parenthesize(expr.base, PRECEDENCE["Mul"])
        return f"({base}*{base})"  # rounded once, where Math.pow promises nothing

    def line(self, expression: sp.Expr) -> str:
        return re.sub(r"\s+", " ", self.doprint(expression))


_OURS = {name: name for name in ("sinc", "decay", "wrap")} | {"turned_back": "turnedBack"}
_REST = [(lambda *_: True, lambda number, period: f"({number} % ({period}))")]
_PRINTER = _Printer({"user_functions": _OURS | {"expm1": "Math.expm1", "fmod": _REST}})


def javascript_name(name: str) -> str:
    """The name in camelCase, as `javascript` prints it."""
    return re.sub("_(.)", lambda part: part[1].upper(), name)


def _function(name: str, formula: Formula) -> str:
    structure = [f"{{ {', '.join(map(str, formula.gains))} }}"] if formula.gains else []
    arguments = [str(each) for each in formula.arguments]
    arguments[3:3] = structure  # behind the state, before what only some laws need
    lines = [f"const {each} = {_PRINTER.line(value)};" for each, value in formula.locals_]
    values = ", ".join(_PRINTER.line(value) for value in formula.values)
    lines.append(f"return {values};" if len(formula.values) == 1 else f"return [{values}];")
    body = "".join(f"  {line}\n" for line in lines)
    head = f"function {javascript_name(name)}({', '.join(arguments)}) {{"
    return f"\n// {formula.says}\n{head}\n{body}}}\n"


def _law(name: str, row: laws.Law) -> str:
    parts = {
        "command": javascript_name(f"{name}_command"),
        "value": javascript_name(row.value.__name__),
        "modes": "null" if row.needs_reference else javascript_name(f"{name}_modes"),
        "gains": str(list(row.gains._fields)),
        "needsReference": str(row.needs_reference).lower(),
    }
    return f"  {name}: {{ {', '.join(f'{key}: {part}' for key, part in parts.items())} }},\n"


def javascript() -> str:
    """The text of ``model.js``: `FORMULAS` as functions, and the laws and methods by name."""
    functions = "".join(_function(name, formula) for name, formula in FORMULAS.items())
    table = "".join(_law(name, row) for name, row in laws.LAWS.items())
    steps = ", ".join(f"{name}: {javascript_name(f.__name__)}" for name, f in motion.STEPS.items())
    rows = {"stages": _dop853.STAGES, "weights": _dop853.WEIGHTS}
    rows |= {"fifth": _dop853.FIFTH.tolist(), "third": _dop853.THIRD.tolist()}
    rule = json.dumps(rows).replace('"', "")
    tables = f"const STEPS = {{ {steps} }};\nconst RULE = {rule};\n"
    return f"{_HEADER}{functions}\nconst LAWS = {{\n{table}}};\n{tables}"
