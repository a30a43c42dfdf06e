"""Runs a cell in the page's Python as a notebook does; worker.js calls `run`."""

import ast
import contextlib
import io
import json
import traceback

LONGEST = 20_000  # characters that a page shows
_names = {"__name__": "__main__"}  # which all cells share


def run(number: int, before: str, source: str) -> str:
    """Return as JSON what the cell shows: pairs of kind and text; and what went wrong, if it did.

    `before` is code that the page does not show.
    """
    shown, file = [], f"<cell {number}>"
    try:
        _execute(before, "<before>", [])
        _execute(source, file, shown)
    except BaseException as error:
        return json.dumps({"shown": shown, "error": _error_text(error, file, source)})
    return json.dumps({"shown": shown, "error": None})


def _execute(source, file, shown):
    tree = ast.parse(source, file)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    try:
        with contextlib.redirect_stdout(printed):
            exec(compile(tree, file, "exec"), _names)
            if last:
                value = eval(compile(ast.Expression(last.value), file, "eval"), _names)
    finally:
        if text := printed.getvalue():
            shown.append(["text", _short(text)])
    if value is not None:
        latex = getattr(value, "_repr_latex_", lambda: None)()
        shown.append(["latex", latex] if latex else ["text", _short(repr(value))])


def _short(text):
    if len(text) <= LONGEST:
        return text
    half, left_out = LONGEST // 2, len(text) - LONGEST
    return f"{text[:half]}\n... {left_out} characters left out ...\n{text[-half:]}"


def _error_text(error, file, source):
    """Return the last line of the error and, if the cell is to blame, which of its lines it was."""
    text = traceback.format_exception_only(error)[-1].strip()
    lines = [it.lineno for it in traceback.extract_tb(error.__traceback__) if it.filename == file]
    if isinstance(error, SyntaxError) and error.filename == file:
        lines = [error.lineno]
    if not lines:
        return text
    if text == "AssertionError":
        text += f": {source.splitlines()[lines[-1] - 1].strip()}"
    return f"Line {lines[-1]}: {text}"
