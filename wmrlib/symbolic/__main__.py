"""``python -m wmrlib.symbolic`` prints wmr_law.h; ``--c PATH`` prints it elsewhere."""

import argparse
import sys
from pathlib import Path

from wmrlib.symbolic import C_HEADER, c_header

parser = argparse.ArgumentParser(prog="python -m wmrlib.symbolic", description=__doc__)
parser.add_argument("--c", metavar="PATH", help="where the header goes; - is the screen")
target = parser.parse_args().c
if target == "-":
    sys.stdout.write(c_header())
else:
    Path(target or C_HEADER).write_bytes(c_header().encode())
