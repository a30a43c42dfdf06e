"""The compilation of formulas and loops by numba, and the folder of the compiled code.

numba's own cache looks only at the file of the function itself to tell whether a binary is still
good, so a loop would go on running an old formula out of another file. Here its files stand in a
folder named by a digest of the modules with compiled code; of a function of another package they
hold a digest of that package's modules too. numba runs the files that it finds there, so a folder
is used only if it belongs to the user or to root and nobody else can put anything into it.
"""

from __future__ import annotations

import os
import stat
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryFile

import numba
import numpy as np
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
    """The folders that may hold compiled code, the best one first, without links on the way."""
    own = os.environ.get("NUMBA_CACHE_DIR")
    given = [own] if own else [str(_PACKAGE / "__pycache__"), "~/.cache/wmrlib"]
    places = [os.path.expanduser(place) for place in given]
    # What still begins with a tilde is the home of a user that has none.
    return [
        Path(os.path.realpath(place), f"compiled-{_digest()}")
        for place in places
        if place[0] != "~"
    ]


def _folder(folders: list[Path]) -> Path | None:
    """The first private folder that can be written to, or else the first with files to read."""
    for folder in folders:
        with suppress(OSError):
            _make(folder)
            if not _danger(folder):
                with TemporaryFile(dir=folder) as trial:
                    trial.write(b"kept")
                return folder
    return next((folder for folder in folders if _has_something_to_read(folder)), None)


def _make(folder: Path) -> None:
    """Make the folder, closed to others, and its parents, whatever the umask leaves to others."""
    for parent in reversed(folder.parents):
        parent.mkdir(0o755, exist_ok=True)  # another process may be first
    folder.mkdir(0o700, exist_ok=True)


def _has_something_to_read(folder: Path) -> bool:
    with suppress(OSError):
        return any(folder.iterdir()) and not _danger(folder)
    return False


def _danger(folder: Path) -> str:
    """Why code in this folder may come from somebody else than the user or root, or "".

    On Windows it never is: profiles, which hold a user's Python and home, are closed to others
    there, and the modes and owners that are looked at here mean nothing.
    """
    if os.name == "nt":
        return ""
    state = folder.lstat()
    if stat.S_ISLNK(state.st_mode):
        return f"{folder} is a link"
    closed = not state.st_mode & 0o077  # nobody else gets to its files, whatever their modes
    for path in (folder, *folder.iterdir()):
        with suppress(FileNotFoundError):  # another process puts its files in place by renaming
            state = path.lstat()
            if state.st_uid not in (0, os.geteuid()):
                return f"{path} belongs to user {state.st_uid}"
            if _others_write(state) and (path == folder or not closed):
                return f"others may write to {path}"
    for parent in folder.parents:  # a user who may write to one can put another folder in place
        state = parent.stat()
        if state.st_uid not in (0, os.geteuid(), _UNMAPPED):
            return f"{parent} belongs to user {state.st_uid}"
        if _others_write(state) and not state.st_mode & stat.S_ISVTX:
            return f"others may write to {parent}"
    return ""


_UNMAPPED = 65534  # the owner of the host's folders, such as /home, inside some containers


def _others_write(state: os.stat_result) -> bool:
    if state.st_mode & stat.S_IWOTH:
        return True
    return bool(state.st_mode & stat.S_IWGRP) and not _has_nobody_else(state.st_gid)


def _has_nobody_else(group: int) -> bool:
    """Whether a group is the user's own, as with the umask 002 of many systems."""
    import grp
    import pwd

    try:
        user, entry = pwd.getpwuid(os.geteuid()).pw_name, grp.getgrgid(group)
    except KeyError:
        return False
    members = {account.pw_name for account in pwd.getpwall() if account.pw_gid == group}
    # The list of accounts may lack those of a network, whose own groups are named as they are.
    members |= {user} & {entry.gr_name}
    return members.union(entry.gr_mem) == {user}


def _why_not(folder: Path) -> str:
    try:
        return _danger(folder) or f"{folder} can't be written to"
    except OSError as error:
        return f"{folder.parent}: {error.strerror}"


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
    reasons = "; ".join(map(_why_not, _FOLDERS)) or "there is no home folder"
    text = f"compiled code is not kept, so each process compiles anew ({reasons}): "
    text += "set NUMBA_CACHE_DIR to a folder of your own, where nobody else may write to it or "
    text += "above it"
    warnings.warn(text, RuntimeWarning, stacklevel=2)


def compiled(function: Callable) -> Callable:
    """`function`, compiled by numba on its first call for each set of argument types.

    ``NUMBA_DISABLE_JIT=1`` leaves plain Python, to be stepped through, in which numpy is as silent
    about infinities and NaN as compiled code is.
    """
    made = numba.njit(nogil=True, **_ARITHMETIC)(function)
    if made is function:
        return _silent(function)
    if FOLDER:
        made._cache = _Cache(function)
    return made


def _silent(function: Callable) -> Callable:
    @wraps(function)
    def silent(*arguments):
        with np.errstate(all="ignore"):
            return function(*arguments)

    silent.py_func = function  # type: ignore[attr-defined]
    return silent


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
