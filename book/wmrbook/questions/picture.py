"""A class's histograms as a picture, and as a page for the projector."""

from __future__ import annotations

import html
import math

from wmrbook.figures._drawing import panels
from wmrbook.figures.style import COLOURS, Picture
from wmrbook.questions.classes import Histogram

_COLUMNS = 5


def bars(histograms: list[Histogram], title: str) -> Picture:
    """Return one graph for each histogram; the right option is dark, and has hatches."""
    columns = min(_COLUMNS, len(histograms))
    rows = math.ceil(len(histograms) / columns)
    size = (6.5, 3.6) if columns == 1 else (2.4 * columns, 1.75 * rows)
    figure, grid = panels(rows, columns, *size, squeeze=False)
    highest = max(max(histogram.counts, default=0) for histogram in histograms)
    for axes, histogram in zip(grid.flat, histograms, strict=False):
        places, look = range(len(histogram.labels)), {"color": COLOURS["robot"], "ec": "none"}
        drawn = axes.bar(places, histogram.counts, **look)
        for bar, label in zip(drawn, histogram.labels, strict=True):
            if label == histogram.right:
                bar.set(facecolor=COLOURS["start"], hatch="//", edgecolor=COLOURS["ink"])
        turned = (
            {"rotation": 30, "ha": "right", "rotation_mode": "anchor"}
            if max(map(len, histogram.labels)) > 8
            else {}
        )
        axes.set_xticks(places, histogram.labels, **turned)
        axes.set_title(histogram.title)
        axes.set_ylim(0.0, 1.1 * max(highest, 1))
        axes.grid(visible=False, axis="x")
        axes.yaxis.get_major_locator().set_params(integer=True)
    for axes in grid.flat[len(histograms) :]:
        axes.remove()
    counts = "; ".join(_in_words(histogram) for histogram in histograms)
    return Picture(figure, f"Histogram of a class's answers, {title}. {counts}.")


def page(groups: dict[str, list[Histogram]]) -> str:
    """Return a page of all pictures, which opens from the disk."""
    parts = [
        f"<h2>{html.escape(title)}</h2>\n{bars(histograms, title)._repr_mimebundle_()['text/html']}"
        for title, histograms in groups.items()
    ]
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<title>A class's answers</title>\n<style>body { font-family: system-ui, sans-serif; "
        "margin: 1em; } img { width: min(100%, 95vw); height: auto; max-height: 90vh; }</style>\n"
        "</head>\n<body>\n<main>\n<h1>A class's answers</h1>\n"
        + "\n".join(parts)
        + "\n</main>\n</body>\n</html>\n"
    )


def _in_words(histogram: Histogram) -> str:
    counts = ", ".join(
        f"{label} {count}{' (right)' * (label == histogram.right)}"
        for label, count in zip(histogram.labels, histogram.counts, strict=True)
    )
    return f"{histogram.title}: {counts}"
