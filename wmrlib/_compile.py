"""How formulas are compiled: numba, cached on disk, and called on one number or on whole arrays.

numba looks only at the file of a function when it decides whether a cached binary is still good. A kernel that calls a formula
from another file would therefore go on running the old formula after an edit. The cache here is kept in a folder named after the
text of *all* compiled modules, so that an edit anywhere among them compiles anew.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np

_PACKAGE = Path(__file__).parent
_SOURCES = sorted((*_PACKAGE.glob("*.py"), *_PACKAGE.glob("_loops/*.py")))


def _cache_folder() -> str:
    digest = hashlib.sha256(b"".join(source.read_bytes() for source in _SOURCES)).hexdigest()[:16]
    user = os.environ.get("NUMBA_CACHE_DIR")
    for parent in (
        (Path(user),) if user else (_PACKAGE / "__pycache__", Path.home() / ".cache" / "wmrlib")
    ):
        folder = parent / f"compiled-{digest}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                return str(folder)
        except OSError:  # installed where the reader may not write: try the next place
            continue
    return ""  # numba then chooses by itself


_CACHE_FOLDER = _cache_folder()


def compiled(function: Callable, *, cache: bool = True, **options) -> Callable:
    """Return `function` compiled by numba on its first call for each set of argument types, and unless told otherwise cached on disk.

    Divisions follow IEEE 754 as in numpy (no ZeroDivisionError); a product and a sum may be rounded once rather than twice.
    ``NUMBA_DISABLE_JIT=1`` leaves plain Python.
    """
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, _CACHE_FOLDER or numba.config.CACHE_DIR
    try:
        return numba.njit(
            function, cache=cache, error_model="numpy", nogil=True, fastmath={"contract"}, **options
        )
    finally:
        numba.config.CACHE_DIR = before


def formula(function: Callable, *, cache: bool = True) -> Callable:
    """`compiled`, and always copied to where it is called: a loop that still had to call it could not be vectorised."""
    return compiled(function, cache=cache, forceinline=True)


def elementwise(loop: Callable, outputs: int, *arguments, options: tuple = ()) -> tuple:
    """Broadcast `arguments`, run the compiled `loop(*flat_inputs, *options, *flat_outputs)`, give its outputs the common shape.

    Numbers in give numbers out. A shape that does not broadcast raises numpy's ValueError, which names the shapes.
    """
    arrays = np.broadcast_arrays(*arguments)
    shape = arrays[0].shape
    results = tuple(np.empty(arrays[0].size) for _ in range(outputs))
    # Copies: a view that broadcasting made, or an array that can't be written to, would be another type to numba, with a warning.
    loop(
        *(np.array(array, dtype=np.float64, order="C").ravel() for array in arrays),
        *options,
        *results,
    )
    return tuple(result.reshape(shape) if shape else float(result[0]) for result in results)
