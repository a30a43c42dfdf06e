"""The book's own package: figures of the chapters, audit of the paper, checks of the course."""

from importlib.util import find_spec

_missing = [name for name in ("filelock", "matplotlib", "sympy") if not find_spec(name)]
if _missing:
    raise ImportError(
        f'wmrbook needs {", ".join(_missing)}: pip install ".[book]" in the repository'
    )
