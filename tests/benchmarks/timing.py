"""How the benchmarks measure: in turn, the best of several rounds, as machines are noisy."""

from __future__ import annotations

import json
import os
import platform
import time
from collections.abc import Callable
from itertools import groupby
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]


class Row(NamedTuple):
    """One line of the table; the section's title names the line that `ratio` is to."""

    section: str
    what: str
    value: float
    unit: str
    ratio: float | None = None


def in_turn(cases: dict[str, Callable], repeat: int = 7) -> dict[str, float]:
    """Seconds of one call of each case: the best of `repeat` rounds, each of all cases in turn."""
    counts = {}
    for name, function in cases.items():
        function()
        begin = time.perf_counter()
        function()
        counts[name] = max(1, round(0.02 / (time.perf_counter() - begin)))
    best = dict.fromkeys(cases, float("inf"))
    for _ in range(repeat):
        for name, function in cases.items():
            begin = time.perf_counter()
            for _ in range(counts[name]):
                function()
            best[name] = min(best[name], (time.perf_counter() - begin) / counts[name])
    return best


def show(rows: list[Row]) -> None:
    for section, members in groupby(rows, key=lambda row: row.section):
        print(f"\n{section}")
        for row in members:
            ratio = "" if row.ratio is None else f"{row.ratio:10.2f}"
            print(f"  {row.what:46}{row.value:12.4g} {row.unit:10}{ratio}")


def keep(name: str, rows: list[Row]) -> None:
    """Write the table and its machine into the book."""
    listed = [row._asdict() | {"value": float(f"{row.value:.4g}")} for row in rows]
    text = json.dumps({"machine": machine(), "rows": listed}, indent=1)
    (ROOT / "book" / name).write_text(text + "\n", encoding="utf-8")


def machine() -> str:
    """The processor, the number of cores and Python's version, in one line."""
    name = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        lines = cpuinfo.read_text(encoding="utf-8").replace("\t", "").splitlines()
        facts = dict(line.split(": ", 1) for line in lines if ": " in line)
        name, flags = facts.get("model name", name), facts.get("flags", "")
        vectors = {"avx512f": ", AVX-512", "avx2": ", AVX2"}
        name += next((title for flag, title in vectors.items() if flag in flags), "")
    cores, python = f"{os.cpu_count()} cores", f"Python {platform.python_version()}"
    return ", ".join([name, cores, platform.system(), python])
