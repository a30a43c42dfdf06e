"""All benchmarks in one run and one table: python tests/benchmarks/everything.py [--fast | --keep]

--fast leaves out the explorer, which needs a browser and takes minutes. --keep writes the table
and its machine to book/speed.json, which the book's page on speed shows. Machines differ and are
noisy: quote the ratios.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import one_run
import sweeps
from timing import keep, machine, show


def main(*options: str) -> None:
    print(machine())
    with tempfile.TemporaryDirectory() as folder:
        rows = [*one_run.rows(), *sweeps.rows(Path(folder))]
    if "--fast" not in options:
        import explorer_latency

        rows += explorer_latency.rows()
    show(rows)
    if "--keep" in options:
        keep("speed.json", rows)


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--fast"], ["--keep"]):  # half a table is not kept
        sys.exit(__doc__)
    main(*sys.argv[1:])
