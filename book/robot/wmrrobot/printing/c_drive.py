"""The drive of `drive` as a C header: the classes and functions behind it, and the table."""

from __future__ import annotations

import ast
import inspect
from itertools import repeat
from pathlib import Path
from typing import get_origin, get_type_hints

from wmrlib.body import LastTurn, Wheels
from wmrlib.symbolic import filled, wrapped
from wmrrobot import drive, monitor, odometry

C_DRIVE = Path(__file__).parents[1] / "c" / "wmr_drive.h"
_STRUCTS = [Wheels, LastTurn, monitor.Rules, monitor.Seen, monitor.Wheel]
_STRUCTS += [odometry.Stretch, odometry.Past, monitor.Memory]
_KINDS = {kind: f"wmr_{kind.__name__.lower()}" for kind in _STRUCTS}
_KINDS |= {LastTurn: "wmr_last_turn", Wheels: "wmr_motors", odometry.Place: "wmr_pose"}
_KINDS |= {float: "WMR_REAL", int: "int", type(None): "void"}
_KINDS[list[odometry.Stretch]] = "wmr_stretch"
OWN = {
    name: value
    for module in (odometry, monitor, drive)
    for name, value in vars(module).items()
    if inspect.isfunction(value) and value.__module__ == module.__name__
}
_CALLS = {"min": "WMR_F(fmin)", "max": "WMR_F(fmax)", "abs": "WMR_F(fabs)"}
_CALLS |= {name: f"WMR_F({name})" for name in ("cos", "sin", "atan2")}
_SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.And: "&&", ast.Or: "||"}
_SIGNS |= {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
_SIGNS |= {ast.Not: "!", ast.USub: "-", ast.Mod: "%"}
_TIGHT = ast.Mult | ast.Div
_WHOLE = ast.Name | ast.Constant | ast.Attribute | ast.Subscript | ast.Call  # needs no brackets
TRUTH = ast.Compare | ast.BoolOp  # true or false
_SHORT = {"s": "seen", "r": "rules", "e": "end"}  # in a condition of the table


def code_name(words: str) -> str:
    """A state, a refusal or a reason as a constant of the header."""
    return "WMR_" + (words or "fine").upper().replace(" ", "_")


class Code(ast.NodeVisitor):
    """One expression of Python as C; NotImplementedError where C has no counterpart."""

    counter, signs = "int", _SIGNS

    def __init__(self, pointers: set[str]) -> None:
        self.pointers = pointers

    def constant(self, value: ast.expr) -> str:
        """The begin of a line that names a value for good."""
        return f"const {'int' if isinstance(value, TRUTH) else 'WMR_REAL'}"

    def stored(self, value: ast.expr) -> str:
        """A value as a field has it."""
        return self.visit(value)

    def generic_visit(self, node):
        raise NotImplementedError(f"{ast.unparse(node)} has no counterpart in C here")

    def visit_Name(self, node):
        return code_name(node.id) if node.id.isupper() else _SHORT.get(node.id, node.id)

    def visit_Constant(self, node):
        return f"WMR_C({node.value!r})" if isinstance(node.value, float) else repr(node.value)

    def visit_Attribute(self, node):
        pointed = isinstance(node.value, ast.Name) and node.value.id in self.pointers
        return f"{self.visit(node.value)}{'->' if pointed else '.'}{node.attr}"

    def visit_Subscript(self, node):
        return f"{self.visit(node.value)}[{self.visit(node.slice)}]"

    def visit_BinOp(self, node):
        sides = []
        for inner, same in (node.left, True), (node.right, isinstance(node.op, ast.Add | ast.Mult)):
            binds = isinstance(node.op, ast.Add | ast.Sub) or (
                isinstance(node.op, _TIGHT) and isinstance(getattr(inner, "op", None), _TIGHT)
            )
            sides.append(self._part(inner, ast.BinOp if same and binds else ()))
        return f" {self.signs[type(node.op)]} ".join(sides)

    def visit_BoolOp(self, node):
        parts = (self._part(n) if isinstance(n, ast.BoolOp) else self.visit(n) for n in node.values)
        return f" {self.signs[type(node.op)]} ".join(parts)

    def visit_UnaryOp(self, node):
        return f"{self.signs[type(node.op)]}{self._part(node.operand)}"

    def visit_Compare(self, node):
        (sign,), (right,) = node.ops, node.comparators
        left, right = self._part(node.left, ast.BinOp), self._part(right, ast.BinOp)
        return f"{left} {self.signs[type(sign)]} {right}"

    def visit_IfExp(self, node):
        test, body, other = map(self._part, (node.test, node.body, node.orelse))
        return f"{test} ? {body} : {other}"

    def visit_Call(self, node):
        name = node.func.id
        kinds = get_type_hints(OWN[name]).values() if name in OWN else repeat(float)
        given = []
        for arg, kind in zip(node.args, kinds, strict=False):
            whole = kind in (float, int) or isinstance(arg, ast.Name)  # a name is a pointer
            given.append(self.visit(arg) if whole else f"&{self.visit(arg)}")
        return f"{_CALLS.get(name, f'wmr_{name}')}({', '.join(given)})"

    def _part(self, node, bare=()):
        """A part in brackets, unless it is whole, or may be bare."""
        text = self.visit(node)
        return text if isinstance(node, (_WHOLE, bare)) else f"({text})"


def c_condition(condition: ast.Lambda) -> str:
    """A condition of the table as C."""
    return Code({argument.arg for argument in condition.args.args}).visit(condition.body)


def conditions() -> list[ast.Lambda]:
    """Those of `drive.TABLE` in the order in which its source has them."""
    tree = ast.parse(inspect.getsource(drive))
    return [node for node in ast.walk(tree) if isinstance(node, ast.Lambda)]


def statement(node: ast.stmt, c: Code, indent: str) -> list[str]:
    """The lines of a statement of Python."""
    inner = indent + "  "
    match node:
        case ast.Expr(value=ast.Call()):
            return [f"{indent}{c.visit(node.value)};"]
        case ast.Return(value=ast.expr() as value):
            return [f"{indent}return {c.visit(value)};"]
        case ast.AugAssign(op=op):
            return [f"{indent}{c.visit(node.target)} {_SIGNS[type(op)]}= {c.visit(node.value)};"]
        case ast.Assign(targets=[ast.Tuple(elts=names)], value=ast.Tuple(elts=values)):
            single = [ast.Assign([name], value) for name, value in zip(names, values, strict=True)]
            return [line for part in single for line in statement(part, c, indent)]
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            return [f"{indent}{c.constant(value)} {name} = {c.visit(value)};"]
        case ast.Assign(targets=[target], value=value):
            return [f"{indent}{c.visit(target)} = {c.stored(value)};"]
        case ast.If():
            body = [line for part in node.body for line in statement(part, c, inner)]
            other = [line for part in node.orelse for line in statement(part, c, inner)]
            other = [f"{indent}}} else {{", *other] if other else []
            return [f"{indent}if ({c.visit(node.test)}) {{", *body, *other, f"{indent}}}"]
        case ast.For(target=ast.Name(id=k), iter=ast.Call(func=ast.Name(id="range"), args=[end])):
            body = [line for part in node.body for line in statement(part, c, inner)]
            head = f"{indent}for ({c.counter} {k} = 0; {k} < {c.visit(end)}; {k} += 1) {{"
            return [head, *body, f"{indent}}}"]
    raise NotImplementedError(f"{ast.unparse(node)} has no counterpart in C here")


def _function(function) -> str:
    (tree,) = ast.parse(inspect.getsource(function)).body
    assert isinstance(tree, ast.FunctionDef)
    kinds = get_type_hints(function)
    back = _KINDS[kinds.pop("return")]
    plain = {name for name, kind in kinds.items() if kind in (float, int)}
    given = []
    for name, kind in kinds.items():
        star = " " if name in plain else " *"
        const = "const " if issubclass(kind, tuple) else ""
        given.append(f"{const}{_KINDS[kind]}{star}{name}".replace(" ", "\xa0"))
    c = Code(set(kinds) - plain)
    lines = [line for node in tree.body[1:] for line in statement(node, c, "  ")]
    head = f"static inline {back} wmr_{function.__name__}({', '.join(given)}) {{"
    return "\n".join([f"/* {inspect.getdoc(function)} */", *map(wrapped, [head, *lines]), "}\n"])


def _structure(kind) -> str:
    hints = get_type_hints(kind).items()
    many = f"[{code_name('past')}]"
    fields = " ".join(
        f"{_KINDS[hint]}\xa0{name}{many if get_origin(hint) else ''};" for name, hint in hints
    )
    return wrapped(f"typedef struct {{ {fields} }} {_KINDS[kind]};")


def _row(row: drive.Row, condition: str) -> str:
    within = row.within.split()
    every = within == list(monitor.STATES[: len(within)])  # up to the last of them
    test = f"m->state {'<=' if every else '=='} {code_name(within[-1])} && "
    assert every or len(within) == 1, row
    test += f"({condition})" if "||" in condition else condition
    test = wrapped(f"  if ({test}) {{")
    change = f"    m->state = {code_name(row.to)}, m->reason = {code_name(row.reason)};"
    return f"{test}\n{change}\n    return;\n  }}"


def c_drive() -> str:
    """The text of ``wmr_drive.h``."""
    names = [map(code_name, words) for words in (monitor.STATES, monitor.REFUSALS, drive.REASONS)]
    usual = ", ".join(
        str(int(value)) if kind is int else f"WMR_C({float(value)})"
        for value, kind in zip(monitor.Rules(), get_type_hints(monitor.Rules).values(), strict=True)
    )
    places = {
        "NAMES": "\n".join(wrapped(f"enum {{ {', '.join(words)} }};") for words in names)
        + f"\nenum {{ {code_name('past')} = {odometry.PAST} }};",
        "STRUCTURES": "\n".join(map(_structure, _STRUCTS)),
        "USUAL": " \\\n".join(wrapped(f"#define WMR_USUAL_RULES {{{usual}}}").splitlines()),
        "FUNCTIONS": "\n".join(_function(words) for words in OWN.values()),
        "TABLE": "\n".join(map(_row, drive.TABLE, map(c_condition, conditions()))),
        "REASONS": ",\n".join(f'    "{reason}"' for reason in drive.REASONS),
    }
    return filled(
        C_DRIVE.with_name("drive_frame.h"),
        {place: f"{printed}\n" for place, printed in places.items()},
    )
