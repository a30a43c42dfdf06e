"""The drive of `parking` as a C header: the classes and functions of `trust`, and the table."""

from __future__ import annotations

import ast
import inspect
import textwrap
from pathlib import Path
from typing import get_origin, get_type_hints

from wmrlib import odometry, parking, trust
from wmrlib.body import LastTurn, Wheels

C_DRIVE = Path(__file__).parent / "c" / "wmr_drive.h"
_FRAME = C_DRIVE.with_name("drive_frame.h")
_COLUMNS = 88
_KINDS = {float: "WMR_REAL", int: "int", type(None): "void", odometry.Place: "wmr_pose"}
_KINDS |= {LastTurn: "wmr_last_turn", Wheels: "wmr_motors", trust.Wheel: "wmr_wheel"}
_KINDS |= {kind: f"wmr_{kind.__name__.lower()}" for kind in (trust.Rules, trust.Seen, trust.Memory)}
_KINDS |= dict.fromkeys((odometry.Stretch, list[odometry.Stretch]), "wmr_stretch")
_KINDS[odometry.Past] = "wmr_past"
_STRUCTS = [Wheels, LastTurn, trust.Rules, trust.Seen, trust.Wheel]
_STRUCTS += [odometry.Stretch, odometry.Past, trust.Memory]
_OWN = {
    name: value
    for module in (odometry, trust)
    for name, value in vars(module).items()
    if inspect.isfunction(value) and value.__module__ == module.__name__
}
_CALLS = {"min": "WMR_F(fmin)", "max": "WMR_F(fmax)", "abs": "WMR_F(fabs)"}
_CALLS |= {name: f"WMR_F({name})" for name in ("cos", "sin", "atan2")}
_SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.And: "&&", ast.Or: "||"}
_SIGNS |= {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
_SIGNS |= {ast.Not: "!", ast.USub: "-", ast.Mod: "%"}


_SHORT = {"s": "seen", "r": "rules", "e": "end"}  # in a condition of the table


def code_name(words: str) -> str:
    """A state, a refusal or a reason as a constant of the header."""
    return "WMR_" + (words or "fine").upper().replace(" ", "_")


class _C(ast.NodeVisitor):
    """One expression of Python as C; what C has no word for is an error."""

    def __init__(self, pointers: set[str]) -> None:
        self.pointers = pointers

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
        left = self.visit(node.left) if self._binds(node.left, node) else self._part(node.left)
        right, same = node.right, isinstance(node.op, ast.Add | ast.Mult)
        right = self.visit(right) if same and self._binds(right, node) else self._part(right)
        return f"{left} {_SIGNS[type(node.op)]} {right}"

    @staticmethod
    def _binds(inner, outer):
        """Whether it needs no brackets within a sum or a product."""
        tight = ast.Mult | ast.Div
        loose = not isinstance(outer.op, tight | ast.Mod)
        return isinstance(inner, ast.BinOp) and (
            loose or (isinstance(inner.op, tight) and not isinstance(outer.op, ast.Mod))
        )

    def visit_BoolOp(self, node):
        parts = (self._part(n) if isinstance(n, ast.BoolOp) else self.visit(n) for n in node.values)
        return f" {_SIGNS[type(node.op)]} ".join(parts)

    def visit_UnaryOp(self, node):
        return f"{_SIGNS[type(node.op)]}{self._part(node.operand)}"

    def visit_Compare(self, node):
        (sign,), (right,) = node.ops, node.comparators
        left, right = (
            self.visit(n) if isinstance(n, ast.BinOp) else self._part(n) for n in (node.left, right)
        )
        return f"{left} {_SIGNS[type(sign)]} {right}"

    def visit_IfExp(self, node):
        return " ".join(
            [self._part(node.test), "?", self._part(node.body), ":", self._part(node.orelse)]
        )

    def visit_Call(self, node):
        name = node.func.id
        if name not in _OWN:
            return f"{_CALLS.get(name, f'wmr_{name}')}({', '.join(map(self.visit, node.args))})"
        given = [
            f"&{self.visit(arg)}"
            if isinstance(arg, ast.Attribute | ast.Subscript) and self._is_structure(name, k)
            else self.visit(arg)
            for k, arg in enumerate(node.args)
        ]
        return f"wmr_{name}({', '.join(given)})"

    @staticmethod
    def _is_structure(name, place):
        kinds = list(get_type_hints(_OWN[name]).values())
        return kinds[place] not in (float, int)

    def _part(self, node):
        text = self.visit(node)
        simple = isinstance(
            node, ast.Name | ast.Constant | ast.Attribute | ast.Subscript | ast.Call
        )
        return text if simple else f"({text})"


def c_condition(condition: ast.Lambda) -> str:
    """A condition of the table as C."""
    return _C({each.arg for each in condition.args.args}).visit(condition.body)


def _conditions() -> list[ast.Lambda]:
    """Those of `parking.TABLE` in the order in which its source has them."""
    tree = ast.parse(inspect.getsource(parking))
    return [node for node in ast.walk(tree) if isinstance(node, ast.Lambda)]


def _statement(node: ast.stmt, c: _C, indent: str) -> list[str]:
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
            return [line for each in single for line in _statement(each, c, indent)]
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            kind = "int" if isinstance(value, ast.Compare | ast.BoolOp) else "WMR_REAL"
            return [f"{indent}const {kind} {name} = {c.visit(value)};"]
        case ast.Assign(targets=[target], value=value):
            return [f"{indent}{c.visit(target)} = {c.visit(value)};"]
        case ast.If():
            body = [line for each in node.body for line in _statement(each, c, inner)]
            other = [line for each in node.orelse for line in _statement(each, c, inner)]
            other = [f"{indent}}} else {{", *other] if other else []
            return [f"{indent}if ({c.visit(node.test)}) {{", *body, *other, f"{indent}}}"]
        case ast.For(target=ast.Name(id=k), iter=ast.Call(func=ast.Name(id="range"), args=[end])):
            body = [line for each in node.body for line in _statement(each, c, inner)]
            head = f"{indent}for (int {k} = 0; {k} < {c.visit(end)}; {k} += 1) {{"
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
    c = _C(set(kinds) - plain)
    lines = [line for each in tree.body[1:] for line in _statement(each, c, "  ")]
    head = f"static inline {back} wmr_{function.__name__}({', '.join(given)}) {{"
    return "\n".join([f"/* {inspect.getdoc(function)} */", *map(_wrapped, [head, *lines]), "}\n"])


def _wrapped(line: str) -> str:
    indent = line[: len(line) - len(line.lstrip())] + "    "
    filled = textwrap.fill(line, _COLUMNS, subsequent_indent=indent, break_long_words=False)
    return filled.replace("\xa0", " ")


def _structure(kind) -> str:
    hints = get_type_hints(kind).items()
    many = f"[{code_name('past')}]"
    fields = " ".join(
        f"{_KINDS[hint]}\xa0{name}{many if get_origin(hint) else ''};" for name, hint in hints
    )
    return _wrapped(f"typedef struct {{ {fields} }} {_KINDS[kind]};")


def _row(row: parking.Row, condition: str) -> str:
    within = row.within.split()
    every = within == list(trust.STATES[: len(within)])  # up to the last of them
    test = f"m->state {'<=' if every else '=='} {code_name(within[-1])} && "
    assert every or len(within) == 1, row
    test += f"({condition})" if "||" in condition else condition
    test = _wrapped(f"  if ({test}) {{")
    change = f"    m->state = {code_name(row.to)}, m->reason = {code_name(row.reason)};"
    return f"{test}\n{change}\n    return;\n  }}"


def c_drive() -> str:
    """The text of ``wmr_drive.h``."""
    text = _FRAME.read_text(encoding="utf-8").partition("*/\n")[2]
    names = [map(code_name, each) for each in (trust.STATES, trust.REFUSALS, parking.REASONS)]
    usual = ", ".join(
        str(int(value)) if kind is int else f"WMR_C({float(value)})"
        for value, kind in zip(trust.Rules(), get_type_hints(trust.Rules).values(), strict=True)
    )
    said = [f'    "{reason}"' for reason in parking.REASONS]
    places = {
        "NAMES": "\n".join(_wrapped(f"enum {{ {', '.join(each)} }};") for each in names)
        + f"\nenum {{ {code_name('past')} = {odometry.PAST} }};",
        "STRUCTURES": "\n".join(map(_structure, _STRUCTS)),
        "USUAL": " \\\n".join(_wrapped(f"#define WMR_USUAL_RULES {{{usual}}}").splitlines()),
        "FUNCTIONS": "\n".join(_function(each) for each in _OWN.values()),
        "TABLE": "\n".join(map(_row, parking.TABLE, map(c_condition, _conditions()))),
        "REASONS": ",\n".join(said),
    }
    for place, printed in places.items():
        assert text.count(f"/* @{place}@ */\n") == 1, place
        text = text.replace(f"/* @{place}@ */\n", printed + "\n")
    return text
