"""The filter against filterpy's on a model of its own, and against the truth of 1,000 runs."""

# ruff: noqa: NPY002 (numba has no other random numbers)
import math

import numpy as np
from driven import ARM, DT, FIRST, NOISE, drive, seen
from filterpy.kalman import ExtendedKalmanFilter
from scipy.stats import chi2

import wmrlib as wmr
from wmrlib.compilation import compiled
from wmrrobot import estimation, kalman

# Another filter: filterpy's, with a model written down here and derivatives by differences.


def moved(state, v, omega, gyro, share, speed_error=0.0, turn_error=0.0):
    x, y, heading, bias, scale = state
    turn = share * scale * omega + (1 - share) * (gyro - bias) + turn_error
    way, middle = (scale * v + speed_error) * DT, heading + turn * DT / 2
    return np.array(
        [x + way * math.cos(middle), y + way * math.sin(middle), heading + turn * DT, bias, scale]
    )


def slopes(function, at):
    at, step = np.asarray(at, float), 1e-6
    sides = [function(at + step * unit) - function(at - step * unit) for unit in np.eye(len(at))]
    return np.atleast_2d(np.array(sides).T) / (2 * step)


class Other(ExtendedKalmanFilter):
    def __init__(self):
        super().__init__(dim_x=5, dim_z=1)
        self.x, self.P = FIRST.state.copy(), FIRST.covariance.copy()

    def use(self, function, value, variance):
        residual = np.atleast_1d(value - function(self.x))
        self.dim_z = len(residual)
        rows, zeros = slopes(function, self.x), np.zeros(self.dim_z)
        self.update(residual, lambda _: rows, lambda _: zeros, variance * np.eye(self.dim_z))

    def carry(self, v, omega, gyro):
        travel = math.hypot(v, omega * NOISE.track_width / 2) * NOISE.wheels**2
        speed_rate, turn_rate, white = travel / 2, 2 * travel / NOISE.track_width**2, NOISE.gyro**2
        if not math.isnan(gyro):
            variance = (white + turn_rate) / DT
            self.use(lambda s: np.array([s[3] + s[4] * omega]), gyro, variance)
        share = 1.0 if math.isnan(gyro) else white / (white + turn_rate)
        gyro = 0.0 if math.isnan(gyro) else gyro
        self.F = slopes(lambda s: moved(s, v, omega, gyro, share), self.x)
        spread = slopes(lambda e: moved(self.x, v, omega, gyro, share, *e), [0.0, 0.0])
        turning = share**2 * turn_rate + (1 - share) ** 2 * white
        walks = np.diag([0, 0, 0, NOISE.bias_walk, NOISE.scale_walk]) ** 2 * DT
        self.Q = spread @ np.diag([speed_rate, turning]) @ spread.T / DT + walks
        self.x = moved(self.x, v, omega, gyro, share)
        self.P = self.F @ self.P @ self.F.T + self.Q


def test_it_is_filterpys_filter():
    ours, other = FIRST, Other()
    for n, (inputs, fix, heading) in enumerate(drive()):
        ours = estimation.predict(ours, *inputs, DT, NOISE, gate=math.inf)
        other.carry(*inputs)
        if n % 5 == 0:
            ours = estimation.use_position(ours, *fix, 0.02, **ARM, gate=math.inf)
            other.use(seen, fix, 0.02**2)
        if n % 7 == 0:
            ours = estimation.use_heading(ours, heading, 0.05, gate=math.inf)
            other.use(lambda s: s[2:3], other.x[2] + wmr.wrap_angle(heading - other.x[2]), 0.05**2)
        v, omega, _ = inputs
        if n % 11 == 0 and v:
            across = math.atan2(omega * ARM["ahead"], v - omega * ARM["left"])
            ours = estimation.use_course(ours, heading + across, 0.1, v, omega, **ARM, slowest=0.0)
            other.use(lambda s: s[2:3], other.x[2] + wmr.wrap_angle(heading - other.x[2]), 0.1**2)
        other.x[2] = wmr.wrap_angle(other.x[2])
        np.testing.assert_allclose(ours.state, other.x, rtol=1e-6, atol=1e-7)
        np.testing.assert_allclose(ours.covariance, other.P, rtol=1e-5, atol=1e-10)
    assert abs(ours.state[3] - 0.01) < 4e-3
    assert abs(ours.state[4] - 1.02) < 4e-3


# Is it as good as it says? NEES over 1,000 runs, each with its own truth.


@compiled
def errors(noise, runs, count, dt, ahead, left, seed):
    """NEES of each run after each 10th of the steps, and the surprises of all its positions."""
    np.random.seed(seed)
    white, walk, creep, width = noise[1], noise[2], noise[3], noise[4]
    nees, nis = np.zeros((10, runs)), np.zeros(runs)
    first = np.array([0.05, 0.05, 0.1, 0.01, 0.02])
    for run in range(runs):
        truth = np.array([0.0, 0.0, 0.5, 0.0, 1.0])
        state, covariance = truth.copy(), np.diag(first * first)
        state += first * np.random.standard_normal(5)
        for n in range(count):
            v = 0.0 if n % 60 < 10 else 0.8
            omega = 0.0 if v == 0.0 else 0.5 * math.sin(0.05 * n)
            travel = math.hypot(v, 0.5 * width * omega) * noise[0] ** 2
            speed = truth[4] * v + math.sqrt(0.5 * travel / dt) * np.random.standard_normal()
            slip = math.sqrt(2.0 * travel / dt) / width * np.random.standard_normal()
            turn = truth[4] * omega + slip
            gyro = turn + truth[3] + white / math.sqrt(dt) * np.random.standard_normal()
            middle = truth[2] + 0.5 * turn * dt
            truth[0] += speed * dt * math.cos(middle)
            truth[1] += speed * dt * math.sin(middle)
            truth[2] += turn * dt
            kalman.carry(state, covariance, v, omega, gyro, dt, noise, math.inf)
            truth[3] += walk * math.sqrt(dt) * np.random.standard_normal()
            truth[4] += creep * math.sqrt(dt) * np.random.standard_normal()
            if n % 2 == 0:
                sine, cosine = math.sin(truth[2]), math.cos(truth[2])
                x = truth[0] + ahead * cosine - left * sine + 0.02 * np.random.standard_normal()
                y = truth[1] + ahead * sine + left * cosine + 0.02 * np.random.standard_normal()
                nis[run] += kalman.see_antenna(state, covariance, x, y, ahead, left, 0.02, math.inf)
            if (n + 1) % (count // 10) == 0:
                off = state - truth
                off[2] = math.atan2(math.sin(off[2]), math.cos(off[2]))
                solved = np.linalg.solve(covariance, off)
                nees[n // (count // 10), run] = np.sum(off * solved)
    return nees, nis


RUNS, COUNT = 1000, 300


def test_it_is_as_good_as_it_says():
    """The mean NEES of 1,000 runs is within its 99.9 % bounds, at ten times; so is the NIS."""
    noise = tuple(map(float, NOISE))
    nees, nis = errors(noise, RUNS, COUNT, DT, ARM["ahead"], ARM["left"], 3)
    low, high = chi2.ppf([0.0005, 0.9995], 5 * RUNS) / RUNS
    assert ((low < nees.mean(axis=1)) & (nees.mean(axis=1) < high)).all()
    low, high = chi2.ppf([0.0005, 0.9995], 2 * RUNS * COUNT // 2)
    assert low < nis.sum() < high
