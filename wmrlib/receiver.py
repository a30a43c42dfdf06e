"""What a positioning receiver does to the positions that a controller steers by.

Its random numbers are not drawn one after the other. Those of a fix follow from the seed, from its
run's number and from its sample's number alone, so it does not matter which core computes them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wmrlib.checks import Real, checked
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import sincos, wrap
from wmrlib.records import record

_WORD = 0xFFFFFFFF


@record
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
def normals(run, sample, purpose, key):
    """Two standard normal numbers, by the rule of Box and Muller, out of 53 bits each."""
    a, b, c, d = philox((run & _WORD, run >> 32, sample, int(purpose)), key)
    size, turn = ((a << 21) + (b >> 11) + 0.5) * 2.0**-53, ((c << 21) + (d >> 11)) * 2.0**-53
    length, (sine, cosine) = math.sqrt(-2.0 * math.log(size)), sincos(2.0 * math.pi * turn)
    return length * cosine, length * sine


# In the loop -------------------------------------------------------------------------------------

# What a random number is for. Each purpose has its own numbers in every sample. They are floats,
# because numba would compile `normals` anew for each whole number that is written into a call.
_ERROR, _SIGHT, _BIAS, _COMPASS, _DROPOUT, _JUMP = map(float, range(6))


class SampledReceiver(NamedTuple):
    """A Receiver as the loop reads it, with times in samples, and whose random numbers it has.

    `fading` is one over the memory. `dropouts` and `jumps` are how many come in a sample, on
    average. `run` is the number of the run, and `key` is made of the seed.
    """

    sigma: float
    fading: float
    period: float
    delay: float
    heading_delay: float
    sight: float
    bias: float
    dropouts: float
    outage: float
    jump: float
    jumps: float
    compass: float
    run: int
    key: tuple[int, int]


class Reception(NamedTuple):
    """What a receiver keeps from one sample to the next.

    `fix` is the sample in which the fix that is shown was true, and `x` and `y` are what is shown.
    `east` and `north` are the error that fades, in standard deviations. `jump_east` and
    `jump_north` point where the last jump went. Until `outage_end` no fix gets through. The bias
    and the compass's error are the run's own.
    """

    fix: float
    x: float
    y: float
    east: float
    north: float
    jump_east: float
    jump_north: float
    outage_end: float
    bias_east: float
    bias_north: float
    compass: float


BEFORE_THE_FIRST_FIX = Reception(-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@compiled
def where_to(receiver, fix, purpose, expected):
    """A unit vector to anywhere if an event of which so many are expected happens; else (0, 0)."""
    east, north = normals(receiver.run, int(fix), purpose, receiver.key)
    size = math.hypot(east, north)  # independent of the direction
    if math.exp(-0.5 * size * size) < -math.expm1(-expected):
        return east / size, north / size
    return 0.0, 0.0


@compiled
def received(before, record, k, receiver):
    """What the receiver keeps in sample k; the rows x and y of the record are where it has been."""
    fix = max(np.floor(k / receiver.period) * receiver.period - receiver.delay, 0.0)
    if fix <= before.fix:  # the fix that is shown is still the newest
        return before
    run, key, first = receiver.run, receiver.key, before.fix < 0.0
    bias_east, bias_north, compass = before.bias_east, before.bias_north, before.compass
    if first:
        east, north = normals(run, int(fix), _BIAS, key)
        bias_east, bias_north = receiver.bias * east, receiver.bias * north
        compass = receiver.compass * normals(run, int(fix), _COMPASS, key)[0]
    outage_end = before.outage_end
    if not first and receiver.dropouts > 0.0:
        expected = receiver.period * receiver.dropouts
        if fix >= outage_end and where_to(receiver, fix, _DROPOUT, expected) != (0.0, 0.0):
            outage_end = fix + max(receiver.outage, 1.0)
        if fix < outage_end:
            held = before.fix, before.x, before.y, before.east, before.north
            jump = before.jump_east, before.jump_north
            return Reception(*held, *jump, outage_end, bias_east, bias_north, compass)
    jump_east, jump_north = before.jump_east, before.jump_north
    if not first and receiver.jumps > 0.0:
        expected = (fix - before.fix) * receiver.jumps
        jump = where_to(receiver, fix, _JUMP, expected)
        if jump != (0.0, 0.0):
            jump_east, jump_north = jump
    east, north = before.east, before.north
    if receiver.sigma > 0.0:
        age = math.inf if first else (fix - before.fix) * receiver.fading
        keep, new = math.exp(-age), math.sqrt(-math.expm1(-2.0 * age))
        new_east, new_north = normals(run, int(fix), _ERROR, key)
        east, north = keep * east + new * new_east, keep * north + new * new_north
    x = record[0, int(fix)] + receiver.sigma * east + (bias_east + receiver.jump * jump_east)
    y = record[1, int(fix)] + receiver.sigma * north + (bias_north + receiver.jump * jump_north)
    constant = bias_east, bias_north, compass
    return Reception(fix, x, y, east, north, jump_east, jump_north, outage_end, *constant)


@formula
def shown_pose(reception, record, k, goal, receiver):
    """The pose that is shown in sample k; the record's row of headings is where it has looked."""
    x, y = reception.x, reception.y
    if receiver.sight > 0.0:
        noise = normals(receiver.run, k, _SIGHT, receiver.key)[0]
        sine, cosine = sincos(receiver.sight * noise)
        east, north = x - goal[0], y - goal[1]
        x, y = goal[0] + cosine * east - sine * north, goal[1] + sine * east + cosine * north
    heading = record[2, max(k - int(receiver.heading_delay), 0)]
    if reception.compass != 0.0:
        heading = wrap(heading + reception.compass)
    return x, y, heading


def in_samples(fields: np.ndarray, dt: float, samples: int) -> np.ndarray:
    """The fields of receivers, one a row, as those of `SampledReceiver`."""
    kept = fields.copy()
    memory, dropout, jump_every = fields[1], fields[7], fields[10]
    with np.errstate(divide="ignore", over="ignore"):
        kept[1] = dt / np.abs(memory)  # -0.0 is 0 as well
    for row, mean in ((7, dropout), (10, jump_every)):
        kept[row] = np.where(mean > 0.0, dt / np.maximum(mean, dt * 1e-9), 0.0)
    times = [2, 3, 4, 8]  # period, delay, heading_delay, outage
    kept[times] = np.rint(np.minimum(fields[times], samples * dt) / dt)
    kept[2] = np.maximum(kept[2], 1.0)
    return kept
