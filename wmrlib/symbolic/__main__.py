"""``python -m wmrlib.symbolic`` prints model.js and wmr_law.h; ``--c PATH`` only the header."""

import argparse
import sys

from wmrlib.symbolic import C_HEADER, MODEL_JS, c_header, javascript
from wmrlib.tracks.writing import overwrite

parser = argparse.ArgumentParser(prog="python -m wmrlib.symbolic", description=__doc__)
parser.add_argument("--c", metavar="PATH", help="where the header goes; - is the screen")
target = parser.parse_args().c
if target == "-":
    sys.stdout.write(c_header())
elif target:
    overwrite(target, c_header().encode())
else:
    overwrite(MODEL_JS, javascript().encode())
    overwrite(C_HEADER, c_header().encode())
