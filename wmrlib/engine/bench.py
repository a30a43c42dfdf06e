"""The bench that runs in continuous time sit on: its rows, and the sums of their slopes.

A bench is one flat array. Its rows are named by where they begin, so that LLVM sees that they don't
overlap, and computes four or eight runs with each instruction.
"""

from __future__ import annotations

from typing import Any

from wmrlib._dop853 import FIFTH, STAGES, THIRD, WEIGHTS
from wmrlib.compilation import compiled

LANES = 32  # runs side by side: a bench stays in the first-level cache
GLIMPSE = 1e-6  # share of a step behind its end at which omega is looked at too, for its rate

# A state is rho, alpha and theta, and the metres rolled in the step, signed as v is.
RHO, ALPHA, THETA, ROLLED = range(0, 4 * LANES, LANES)
# TIME has passed, and LEFT is to go: its sign turns if the run is over before. A sample is due at
# NEXT. OMEGA is the row below a state's, among the slopes alone.
LEFT, TIME, PEAK, LENGTH, K_RHO, K_ALPHA, H, V_MAX, STEP, SWING, TRIALS, NEXT = range(
    4 * LANES, 16 * LANES, LANES
)
SLOPES, STAGE = 16 * LANES, 5 * LANES  # of each stage, the rates of the state, and then omega
OMEGA = 4 * LANES
KEPT = 21  # rows: what is kept of a run between two steps, the slopes at its beginning too
LAST, BEYOND = 12, 13  # the stages at the end of a step, and a glimpse behind it
NEW, NEAR, FINE, COARSE, DT, TAKEN, ROOM = (
    SLOPES + 14 * STAGE + rows * LANES for rows in (0, 4, 8, 12, 16, 17, 18)
)
_TO = (*STAGES, WEIGHTS, (*WEIGHTS, GLIMPSE), FIFTH, THIRD)  # what each stage adds up


def _written_out():
    """The text of `combine`: LLVM vectorises no loop that holds another, and a loop over the slopes
    outside, which keeps its sums in memory, takes 100 ns a step of a run where this takes 20.
    """
    yield "def combine(bench, used, stage):"
    yield f" for first in range(0, 4 * {LANES}, {LANES}):"
    yield "  row = first & 127"  # so that LLVM knows that no index is negative
    for stage, weights in enumerate(_TO, 1):
        slopes = ((SLOPES + j * STAGE, float(w)) for j, w in enumerate(weights) if w)
        total = " + ".join(f"{weight!r} * bench[{at} + row + i]" for at, weight in slopes)
        to = {BEYOND: NEAR, BEYOND + 1: FINE, BEYOND + 2: COARSE}.get(stage, NEW)
        start = "bench[row + i] + " if stage <= BEYOND else ""
        yield f"  if stage == {stage}:\n   for i in range(used):"
        yield f"    bench[{to} + row + i] = {start}bench[{DT} + i] * ({total})"


_space: dict[str, Any] = {"__name__": __name__}
exec(compile("\n".join(_written_out()), __file__, "exec"), _space)
combine = compiled(_space["combine"])
"""Write the state at a stage, from its sum of slopes; or one of the two errors."""
