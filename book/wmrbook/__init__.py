"""The book's own package: figures of the chapters, audit of the paper, checks of the course.

The chapters import it before other packages, so that a reader without the book's is told so.
"""

from importlib.util import find_spec

_NEEDED = (
    "anywidget",
    "control",
    "geographiclib",
    "ipywidgets",
    "matplotlib",
    "scipy",
    "sympy",
)
_missing = [name for name in _NEEDED if not find_spec(name)]
if _missing:
    raise ImportError(
        f'wmrbook needs {", ".join(_missing)}: pip install ".[book]" in the repository'
    )
