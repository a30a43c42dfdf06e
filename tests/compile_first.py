"""Compiles the loops that many tests and chapters need, in two processes, before the workers begin.

Otherwise each worker, and each kernel of a chapter, compiles the same loops at the same time: on a
machine that has compiled nothing this takes 100 s more.
"""

from __future__ import annotations

import subprocess
import sys

CASE = """
import numpy as np
import wmrlib as wmr
start, goal, gains, _ = wmr.paper.outdoor()
many = gains._replace(h=np.array([0.1, 0.2]))
"""
SIDE_BY_SIDE = """
for law in ("corrected", "printed"):
    wmr.sweep(start, goal, many, law=law)
for law in wmr.laws.POSE_LAWS:
    wmr.sweep(start, goal, many, law=law, method="arc")
"""
ONE_BY_ONE = """
wmr.simulate(start, goal, gains)
wmr.simulate(start, goal, gains, method="continuous")
circle = wmr.paper.circle, wmr.paper.CIRCLE_START, wmr.paper.CIRCLE_GAINS
wmr.track(*circle, method="continuous", duration=1.0)
wmr.sweep(start, goal, many, method="arc", trajectories=True)
wmr.sweep(start, goal, many, method="arc", receiver=wmr.Receiver(0.1))
wmr.sweep(start, goal, many, trajectories=True)
import wmrrobot as wr
wr.certificate(wr.Robot(), runs=1)
"""


def compile_all() -> None:
    """Run both; what goes wrong there will go wrong in a test, which says more."""
    commands = [[sys.executable, "-c", CASE + part] for part in (SIDE_BY_SIDE, ONE_BY_ONE)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    for process in [subprocess.Popen(command, **quiet) for command in commands]:
        process.wait()
