"""What a receiver shows of a run: noisy, held and late.

Random numbers are counted, not drawn in turn: those of a fix follow from the seed, its run's number
and its sample's alone, whoever computes them.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib._compile import compiled, formula
from wmrlib._loops import rows
from wmrlib._vecmath import sincos

# The rows of a receiver: its fields, in samples, the memory as how fast it fades; the number of its
# run; and its last fix, as the error in standard deviations and the sample.
SIGMA, FADING, PERIOD, DELAY, HEADING_DELAY, RUN, EAST, NORTH, FIX = range(9)
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
def normals(run, sample, key):
    """Two standard normal numbers, by the rule of Box and Muller, out of 53 bits each."""
    a, b, c, d = philox((run & _WORD, run >> 32, sample, 0), key)
    size, turn = ((a << 21) + (b >> 11) + 0.5) * 2.0**-53, ((c << 21) + (d >> 11)) * 2.0**-53
    length, (sine, cosine) = math.sqrt(-2.0 * math.log(size)), sincos(2.0 * math.pi * turn)
    return length * cosine, length * sine


@compiled
def shown(record, k, receiver, key):
    """The pose that is shown in sample k of a run."""
    sigma, fading, period, delay, heading_delay, run, east, north, last = receiver
    fix = max(k - k % int(period) - int(delay), 0)
    if sigma > 0.0 and fix > last:
        age = (fix - last) * fading if last >= 0.0 else math.inf
        keep, share = math.exp(-age), math.sqrt(-math.expm1(-2.0 * age))
        one, other = normals(int(run), fix, key)
        east, north = keep * east + share * one, keep * north + share * other
        receiver[EAST], receiver[NORTH], receiver[FIX] = east, north, fix
    x, y = record[fix, rows.X] + sigma * east, record[fix, rows.Y] + sigma * north
    return x, y, record[max(k - int(heading_delay), 0), rows.HEADING]


def in_samples(receivers, dt, samples):
    """The rows before the first sample, and which receivers show anything but the truth."""
    found = np.zeros((FIX + 1, receivers.shape[1]))
    found[: len(receivers)], found[FIX] = receivers, -1.0
    with np.errstate(divide="ignore", over="ignore"):
        found[FADING] = dt / np.abs(found[FADING])  # -0.0 is 0 as well
    found[PERIOD:RUN] = np.rint(np.minimum(found[PERIOD:RUN], samples * dt) / dt)
    found[PERIOD] = np.maximum(found[PERIOD], 1.0)
    return found, (found[SIGMA] > 0.0) | (found[PERIOD] > 1.0) | found[DELAY:RUN].any(axis=0)
