"""A drive for the filter's tests: its noise, its first estimate, its inputs and measurements."""

import math

import numpy as np

import wmrlib as wmr
from wmrrobot import estimation
from wmrrobot.estimation import Noise

NOISE = Noise(wheels=0.03, gyro=2e-3, bias_walk=1e-4, scale_walk=1e-4, track_width=0.5)
ARM = {"ahead": 0.4, "left": -0.15}
DT = 0.1
FIRST = estimation.start(wmr.Pose(1.0, -2.0, 0.4), 0.5, 0.2)


def seen(state):
    sine, cosine = math.sin(state[2]), math.cos(state[2])
    rotation = np.array([[cosine, -sine], [sine, cosine]])
    return state[:2] + rotation @ [ARM["ahead"], ARM["left"]]


def drive(count=300, seed=5):
    """Rows of v, omega and gyro, with rests, reverse and gaps, and the fix and heading after."""
    random = np.random.default_rng(seed)
    truth, bias, scale = np.array([1.3, -2.2, 0.5]), 0.01, 1.02
    for n in range(count):
        v = (0.0, 1.0, 1.0, -0.6)[n // 25 % 4]
        omega = 0.0 if v == 0.0 else 0.6 * math.sin(0.07 * n)
        true = scale * v, scale * omega
        truth[:] = wmr.advance(wmr.Pose(*truth), *true, DT)
        gyro = true[1] + bias + random.normal(0.0, NOISE.gyro / math.sqrt(DT))
        gyro = math.nan if n % 40 == 39 else gyro
        fix = seen(truth) + random.normal(0.0, 0.02, 2)
        yield (v, omega, gyro), fix, truth[2] + random.normal(0.0, 0.05)
