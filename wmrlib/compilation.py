"""How formulas and loops are compiled by numba, and where it keeps what it made.

numba's own cache looks only at the file of the function itself to tell whether a binary is still
good, so a loop would go on running an old formula out of another file. Here its files stand in a
folder named by a digest of all modules.
"""

from __future__ import annotations

import os
import sys
import time
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
_MONTH = 30 * 24 * 3600.0  # s
_SOURCES = sorted((*_PACKAGE.glob("*.py"), *_PACKAGE.glob("engine/*.py")))
# Divisions follow IEEE 754 as in numpy; a product and a sum may be rounded once rather than twice.
_ARITHMETIC = {"error_model": "numpy", "fastmath": {"contract"}}


def _digest() -> str:
    compiler = f"{numba.__version__} {sys.implementation.cache_tag}".encode()
    return sha256(compiler + b"".join(map(Path.read_bytes, _SOURCES))).hexdigest()[:16]


def _folders() -> list[Path]:
    """Where compiled code may be kept, the best place first."""
    own = os.environ.get("NUMBA_CACHE_DIR")
    given = [own] if own else [str(_PACKAGE / "__pycache__"), "~/.cache/wmrlib"]
    places = [os.path.expanduser(place) for place in given]
    # What still begins with a tilde is the home of a user that has none.
    return [Path(place, f"compiled-{_digest()}") for place in places if place[0] != "~"]


def _folder(folders: list[Path]) -> Path | None:
    """The first folder that can be written to; or the first that there is something in to read."""
    for folder in folders:
        with suppress(OSError):
            if not folder.exists():
                _forget_old(folder.parent)
                folder.mkdir(parents=True, exist_ok=True)  # another process may be first
            with TemporaryFile(dir=folder) as trial:
                trial.write(b"kept")
            return folder
    return next((folder for folder in folders if folder.is_dir() and any(folder.iterdir())), None)


def _forget_old(place: Path) -> None:
    """Remove what other versions compiled, where nothing was added for a month."""
    for folder in place.glob("compiled-" + 16 * "[0-9a-f]"):
        with suppress(OSError):  # it holds something else, or another process forgets it too
            if folder.stat().st_mtime < time.time() - _MONTH and not folder.is_symlink():
                for file in (*folder.glob("*.nbi"), *folder.glob("*.nbc")):
                    file.unlink()
                folder.rmdir()


class _Locator(InTreeCacheLocator):
    """Says where numba keeps the binaries of a function."""

    def get_cache_path(self) -> str:
        return str(FOLDER)

    def ensure_cache_path(self) -> None:
        """The folder is there, if only to be read: numba would refuse to cache."""

    def get_source_stamp(self) -> str:
        return ""  # an edit leads to another folder


class _Kept(CompileResultCacheImpl):
    _locator_classes = [_Locator]  # noqa: RUF012 (numba's name)


class _Cache(FunctionCache):
    """What can't be read is compiled anew, and what can't be kept is done without."""

    _impl_class = _Kept

    def load_overload(self, signature, target_context):
        try:
            return super().load_overload(signature, target_context)
        except Exception:  # a damaged file raises any, and would when something is added to it
            with suppress(OSError):
                self.flush()
        return None

    def save_overload(self, signature, data):
        with suppress(OSError):
            super().save_overload(signature, data)


_FOLDERS = _folders()
FOLDER = _folder(_FOLDERS)
if not FOLDER and not numba.config.DISABLE_JIT:
    places = " or ".join(str(folder.parent) for folder in _FOLDERS)
    text = f"compiled code can't be kept in {places}, so each process compiles anew: "
    warnings.warn(text + "set NUMBA_CACHE_DIR to a folder for it", RuntimeWarning, stacklevel=2)


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
    return register_jitable(forceinline=True, **_ARITHMETIC)(function)


def elementary(function: Callable) -> Callable:
    """`function` of one kind of numbers in compiled loops, where the caller has others for it."""
    return overload(function, jit_options={"forceinline": True, **_ARITHMETIC}, strict=False)
