/* wmr_filter.h: where the robot is and where it faces, from wheels, gyro, GNSS and
   compass; an extended Kalman filter beside wmr_law.h.
   Printed by python -m wmrrobot from the formulas of wmrrobot: change those.

   The state is x, y, heading, gyro_bias [rad/s] and wheel_scale, the true speed over the
   one that the wheels report. No memory is allocated and no matrix inverted. A
   measurement is used if its surprise, the normalised innovation squared, is within the
   gate (99.9 % of good ones: WMR_GATE_1 for one number, WMR_GATE_2 for a position;
   INFINITY uses all). Each function returns whether it was used. One with NaN, infinity
   or a sigma that is not above 0 changes nothing and returns 0.

   SPDX-License-Identifier: BSD-3-Clause */
#ifndef WMR_FILTER_H
#define WMR_FILTER_H

#include "wmr_law.h"

#define WMR_SIZE 5
#define WMR_GATE_1 WMR_C(10.83)
#define WMR_GATE_2 WMR_C(13.82)
#define WMR_LONGEST WMR_C(60.0) /* s, of a step */

typedef struct {
  WMR_REAL state[WMR_SIZE]; /* x, y, heading, gyro_bias, wheel_scale */
  WMR_REAL covariance[WMR_SIZE][WMR_SIZE];
  WMR_REAL surprise; /* of the last measurement, used or not */
} wmr_filter;

/* m after the first metre of a wheel; rad/sqrt(s), above 0; rad/s/sqrt(s); 1/sqrt(s); m; m/s,
   the wheels' top speed: a faster reading is a fault of an encoder */
typedef struct {
  WMR_REAL wheels, gyro, bias_walk, scale_walk, track_width, max_speed;
} wmr_noise;

/* x, y, heading after a step */
static inline void wmr_moved(WMR_REAL x, WMR_REAL y, WMR_REAL heading, WMR_REAL speed,
      WMR_REAL turn, WMR_REAL dt, WMR_REAL out[3]) {
  const WMR_REAL part0 = dt * turn;
  const WMR_REAL part1 = heading + WMR_C(0.5) * part0;
  const WMR_REAL part2 = dt * speed;
  out[0] = part2 * WMR_F(cos)(part1) + x;
  out[1] = part2 * WMR_F(sin)(part1) + y;
  out[2] = wmr_wrap(heading + part0);
}

/* true speed and turning rate */
static inline void wmr_true_twist(WMR_REAL gyro_bias, WMR_REAL wheel_scale, WMR_REAL v,
      WMR_REAL omega, WMR_REAL gyro, WMR_REAL share, WMR_REAL out[2]) {
  out[0] = v * wheel_scale;
  out[1] = omega * share * wheel_scale + (WMR_C(1.0) - share) * (gyro - gyro_bias);
}

/* the gyro without slip */
static inline WMR_REAL wmr_gyro_reading(WMR_REAL gyro_bias, WMR_REAL wheel_scale,
      WMR_REAL omega) {
  return gyro_bias + omega * wheel_scale;
}

/* variance rates of speed and turning rate */
static inline void wmr_wheel_noise(WMR_REAL v, WMR_REAL omega, WMR_REAL track_width,
      WMR_REAL noise, WMR_REAL out[2]) {
  const WMR_REAL part0 = (track_width * track_width);
  const WMR_REAL part1 = (noise * noise) * WMR_F(sqrt)(WMR_C(0.25) * (omega * omega) *
      part0 + (v * v));
  out[0] = WMR_C(0.5) * part1;
  out[1] = WMR_C(2.0) * part1/part0;
}

/* the antenna's east and north */
static inline void wmr_antenna(WMR_REAL x, WMR_REAL y, WMR_REAL heading, WMR_REAL ahead,
      WMR_REAL left, WMR_REAL out[2]) {
  const WMR_REAL part0 = WMR_F(cos)(heading);
  const WMR_REAL part1 = WMR_F(sin)(heading);
  out[0] = ahead * part0 - left * part1 + x;
  out[1] = ahead * part1 + left * part0 + y;
}

/* where the antenna moves */
static inline WMR_REAL wmr_course(WMR_REAL heading, WMR_REAL v, WMR_REAL omega,
      WMR_REAL ahead, WMR_REAL left) {
  return heading + WMR_F(atan2)(ahead * omega, -left * omega + v);
}

