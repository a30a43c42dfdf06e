"""``python -m wmrrobot`` prints the C headers of the drive and the filter, and jacobians.py.

``--c FOLDER`` puts all that a robot's C needs into a folder: wmr_law.h, wmr_drive.h, wmr_filter.h,
example.c and plant.h.
"""

import argparse
from pathlib import Path

from wmrlib.symbolic import C_HEADER, c_header
from wmrrobot import printing

parser = argparse.ArgumentParser(prog="python -m wmrrobot", description=__doc__)
parser.add_argument("--c", metavar="FOLDER", help="where the C files go")
target = parser.parse_args().c
texts = {
    printing.C_DRIVE: printing.c_drive(),
    printing.C_FILTER_HEADER: printing.c_filter_header(),
}
if target:
    texts[C_HEADER] = c_header()
    for path in printing.C_EXAMPLE, printing.C_PLANT:
        texts[path] = path.read_text("utf-8")
    folder = Path(target)
    folder.mkdir(parents=True, exist_ok=True)
    texts = {folder / path.name: text for path, text in texts.items()}
else:
    texts[printing.PYTHON_MODULE] = printing.python_module()
for path, text in texts.items():
    path.write_bytes(text.encode())
