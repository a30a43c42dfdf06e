"""All benchmarks in one run and one table: python tests/benchmarks/everything.py [--fast | --keep]

--fast leaves out the chapters, the book and the explorer, which take minutes. --keep
writes the table and its machine to book/speed.json, which the book's page on speed shows, if all of
it could be measured. Machines differ and are noisy: quote the ratios.
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path

import one_run
import sweeps
from timing import ROOT, Row, command, machine, process, show

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


def building(folder: Path, failures: list[str]) -> list[Row]:
    rows = []
    for chapter in sorted((ROOT / "notebooks").glob("*.ipynb")):
        seconds, done = command(
            "-m", "nbconvert", "--to", "notebook", "--execute", f"--output-dir={folder}", chapter
        )
        rows.append(Row("The book", f"run {chapter.stem}", seconds, "s"))
        failures += [done.stderr[-500:]] if done.returncode else []
    seconds, done = command(ROOT / "book" / "tools" / "build.py", folder / "book")
    rows.append(Row("The book", "build all pages", seconds, "s"))
    failures += [done.stderr[-500:]] if done.returncode else []
    return rows


def explorer(failures: list[str]) -> list[Row]:
    _, done = command(Path(__file__).with_name("explorer_latency.py"))
    if done.returncode:
        failures.append(f"The explorer was not measured: {done.stderr.strip().splitlines()[-1]}")
        return []
    section, lines = "The explorer, slider event to finished picture, median", done.stdout
    rows = ((line[:40].strip(), float(line[40:48])) for line in lines.splitlines()[1:])
    return [Row(section, *row, "ms") for row in rows]


def main(fast: bool, keep: bool) -> None:
    print(machine())
    failures: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = [
            *one_run.rows(),
            *sweeps.against_the_limit(folder),
            *sweeps.with_error_control(),
            *sweeps.growth(),
            *starting(),
        ]
        if not fast:
            rows += [*building(folder, failures), *explorer(failures)]
    show(rows)
    if failures:
        sys.exit("\n".join(["", "Nothing is kept, because not all could be measured.", *failures]))
    if keep:
        table = {
            "machine": machine(),
            "rows": [row._asdict() | {"value": float(f"{row.value:.4g}")} for row in rows],
        }
        (ROOT / "book" / "speed.json").write_text(
            json.dumps(table, indent=1) + "\n", encoding="utf-8"
        )


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--fast"], ["--keep"]):  # half a table is not kept
        sys.exit(__doc__)
    main("--fast" in sys.argv, "--keep" in sys.argv)
