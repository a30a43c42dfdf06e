"""Runs a cell in the page's Python as a notebook does; worker.js calls `run`."""

import ast
import contextlib
import io
import json
import linecache
import traceback

LONGEST = 20_000  # characters that a page shows
_spaces, _made = {}, {}  # variables by space, and the names that each cell's last run brought


def run(space: str, number: int, before: str, source: str, checks: list[str]) -> str:
    """Return as JSON what the cell shows: pairs of kind and text; and what went wrong, if it did.

    Cells of one `space` share their variables. `before` is code that the page does not show. What a
    cell itself made is gone before it runs again: an answer that is renamed is no answer.
    """
    names = _spaces.setdefault(space, {"__name__": "__main__", "input": _nobody_answers})
    for name in _made.get((space, number), ()):
        names.pop(name, None)
    shown, known = [], set(names)
    file = f"<ipython-input-{number}>"  # by which the checks know a reader's own code
    try:
        _execute(before, "<before>", names, [])
        _execute(source, file, names, shown)
        for check in checks:
            _execute(check, "<check>", names, shown)
    except BaseException as error:
        hint = hasattr(error, "_render_traceback_")
        return json.dumps({"shown": shown, "error": _said(error, file, source), "hint": hint})
    finally:
        _made[space, number] = names.keys() - known
    return json.dumps({"shown": shown, "error": None})


def _nobody_answers(prompt=""):
    raise RuntimeError("nobody answers here: write the value into the code")


def _execute(source, file, names, shown):
    linecache.cache[file] = (len(source), None, source.splitlines(keepends=True), file)
    tree = ast.parse(source, file)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    try:
        with contextlib.redirect_stdout(printed):
            exec(compile(tree, file, "exec"), names)
            if last:
                value = eval(compile(ast.Expression(last.value), file, "eval"), names)
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


def _said(error, file, source):
    """Return the last line of the error and, if the cell is to blame, which of its lines it was."""
    if hasattr(error, "_render_traceback_"):
        return " ".join(error._render_traceback_())
    text = traceback.format_exception_only(error)[-1].strip()
    lines = [it.lineno for it in traceback.extract_tb(error.__traceback__) if it.filename == file]
    if isinstance(error, SyntaxError) and error.filename == file:
        lines = [error.lineno]
    if not lines:
        return text
    if text == "AssertionError":
        text += f": {source.splitlines()[lines[-1] - 1].strip()}"
    return f"Line {lines[-1]}: {text}"
