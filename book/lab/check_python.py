"""Refuse a Python that the book does not run on, before anything is installed; README's commands
begin with it. The versions are those of requires-python in pyproject.toml.
"""

import re
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2] / "pyproject.toml"


def refusal(version, executable):
    """What to say of a Python; nothing if it fits."""
    project = PROJECT.read_text(encoding="utf-8")
    first, beyond = re.search(r'requires-python = ">=3\.(\d+),<3\.(\d+)"', project).groups()
    if (3, int(first)) <= version[:2] < (3, int(beyond)):
        return None
    last = int(beyond) - 1
    return (
        f"This book needs Python 3.{first} to 3.{last}, and this is {version[0]}.{version[1]} "
        f"({executable}).\nInstall one of those and name it in the command twice: "
        f"python3.{last} for python3, or on Windows py -3.{last} for py."
    )


if __name__ == "__main__":
    sys.exit(refusal(sys.version_info, sys.executable))
