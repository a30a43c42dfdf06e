"""Answers that two or three students wrote alike, where that is no chance.

Right answers to a short task look alike, which says nothing. These are the same program but for
names and layout, and share something that nobody else in the class, nor the notebook, nor the model
has: a remark, a number, a text, or two names. That is a reason to ask and no proof, and a copy in
which they were changed is not found.
"""

from __future__ import annotations

import ast
import io
import tokenize
from collections import defaultdict
from collections.abc import Iterator

from cells import MOST_CODE

LEAST = 25  # nodes of a program's tree: shorter ones are alike by chance
MOST = 3  # students; what more have, they may have from a lesson
CLASS = 5  # students: in a smaller class nothing is rare


def alike(answers: dict[str, str], known: str) -> Iterator[tuple[list[str], list[str]]]:
    """Yield students with the same program, and what they alone have in common.

    answers: a task's, {student: source}; known: all texts that everybody has.
    """
    told, forms, owners = {}, {}, defaultdict(list)
    for student, source in answers.items():
        try:
            tree = ast.parse(source[:MOST_CODE])
            marks = _marks(tree, source)
            if sum(1 for _ in ast.walk(tree)) >= LEAST:
                forms[student] = _form(tree)
        except (SyntaxError, ValueError, RecursionError, MemoryError, tokenize.TokenError):
            continue  # no program, or one that nobody wrote by hand
        told[student] = marks
    for mark in set().union(*told.values()):
        if mark.strip("# '\"") not in known:
            owners[tuple(each for each in told if mark in told[each])].append(mark)
    for students, shared in sorted(owners.items()) if len(told) >= CLASS else ():
        same = {forms.get(each, each) for each in students}
        if 2 <= len(students) <= MOST and len(same) == 1:
            names = [it for it in shared if it.isidentifier()]
            if len(names) > 1 or len(shared) > len(names):
                yield [*students], sorted(shared, key=lambda it: (it.isidentifier(), it))


def _marks(tree: ast.AST, source: str) -> set[str]:
    """The names, longer numbers and texts, and remarks of a program."""
    found = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    constants = (repr(it.value) for it in ast.walk(tree) if isinstance(it, ast.Constant))
    found |= {text for text in constants if 4 < len(text) < 60}
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    remarks = {each.string for each in tokens if each.type == tokenize.COMMENT}
    return found | {text for text in remarks if len(text) > 12}


def _form(tree: ast.AST) -> str:
    """A program as text, without docstrings, its names numbered as they come."""
    numbers: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and ast.get_docstring(node) is not None:
            node.body = node.body[1:]
        for field in "id", "arg", "name":
            if isinstance(name := getattr(node, field, None), str):
                setattr(node, field, numbers.setdefault(name, f"name{len(numbers)}"))
    return ast.dump(tree)
