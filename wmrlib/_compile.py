"""How formulas are compiled: numba, cached on disk, called on one number or on whole arrays.

To tell whether a cached binary is still good, numba looks only at the file of the function itself.
A loop that calls a formula from another file would go on running the old formula after an edit.
The cache is therefore kept in a folder named after the text of *all* compiled modules, so that an
edit to any of them compiles anew.
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
    own = os.environ.get("NUMBA_CACHE_DIR")
    usual = (_PACKAGE / "__pycache__", Path.home() / ".cache" / "wmrlib")
    for parent in (Path(own),) if own else usual:
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
    """Return `function` compiled by numba on its first call for each set of argument types.

    Divisions follow IEEE 754 as in numpy (no ZeroDivisionError); a product and a sum may be rounded
    once rather than twice. ``NUMBA_DISABLE_JIT=1`` leaves plain Python.
    """
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, _CACHE_FOLDER or numba.config.CACHE_DIR
    try:
        return numba.njit(
            function, cache=cache, error_model="numpy", nogil=True, fastmath={"contract"}, **options
        )
    finally:
        numba.config.CACHE_DIR = before


def formula(function: Callable, *, cache: bool = True) -> Callable:
    """`compiled`, and inlined by every caller: a loop that calls a function is not vectorised."""
    return compiled(function, cache=cache, forceinline=True)


def elementwise(loop: Callable, outputs: int, *arguments, options: tuple = ()) -> tuple:
    """Broadcast `arguments` and run `loop(*flat_inputs, *options, *flat_outputs)`.

    Numbers in give numbers out. A shape that does not broadcast raises numpy's ValueError.
    """
    arrays = np.broadcast_arrays(*arguments)
    shape = arrays[0].shape
    # Copied: a broadcast view or a read-only array is another type to numba, and brings a warning.
    inputs = [np.array(array, dtype=np.float64, order="C").ravel() for array in arrays]
    results = [np.empty(arrays[0].size) for _ in range(outputs)]
    loop(*inputs, *options, *results)
    return tuple(result.reshape(shape) if shape else float(result[0]) for result in results)
