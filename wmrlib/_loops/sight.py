"""Sampled control in the plane by what a receiver shows: noisy, held and late.

Random numbers are not drawn in turn but counted: those of a fix follow from the seed, the number of
its run and that of its sample alone, whoever computes them, and when.
"""

from __future__ import annotations

import math

import numpy as np

from wmrlib._compile import compiled, formula
from wmrlib._loops import plane, rows
from wmrlib._vecmath import sincos
from wmrlib.laws import pose_tuning
from wmrlib.motion import polar_from_pose, wrap

# The rows of a run, after those that `plane` knows: times in samples, how many a fix is held beyond
# its own, and the run's number.
SIGMA, MEMORY, HELD, LATE, HEADING_LATE, NUMBER = range(10, 16)
_WORD = 0xFFFFFFFF
_ROUNDS = 10


@formula
def philox(counter, key):
    """Four random words of 32 bits: Philox 4x32-10 of Salmon et al. (2011).

    What overflows in a product is only its sign, and masked.
    """
    a, b, c, d = counter
    key_1, key_2 = key
    for _ in range(_ROUNDS):
        one, two = 0xD2511F53 * a, 0xCD9E8D57 * c
        a, c = ((two >> 32) & _WORD) ^ b ^ key_1, ((one >> 32) & _WORD) ^ d ^ key_2
        b, d = two & _WORD, one & _WORD
        key_1, key_2 = (key_1 + 0x9E3779B9) & _WORD, (key_2 + 0xBB67AE85) & _WORD
    return a, b, c, d


@formula
def uniform(high, low):
    """A number in (0, 1] out of two words, whose 53 bits are those of a double."""
    return ((high << 21) + (low >> 11) + 0.5) * 2.0**-53


@compiled
def normals(run, sample, key):
    """Two independent standard normal numbers, by the rule of Box and Muller."""
    a, b, c, d = philox((run & _WORD, run >> 32, sample, 0), key)
    size = math.sqrt(-2.0 * math.log(uniform(a, b)))
    sine, cosine = sincos(2.0 * math.pi * uniform(c, d))
    return size * cosine, size * sine


@compiled
def drive(summary, records, runs, members, law, wheels, step, dt, samples, arrival_radius, key):
    """Drive and sum up the runs in the columns `members`. Each stops where it believes to be."""
    recorded, longest = records.shape[2] > 0, 0
    for i in members:
        longest = max(longest, int(runs[LATE, i]), int(runs[HEADING_LATE, i]))
    size = longest + 1
    truth = np.empty((3, size))  # the last poses; that of sample k is in column k % size
    for i in members:
        start, goal, gains = rows.run_of(runs[:SIGMA], i)
        sigma, memory, held, late, heading_late, number = runs[SIGMA:, i]
        tuning, outcome = pose_tuning(*gains), rows.TIMED_OUT
        pose = new = (start[0], start[1], wrap(start[2]))
        east = north = shown_x = shown_y = peak = length = rolled = 0.0
        fixed = -1  # the sample of the fix before
        for k in range(samples):
            now = k % size
            truth[0, now], truth[1, now], truth[2, now] = new
            if k % (int(held) + 1) == 0:
                fix = max(k - int(late), 0)
                if sigma > 0.0 and fix > fixed:
                    known = fixed >= 0 and memory > 0.0
                    age = (fix - fixed) * dt / memory if known else math.inf
                    keep, share = math.exp(-age), math.sqrt(-math.expm1(-2.0 * age))
                    one, other = normals(int(number), fix, key)
                    east, north = keep * east + share * one, keep * north + share * other
                    fixed = fix
                shown_x = truth[0, fix % size] + sigma * east
                shown_y = truth[1, fix % size] + sigma * north
            shown = shown_x, shown_y, truth[2, max(k - int(heading_late), 0) % size]
            rho, _, _, v, omega = plane.observe(shown, goal, (0.0, 0.0), tuning, law, wheels)
            if not math.isfinite(new[0] + new[1] + rho + v + omega):
                outcome = rows.DIVERGED
                break
            pose, peak, length = new, max(peak, abs(omega)), length + rolled
            if recorded:
                rows.write(records[:, i], k, pose, polar_from_pose(*pose, *goal), v, omega)
            if rho <= arrival_radius:
                outcome = rows.ARRIVED
                break
            new, rolled = plane.move(pose, v, omega, dt, step), dt * abs(v)
        rho, alpha, theta = polar_from_pose(*pose, *goal)
        turned = wrap(theta - alpha)
        rows.summarise(summary, i, outcome, k * dt, turned, peak, length, rho)


def survey(runs, law, wheels, step, dt, samples, arrival_radius, recorded, *key):
    """As `plane.survey`, which has the runs whose receiver shows the truth."""
    common = law, wheels, step, dt, samples, arrival_radius
    summary = np.empty((rows.DISTANCE + 1, runs.shape[1]))
    records = np.full((rows.LYAPUNOV, runs.shape[1], samples if recorded else 0), np.nan)
    wrong = runs[[SIGMA, HELD, LATE, HEADING_LATE]].any(axis=0)
    clear, members = np.flatnonzero(~wrong), np.flatnonzero(wrong)
    summary[:, clear], records[:, clear] = plane.survey(runs[:SIGMA, clear], *common, recorded)
    drive(summary, records, runs, members, *common, key)
    return summary, records
