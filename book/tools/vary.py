"""Vary what a headline's cell did not mean to fix, and see whether the sentence survives.

    python book/tools/vary.py                # every headline, 40 draws each
    python book/tools/vary.py 05 README.md   # those that stand in chapter 5 and in the README

Prints the range that each number takes; exits with 1 if a sentence falls, or is not in its place.
"""

from __future__ import annotations

import argparse
import re
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import nbformat

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "book")]

from wmrbook.headlines import HEADLINES, Headline, drawn  # noqa: E402

# A sentence with such a word speaks of more than one case, so it has to be varied.
STRONG = (
    r"\b(never|always|no|none|nowhere|each|every|all|any|only|at (most|least)|first|whatever)\b"
)


def main(places: list[str], draws: int, seed: int) -> int:
    """Print a line a headline; return how many fall."""
    rows = [row for row in HEADLINES if not places or row.where in places]
    if missing := set(places) - {row.where for row in rows}:
        raise SystemExit(f"no headline in {', '.join(sorted(missing))}")
    numbers = [HEADLINES.index(row) for row in rows]
    with ProcessPoolExecutor() as pool:
        ranges = pool.map(partial(spread, draws=draws, seed=seed), numbers)
        falls = sum(report(row, *taken) for row, taken in zip(rows, ranges, strict=True))
    print(f"{len(rows)} headlines, {draws} draws each: {falls} fall")
    return falls


def spread(number: int, draws: int, seed: int) -> tuple[float, float, str]:
    """Return the least and greatest value of a headline, and the first draw that it forbids."""
    row, values, broken = HEADLINES[number], [], ""
    for draw, value in drawn(row.value, row.vary, draws, seed):
        values.append(value)
        if not row.at_least <= value <= row.at_most:  # NaN too
            broken = broken or ", ".join(f"{name} {_short(it)}" for name, it in draw.items())
    return min(values), max(values), broken


def report(row: Headline, low: float, high: float, broken: str) -> bool:
    """Print what a headline's number takes; return whether its sentence falls."""
    lost = plain(row.says) not in text(row.where)
    verdict = "NOT THERE" if lost else f"FALLS at {broken}" if broken else "holds"
    limits = f"{row.at_least:.4g} to {row.at_most:.4g}".replace("-inf to", "at most")
    limits = re.sub("(.*) to inf", r"at least \1", limits)
    name = f"{row.where} {row.value.__name__}"
    print(f"{name:34} takes {low:.4g} to {high:.4g} {row.unit}, may {limits}: {verdict}")
    print(f"    over {', '.join(row.vary)}: {row.says}")
    return lost or bool(broken)


def text(where: str) -> str:
    """Return a page's words; a chapter's are its sentences and what its cells print."""
    if not re.fullmatch(r"\d\d", where):
        return plain((ROOT / where).read_text(encoding="utf-8"))
    (path,) = (ROOT / "notebooks").glob(f"{where}_*.ipynb")
    cells = nbformat.read(path, as_version=4).cells
    outputs = [out for cell in cells for out in cell.get("outputs", ())]
    printed = [out.get("text") or out.get("data", {}).get("text/markdown", "") for out in outputs]
    return plain("\n".join([cell.source for cell in cells] + printed))


def plain(words: str) -> str:
    """Return text without emphasis, and with single spaces."""
    return " ".join(re.sub(r"[*`]|(?<!\w)_|_(?!\w)", "", words).split())


def _short(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("places", nargs="*", help="two digits of a chapter, or a file's path")
    parser.add_argument("--draws", type=int, default=40)
    parser.add_argument("--seed", type=int, default=0)
    sys.exit(bool(main(**vars(parser.parse_args()))))
