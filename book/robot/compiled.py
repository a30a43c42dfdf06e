"""The drive as C, compiled here: what `wmrrobot.Drive` does, by ``wmr_drive.h``."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path
from typing import get_args, get_type_hints

import wmrlib as wmr
import wmrrobot as wr
from wmrlib import symbolic
from wmrrobot import monitor, printing
from wmrrobot.drive import REASONS
from wmrrobot.odometry import PAST, Place

_CALL = """#include "wmr_drive.h"
void step(wmr_memory *m, const wmr_seen *seen, const wmr_plan *plan, WMR_REAL *out) {
  const wmr_wheels wheels = wmr_drive(m, seen, plan);
  out[0] = wheels.left, out[1] = wheels.right;
}
"""
INCLUDES = [f"-I{header.parent}" for header in (symbolic.C_HEADER, printing.C_DRIVE)]
REALS = {"double": ctypes.c_double, "float": ctypes.c_float}


def _structure(kind, real):
    """A class of Python as the structure that the header has for it."""
    plain = {float: real, int: ctypes.c_int}
    fields = []
    for name, hint in get_type_hints(kind).items():
        (one,) = get_args(hint) or (hint,)
        field = plain.get(one) or _structure(one, real)
        fields.append((name, field if one is hint else field * PAST))
    return type(kind.__name__, (ctypes.Structure,), {"_fields_": fields})


@cache
def _library(real: str, law: str) -> tuple:
    """The compiled function and its structures; the folder goes as soon as it is loaded."""
    compiler, number = shutil.which("cc") or shutil.which("gcc"), REALS[real]
    if not compiler:
        raise RuntimeError("this needs a C compiler (Debian: apt install gcc libc6-dev)")
    kinds = {
        kind: _structure(kind, number)
        for kind in (monitor.Memory, wr.Seen, Place, wmr.Wheels, wmr.LastTurn, wr.Rules)
    }
    fields = [(name, number) for name in wmr.Gains._fields]
    gains = type("Gains", (ctypes.Structure,), {"_fields_": fields})
    fields = [("goal", kinds[Place]), ("gains", gains), ("motors", kinds[wmr.Wheels])]
    fields += [("end", kinds[wmr.LastTurn]), ("rules", kinds[wr.Rules])]
    plan = type("Plan", (ctypes.Structure,), {"_fields_": fields})
    options = ["-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fPIC", f"-DWMR_REAL={real}"]
    options += [f"-DWMR_DRIVE_LAW=wmr_{law}", *INCLUDES]
    with tempfile.TemporaryDirectory() as folder:
        source, library = Path(folder, "step.c"), Path(folder, "step.so")
        source.write_text(_CALL, encoding="utf-8")
        subprocess.run([compiler, *options, source, "-o", library, "-lm"], check=True)
        return ctypes.CDLL(str(library)).step, kinds, plan


class CDrive(wr.Drive):
    """A `Drive` whose steps are the header's."""

    def __init__(self, *given, real: str = "double", **named) -> None:
        super().__init__(*given, **named)
        law = "law" if self.law == "corrected" else f"law_{self.law}"
        self._step, kinds, plan = _library(real, law)
        self._readings, self._memory = kinds[wr.Seen], kinds[monitor.Memory]()
        self._out = (REALS[real] * 2)()
        whole = {name: int(getattr(self.rules, name)) for name in ("settle", "least")}
        rules = self.rules._asdict() | whole
        parts = self.goal, self.gains, self.wheels, self.end, rules.values()
        self._plan = plan(*map(tuple, parts))

    def reset(self) -> None:
        super().reset()
        if hasattr(self, "_kept"):
            self._memory = type(self._memory)()

    @property
    def state(self) -> str:
        return monitor.STATES[self._memory.state]

    @property
    def reason(self) -> str:
        return REASONS[self._memory.reason]

    def step(self, seen: wr.Seen) -> tuple[float, float]:
        given = self._memory, self._readings(*seen), self._plan
        self._step(*map(ctypes.byref, given), self._out)
        return self._out[0], self._out[1]
