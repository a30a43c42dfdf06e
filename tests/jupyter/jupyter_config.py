"""Read by each Jupyter application that a test starts."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "book" / "tools"))
import kernels

kernels.use_files()
