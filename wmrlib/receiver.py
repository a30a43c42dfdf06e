"""A positioning receiver and its errors, between the true pose and the controller.

The random numbers of a fix are computed from the seed, the number of the run and the number of the
sample alone, so the same fix has the same error on whatever core its run is computed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from wmrlib.checks import Real, checked, kind_of, refusal
from wmrlib.compilation import compiled, formula
from wmrlib.elementary import sincos, wrap
from wmrlib.records import record

_WORD = 0xFFFFFFFF


@record
@checked("at_least_0")
class Receiver(NamedTuple):
    """A positioning receiver with a compass: its errors, its period and its delays; or many.

    The error is a Gauss-Markov process on each axis, in its stationary state from the first fix on:
    tau seconds later it keeps the share c = exp(-tau/memory), and sqrt(1 - c^2) sigma is new.
    Other times are rounded to whole samples. The fix of the first sample is used until the next
    arrives.

    Parameters
    ----------
    sigma : float or array, m. Standard deviation of the error, to the east and to the north.
    memory : float or array, s. Correlation time of the error; with 0 that of each fix is new.
    period : float or array, s. Time between two fixes; 0: a fix in every sample.
    delay : float or array, s. Age of a fix when it arrives.
    heading_delay : float or array, s. Age of the heading.
    sight : float or array, rad. Standard deviation of white noise on the line of sight, so on alpha
        and theta alike: the measured position is rotated about the goal, anew in each sample.
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

    Examples
    --------
    >>> import wmrlib as wmr
    >>> start, goal = wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(5.0, 3.0, 0.0)
    >>> noisy = wmr.Receiver(sigma=[0.0, 0.05, 0.3], period=0.2)  # three receivers
    >>> runs = wmr.sweep(start, goal, wmr.GENTLE_GAINS, method="arc", receiver=noisy)
    >>> print(runs.path_length.round(1), runs.peak_omega.round(1))  # m, rad/s
    [5.9 6.  8.3] [1.7 3.4 6.1]
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

# The purposes of random numbers, each of which has numbers of its own in every sample. They are
# floats, because numba would compile `normals` anew for each whole number in a call.
_ERROR, _SIGHT, _BIAS, COMPASS, _DROPOUT, _JUMP = map(float, range(6))


class SampledReceiver(NamedTuple):
    """A Receiver as the loops take it: times in samples, and the key to its random numbers.

    `fading` is one over the memory. `dropouts` and `jumps` are mean numbers of events a
    sample. `run` is the number of the run, and `key` is made of the seed.
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
    """The state of a receiver between two samples.

    `fix` is the sample in which the newest fix was measured, and (`x`, `y`) is its position, m.
    `east` and `north` are the fading error, in standard deviations. (`jump_east`, `jump_north`) is
    the unit vector of the last jump. Until the sample `outage_end` no fix arrives. The bias [m] and
    the error of the compass [rad] are constant in a run.
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
    """A random unit vector if an event happens, else (0, 0); `expected` is its mean number."""
    east, north = normals(receiver.run, int(fix), purpose, receiver.key)
    size = math.hypot(east, north)  # independent of the direction
    if math.exp(-0.5 * size * size) < -math.expm1(-expected):
        return east / size, north / size
    return 0.0, 0.0


@compiled
def received(before, record, k, receiver):
    """The receiver's state at sample k, from its state before and the recorded true positions."""
    fix = max(np.floor(k / receiver.period) * receiver.period - receiver.delay, 0.0)
    if fix <= before.fix:  # no newer fix has arrived
        return before
    run, key, first = receiver.run, receiver.key, before.fix < 0.0
    bias_east, bias_north, compass = before.bias_east, before.bias_north, before.compass
    if first:
        east, north = normals(run, int(fix), _BIAS, key)
        bias_east, bias_north = receiver.bias * east, receiver.bias * north
        compass = receiver.compass * normals(run, int(fix), COMPASS, key)[0]
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
def measured_pose(reception, record, k, goal, receiver):
    """The measured pose at sample k, from the receiver's state and the recorded true headings."""
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


def key_of(seed: int) -> tuple[int, int]:
    """The key to the random numbers of a seed; ValueError if it is none."""
    whole = isinstance(seed, int | np.integer) and not isinstance(seed, bool)
    if not whole or not 0 <= seed < 2**64:
        remark = "" if whole else f", not {kind_of(seed)}"
        raise refusal("seed", seed, "a whole number from 0 to 2**64 - 1", remark)
    high, low = divmod(int(seed), 2**32)
    return low, high


def in_samples(fields: np.ndarray, dt: float, samples: int) -> np.ndarray:
    """The fields of receivers, one a row, turned from seconds into samples of dt."""
    in_steps = fields.copy()
    memory, dropout, jump_every = fields[1], fields[7], fields[10]
    with np.errstate(divide="ignore", over="ignore"):
        in_steps[1] = dt / np.abs(memory)  # -0.0 is 0 as well
    for row, mean in ((7, dropout), (10, jump_every)):
        in_steps[row] = np.where(mean > 0.0, dt / np.maximum(mean, dt * 1e-9), 0.0)
    times = [2, 3, 4, 8]  # period, delay, heading_delay, outage
    in_steps[times] = np.rint(np.minimum(fields[times], samples * dt) / dt)
    in_steps[2] = np.maximum(in_steps[2], 1.0)
    return in_steps
