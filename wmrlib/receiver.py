"""What a positioning receiver does to the positions that a controller steers by.

Its random numbers are counted, not drawn in turn: those of a fix follow from the seed, its run's
number and its sample's alone, whoever computes them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from wmrlib.checks import Real, checked
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import sincos

_WORD = 0xFFFFFFFF


@checked("at_least_0")
class Receiver(NamedTuple):
    """A receiver with its compass: it errs, shows fixes one at a time, and late; or many of them.

    The error is a Gauss-Markov process on each axis, in its stationary state from the first fix on:
    tau seconds later it keeps the share c = exp(-tau/memory), and sqrt(1 - c^2) sigma is new.
    Other times are rounded to whole samples. The first sample's fix is shown until another is.

    Parameters
    ----------
    sigma : float or array, m. Standard deviation of the error, to the east and to the north.
    memory : float or array, s. Correlation time of the error; with 0 that of each fix is new.
    period : float or array, s. A fix is shown for so long, until the next; 0: for one sample.
    delay : float or array, s. Age of a fix when it is first shown.
    heading_delay : float or array, s. Age of the heading.
    sight : float or array, rad. Standard deviation of white noise on the line of sight, so on alpha
        and theta alike: what is shown is turned round the goal, anew in each sample.
    bias : float or array, m. Standard deviation, to the east and to the north, of a constant error
        that is drawn when the receiver is switched on, once a run.
    dropout, outage : float or array, s. Mean time from the end of one outage to the next, 0 for
        none, and how long each lasts. Meanwhile the last fix is held.
    jump, jump_every : float or array, m and s. Size of an offset that is 0 at first and, after
        random times of this mean (0: never), has another direction; it lasts until the next jump.
    compass : float or array, rad. Standard deviation of a constant error of the heading, once a
        run.

    Raises
    ------
    ValueError : for a field that is negative, infinite or NaN, or mismatched lengths.
    """

    sigma: Real = 0.0
    memory: Real = 0.0
    period: Real = 0.0
    delay: Real = 0.0
    heading_delay: Real = 0.0
    sight: Real = 0.0
    bias: Real = 0.0
    dropout: Real = 0.0
    outage: Real = 0.0
    jump: Real = 0.0
    jump_every: Real = 0.0
    compass: Real = 0.0


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
