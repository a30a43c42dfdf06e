"""What a receiver shows of a run: noisy, held and late."""

from __future__ import annotations

import math

import numpy as np

from wmrlib.compilation import compiled, formula
from wmrlib.elementary import sincos, wrap
from wmrlib.receiver import normals

# The rows of a receiver: its fields, in samples, the memory as how fast it fades, and what comes at
# random as how often; its run's number; the error in standard deviations, the last fix, that which
# is due, the place that is shown, the bias, the direction of the last jump, and an outage's end.
SIGMA, FADING, PERIOD, DELAY, HEADING_DELAY, SIGHT, BIAS, DROPS, OUTAGE, JUMP, JUMPS = range(11)
COMPASS, RUN, EAST, NORTH, FIX, NOW, X, Y = range(11, 19)
OFF_EAST, OFF_NORTH, JUMP_EAST, JUMP_NORTH, END = range(19, 24)
ROWS = END + 1


@compiled
def happens(run, sample, stream, key, often):
    """Where to, as a unit vector, if what comes so often comes now; else 0, 0."""
    east, north = normals(run, sample, stream, key)
    size = math.hypot(east, north)  # the chance and the direction are independent
    if math.exp(-0.5 * size * size) < -math.expm1(-often):
        return east / size, north / size
    return 0.0, 0.0


@compiled
def switch_on(eyes, key):
    for i in range(eyes.shape[1]):
        east, north = normals(int(eyes[RUN, i]), 0, 2, key)
        eyes[OFF_EAST, i], eyes[OFF_NORTH, i] = eyes[BIAS, i] * east, eyes[BIAS, i] * north
        eyes[COMPASS, i] *= normals(int(eyes[RUN, i]), 0, 3, key)[0]


@compiled
def take(eyes, i, past, key):
    """Take the fix that is due, unless an outage hides it."""
    fix, last, run = eyes[NOW, i], eyes[FIX, i], int(eyes[RUN, i])
    if last >= 0.0 and eyes[DROPS, i] > 0.0:
        often = eyes[PERIOD, i] * eyes[DROPS, i]
        if fix >= eyes[END, i] and happens(run, int(fix), 4, key, often) != (0.0, 0.0):
            eyes[END, i] = fix + max(eyes[OUTAGE, i], 1.0)
        if fix < eyes[END, i]:
            return
    if last >= 0.0 and eyes[JUMPS, i] > 0.0:
        jump = happens(run, int(fix), 5, key, (fix - last) * eyes[JUMPS, i])
        if jump != (0.0, 0.0):
            eyes[JUMP_EAST, i], eyes[JUMP_NORTH, i] = jump
    if eyes[SIGMA, i] > 0.0:
        age = (fix - last) * eyes[FADING, i] if last >= 0.0 else math.inf
        keep, share = math.exp(-age), math.sqrt(-math.expm1(-2.0 * age))
        east, north = normals(run, int(fix), 0, key)
        eyes[EAST, i] = keep * eyes[EAST, i] + share * east
        eyes[NORTH, i] = keep * eyes[NORTH, i] + share * north
    x, y = past[0, int(fix) % past.shape[1], i], past[1, int(fix) % past.shape[1], i]
    sigma, jump = eyes[SIGMA, i], eyes[JUMP, i]
    eyes[X, i] = x + sigma * eyes[EAST, i] + (eyes[OFF_EAST, i] + jump * eyes[JUMP_EAST, i])
    eyes[Y, i] = y + sigma * eyes[NORTH, i] + (eyes[OFF_NORTH, i] + jump * eyes[JUMP_NORTH, i])
    eyes[FIX, i] = fix


@formula
def show(block, place, goal, eyes, past, k, used, key):
    """Write the poses that are shown in sample k into the rows from `place` on.

    The goal is in the rows from `goal` on.
    `past` has an axis for x, y and heading, one for the last samples, in turns, and the runs'.
    """
    depth = past.shape[1]
    for i in range(used):
        for row in range(3):
            past[row, k % depth, i] = block[row, i]
        period = eyes[PERIOD, i]
        fix = np.floor(k / period) * period - eyes[DELAY, i]
        eyes[NOW, i] = fix if fix > 0.0 else 0.0
    for i in range(used):
        if eyes[NOW, i] > eyes[FIX, i]:
            take(eyes, i, past, key)
        looked = max(k - int(eyes[HEADING_DELAY, i]), 0) % depth
        x, y, heading = eyes[X, i], eyes[Y, i], past[2, looked, i]
        if eyes[SIGHT, i] > 0.0:
            sine, cosine = sincos(eyes[SIGHT, i] * normals(int(eyes[RUN, i]), k, 1, key)[0])
            goal_x, goal_y = block[goal, i], block[goal + 1, i]
            x, y = x - goal_x, y - goal_y
            x, y = goal_x + cosine * x - sine * y, goal_y + sine * x + cosine * y
        if eyes[COMPASS, i] != 0.0:
            heading = wrap(heading + eyes[COMPASS, i])
        block[place, i], block[place + 1, i], block[place + 2, i] = x, y, heading


def in_samples(receivers, task):
    """The rows before the first sample, and how many samples back any of them looks."""
    eyes, dt, samples = np.zeros((ROWS, receivers.shape[1])), task.dt, task.samples
    eyes[: len(receivers)], eyes[FIX], eyes[PERIOD] = receivers, -1.0, 1.0
    if not len(receivers):
        return eyes, 1
    with np.errstate(divide="ignore", over="ignore"):
        eyes[FADING] = dt / np.abs(eyes[FADING])  # -0.0 is 0 as well
    for row in (DROPS, JUMPS):
        eyes[row] = np.where(receivers[row] > 0.0, dt / np.maximum(receivers[row], dt * 1e-9), 0.0)
    times = [PERIOD, DELAY, HEADING_DELAY, OUTAGE]
    eyes[times] = np.rint(np.minimum(receivers[times], samples * dt) / dt)
    eyes[PERIOD] = np.maximum(eyes[PERIOD], 1.0)
    switch_on(eyes, task.key)
    back = np.maximum(eyes[PERIOD] + eyes[DELAY], eyes[HEADING_DELAY])
    return eyes, min(int(back.max(initial=0.0)) + 1, samples)
