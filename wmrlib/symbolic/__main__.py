"""``python -m wmrlib.symbolic`` prints model.js and wmr_law.h; ``--c PATH`` only the header."""

import argparse
import sys
from pathlib import Path

from wmrlib.symbolic import C_HEADER, MODEL_JS, c_header, javascript

parser = argparse.ArgumentParser(prog="python -m wmrlib.symbolic", description=__doc__)
parser.add_argument("--c", metavar="PATH", help="where the header goes; - is the screen")
target = parser.parse_args().c
if target == "-":
    sys.stdout.write(c_header())
elif target:
    Path(target).write_bytes(c_header().encode())
else:
    MODEL_JS.write_bytes(javascript().encode())
    C_HEADER.write_bytes(c_header().encode())
