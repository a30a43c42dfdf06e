"""``python -m wmrlib.symbolic`` prints the C header of the law, wmr_law.h.

``--c PATH`` prints it elsewhere.
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
else:
    Path(target or symbolic.C_HEADER).write_bytes(symbolic.c_header().encode())
