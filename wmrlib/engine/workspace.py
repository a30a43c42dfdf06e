"""The memory in which runs in continuous time are integrated side by side, and the sums in it.

It is one flat array with a lane for each run. A row is named by where it begins. With an array for
each row LLVM would have to check at run time that no two of them overlap, and gives up: a step then
takes three times as long.
"""

from __future__ import annotations

from typing import Any

from wmrlib._dop853 import FIFTH, STAGES, THIRD, WEIGHTS
from wmrlib.compilation import compiled, formula

LANES = 32  # runs side by side: their memory stays in the first-level cache
PROBE_STEP = 1e-6  # share of a step: so far behind its end omega is probed, for its rate

# A state is rho, alpha and theta, and the metres rolled in the step, signed as v is.
RHO, ALPHA, THETA, ROLLED = range(0, 4 * LANES, LANES)
# TIME has passed, and LEFT is to go: its sign turns if the run is over before. OMEGA is the row
# below a state's, among the slopes alone.
LEFT, TIME, PEAK, LENGTH, K_RHO, K_ALPHA, H, V_MAX, STEP, OMEGA_RATE, TRIALS = range(
    4 * LANES, 15 * LANES, LANES
)
SLOPES, STAGE = 15 * LANES, 5 * LANES  # of each stage, the rates of the state, and then omega
OMEGA = 4 * LANES
RUN_ROWS = 20  # rows that a run keeps between two steps: the above, and the slopes of stage 0
LAST, PROBE = 12, 13  # the stages at the end of a step, and at the probe behind it
NEW, PROBE_STATE, FINE, COARSE, DT, ACCEPTED, WORKSPACE_SIZE = (
    SLOPES + 14 * STAGE + rows * LANES for rows in (0, 4, 8, 12, 16, 20, 21)
)  # DT has as many rows as a state, each with the same steps
_ADDED_UP = (*STAGES, WEIGHTS, (*WEIGHTS, PROBE_STEP), FIFTH, THIRD)  # by `combine` at each stage


@formula
def add_four(total, work, i, a, b, c, d, w, x, y, z):
    """Add four slopes with their weights: sums without this function compile in 0.3 s more."""
    return total + w * work[a + i] + x * work[b + i] + y * work[c + i] + z * work[d + i]


def _written_out():
    """The text of `combine`, because LLVM vectorises no loop that holds another.

    A loop over the slopes outside one over the lanes keeps its sums in memory, and takes 100 ns a
    step of a run where this takes 20.
    """
    yield "def combine(work, stage):"
    for stage, weights in enumerate(_ADDED_UP, 1):
        slopes = [(SLOPES + j * STAGE, float(w)) for j, w in enumerate(weights) if w]
        slopes += [(SLOPES, 0.0)] * (-len(slopes) % 4)  # of stage 0, as others may still be NaN
        total = "0.0"
        for first in range(0, len(slopes), 4):
            columns = zip(*slopes[first : first + 4], strict=True)
            four = ", ".join(repr(number) for column in columns for number in column)
            total = f"add_four({total}, work, i, {four})"
        to = {PROBE: PROBE_STATE, PROBE + 1: FINE, PROBE + 2: COARSE}.get(stage, NEW)
        start = "work[i]" if stage <= PROBE else "0.0"
        yield f" if stage == {stage}:\n  for i in range({4 * LANES}):"
        yield f"   work[{to} + i] = {start} + work[{DT} + i] * {total}"


_made: dict[str, Any] = {"__name__": __name__, "add_four": add_four}
exec(compile("\n".join(_written_out()), __file__, "exec"), _made)
combine = compiled(_made["combine"])
"""Write the state at a stage, from its sum of slopes; or one of the two errors."""