/* d(x, y, heading) by the state's five entries, the speed and the turning rate */
static inline void wmr_moved_rows(WMR_REAL heading, WMR_REAL gyro_bias,
      WMR_REAL wheel_scale, WMR_REAL v, WMR_REAL omega, WMR_REAL gyro, WMR_REAL share,
      WMR_REAL dt, WMR_REAL out[21]) {
  const WMR_REAL part0 = omega * share;
  const WMR_REAL part1 = part0 * wheel_scale;
  const WMR_REAL part2 = share + WMR_C(-1.0);
  const WMR_REAL part3 = WMR_C(0.5) * dt * (part1 - part2 * (gyro - gyro_bias)) +
      heading;
  const WMR_REAL part4 = WMR_F(sin)(part3);
  const WMR_REAL part5 = dt * part4;
  const WMR_REAL part6 = part5 * v;
  const WMR_REAL part7 = WMR_C(0.5) * (dt * dt) * v;
  const WMR_REAL part8 = part7 * wheel_scale;
  const WMR_REAL part9 = part4 * part8;
  const WMR_REAL part10 = WMR_F(cos)(part3);
  const WMR_REAL part11 = part1 * part7;
  const WMR_REAL part12 = dt * part10;
  const WMR_REAL part13 = part10 * part8;
  out[0] = WMR_C(1.0);
  out[1] = WMR_C(0.0);
  out[2] = -part6 * wheel_scale;
  out[3] = -part2 * part9;
  out[4] = dt * part10 * v - part11 * part4;
  out[5] = part12;
  out[6] = -part9;
  out[7] = WMR_C(0.0);
  out[8] = WMR_C(1.0);
  out[9] = part12 * v * wheel_scale;
  out[10] = part13 * part2;
  out[11] = part10 * part11 + part6;
  out[12] = part5;
  out[13] = part13;
  out[14] = WMR_C(0.0);
  out[15] = WMR_C(0.0);
  out[16] = WMR_C(1.0);
  out[17] = dt * part2;
  out[18] = dt * part0;
  out[19] = WMR_C(0.0);
  out[20] = dt;
}

/* d(east, north) of the antenna by the state's five entries */
static inline void wmr_antenna_rows(WMR_REAL heading, WMR_REAL ahead, WMR_REAL left,
      WMR_REAL out[10]) {
  const WMR_REAL part0 = WMR_F(sin)(heading);
  const WMR_REAL part1 = WMR_F(cos)(heading);
  out[0] = WMR_C(1.0);
  out[1] = WMR_C(0.0);
  out[2] = -ahead * part0 - left * part1;
  out[3] = WMR_C(0.0);
  out[4] = WMR_C(0.0);
  out[5] = WMR_C(0.0);
  out[6] = WMR_C(1.0);
  out[7] = ahead * part1 - left * part0;
  out[8] = WMR_C(0.0);
  out[9] = WMR_C(0.0);
}

/* The first estimate, with standard deviations above 0 in m, rad, rad/s and a ratio. */
static inline wmr_filter wmr_filter_start(wmr_pose pose, WMR_REAL position_sigma,
                                          WMR_REAL heading_sigma, WMR_REAL bias_sigma,
                                          WMR_REAL scale_sigma) {
  const WMR_REAL zero = WMR_C(0.0);
  wmr_filter filter = {{pose.x, pose.y, pose.heading, zero, WMR_C(1.0)}, {{zero}}, zero};
  const WMR_REAL sigma[WMR_SIZE] = {position_sigma, position_sigma, heading_sigma,
                                    bias_sigma, scale_sigma};
  for (int i = 0; i < WMR_SIZE; ++i) filter.covariance[i][i] = sigma[i] * sigma[i];
  return filter;
}

static inline wmr_pose wmr_filter_pose(const wmr_filter *filter) {
  const wmr_pose pose = {filter->state[0], filter->state[1], filter->state[2]};
  return pose;
}

/* matrix covariance matrix', and variance vector vector' besides. */
static inline void wmr_spread(wmr_filter *filter,
                              const WMR_REAL matrix[WMR_SIZE][WMR_SIZE],
                              const WMR_REAL vector[WMR_SIZE], WMR_REAL variance) {
  WMR_REAL half[WMR_SIZE][WMR_SIZE];
  for (int i = 0; i < WMR_SIZE; ++i)
    for (int j = 0; j < WMR_SIZE; ++j) {
      half[i][j] = WMR_C(0.0);
      for (int k = 0; k < WMR_SIZE; ++k)
        half[i][j] += matrix[i][k] * filter->covariance[k][j];
    }
  for (int i = 0; i < WMR_SIZE; ++i)
    for (int j = 0; j <= i; ++j) {
      WMR_REAL value = vector[i] * variance * vector[j];
      for (int k = 0; k < WMR_SIZE; ++k) value += half[i][k] * matrix[j][k];
      filter->covariance[i][j] = filter->covariance[j][i] = value;
    }
}

