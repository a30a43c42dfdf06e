"""The arithmetic of the filter, which changes state and covariance in place; in C, filter_frame.h.

A measurement is one row of derivatives, its residual and its variance; several go one after the
other, which needs no inverse. Joseph's form keeps the covariance positive definite, in floats too.

Sums are written out: with numpy's operators on whole arrays numba also compiles their messages
about shapes that do not fit, which takes six times as long.
"""

from __future__ import annotations

import numpy as np

from wmrlib.compilation import compiled, formula
from wmrlib.elementary import wrap
from wmrrobot import sensing
from wmrrobot.jacobians import antenna_rows, moved_rows

SIZE = 5  # x, y, heading, gyro_bias, wheel_scale


@formula
def spread(covariance, matrix, vector, variance):
    """Make the covariance matrix covariance matrix' + vector variance vector'."""
    half = np.zeros((SIZE, SIZE))
    for i in range(SIZE):
        for j in range(SIZE):
            for k in range(SIZE):
                half[i, j] += matrix[i, k] * covariance[k, j]
    for i in range(SIZE):
        for j in range(i + 1):
            value = vector[i] * variance * vector[j]
            for k in range(SIZE):
                value += half[i, k] * matrix[j, k]
            covariance[i, j] = covariance[j, i] = value


@compiled
def absorb(state, covariance, row, residual, variance):
    """Use one number; its normalised innovation squared."""
    shared = np.zeros(SIZE)
    for i in range(SIZE):
        for j in range(SIZE):
            shared[i] += covariance[i, j] * row[j]
    total = variance
    for i in range(SIZE):
        total += row[i] * shared[i]
    gain, rest = np.empty(SIZE), np.empty((SIZE, SIZE))
    for i in range(SIZE):
        gain[i] = shared[i] / total
        state[i] += gain[i] * residual
        for j in range(SIZE):
            rest[i, j] = (1.0 if i == j else 0.0) - gain[i] * row[j]
    spread(covariance, rest, gain, variance)
    return residual * residual / total


@compiled
def gated(state, covariance, rows, residuals, variance, gate):
    """Use numbers that belong together if their surprise, which is returned, is within the gate."""
    before, doubts = state.copy(), covariance.copy()
    surprise = 0.0
    for i in range(len(residuals)):
        left = residuals[i]
        for j in range(SIZE):
            left -= rows[i, j] * (state[j] - before[j])
        surprise += absorb(state, covariance, rows[i], left, variance)
    if not surprise <= gate:  # NaN too
        for i in range(SIZE):
            state[i] = before[i]
            for j in range(SIZE):
                covariance[i, j] = doubts[i, j]
    state[2] = wrap(state[2])
    return surprise


@compiled
def carry(state, covariance, v, omega, gyro, dt, noise, gate):
    """A step by wheels and gyro: their difference measures the bias, their mean turns the robot."""
    wheels, white, bias_walk, scale_walk, track_width, _ = noise
    speed_rate, turn_rate = sensing.wheel_noise(v, omega, track_width, wheels)
    share, surprise, gyro_rate = 1.0, 0.0, white * white
    if gyro == gyro:  # not NaN
        row = np.array([[0.0, 0.0, 0.0, 1.0, omega]])
        residual = np.array([gyro - sensing.gyro_reading(state[3], state[4], omega)])
        surprise = gated(state, covariance, row, residual, (gyro_rate + turn_rate) / dt, gate)
        share = gyro_rate / (gyro_rate + turn_rate) if surprise <= gate else 0.0
    else:
        gyro = 0.0
    heading, bias, scale = state[2], state[3], state[4]
    speed, turn = sensing.speed_and_turn(bias, scale, v, omega, gyro, share)
    slopes = moved_rows(heading, bias, scale, v, omega, gyro, share, dt)
    pose = sensing.moved(state[0], state[1], heading, speed, turn, dt)
    state[0], state[1], state[2] = pose
    rates = speed_rate, share * share * turn_rate + (1.0 - share) * (1.0 - share) * gyro_rate
    step = np.eye(SIZE)
    for i in range(3):
        for j in range(SIZE):
            step[i, j] = slopes[7 * i + j]
    spread(covariance, step, np.zeros(SIZE), 0.0)
    for i in range(3):
        for j in range(3):
            for k in range(2):
                part = slopes[7 * i + 5 + k] * slopes[7 * j + 5 + k] * rates[k] / dt
                covariance[i, j] += part
    covariance[3, 3] += bias_walk * bias_walk * dt
    covariance[4, 4] += scale_walk * scale_walk * dt
    return surprise


@compiled
def see_antenna(state, covariance, x, y, ahead, left, sigma, gate):
    east, north = sensing.antenna(state[0], state[1], state[2], ahead, left)
    slopes, rows = antenna_rows(state[2], ahead, left), np.zeros((2, SIZE))
    for i in range(2):
        for j in range(SIZE):
            rows[i, j] = slopes[SIZE * i + j]
    return gated(state, covariance, rows, np.array([x - east, y - north]), sigma * sigma, gate)


@compiled
def see_heading(state, covariance, heading, sigma, gate):
    rows, residual = np.zeros((1, SIZE)), np.array([wrap(heading - state[2])])
    rows[0, 2] = 1.0
    return gated(state, covariance, rows, residual, sigma * sigma, gate)
