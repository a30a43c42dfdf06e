"""The drive of `drive` as JavaScript, for the page that certifies a robot."""

from __future__ import annotations

import ast
import inspect
from typing import get_args, get_type_hints

from wmrlib.symbolic import javascript_name, wrapped
from wmrrobot import drive, monitor, odometry
from wmrrobot.printing.c_drive import OWN, TRUTH, Code, conditions, statement

_HEADER = """// The checks, the odometry and the decisions of a drive, in periods.
// Printed by book/tools/kit.py from wmrrobot's drive, monitor and odometry: change those.

import { sinc, wrap } from './model.js';
"""
_CALLS = {"min": "Math.min", "max": "Math.max", "abs": "Math.abs", "distance": "Math.hypot"}
_CALLS |= {name: f"Math.{name}" for name in ("cos", "sin", "atan2")}


class _JavaScript(Code):
    """One expression of Python as JavaScript."""

    counter = "let"
    signs = Code.signs | {ast.Eq: "===", ast.NotEq: "!=="}

    def constant(self, value):
        return "const"

    def stored(self, value):
        truth = isinstance(value, TRUTH) or isinstance(getattr(value, "op", None), ast.Not)
        return f"Number({self.visit(value)})" if truth else self.visit(value)

    def visit_Name(self, node):  # noqa: N802 (ast's name)
        return super().visit_Name(node).removeprefix("WMR_")

    def visit_Constant(self, node):  # noqa: N802 (ast's name)
        return repr(node.value).removesuffix(".0")

    def visit_Attribute(self, node):  # noqa: N802 (ast's name)
        return f"{self.visit(node.value)}.{node.attr}"

    def visit_Call(self, node):  # noqa: N802 (ast's name)
        given = ", ".join(map(self.visit, node.args))
        return f"{_CALLS.get(node.func.id, javascript_name(node.func.id))}({given})"


_CODE = _JavaScript(set())


def _function(function) -> str:
    (tree,) = ast.parse(inspect.getsource(function)).body
    assert isinstance(tree, ast.FunctionDef)
    lines = [line for node in tree.body[1:] for line in statement(node, _CODE, "  ")]
    given = ", ".join(argument.arg for argument in tree.args.args)
    head = f"function {javascript_name(function.__name__)}({given}) {{"
    head = f"export {head}" if function.__name__ in ("observe", "aim") else head
    return "\n".join([f"// {inspect.getdoc(function)}", *map(wrapped, [head, *lines]), "}\n"])


def _at_first(kind) -> str:
    """The code of an object with the fields of a dataclass, all 0."""
    parts = []
    for name, hint in get_type_hints(kind).items():
        (part,) = get_args(hint) or (hint,)
        first = "0" if part in (int, float) else _at_first(part)
        many = f"Array.from({{ length: PAST }}, () => ({first}))"
        parts.append(f"{name}: {many if get_args(hint) else first}")
    return f"{{ {', '.join(parts)} }}"


def _row(row: drive.Row, condition: ast.Lambda) -> str:
    names = [name.upper() for name in row.within.split()]
    every = row.within.split() == list(monitor.STATES[: len(names)])  # up to the last of them
    test = f"m.state {'<=' if every else '==='} {names[-1]}"
    assert every or len(names) == 1, row
    both = _CODE.visit(ast.BoolOp(ast.And(), [ast.Name("within"), condition.body]))
    change = f"return\xa0go(m, {row.to.upper()}, {drive.REASONS.index(row.reason)})"
    return wrapped(f"  if ({both.replace('within', test)}) {change};")


def javascript_drive() -> str:
    """The text of ``drive.js`` of the panels' kit."""
    states, refusals = (
        ", ".join(f"{name.upper()} = {number}" for number, name in enumerate(names))
        for names in (monitor.STATES, monitor.REFUSALS)
    )
    functions = "\n".join(map(_function, OWN.values()))
    rows = "\n".join(map(_row, drive.TABLE, conditions()))
    first = wrapped(f"export const memory = () => ({_at_first(monitor.Memory)});")
    reasons = ", ".join(f"'{reason}'" for reason in drive.REASONS).replace(" ", "\xa0")
    reasons = reasons.replace(",\xa0", ", ")
    return f"""{_HEADER}
{wrapped(f"export const {states};")}
{wrapped(f"const {refusals};")}
const PAST = {odometry.PAST};
{wrapped(f"export const REASONS = [{reasons}];")}

// What a drive remembers: at first nothing.
{first}

{functions}
function go(m, state, reason) {{
  m.state = state;
  m.reason = reason;
}}

// The first row of the table that fits.
export function decide(m, seen, rules, end) {{
{rows}
}}
"""