/* Uses one number, by Joseph's form, which keeps the covariance positive definite. */
static inline void wmr_absorb(wmr_filter *filter, const WMR_REAL row[WMR_SIZE],
                              WMR_REAL residual, WMR_REAL variance) {
  WMR_REAL gain[WMR_SIZE], kept[WMR_SIZE][WMR_SIZE], total = variance;
  for (int i = 0; i < WMR_SIZE; ++i) {
    gain[i] = WMR_C(0.0);
    for (int j = 0; j < WMR_SIZE; ++j) gain[i] += filter->covariance[i][j] * row[j];
  }
  for (int i = 0; i < WMR_SIZE; ++i) total += row[i] * gain[i];
  for (int i = 0; i < WMR_SIZE; ++i) {
    gain[i] /= total;
    filter->state[i] += gain[i] * residual;
    for (int j = 0; j < WMR_SIZE; ++j)
      kept[i][j] = (i == j ? WMR_C(1.0) : WMR_C(0.0)) - gain[i] * row[j];
  }
  wmr_spread(filter, (const WMR_REAL(*)[WMR_SIZE])kept, gain, variance);
  filter->surprise += residual * residual / total;
}

/* Uses `count` numbers, one or two, that belong together. */
static inline int wmr_gated(wmr_filter *filter, int count, const WMR_REAL *rows,
                            const WMR_REAL *residuals, WMR_REAL variance,
                            WMR_REAL gate) {
  wmr_filter after = *filter;
  int finite = wmr_is_finite(variance) && variance > WMR_C(0.0);
  after.surprise = WMR_C(0.0);
  for (int i = 0; i < count; ++i) {
    const WMR_REAL *row = rows + i * WMR_SIZE;
    WMR_REAL left = residuals[i];
    for (int j = 0; j < WMR_SIZE; ++j) left -= row[j] * (after.state[j] - filter->state[j]);
    wmr_absorb(&after, row, left, variance);
  }
  for (int i = 0; i < WMR_SIZE; ++i) finite = finite && wmr_is_finite(after.state[i]);
  if (!finite) return 0;
  filter->surprise = after.surprise;
  if (!(after.surprise <= gate)) return 0;
  after.state[2] = wmr_wrap(after.state[2]);
  *filter = after;
  return 1;
}

/* A step of dt [s], above 0, by the twist of the wheels [m/s, rad/s] and the gyro
   [rad/s; NaN if there is none]. The difference of their turning rates measures the
   bias, at rest exactly the gyro's reading; their mean, by their noise, turns the robot.
   Beyond the gate the wheels slip: then the gyro alone counts, and 0 is returned. */
