"""``python -m wmrlib.symbolic`` prints wmr_law.h, wmr_drive.h, wmr_filter.h and _jacobians.py.

``--c PATH`` prints wmr_law.h alone, elsewhere.
"""

import argparse
import sys
from pathlib import Path

from wmrlib.symbolic import (
    C_DRIVE,
    C_FILTER_HEADER,
    C_HEADER,
    PYTHON_MODULE,
    c_drive,
    c_filter_header,
    c_header,
    python_module,
)

parser = argparse.ArgumentParser(prog="python -m wmrlib.symbolic", description=__doc__)
parser.add_argument("--c", metavar="PATH", help="where wmr_law.h goes; - is the screen")
target = parser.parse_args().c
if target == "-":
    sys.stdout.write(c_header())
elif target:
    Path(target).write_bytes(c_header().encode())
else:
    C_HEADER.write_bytes(c_header().encode())
    C_DRIVE.write_bytes(c_drive().encode())
    C_FILTER_HEADER.write_bytes(c_filter_header().encode())
    PYTHON_MODULE.write_bytes(python_module().encode())
