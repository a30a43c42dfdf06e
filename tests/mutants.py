"""Break the libraries' formulas, one change at a time, and report what no test notices.

    python tests/mutants.py [--count 100] [--module control ...] [--seed 1]

A mutant is a copy of the repository in which one operator, sign, comparison or function of a
formula is another. It is tested by the tests that TESTS names, by default test_MODULE; one that
hangs counts as noticed. A survivor is a test that is missing, or a change that nobody can see, such
as `<=` for `<` at a border that is never met: judge each. (mutmut leaves out functions with a
decorator, and here numba decorates every formula.)
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from itertools import accumulate
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = "wmrlib", "book/robot/wmrrobot"
TESTS = {  # of a module or a folder; "jit" where plain Python would take long
    "_dop853": "simulation",
    "threads": "jit sweeping",
    "engine": "jit sweeping simulation",
    "estimation": "jit estimation",
    "exports": "sheets",
    "gains": "gains control",
    "jacobians": "jit filter",
    "kalman": "jit filter estimation",
    "kinematics": "kinematics arguments",
    "laws": "control simulation",
    "loops": "jit simulation hysteresis",
    "monitor": "drive",
    "motion": "kinematics simulation",
    "odometry": "drive",
    "printing": "c_example c_filter",
    "receiver": "jit receiver",
    "runs": "metrics simulation",
    "steering": "drive",
    "trials": "jit certificate sheets",
    "sheets": "jit sheets",
    "sensing": "jit estimation filter",
    "sweeping": "jit sweeping receiver",
    "symbolic": "symbolic control c_header",
    "tracks": "tracks ubx",
}
NO_FORMULAS = {"__init__", "__main__", "checks", "compilation"}
OPERATORS = {
    **{ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*", ast.Mod: "*", ast.Pow: "*"},
    **{ast.Lt: ">=", ast.LtE: ">", ast.Gt: "<=", ast.GtE: "<", ast.Eq: "!=", ast.NotEq: "=="},
    **{ast.And: "or", ast.Or: "and"},
}
SWAPPED = {"sin": "cos", "cos": "sin", "max": "min", "min": "max"}
LIMIT = 600.0  # s, in which the tests of a module end


class Mutant(NamedTuple):
    """`after` in place of the characters from `start` to `end` of a file."""

    path: Path
    start: int
    end: int
    after: str

    def __str__(self) -> str:
        source = self.path.read_text(encoding="utf-8")
        number, before = source.count("\n", 0, self.start), source[self.start : self.end]
        line = source.splitlines()[number].strip()
        return f"{self.path.relative_to(ROOT)}:{number + 1}: {before!r} -> {self.after!r} in {line}"

    @property
    def module(self) -> str:
        package = next(ROOT / part for part in PACKAGES if (ROOT / part) in self.path.parents)
        return self.path.relative_to(package).parts[0].removesuffix(".py")


def mutants() -> Iterator[Mutant]:
    """All of them, in the order of the files."""
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            if path.stem not in NO_FORMULAS:
                for change in changes(path.read_text(encoding="utf-8")):
                    yield Mutant(path, *change)


def changes(source: str) -> Iterator[tuple[int, int, str]]:
    """Where a formula could be another: from, to, and what then stands there."""
    source = source.encode("ascii", "replace").decode()  # ast counts bytes, and a \u03b8 has two
    starts = [0, *accumulate(map(len, source.splitlines(keepends=True)))]

    def between(left: ast.expr, right: ast.expr, kind: ast.AST) -> Iterator[tuple[int, int, str]]:
        end = starts[left.end_lineno - 1] + left.end_col_offset
        begin = starts[right.lineno - 1] + right.col_offset
        text = source[end:begin]
        operator = text.strip(" ()\\\n")
        if type(kind) in OPERATORS and "#" not in text:
            at = end + text.index(operator)
            yield at, at + len(operator), OPERATORS[type(kind)]

    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.BinOp(left, kind, right):
                yield from between(left, right, kind)
            case ast.Compare(left, [kind], [right]):
                yield from between(left, right, kind)
            case ast.BoolOp(kind, [left, right, *_]):
                yield from between(left, right, kind)
            case ast.UnaryOp(ast.USub()):
                at = starts[node.lineno - 1] + node.col_offset
                yield at, at + 1, ""
            case ast.Name(name) | ast.Attribute(_, name) if name in SWAPPED:
                end = starts[node.end_lineno - 1] + node.end_col_offset
                yield end - len(name), end, SWAPPED[name]


def fate(mutant: Mutant) -> str:
    """Test it in a copy of the repository."""
    mode, *names = TESTS.get(mutant.module, mutant.module).split()
    names = names if mode == "jit" else [mode, *names]
    left_out = shutil.ignore_patterns(".*", "_build", "vendor", "node_modules", "__pycache__")
    with tempfile.TemporaryDirectory() as folder:
        copy = shutil.copytree(ROOT, Path(folder, "copy"), ignore=left_out)
        file = copy / mutant.path.relative_to(ROOT)
        source = file.read_text(encoding="utf-8")
        changed = source[: mutant.start] + mutant.after + source[mutant.end :]
        file.write_text(changed, encoding="utf-8")
        tests = [path for name in names for path in sorted(copy.glob(f"tests/**/test_{name}.py"))]
        command = [sys.executable, "-m", "pytest", "-xqo", "addopts=", "-p", "no:cacheprovider"]
        command += ["-W", "ignore::RuntimeWarning"] if mode != "jit" else []
        paths = [str(copy / part) for part in (".", "book", "book/robot")]
        settings = {"PYTHONPATH": os.pathsep.join(paths), "NUMBA_CACHE_DIR": f"{folder}/cache"}
        settings |= {"NUMBA_DISABLE_JIT": str(int(mode != "jit"))}
        options = {"cwd": copy, "env": os.environ | settings, "timeout": LIMIT}
        try:
            done = subprocess.run([*command, *tests], capture_output=True, **options)
        except subprocess.TimeoutExpired:
            return "noticed"
        return "noticed" if done.returncode else "SURVIVED"


def main(count: int, seed: int, module: list[str]) -> None:
    sites = [mutant for mutant in mutants() if not module or mutant.module in module]
    survived, sound = 0, set()
    for mutant in sorted(random.Random(seed).sample(sites, min(count, len(sites)))):
        unchanged = mutant._replace(end=mutant.start, after="")
        if mutant.module not in sound and fate(unchanged) == "noticed":
            sys.exit(f"The tests of {mutant.module} fail without a mutant.")
        sound.add(mutant.module)
        print(f"{(verdict := fate(mutant)):10}{mutant}", flush=True)
        survived += verdict == "SURVIVED"
    print(f"{survived} of {min(count, len(sites))} survived")


if __name__ == "__main__":
    formatter = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=formatter)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--module", nargs="+", default=[])
    main(**vars(parser.parse_args()))
