"""``python -m wmrlib.symbolic`` prints the C headers; ``--c PATH`` prints the law's elsewhere."""

import argparse
import sys
from pathlib import Path

from wmrlib.symbolic import C_DRIVE, C_HEADER, c_drive, c_header

parser = argparse.ArgumentParser(prog="python -m wmrlib.symbolic", description=__doc__)
parser.add_argument("--c", metavar="PATH", help="where the law's header goes; - is the screen")
target = parser.parse_args().c
if target == "-":
    sys.stdout.write(c_header())
else:
    Path(target or C_HEADER).write_bytes(c_header().encode())
    if not target:
        C_DRIVE.write_bytes(c_drive().encode())
