"""The drive and the filter in C, printed by wmrlib's printers.

``python -m wmrrobot`` prints the drive into ``wmr_drive.h``, `filter_formulas` into
``wmr_filter.h`` and `jacobians` into ``wmrrobot/jacobians.py``. `javascript_drive` is the drive for
a page of the book.
"""

from wmrrobot.printing.c_drive import C_DRIVE, c_drive  # noqa: F401
from wmrrobot.printing.c_filter import C_FILTER_HEADER, c_filter_header  # noqa: F401
from wmrrobot.printing.formulas import (  # noqa: F401
    filter_formulas,
    gyro,
    gyro_bias,
    jacobians,
    share,
    wheel_scale,
)
from wmrrobot.printing.javascript import javascript_drive  # noqa: F401
from wmrrobot.printing.python import PYTHON_MODULE, python_module  # noqa: F401

C_EXAMPLE = C_DRIVE.with_name("example.c")
"""A robot's main loop."""
C_PLANT = C_DRIVE.with_name("plant.h")
"""A simulated robot for it."""
