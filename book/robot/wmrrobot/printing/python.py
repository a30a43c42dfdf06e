"""The filter's derivatives as Python, so that the filter needs no sympy."""

from __future__ import annotations

from pathlib import Path

from sympy.printing.precedence import PRECEDENCE
from sympy.printing.pycode import PythonCodePrinter

from wmrlib.symbolic import Formula
from wmrrobot.printing.formulas import jacobians

PYTHON_MODULE = Path(__file__).parents[1] / "jacobians.py"
_HEADER = '''"""Printed by python -m wmrrobot from wmrrobot.sensing: change that."""

import math

from wmrlib.compilation import formula
'''


class _Printer(PythonCodePrinter):
    def _print_Rational(self, expr):  # noqa: N802 (sympy's name)
        return repr(float(expr))

    _print_Integer = _print_Rational  # noqa: N815

    def _print_Pow(self, expr, rational=False):  # noqa: N802
        if expr.exp != 2:
            return super()._print_Pow(expr, rational=rational)
        return "{0}*{0}".format(self.parenthesize(expr.base, PRECEDENCE["Pow"]))


_PRINTER = _Printer({"fully_qualified_modules": True})


def _function(name: str, formula: Formula) -> str:
    lines = [f"{symbol} = {_PRINTER.doprint(value)}" for symbol, value in formula.locals_]
    lines.append("return (")
    lines += [f"    {_PRINTER.doprint(value)}," for value in formula.values]
    body = "".join(f"    {line}\n" for line in [f'"""{formula.says}"""', *lines, ")"])
    return f"\n\n@formula\ndef {name}({', '.join(map(str, formula.arguments))}):\n{body}"


def python_module() -> str:
    """The text of ``jacobians.py``."""
    return _HEADER + "".join(_function(name, formula) for name, formula in jacobians().items())