static inline int wmr_filter_predict(wmr_filter *filter, WMR_REAL v, WMR_REAL omega,
                                     WMR_REAL gyro, WMR_REAL dt, wmr_noise noise,
                                     WMR_REAL gate) {
  const WMR_REAL zero = WMR_C(0.0), one = WMR_C(1.0), white = noise.gyro * noise.gyro;
  const WMR_REAL none[WMR_SIZE] = {zero};
  WMR_REAL rates[2], twist[2], pose[3], slopes[21];
  WMR_REAL step[WMR_SIZE][WMR_SIZE] = {{zero}}, share = one, *state = filter->state;
  int together = 1;
  if (!wmr_is_finite(v) || !wmr_is_finite(omega) || !(dt > zero && dt <= WMR_LONGEST))
    return 0;
  if (!(wmr_fastest_wheel(v, omega, noise.track_width) <= WMR_C(1.5) * noise.max_speed)) return 0;
  wmr_wheel_noise(v, omega, noise.track_width, noise.wheels, rates);
  if (wmr_is_finite(gyro)) {
    const WMR_REAL row[WMR_SIZE] = {zero, zero, zero, one, omega};
    const WMR_REAL residual = gyro - wmr_gyro_reading(state[3], state[4], omega);
    together = wmr_gated(filter, 1, row, &residual, (white + rates[1]) / dt, gate);
    share = together ? white / (white + rates[1]) : zero;
  } else {
    gyro = zero;
  }
  wmr_true_twist(state[3], state[4], v, omega, gyro, share, twist);
  wmr_moved_rows(state[2], state[3], state[4], v, omega, gyro, share, dt, slopes);
  wmr_moved(state[0], state[1], state[2], twist[0], twist[1], dt, pose);
  rates[1] = share * share * rates[1] + (one - share) * (one - share) * white;
  for (int i = 0; i < WMR_SIZE; ++i)
    for (int j = 0; j < WMR_SIZE; ++j)
      step[i][j] = i < 3 ? slopes[7 * i + j] : i == j ? one : zero;
  for (int i = 0; i < 3; ++i) state[i] = pose[i];
  wmr_spread(filter, (const WMR_REAL(*)[WMR_SIZE])step, none, zero);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 2; ++k)
        filter->covariance[i][j] +=
            slopes[7 * i + 5 + k] * slopes[7 * j + 5 + k] * rates[k] / dt;
  filter->covariance[3][3] += noise.bias_walk * noise.bias_walk * dt;
  filter->covariance[4][4] += noise.scale_walk * noise.scale_walk * dt;
  return together;
}

/* The same state, less certain: for a gate that has refused several measurements in a row
   and may be refusing the truth. Call it with 4, say, at each refusal from then on. A place
   that is uncertain by more than 100 m is not doubted further: it is lost. */
static inline void wmr_filter_doubt(wmr_filter *filter, WMR_REAL factor) {
  int i, j;
  if (filter->covariance[0][0] + filter->covariance[1][1] > WMR_C(1e4)) return;
  for (i = 0; i < WMR_SIZE; ++i)
    for (j = 0; j < WMR_SIZE; ++j) filter->covariance[i][j] *= factor;
}

/* Whether it is uncertain by more than 100 m, or no number: start again from the next fix. */
static inline int wmr_filter_is_lost(const wmr_filter *filter) {
  const WMR_REAL area = filter->covariance[0][0] + filter->covariance[1][1];
  for (int i = 0; i < WMR_SIZE; ++i)
    if (!wmr_is_finite(filter->state[i])) return 1;
  return !(area >= WMR_C(0.0) && area <= WMR_C(1e4));
}

/* Uses the position of an antenna `ahead` and `left` of the middle of the wheels [m],
   with a standard deviation of each number. */
static inline int wmr_filter_position(wmr_filter *filter, WMR_REAL x, WMR_REAL y,
                                      WMR_REAL sigma, WMR_REAL ahead, WMR_REAL left,
                                      WMR_REAL gate) {
  WMR_REAL place[2], rows[2 * WMR_SIZE];
  wmr_antenna(filter->state[0], filter->state[1], filter->state[2], ahead, left, place);
  wmr_antenna_rows(filter->state[2], ahead, left, rows);
  place[0] = x - place[0], place[1] = y - place[1];
  return wmr_gated(filter, 2, rows, place, sigma * sigma, gate);
}

/* Uses a heading: a compass's, or that of two antennas less their baseline's angle. */
static inline int wmr_filter_heading(wmr_filter *filter, WMR_REAL heading,
                                     WMR_REAL sigma, WMR_REAL gate) {
  const WMR_REAL zero = WMR_C(0.0), row[WMR_SIZE] = {zero, zero, WMR_C(1.0), zero, zero};
  const WMR_REAL residual = wmr_wrap(heading - filter->state[2]);
  return wmr_gated(filter, 1, row, &residual, sigma * sigma, gate);
}

/* Uses the antenna's course over ground, unless by the wheels' twist the antenna is
   slower than `slowest` [m/s]. */
static inline int wmr_filter_course(wmr_filter *filter, WMR_REAL course, WMR_REAL sigma,
                                    WMR_REAL v, WMR_REAL omega, WMR_REAL ahead,
                                    WMR_REAL left, WMR_REAL slowest, WMR_REAL gate) {
  const WMR_REAL speed = wmr_distance(v - omega * left, omega * ahead);
  if (!(speed >= slowest) || !wmr_is_finite(speed)) return 0;
  course -= wmr_course(WMR_C(0.0), v, omega, ahead, left);
  return wmr_filter_heading(filter, course, sigma, gate);
}

#endif
