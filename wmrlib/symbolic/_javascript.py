"""The formulas as JavaScript, for the panel."""

from __future__ import annotations

import re
from pathlib import Path

from sympy.printing.jscode import JavascriptCodePrinter
from sympy.printing.precedence import PRECEDENCE

from wmrlib.symbolic._formulas import FORMULAS


class _Printer(JavascriptCodePrinter):
    def _print_Pow(self, expr):  # noqa: N802 (sympy's name)
        if expr.exp != 2:
            return super()._print_Pow(expr)
        base = self.parenthesize(expr.base, PRECEDENCE["Mul"])
        return f"({base}*{base})"  # rounded once, where Math.pow promises nothing


MODEL_JS = Path(__file__).parents[1] / "panel" / "model.js"
_HEADER = "// The model's formulas, printed from sympy: change wmrlib/symbolic, then run python -m wmrlib.symbolic.\n"


def javascript_name(name: str) -> str:
    """The name in camelCase, as `javascript` prints it."""
    return re.sub("_(.)", lambda part: part[1].upper(), name)


def javascript() -> str:
    """The text of ``model.js``: every formula of `FORMULAS` as a JavaScript function of numbers, named in camelCase."""
    names = {name: javascript_name(name) for name in FORMULAS}
    printer = _Printer({"user_functions": names | {"expm1": "Math.expm1"}})
    functions = []
    for name, (arguments, value, says) in FORMULAS.items():
        body = re.sub(r"\s+", " ", printer.doprint(value))
        functions.append(
            f"\n// {says}\nfunction {names[name]}({', '.join(map(str, arguments))}) {{\n  return {body};\n}}\n"
        )
    return _HEADER + "".join(functions)
