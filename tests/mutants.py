"""Break wmrlib's formulas, one change at a time, and count how many breaks the tests notice.

    python tests/mutants.py [--count 200] [--module control ...] [--jobs 2] [--seed 1]

A mutant is the package with one operator, sign, constant, comparison, condition or call changed.
It is tested in a copy of the repository, with the test files that PLANS names, or test_MODULE. A
mutant that hangs counts as killed. The exit status is 1 if fewer than 90 % are killed. (mutmut
leaves out functions with a decorator, and here numba decorates every formula.)
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import accumulate, pairwise
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "wmrlib"
# The tests of a file or a folder, in this order until one fails; by default "plain NAME", which
# runs test_NAME without compiling: quicker where a formula is called a few thousand times. "quick"
# does so too, without what then takes long or fails: most mutants die before anything is compiled.
PLANS = {
    "elementary": "quick elementary; jit elementary",
    "_dop853": "quick simulation; jit simulation",
    "loops": "quick simulation; jit simulation hysteresis",
    "engine": "jit sweeping; jit simulation",
    "engine/vectors": "quick elementary; jit elementary",
    "engine/sampled": "jit receiver; jit sweeping hysteresis body",
    "engine/receivers": "jit receiver",
    "body": "quick body; jit body",
    "control": "plain control arguments",
    "_threads": "jit sweeping receiver",
    "gains": "plain gains control; jit paper",
    "kinematics": "plain kinematics arguments",
    "geodesy": "plain geodesy",
    "laws": "plain control; quick simulation; jit simulation",
    "motion": "plain kinematics; quick simulation; jit simulation hysteresis",
    "receiver": "jit receiver",
    "runs": "plain metrics; quick simulation; jit simulation",
    "simulation": "quick simulation; jit simulation",
    "sweeping": "jit sweeping; jit receiver",
    "symbolic": "plain symbolic control c_header",
    "tracks/ubx": "plain ubx tracks",
    "tuning": "quick tuning; jit tuning",
}
NO_FORMULAS = {"__init__", "checks", "compilation"}
# The file, what the line or the change reads, and why no test can tell the mutant.
EQUIVALENT = [
    ("_threads.py", "in _POLL_SECONDS = ", "a patience"),
    ("_threads.py", "in _IN_FLIGHT = ", "how many chunks wait does not show"),
    ("engine", "in _ROUNDS = ", "how often is looked at who has finished does not show"),
    ("engine/continuous.py", "'>' -> '>=' in far = ", "nobody stops at the border"),
    ("engine/continuous.py", "'<' -> '<=' in hopeless", "a patience"),
    ("engine/continuous.py", "'<=' -> '<' in hopeless", "a patience"),
    ("_dop853.py", "'<' -> '<=' in wanted = ", "what is equal is taken for its equal"),
    ("_dop853.py", "'1e-300' -> '2e-300'", "a number that is never met"),
    ("_dop853.py", "'>' -> '>=' in return turn", "nothing misses just the slack"),
    ("_dop853.py", "'<' -> '<=' in return time", "nobody stops at the border"),
    ("_dop853.py", "'5.0' -> '10.0'", "how long steps are tried does not show"),
    ("_dop853.py", "'&' -> '|' in passing = ", "a step may end at any turn of rho"),
    ("engine/vectors.py", "for n in range(14)", "terms that are too many are not used"),
    ("engine/vectors.py", "'>' -> '>=' in turned = ", "both branches agree at the border"),
    ("engine/vectors.py", "> _HIGHEST else x", "both branches agree at the border"),
    ("elementary.py", "in divisor = 1.0 if tiny", "a quotient that is not used"),
    ("elementary.py", "in tiny = ", "both branches agree at the border"),
    ("body.py", "'1.0' -> '2.0' in NO_LIMITS = ", "limits that never bind"),
    ("body.py", "in _AT_ONCE = ", "a tolerance"),
    ("body.py", "'<' -> '<=' in return (abs(body", "no wheel is just as fast"),
    ("geodesy.py", "in lon2 = np.where", "half a turn more or less, in mod 360, which keeps -180"),
    ("engine/receivers.py", "in return eyes, 1", "how far back it could look does not show"),
    ("runs.py", "int(steps + 1e-9)", "a tolerance"),
    ("runs.py", "if steps > MOST_SAMPLES", "one step in ten million"),
    ("simulation.py", "'0.0' -> '1' in path = ", "rows that are not used"),
    ("simulation.py", "'6' -> '12' in state = ", "rows that are not used"),
    ("simulation.py", "'wrap(end.heading)' ->", "the last bits, as a sweep has them"),
    ("sweeping.py", "_CHUNK", "how runs are cut into chunks does not show"),
    ("sweeping.py", "in size = ", "how runs are cut into chunks does not show"),
    ("sweeping.py", "in if len(chunks)", "where is compiled does not show"),
    ("symbolic/symbols.py", "'1' -> '2' in def fdiff(", "sympy passes it"),
    ("tracks/ubx.py", "'>' -> '>=' in if end > self.end", "the same sums, once more"),
    ("tracks/nmea.py", "'13' -> '26' in fields = ", "fields that are not read"),
    ("symbolic/formulas.py", "motion.polar_from_pose, 0, 0, 0", "what the result does not read"),
]

OPERATORS = {
    **{"+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "//": ["*"], "**": ["*"], "%": ["*"]},
    **{"<": ["<=", ">="], "<=": ["<", ">"], ">": [">=", "<="], ">=": [">", "<"]},
    **{"==": ["!="], "!=": ["=="], "is": ["is not"], "is not": ["is"], "in": ["not in"]},
    **{"not in": ["in"], "and": ["or"], "or": ["and"], "&": ["|"], "+=": ["-="], "-=": ["+="]},
}
OPERATOR = re.compile(rb"(?:[\s)\\]|#.*\n)*(is not|not in|[a-z]+|[-+*/%&|<>=!@^]+)")
SWAPPED = {"sin": "cos", "cos": "sin", "max": "min", "min": "max", "radians": "degrees"}
DROPPED = {"wrap", "wrap_angle", "abs", "max", "min", "maximum", "minimum", "clip", "sqrt"}
NOT_COMPUTED = {"annotation", "returns", "decorator_list", "bases"}
_QUICK = 4.0  # s, for a test that is quick
# In the copies hypothesis does not shrink what fails, the tests that are soon done run first, and
# what is compiled is kept for the next mutant if that leaves the kernels alone.
CONFTEST = """
import json
import signal
from hypothesis import Phase
settings.load_profile("repeatable")
settings.register_profile("mutants", phases=(Phase.explicit, Phase.generate))
settings.load_profile("mutants")
_TOOK = Path(os.environ["MUTANTS_TOOK"])
_took = json.loads(_TOOK.read_text()) if _TOOK.exists() else {}
_QUICK = 0.0 if _took else float(os.environ["MUTANTS_QUICK"])  # without a mutant, to find them

