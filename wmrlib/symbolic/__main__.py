"""``python -m wmrlib.symbolic`` prints the C headers and _jacobians.py.

``--c PATH`` prints wmr_law.h alone, elsewhere.
"""

import argparse
import sys
from pathlib import Path

from wmrlib import symbolic

parser = argparse.ArgumentParser(prog="python -m wmrlib.symbolic", description=__doc__)
parser.add_argument("--c", metavar="PATH", help="where wmr_law.h goes; - is the screen")
target = parser.parse_args().c
if target == "-":
    sys.stdout.write(symbolic.c_header())
elif target:
    Path(target).write_bytes(symbolic.c_header().encode())
else:
    for path, text in (
        (symbolic.C_HEADER, symbolic.c_header),
        (symbolic.C_FILTER_HEADER, symbolic.c_filter_header),
        (symbolic.C_DRIVE, symbolic.c_drive),
        (symbolic.PYTHON_MODULE, symbolic.python_module),
    ):
        path.write_bytes(text().encode())
