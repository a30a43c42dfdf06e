"""All benchmarks in one run and one table: python tests/benchmarks/everything.py [--fast | --keep]

--fast leaves out the book and the explorer, which take minutes. --keep writes the table and its
machine to book/speed.json, which the book's page on speed shows. Machines differ and are noisy:
quote the ratios.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import one_run
import sweeps
from timing import ROOT, Row, keep, machine, process, show

FIRST_RUN = "import wmrlib as w; w.simulate(w.Pose(0, 0, 0), w.Pose(9, 9, 1), w.Gains(2, 1, 0.3))"
FIRST_SWEEP = "import wmrlib as w; w.sweep(w.Pose(0, 0, 0), w.Pose(9, 9, 1), w.Gains(2, 1, 0.3))"


def starting() -> list[Row]:
    section, times = "A fresh process", {}
    imports = {"import wmrlib": "import wmrlib", "import numba, to compare": "import numba"}
    for name, statement in imports.items():
        times[name] = min(process(statement) for _ in range(5))
    for name, statement in {"simulate": FIRST_RUN, "sweep": FIRST_SWEEP}.items():
        with tempfile.TemporaryDirectory() as cache:
            anew, *again = (process(statement, NUMBA_CACHE_DIR=cache) for _ in range(4))
        times[f"import and first {name}, compiled anew"] = anew
        times[f"import and first {name}, cached"] = min(again)
    return [Row(section, name, value, "s") for name, value in times.items()]


def building(folder: Path) -> list[Row]:
    begin = time.perf_counter()
    command = [sys.executable, ROOT / "book" / "tools" / "build.py", folder / "book"]
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return [Row("The book", "build all pages", time.perf_counter() - begin, "s")]


def main(*options: str) -> None:
    print(machine())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = [
            *one_run.rows(),
            *sweeps.against_the_limit(folder),
            *sweeps.with_error_control(),
            *sweeps.growth(),
            *starting(),
        ]
        if "--fast" not in options:
            import explorer_latency

            rows += [*building(folder), *explorer_latency.rows()]
    show(rows)
    if "--keep" in options:
        keep("speed.json", rows)


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--fast"], ["--keep"]):  # half a table is not kept
        sys.exit(__doc__)
    main(*sys.argv[1:])
