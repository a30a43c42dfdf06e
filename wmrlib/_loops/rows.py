"""The names of rows and codes that the compiled loops share."""

ARRIVED, TIMED_OUT, DIVERGED, COMPLETED = range(4)  # how a run ends
X, Y, HEADING, RHO, ALPHA, THETA, V, OMEGA, LYAPUNOV = range(9)  # the rows of a recorded run
