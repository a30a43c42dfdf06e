"""Refuse a Python that the book does not run on, before anything is installed; README's commands
begin with it. The versions are those of requires-python in pyproject.toml.
"""

import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def refusal(version, executable):
    """What to say of a Python; nothing if it fits."""
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    first, beyond = re.search(r'requires-python = ">=3\.(\d+),<3\.(\d+)"', project).groups()
    if (3, int(first)) <= version[:2] < (3, int(beyond)):
        return None
    last = int(beyond) - 1
    return (
        f"This book needs Python 3.{first} to 3.{last}, and this is {version[0]}.{version[1]} "
        f"({executable}).\nInstall one of those and name it in the command twice: "
        f"python3.{last} for python3, or on Windows py -3.{last} for py."
    )


def unreadable(version, folder):
    """What to say of the book's folder; nothing if this Python can import from it.

    The environment names the folder in UTF-8. Up to 3.12 Python reads that in the locale's
    encoding, even in its UTF-8 mode, and then the environment's Python can't start at all.
    """
    import locale

    if version >= (3, 13) or str(folder).isascii() or locale.getencoding().upper() == "UTF-8":
        return None
    ways = "take Python 3.13 or later, or move the book to a folder of ASCII letters alone"
    if os.name != "nt":
        ways = f"run export LC_ALL=C.UTF-8 first, {ways}"
    return (
        f"Python {version[0]}.{version[1]} can't read the name of this folder ({folder}), since "
        f"the locale's encoding is {locale.getencoding()}: {ways}."
    )


if __name__ == "__main__":
    version = sys.version_info
    sys.exit(refusal(version, sys.executable) or unreadable(version, ROOT))
