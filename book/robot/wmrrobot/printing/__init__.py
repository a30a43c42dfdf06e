"""What stands in C: the drive and the filter, by wmrlib's printers.

``python -m wmrrobot`` prints the drive into ``wmr_drive.h``, `C_FILTER` into ``wmr_filter.h`` and
`JACOBIANS` into ``wmrrobot/jacobians.py``.
"""

from wmrrobot.printing.c_drive import C_DRIVE, c_drive  # noqa: F401
from wmrrobot.printing.c_filter import C_FILTER_HEADER, c_filter_header  # noqa: F401
from wmrrobot.printing.formulas import (  # noqa: F401
    C_FILTER,
    JACOBIANS,
    gyro,
    gyro_bias,
    share,
    wheel_scale,
)
from wmrrobot.printing.python import PYTHON_MODULE, python_module  # noqa: F401

C_EXAMPLE = C_DRIVE.with_name("example.c")
"""A robot's main loop."""