def pytest_collection_modifyitems(config, items):
    config.option.maxfail = 0 if _QUICK else 1
    items[:] = [item for item in items if _took.get(item.nodeid) != "left out"]
    items.sort(key=lambda item: _took.get(item.nodeid, 0.0))

@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item):
    if _QUICK:
        signal.signal(signal.SIGALRM, lambda *_: pytest.skip("takes long"))
        signal.setitimer(signal.ITIMER_REAL, _QUICK)
    yield
    if _QUICK:
        signal.setitimer(signal.ITIMER_REAL, 0.0)

def pytest_runtest_logreport(report):
    took = _took.get(report.nodeid, 0.0)
    if _QUICK and not report.passed or took == "left out":
        _took[report.nodeid] = "left out"
    else:
        _took[report.nodeid] = max(report.duration, took)

def pytest_sessionfinish(exitstatus):
    if exitstatus == 0 or _QUICK:
        _TOOK.write_text(json.dumps(_took))
"""
COMPILE = """
_FOLDERS = [Path(os.environ["MUTANTS_CACHE"])]
"""


class Mutant(NamedTuple):
    """`after` in place of the bytes from `start` to `end` of wmrlib's file `path`."""

    path: str
    start: int
    end: int
    after: str

    def __str__(self) -> str:
        source = (PACKAGE / self.path).read_bytes()
        line = source.count(b"\n", 0, self.start)
        before, shown = source[self.start : self.end].decode(), source.splitlines()[line].decode()
        return f"{self.path}:{line + 1}: {before!r} -> {self.after!r} in {shown.strip()}"

    @property
    def module(self) -> str:
        return self.path.removesuffix(".py").split("/")[0]

    @property
    def plan(self) -> str:
        own = PLANS.get(self.module, f"plain {self.module}")
        return PLANS.get(self.path.removesuffix(".py"), own)


