"""The compilation of formulas and loops by numba, and the folder of the compiled code.

numba's own cache looks only at the file of the function itself to tell whether a binary is still
good, so a loop would go on running an old formula out of another file. Here its files stand in a
folder named by a digest of the modules with compiled code; of a function of another package they
hold a digest of that package's modules too. numba runs what it finds there, so a folder that others
may write to is not used.
"""

from __future__ import annotations

import os
import stat
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryFile

import numba
from numba.core.caching import CompileResultCacheImpl, FunctionCache, InTreeCacheLocator
from numba.extending import overload, register_jitable

_PACKAGE = Path(__file__).parent
_SOURCES = sorted((*_PACKAGE.glob("*.py"), *_PACKAGE.glob("engine/*.py")))
# Divisions follow IEEE 754 as in numpy; a product and a sum may be rounded once rather than twice.
_ARITHMETIC = {"error_model": "numpy", "fastmath": {"contract"}}
_INLINED = _ARITHMETIC | {"forceinline": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def _text_digest(files: list[Path], more: str = "") -> str:
    return sha256(more.encode() + b"".join(map(Path.read_bytes, files))).hexdigest()[:16]


def _digest() -> str:
    return _text_digest(_SOURCES, f"{numba.__version__} {sys.implementation.cache_tag}")


def _folders() -> list[Path]:
    """The folders that may hold compiled code, the best one first."""
    own = os.environ.get("NUMBA_CACHE_DIR")
    given = [own] if own else [str(_PACKAGE / "__pycache__"), "~/.cache/wmrlib"]
    places = [os.path.expanduser(place) for place in given]
    # What still begins with a tilde is the home of a user that has none.
    return [Path(place, f"compiled-{_digest()}") for place in places if place[0] != "~"]


def _folder(folders: list[Path]) -> Path | None:
    """The first folder that can be written to; or the first that there is something in to read.

    It is one that nobody else can put anything into: numba runs what it finds there.
    """
    for folder in folders:
        with suppress(OSError):
            folder.mkdir(0o700, parents=True, exist_ok=True)  # another process may be first
            if _is_private(folder):
                with TemporaryFile(dir=folder) as trial:
                    trial.write(b"kept")
                return folder
    return next((folder for folder in folders if _has_something_to_read(folder)), None)


def _has_something_to_read(folder: Path) -> bool:
    with suppress(OSError):
        return _is_private(folder) and any(folder.iterdir())
    return False


def _is_private(folder: Path) -> bool:
    """Whether the folder and its files are the user's or root's, and nobody else's to write."""
    if os.name == "nt":  # where a user's folders are closed to others
        return True
    place = folder.parent.stat().st_mode
    if place & stat.S_IWOTH and not place & stat.S_ISVTX:  # anybody may put another in its place
        return False
    states = [folder.lstat()]
    if states[0].st_mode & 0o077:  # else nobody else gets to the files
        states += [file.lstat() for file in folder.iterdir()]
    return all(state.st_uid in (0, os.getuid()) and not state.st_mode & 0o022 for state in states)


class _Locator(InTreeCacheLocator):
    """The folder in which numba keeps the binaries of a function."""

    def get_cache_path(self) -> str:
        return str(FOLDER)

    def ensure_cache_path(self) -> None:
        """The folder is there, if only to be read: numba would refuse to cache."""

    def get_source_stamp(self) -> str:
        """The stamp that numba compares: a digest of the modules beside a user's own function.

        Functions of wmrlib need none, because an edit of wmrlib leads to another folder.
        """
        file = Path(self._py_file)
        return "" if file in _SOURCES else _text_digest(sorted(file.parent.glob("*.py")))


class _CacheFiles(CompileResultCacheImpl):
    _locator_classes = [_Locator]  # noqa: RUF012 (numba's name)


class _Cache(FunctionCache):
    """numba's cache, which a full or read-only disk does not stop."""

    _impl_class = _CacheFiles

    def save_overload(self, signature, data):
        with suppress(OSError):
            super().save_overload(signature, data)


_FOLDERS = _folders()
FOLDER = _folder(_FOLDERS)
if not FOLDER and not numba.config.DISABLE_JIT:
    places = " or ".join(str(folder.parent) for folder in _FOLDERS)
    text = f"compiled code can't be kept in {places}, so each process compiles anew: "
    text += "set NUMBA_CACHE_DIR to a folder of your own that nobody else may write to"
    warnings.warn(text, RuntimeWarning, stacklevel=2)


def compiled(function: Callable) -> Callable:
    """`function`, compiled by numba on its first call for each set of argument types.

    ``NUMBA_DISABLE_JIT=1`` leaves plain Python, to be stepped through.
    """
    made = numba.njit(nogil=True, **_ARITHMETIC)(function)
    if made is not function and FOLDER:
        made._cache = _Cache(function)
    return made


def formula(function: Callable) -> Callable:
    """`function` itself, which takes numbers, arrays and symbols; compiled loops inline it."""
    return register_jitable(**_INLINED)(function)


def chosen_by_type(function: Callable) -> Callable:
    """Let the decorated function choose a formula by the types of its arguments, in compiled loops.

    Called from Python, `function` itself makes the same choice from the arguments' values.
    """
    return overload(function, jit_options=_INLINED, strict=False)


def compiled_by_its_user(function: Callable) -> bool:
    """Whether a function has been compiled by numba already."""
    return isinstance(function, numba.core.registry.CPUDispatcher)


def compiled_for_now(function: Callable) -> Callable:
    """`compiled` without the cache on disk, for a function that is given functions of a user."""
    return numba.njit(nogil=True, **_ARITHMETIC)(plain_python(function))


def plain_python(function: Callable) -> Callable:
    """A compiled function as it was written."""
    return getattr(function, "py_func", function)
