"""How formulas are compiled: numba, kept on disk, called on one number or on whole arrays.

numba's own cache looks only at the file of the function itself to tell whether a binary is still
good, so a loop would go on running an old formula out of another file; and where it can't write it
raises an error. Here binaries are in a folder named after the text of *all* compiled modules, each
with a checksum and named after what it was compiled for.
"""

from __future__ import annotations

import os
import pickle
import sys
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from uuid import uuid4

import numba
import numpy as np
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

_PACKAGE = Path(__file__).parent
_MONTH = 30 * 24 * 3600.0  # s
_DIGEST = 16 * "[0-9a-f]"  # how the names of folders and files end; twice for an unfinished file
_SOURCES = sorted((*_PACKAGE.glob("*.py"), *_PACKAGE.glob("_loops/*.py")))


def _folders() -> list[Path]:
    """Where binaries are looked for, and kept in the first that can be written to."""
    compiler = f"{numba.__version__} {sys.implementation.cache_tag}".encode()
    digest = sha256(compiler + b"".join(source.read_bytes() for source in _SOURCES)).hexdigest()
    own = os.environ.get("NUMBA_CACHE_DIR")
    given = [own] if own else [str(_PACKAGE / "__pycache__"), "~/.cache/wmrlib"]
    places = [os.path.expanduser(place) for place in given]
    # What still begins with a tilde is the home of a user that has none.
    return [Path(place, f"compiled-{digest[:16]}") for place in places if place[0] != "~"]


_FOLDERS = _folders()


def _identity(value):
    """What tells a function from others of its name: the numbers and functions it closes over."""
    function = getattr(value, "py_func", value)
    if not hasattr(function, "__code__"):
        return value
    cells = [_identity(cell.cell_contents) for cell in function.__closure__ or ()]
    return function.__module__, function.__qualname__, cells


class _Cache(NullCache):
    """The binaries of a function. One that is not there, or damaged, is compiled anew."""

    def __init__(self, function: Callable) -> None:
        self.function = function

    def files(self, signature, codegen) -> list[Path]:
        name = self.function.__name__
        key = repr((_identity(self.function), signature, codegen.magic_tuple()))
        return [folder / f"{name}-{sha256(key.encode()).hexdigest()[:16]}" for folder in _FOLDERS]

    def load_overload(self, signature, target_context):
        target_context.refresh()
        for file in self.files(signature, target_context.codegen()):
            with suppress(Exception):
                content = file.read_bytes()
                if content[:32] == sha256(content[32:]).digest():
                    return CompileResult._rebuild(target_context, *pickle.loads(content[32:]))
        return None

    def save_overload(self, signature, data):
        binary = dumps(data._reduce())
        content = sha256(binary).digest() + binary
        if not any(_kept(file, content) for file in self.files(signature, data.codegen)):
            _warn()


def _kept(file: Path, content: bytes) -> bool:
    part = file.with_name(uuid4().hex)  # other processes see the whole file or none
    with suppress(OSError):
        if not file.parent.exists():
            _forget_old(file.parent.parent)
            file.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(content)
        part.replace(file)
    with suppress(OSError):  # what did not become the file
        part.unlink()
    return os.path.exists(file)  # Windows replaces no file that another process is reading


def _forget_old(place: Path) -> None:
    """Remove what other versions compiled, where nothing was added for a month."""
    for folder in place.glob(f"compiled-{_DIGEST}"):
        with suppress(OSError):  # it holds something else, or another process forgets it too
            if not folder.is_symlink() and folder.stat().st_mtime < time.time() - _MONTH:
                for file in (*folder.glob(f"*-{_DIGEST}"), *folder.glob(2 * _DIGEST)):
                    file.unlink()
                folder.rmdir()


@lru_cache
def _warn() -> None:
    places = " or ".join(str(folder.parent) for folder in _FOLDERS)
    text = f"compiled code can't be kept in {places}, so each process compiles anew: "
    warnings.warn(text + "set NUMBA_CACHE_DIR to a folder for it", RuntimeWarning, stacklevel=2)


def compiled(function: Callable, *, cache: bool = True, **options) -> Callable:
    """Return `function` compiled by numba on its first call for each set of argument types.

    Divisions follow IEEE 754 as in numpy (no ZeroDivisionError); a product and a sum may be rounded
    once rather than twice. ``NUMBA_DISABLE_JIT=1`` leaves plain Python. If it is kept in the
    `cache`, it may close over plain numbers and compiled functions only.
    """
    if function.__closure__ and not numba.config.DISABLE_JIT:
        # Binaries name what they call, and numba tells closures of one name apart by a counter that
        # begins anew in each process.
        own = sha256(repr(_identity(function)).encode()).hexdigest()[:16]
        function.__qualname__ += f"_{own}"
    made = numba.njit(error_model="numpy", nogil=True, fastmath={"contract"}, **options)(function)
    if made is not function:
        # numba would compile it anew for each constant that a caller passes.
        one, plain = made.get_call_template, numba.types.unliteral
        made.get_call_template = lambda types, named: one(tuple(map(plain, types)), named)
        made._cache = _Cache(function) if cache else made._cache
    return made


def formula(function: Callable, *, cache: bool = True) -> Callable:
    """`compiled`, and inlined by every caller: a loop that calls a function is not vectorised."""
    return compiled(function, cache=cache, forceinline=True)


@lru_cache
def loop_over(one: Callable) -> Callable:
    """The loop that calls a compiled function for each row of its columns."""

    def loop(results, options, *columns):
        for i, row in enumerate(zip(*columns)):  # noqa: B905 (numba's has no `strict`)
            results[i] = one(*row, *options)

    return compiled(loop)


def elementwise(one: Callable, outputs: int, *arguments, options: tuple = ()) -> tuple:
    """Broadcast `arguments` and call `one(*numbers, *options)` for each entry.

    Numbers in give numbers out. A shape that does not broadcast raises numpy's ValueError.
    """
    arrays = np.broadcast_arrays(*arguments)
    shape = arrays[0].shape
    # Copied: a broadcast view or a read-only array is another type to numba, and brings a warning.
    columns = [np.array(array, dtype=np.float64, order="C").ravel() for array in arrays]
    results = np.empty((arrays[0].size, outputs))
    loop_over(one)(results, options, *columns)
    return tuple(each.reshape(shape) if shape else float(each[0]) for each in results.T.copy())