def mutants() -> Iterator[Mutant]:
    for file in sorted(PACKAGE.rglob("*.py")):
        for change in sorted(set(changes(file.read_bytes()))):
            mutant = Mutant(file.relative_to(PACKAGE).as_posix(), *change)
            known = (path in str(mutant) and text in str(mutant) for path, text, _ in EQUIVALENT)
            if mutant.module not in NO_FORMULAS and not any(known):
                yield mutant


def changes(source: bytes) -> Iterator[tuple[int, int, str]]:
    starts = [0, *accumulate(map(len, source.splitlines(keepends=True)))]

    def at(node: ast.AST) -> tuple[int, int]:
        first, last = starts[node.lineno - 1], starts[node.end_lineno - 1]
        return first + node.col_offset, last + node.end_col_offset

    for node in computed(ast.parse(source)):
        parts = []
        match node:
            case ast.BoolOp(_, parts):
                pass
            case ast.BinOp(left, _, right) | ast.AugAssign(left, _, right):
                parts = [left, right]
            case ast.Compare(left, _, rights):
                parts = [left, *rights]
            case ast.UnaryOp(ast.USub() | ast.Not(), operand):
                yield at(node)[0], at(operand)[0], ""
            case ast.Constant(bool(value)):
                yield *at(node), str(not value)
            case ast.Constant(int(value) | float(value)):
                yield *at(node), repr(2 * value or 1)
            case ast.If(test) | ast.IfExp(test) if isinstance(test, ast.Name | ast.Call):
                yield at(test)[0], at(test)[0], "not "
            case ast.Call(func, [first, *_]):
                name = getattr(func, "attr", getattr(func, "id", ""))
                if name in DROPPED:
                    yield *at(node), source[slice(*at(first))].decode()
                if name in SWAPPED:
                    yield at(func)[1] - len(name), at(func)[1], SWAPPED[name]
        for left, right in pairwise(parts):
            found = OPERATOR.match(source, at(left)[1], at(right)[0])
            for after in OPERATORS.get(found[1].decode(), ()):
                yield *found.span(1), after


def computed(node: ast.AST) -> Iterator[ast.AST]:
    """All nodes but annotations, bases, decorators, error texts, and zip's check of lengths."""
    if isinstance(node, ast.keyword) and node.arg == "strict":
        return
    yield node
    for field, value in ast.iter_fields(node):
        for child in value if isinstance(value, list) else [value]:
            skipped = isinstance(child, ast.Raise | ast.JoinedStr) or field in NOT_COMPUTED
            if isinstance(child, ast.AST) and not skipped:
                yield from computed(child)


