"""What a receiver shows of a run: noisy, held and late.

Random numbers are counted, not drawn in turn: those of a fix follow from the seed, its run's number
and its sample's alone, whoever computes them.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib._compile import compiled, formula
from wmrlib._elementary import sincos

# The rows of a receiver: its fields, in samples, the memory as how fast it fades; its run's number;
# its last fix, as the error in standard deviations and the sample; and the sample it shows now.
SIGMA, FADING, PERIOD, DELAY, HEADING_DELAY, SIGHT, RUN, EAST, NORTH, FIX, NOW = range(11)
ROWS = NOW + 1
_WORD = 0xFFFFFFFF


@formula
def philox(counter, key):
    """Four random words of 32 bits: Philox 4x32-10 of Salmon et al. (2011)."""
    a, b, c, d = counter
    key_1, key_2 = key
    for _ in range(10):
        one, two = 0xD2511F53 * a, 0xCD9E8D57 * c  # too long for a sign, which is masked
        a, c = ((two >> 32) & _WORD) ^ b ^ key_1, ((one >> 32) & _WORD) ^ d ^ key_2
        b, d = two & _WORD, one & _WORD
        key_1, key_2 = (key_1 + 0x9E3779B9) & _WORD, (key_2 + 0xBB67AE85) & _WORD
    return a, b, c, d


@compiled
def normals(run, sample, stream, key):
    """Two standard normal numbers, by the rule of Box and Muller, out of 53 bits each."""
    a, b, c, d = philox((run & _WORD, run >> 32, sample, stream), key)
    size, turn = ((a << 21) + (b >> 11) + 0.5) * 2.0**-53, ((c << 21) + (d >> 11)) * 2.0**-53
    length, (sine, cosine) = math.sqrt(-2.0 * math.log(size)), sincos(2.0 * math.pi * turn)
    return length * cosine, length * sine


@formula
def show(block, place, goal, eyes, past, k, used, key):
    """Write the poses that are shown in sample k into the rows from `place` on.

    The goal is in the rows from `goal` on.
    `past` has an axis for x, y and heading, one for the last samples, in turns, and the runs'.
    """
    depth, due = past.shape[1], 0
    for i in range(used):
        for row in range(3):
            past[row, k % depth, i] = block[row, i]
        period = eyes[PERIOD, i]
        fix = np.floor(k / period) * period - eyes[DELAY, i]
        eyes[NOW, i] = fix if fix > 0.0 else 0.0
        due += (eyes[SIGMA, i] > 0.0) & (eyes[NOW, i] > eyes[FIX, i])
    for i in range(used if due else 0):
        fix, last = eyes[NOW, i], eyes[FIX, i]
        if eyes[SIGMA, i] > 0.0 and fix > last:
            age = (fix - last) * eyes[FADING, i] if last >= 0.0 else math.inf
            keep, share = math.exp(-age), math.sqrt(-math.expm1(-2.0 * age))
            east, north = normals(int(eyes[RUN, i]), int(fix), 0, key)
            eyes[EAST, i] = keep * eyes[EAST, i] + share * east
            eyes[NORTH, i] = keep * eyes[NORTH, i] + share * north
            eyes[FIX, i] = fix
    for i in range(used):
        fix, sigma = int(eyes[NOW, i]) % depth, eyes[SIGMA, i]
        looked = max(k - int(eyes[HEADING_DELAY, i]), 0) % depth
        x, y = past[0, fix, i] + sigma * eyes[EAST, i], past[1, fix, i] + sigma * eyes[NORTH, i]
        if eyes[SIGHT, i] > 0.0:
            sine, cosine = sincos(eyes[SIGHT, i] * normals(int(eyes[RUN, i]), k, 1, key)[0])
            goal_x, goal_y = block[goal, i], block[goal + 1, i]
            x, y = x - goal_x, y - goal_y
            x, y = goal_x + cosine * x - sine * y, goal_y + sine * x + cosine * y
        block[place, i], block[place + 1, i], block[place + 2, i] = x, y, past[2, looked, i]


def in_samples(receivers, task):
    """The rows before the first sample, and how many samples back any of them looks."""
    eyes, dt, samples = np.zeros((ROWS, receivers.shape[1])), task.dt, task.samples
    eyes[: len(receivers)], eyes[FIX], eyes[PERIOD] = receivers, -1.0, 1.0
    if not len(receivers):
        return eyes, 1
    with np.errstate(divide="ignore", over="ignore"):
        eyes[FADING] = dt / np.abs(eyes[FADING])  # -0.0 is 0 as well
    eyes[PERIOD:SIGHT] = np.rint(np.minimum(receivers[PERIOD:SIGHT], samples * dt) / dt)
    eyes[PERIOD] = np.maximum(eyes[PERIOD], 1.0)
    back = np.maximum(eyes[PERIOD] + eyes[DELAY], eyes[HEADING_DELAY])
    return eyes, min(int(back.max(initial=0.0)) + 1, samples)
