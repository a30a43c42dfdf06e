"""What the process that forks the judges has done once: numba takes a second for its first call."""

import wmrlib

case = wmrlib.paper.outdoor()
for method in "arc", "continuous":
    run = wmrlib.simulate(case.start, case.goal, case.gains, method=method)
    wmrlib.lyapunov_rate(run.rho, run.alpha, run.theta, case.gains)
    starts = wmrlib.Pose([0.0, 1.0], 0.0, 0.0)
    wmrlib.sweep(starts, case.goal, case.gains, method=method, progress=False)
