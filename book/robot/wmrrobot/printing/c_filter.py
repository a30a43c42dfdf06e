"""The filter of `estimation` as a C header: the printed formulas, and the matrices round them."""

from wmrlib.symbolic import c_functions, filled
from wmrrobot.printing.c_drive import C_DRIVE
from wmrrobot.printing.formulas import filter_formulas

C_FILTER_HEADER = C_DRIVE.with_name("wmr_filter.h")


def c_filter_header() -> str:
    """The text of ``wmr_filter.h``: its frame with the printed functions in their places."""
    frame = C_FILTER_HEADER.with_name("filter_frame.h")
    return filled(frame, {"FILTER": c_functions(filter_formulas())})