class Copy:
    """A copy of the repository in which one mutant at a time is tested."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.limits = folder, {}
        left_out = shutil.ignore_patterns(".*", "_*build", "vendor", "node_modules", "__pycache__")
        shutil.copytree(ROOT, folder, ignore=left_out)
        for name, text in (("tests/conftest.py", CONFTEST), ("wmrlib/compilation.py", COMPILE)):
            with (folder / name).open("a", encoding="utf-8") as file:
                file.write(text)

    def fate(self, mutant: Mutant) -> str:
        plans = mutant.plan.split("; ")
        for plan in plans:
            if plan not in self.limits:
                if plan.startswith("quick"):
                    self.tests(plan, "kept", 1200.0)  # finds what to leave out
                begin = time.perf_counter()
                if self.tests(plan, "kept", 1200.0):
                    sys.exit(f"The tests of {mutant.path}, {plan}, fail without a mutant.")
                self.limits[plan] = 30.0 + 3.0 * (time.perf_counter() - begin)
        file = self.folder / "wmrlib" / mutant.path
        source = file.read_bytes()
        cache = "new" if re.search(rb"import.*\b(compiled|formula)\b", source) else "kept"
        file.write_bytes(source[: mutant.start] + mutant.after.encode() + source[mutant.end :])
        try:
            failed = any(self.tests(plan, cache, self.limits[plan]) for plan in plans)
            return "killed" if failed else "SURVIVED"
        except subprocess.TimeoutExpired:
            return "killed by the clock"
        finally:
            file.write_bytes(source)
            shutil.rmtree(self.folder / "new", ignore_errors=True)

    def tests(self, plan: str, cache: str, limit: float) -> int:
        """The exit status of pytest on the tests of a plan."""
        how, *names = plan.split()
        command = [sys.executable, "-m", "pytest", "-xqo", "addopts=", "-p", "no:cacheprovider"]
        if how != "jit":  # numpy's; compiled code overflows in silence
            command += ["-W", "ignore::RuntimeWarning"]
        command += [f"tests/test_{name}.py" for name in names]
        settings = os.environ | {
            "PYTHONPATH": os.pathsep.join(
                str(self.folder / place) for place in ("", "book", "book/robot")
            ),
            "PYTHONDONTWRITEBYTECODE": "1",  # it would outlive a mutant of the same size
            "NUMBA_DISABLE_JIT": str(int(how != "jit")),
            "MUTANTS_QUICK": str(_QUICK if how == "quick" else 0.0),
            "MUTANTS_CACHE": str(self.folder / cache),
            "MUTANTS_TOOK": str(self.folder / f"{plan}.json"),
        }
        options = {"cwd": self.folder, "env": settings, "timeout": limit, "capture_output": True}
        return subprocess.run(command, **options).returncode


def main(count: int, jobs: int, seed: int, module: list[str]) -> None:
    sites = [mutant for mutant in mutants() if not module or mutant.module in module]
    chosen = sorted(random.Random(seed).sample(sites, min(count, len(sites))))
    mine = threading.local()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(jobs) as pool:

        def fate(mutant: Mutant) -> str:
            if not hasattr(mine, "copy"):
                mine.copy = Copy(Path(folder, str(threading.get_ident())))
            return mine.copy.fate(mutant)

        fates = {}
        for mutant, fates[mutant] in zip(chosen, pool.map(fate, chosen), strict=True):
            print(f"{fates[mutant]:20}{mutant}", flush=True)
    survivors = [mutant for mutant, fate in fates.items() if fate == "SURVIVED"]
    alive = Counter(mutant.module for mutant in survivors)
    for name, total in Counter(mutant.module for mutant in chosen).items():
        print(f"{name:20}{total - alive[name]:5} of {total} killed")
    print(f"{'all':20}{len(chosen) - len(survivors):5} of {len(chosen)} killed")
    print("\nSurvivors:", *survivors, sep="\n")
    if len(survivors) > 0.1 * len(chosen):
        sys.exit("Fewer than 90 % were killed.")


if __name__ == "__main__":
    formatter = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=formatter)
    for name, default in {"count": 200, "jobs": 2, "seed": 1}.items():
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--module", nargs="+", default=[])
    main(**vars(parser.parse_args()))
