"""The filter against filterpy's on a model of its own; chapter 14 holds it against the truth."""

import math

import numpy as np
from driven import ARM, DT, FIRST, NOISE, drive, seen
from filterpy.kalman import ExtendedKalmanFilter

import wmrlib as wmr
from wmrrobot import estimation

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
