/* wmr_law.h: from a pose to the speeds of two wheels.
   Printed by python -m wmrlib.symbolic from the formulas of wmrlib: change those.

   C99 or C++11; needs <float.h>, <math.h> and <stdint.h>; no state, no memory, no loop.
   Metres, seconds, radians. x is east, y is north, and headings and turns are
   counter-clockwise, a heading from east.

   #define WMR_REAL float before the #include for a processor without doubles. GPS
   points come as doubles (wmr_local_position) or as integers of 1e-7 degrees
   (wmr_local_position_e7), as UBX sends them; where a double has 4 bytes, as on
   AVR, only as integers.

   An argument that is NaN, infinite or out of range, or a result that is not finite,
   gives v = omega = 0 and status WMR_STOP; only a max_speed may be infinite. Compile
   without -ffast-math or -ffinite-math-only, which remove such checks.

   SPDX-License-Identifier: BSD-3-Clause */
#ifndef WMR_LAW_H
#define WMR_LAW_H

#include <float.h>
#include <math.h>
#include <stdint.h>

#if defined(__FAST_MATH__) || defined(_M_FP_FAST) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "wmr_law.h needs NaN and infinity: compile without -ffast-math or /fp:fast"
#endif

#ifndef WMR_REAL
#define WMR_REAL double
#endif
#define WMR_IS_double 1
#define WMR_IS_float 2
#define WMR_PASTE_(a, b) a##b
#define WMR_PASTE(a, b) WMR_PASTE_(a, b)
#if WMR_PASTE(WMR_IS_, WMR_REAL) == 1
#define WMR_C(number) number
#define WMR_F(function) function
#elif WMR_PASTE(WMR_IS_, WMR_REAL) == 2
#define WMR_C(number) number##F
#define WMR_F(function) function##f
#else
#error "WMR_REAL must be float or double"
#endif

enum { WMR_OK = 0, WMR_STOP = 1 };

typedef struct { WMR_REAL x, y, heading; } wmr_pose;
typedef struct { WMR_REAL rho, alpha, theta; } wmr_polar;
/* 1/m (aicardi: 1/s), 1/s (graceful: no unit), no unit: all 0 or more; m/s: above 0 (even
   for aicardi) */
typedef struct { WMR_REAL k_rho, k_alpha, h, v_max; } wmr_gains;
typedef struct { WMR_REAL v, omega; int status; } wmr_twist;
typedef struct { WMR_REAL left, right; int status; } wmr_wheels;

/* exp(x) - 1 by Kahan's formula, since not every library has expm1: the rounding of u
   is in the numerator and in the denominator. */
static inline WMR_REAL wmr_expm1(WMR_REAL x) {
  const WMR_REAL u = WMR_F(exp)(x), above_1 = u - WMR_C(1.0);
  if (above_1 == WMR_C(0.0)) return x;
  return above_1 == WMR_C(-1.0) ? above_1 : above_1 * x / WMR_F(log)(u);
}

/* sin(angle)/angle, which is 1 at 0 */
static inline WMR_REAL wmr_sinc(WMR_REAL angle) {
  return ((WMR_F(fabs)(angle) > WMR_C(1e-08)) ? ( WMR_F(sin)(angle)/angle ) : (
      WMR_C(1.0) ));
}

/* (1 - exp(-k_rho rho))/rho, which is k_rho at rho = 0 */
static inline WMR_REAL wmr_decay(WMR_REAL rho, WMR_REAL k_rho) {
  return ((k_rho * WMR_F(fabs)(rho) > WMR_C(1e-08)) ? ( -wmr_expm1(-k_rho * rho)/rho ) :
      ( k_rho * (-WMR_C(0.5) * k_rho * rho + WMR_C(1.0)) ));
}

/* an angle within a turn of 0 */
static inline WMR_REAL wmr_turned_back(WMR_REAL angle) {
  return ((angle > WMR_C(3.14159265358979323846)) ? ( angle - WMR_C(2.0) *
      WMR_C(3.14159265358979323846) ) : ((angle <= -WMR_C(3.14159265358979323846)) ? (
      angle + WMR_C(2.0) * WMR_C(3.14159265358979323846) ) : ( angle )));
}

/* the same direction in (-pi, pi]; in float it loses 2e-7 rad with each whole turn */
static inline WMR_REAL wmr_wrap(WMR_REAL angle) {
  return ((angle <= WMR_C(3.14159265358979323846) && angle >
      -WMR_C(3.14159265358979323846)) ? ( angle ) : ( wmr_turned_back(WMR_F(fmod)(angle,
      WMR_C(2.0) * WMR_C(3.14159265358979323846))) ));
}

/* V, (18) */
static inline WMR_REAL wmr_lyapunov_value(WMR_REAL rho, WMR_REAL alpha, WMR_REAL theta,
      WMR_REAL h, WMR_REAL L) {
  return WMR_C(0.5) * (alpha * alpha) + WMR_C(0.5) * h * (theta * theta) + WMR_C(0.5) *
      (rho * rho)/L;
}

/* theta to be used, up to pi + hysteresis; before: the last result, NaN if there is
   none */
static inline WMR_REAL wmr_keep_branch(WMR_REAL theta, WMR_REAL before,
      WMR_REAL hysteresis) {
  const WMR_REAL part0 = theta + WMR_C(6.283185307179586) *
      WMR_F(floor)(WMR_C(0.15915494309189535) * before - WMR_C(0.15915494309189535) *
      theta + WMR_C(0.5));
  return ((WMR_F(fabs)(part0) < hysteresis + WMR_C(3.141592653589793)) ? ( part0 ) : (
      theta ));
}

/* omega of a turn on the spot by an error that is left */
static inline WMR_REAL wmr_turn_rate(WMR_REAL error, WMR_REAL gain, WMR_REAL min_rate,
      WMR_REAL max_rate) {
  const WMR_REAL part0 = gain * WMR_F(fabs)(error);
  const WMR_REAL part1 = ((min_rate > part0) ? ( min_rate ) : ((max_rate < part0) ? (
      max_rate ) : ( part0 )));
  return ((error < WMR_C(0.0)) ? ( -part1 ) : ( part1 ));
}

/* rho */
static inline WMR_REAL wmr_distance(WMR_REAL east, WMR_REAL north) {
  return WMR_F(sqrt)((east * east) + (north * north));
}

/* the line of sight, from east */
static inline WMR_REAL wmr_sight(WMR_REAL east, WMR_REAL north) {
  return WMR_F(atan2)(north, east);
}

/* ground speed, from (1) and (2) */
static inline WMR_REAL wmr_left_wheel(WMR_REAL v, WMR_REAL omega, WMR_REAL b) {
  return -WMR_C(0.5) * b * omega + v;
}

/* ground speed, from (1) and (2) */
static inline WMR_REAL wmr_right_wheel(WMR_REAL v, WMR_REAL omega, WMR_REAL b) {
  return WMR_C(0.5) * b * omega + v;
}

/* the factor on it for a min_speed */
static inline WMR_REAL wmr_hurry(WMR_REAL v, WMR_REAL alpha, WMR_REAL min_speed) {
  const WMR_REAL part0 = min_speed * WMR_F(fabs)(v) * WMR_F(fabs)(WMR_F(cos)(alpha))/((v
      * v) + WMR_C(1e-24));
  return ((part0 < WMR_C(1.0)) ? ( WMR_C(1.0) ) : ((part0 > WMR_C(1000000000.0)) ? (
      WMR_C(1000000000.0) ) : ( part0 )));
}

/* speed of the faster wheel */
static inline WMR_REAL wmr_fastest_wheel(WMR_REAL v, WMR_REAL omega, WMR_REAL b) {
  return WMR_C(0.5) * b * WMR_F(fabs)(omega) + WMR_F(fabs)(v);
}

/* the factor on the twist for a max_speed */
static inline WMR_REAL wmr_saturation_scale(WMR_REAL max_speed, WMR_REAL fastest) {
  return ((fastest > max_speed) ? ( max_speed/fastest ) : ( WMR_C(1.0) ));
}

/* (11) to (13) */
static inline WMR_REAL wmr_sphere_distance(WMR_REAL lat1, WMR_REAL lat2,
      WMR_REAL Delta_lat, WMR_REAL Delta_long, WMR_REAL R) {
  const WMR_REAL part0 = WMR_C(0.5) * Delta_long;
  const WMR_REAL part1 = WMR_F(cos)(lat1) * WMR_F(cos)(lat2);
  return WMR_C(2.0) * R * WMR_F(atan2)(WMR_F(sqrt)(part1 * (WMR_F(sin)(part0) *
      WMR_F(sin)(part0)) + (WMR_F(sin)(WMR_C(0.5) * Delta_lat) * WMR_F(sin)(WMR_C(0.5) *
      Delta_lat))), WMR_F(sqrt)(part1 * (WMR_F(cos)(part0) * WMR_F(cos)(part0)) +
      (WMR_F(sin)(WMR_C(0.5) * lat1 + WMR_C(0.5) * lat2) * WMR_F(sin)(WMR_C(0.5) * lat1
      + WMR_C(0.5) * lat2))));
}

/* (15) to (17) */
static inline WMR_REAL wmr_bearing(WMR_REAL lat1, WMR_REAL lat2, WMR_REAL Delta_lat,
      WMR_REAL Delta_long) {
  const WMR_REAL part0 = WMR_F(cos)(lat2);
  return WMR_F(atan2)(part0 * WMR_F(sin)(Delta_long), WMR_C(2.0) * part0 *
      (WMR_F(sin)(WMR_C(0.5) * Delta_long) * WMR_F(sin)(WMR_C(0.5) * Delta_long)) *
      WMR_F(sin)(lat1) + WMR_F(sin)(Delta_lat));
}

static inline int wmr_is_finite(WMR_REAL number) {
  return number - number == WMR_C(0.0);
}

static inline int wmr_is_size(WMR_REAL number) {
  return number >= WMR_C(0.0) && wmr_is_finite(number);
}

/* The goal as seen from the robot: rho, and the line of sight from the robot's heading,
   alpha, and from the goal's, theta. */
static inline wmr_polar wmr_polar_error(wmr_pose pose, wmr_pose goal) {
  const WMR_REAL east = goal.x - pose.x, north = goal.y - pose.y;
  const WMR_REAL sight = wmr_sight(east, north);
  const wmr_polar error = {wmr_distance(east, north), wmr_wrap(sight - pose.heading),
                           wmr_wrap(sight - goal.heading)};
  return error;
}

/* The twist if all of it can be trusted, and otherwise a stop. */
static inline wmr_twist wmr_checked(wmr_polar error, wmr_gains gains, WMR_REAL v,
                                    WMR_REAL omega) {
  const wmr_twist stop = {WMR_C(0.0), WMR_C(0.0), WMR_STOP};
  const wmr_twist twist = {v, omega, WMR_OK};
  const int known = wmr_is_size(error.rho) && wmr_is_finite(error.alpha) &&
                    wmr_is_finite(error.theta);
  const int tuned =
      wmr_is_size(gains.k_rho) && wmr_is_size(gains.k_alpha) && wmr_is_size(gains.h);
  const int fast = wmr_is_size(gains.v_max) && gains.v_max > WMR_C(0.0);
  const int finite = wmr_is_finite(v) && wmr_is_finite(omega);
  return known && tuned && fast && finite ? twist : stop;
}

/* (22), and the omega that the proof needs */
static inline wmr_twist wmr_law(wmr_polar error, wmr_gains gains) {
  const WMR_REAL rho = error.rho, alpha = error.alpha, theta = error.theta;
  const WMR_REAL k_rho = gains.k_rho, k_alpha = gains.k_alpha, h = gains.h,
      v_max = gains.v_max;
  const WMR_REAL v_over_rho = v_max * WMR_F(cos)(alpha) * wmr_decay(rho, k_rho);
  const WMR_REAL omega = alpha * k_alpha + v_over_rho * (alpha + h * theta) *
      wmr_sinc(alpha);
  return wmr_checked(error, gains, rho * v_over_rho, omega);
}

/* (22) and (24) as the paper prints them */
static inline wmr_twist wmr_law_printed(wmr_polar error, wmr_gains gains) {
  const WMR_REAL rho = error.rho, alpha = error.alpha, theta = error.theta;
  const WMR_REAL k_rho = gains.k_rho, k_alpha = gains.k_alpha, h = gains.h,
      v_max = gains.v_max;
  const WMR_REAL v_over_rho = v_max * WMR_F(cos)(alpha) * wmr_decay(rho, k_rho);
  const WMR_REAL omega = alpha * k_alpha + v_over_rho * (alpha + h * theta) *
      WMR_F(sin)(alpha) * WMR_F(cos)(alpha) * wmr_sinc(alpha);
  return wmr_checked(error, gains, rho * v_over_rho, omega);
}

/* Aicardi et al. (1995), without a speed limit */
static inline wmr_twist wmr_law_aicardi(wmr_polar error, wmr_gains gains) {
  const WMR_REAL rho = error.rho, alpha = error.alpha, theta = error.theta;
  const WMR_REAL k_rho = gains.k_rho, k_alpha = gains.k_alpha, h = gains.h;
  const WMR_REAL v_over_rho = k_rho * WMR_F(cos)(alpha);
  const WMR_REAL omega = alpha * k_alpha + v_over_rho * (alpha + h * theta) *
      wmr_sinc(alpha);
  return wmr_checked(error, gains, rho * v_over_rho, omega);
}

/* after Todorovski et al. (2025): never crosses half a turn of alpha or theta */
static inline wmr_twist wmr_law_barrier(wmr_polar error, wmr_gains gains) {
  const WMR_REAL rho = error.rho, alpha = error.alpha, theta = error.theta;
  const WMR_REAL k_rho = gains.k_rho, k_alpha = gains.k_alpha, h = gains.h,
      v_max = gains.v_max;
  const WMR_REAL v_over_rho = v_max * WMR_F(cos)(alpha) * wmr_decay(rho, k_rho);
  const WMR_REAL omega = k_alpha * WMR_F(sin)(alpha) + v_over_rho * (WMR_C(2.0) * h *
      (WMR_C(0.25) * WMR_F(cos)(alpha) + WMR_C(0.25)) * (WMR_F(cos)(alpha) + WMR_C(1.0))
      * WMR_F(sin)(WMR_C(0.5) * theta)/WMR_F(pow)(WMR_F(cos)(WMR_C(0.5) * theta),
      WMR_C(3.0)) + WMR_F(sin)(alpha));
  return wmr_checked(error, gains, rho * v_over_rho, omega);
}

/* Park and Kuipers (2011), as in Nav2: k_alpha is their k_delta, h their k_phi */
static inline wmr_twist wmr_law_graceful(wmr_polar error, wmr_gains gains) {
  const WMR_REAL rho = error.rho, alpha = error.alpha, theta = error.theta;
  const WMR_REAL k_rho = gains.k_rho, k_alpha = gains.k_alpha, h = gains.h,
      v_max = gains.v_max;
  const WMR_REAL v_over_rho = v_max * wmr_decay(rho, k_rho);
  const WMR_REAL omega = v_over_rho * (k_alpha * (alpha + WMR_F(atan)(h * theta)) +
      (h/((h * h) * (theta * theta) + WMR_C(1.0)) + WMR_C(1.0)) * WMR_F(sin)(alpha));
  return wmr_checked(error, gains, rho * v_over_rho, omega);
}

/* The ground speeds of the wheels, track_width apart: as fast as the twist asks, or
   both scaled by one factor so that neither is faster than max_speed and the path keeps
   its curvature. track_width and max_speed are above 0; a max_speed of INFINITY is no
   limit. */
static inline wmr_wheels wmr_limited_wheels(wmr_twist twist, WMR_REAL track_width,
                                            WMR_REAL max_speed) {
  const wmr_wheels stop = {WMR_C(0.0), WMR_C(0.0), WMR_STOP};
  const WMR_REAL fastest = wmr_fastest_wheel(twist.v, twist.omega, track_width);
  const WMR_REAL scale = wmr_saturation_scale(max_speed, fastest);
  const WMR_REAL v = scale * twist.v, omega = scale * twist.omega;
  const wmr_wheels wheels = {wmr_left_wheel(v, omega, track_width),
                             wmr_right_wheel(v, omega, track_width), WMR_OK};
  const int allowed =
      twist.status == WMR_OK && track_width > WMR_C(0.0) && max_speed > WMR_C(0.0);
  const int finite = wmr_is_finite(wheels.left) && wmr_is_finite(wheels.right);
  return allowed && finite ? wheels : stop;
}

/* A point in metres east and north of an origin on a sphere, by their latitudes and the
   differences of latitude and of longitude, all in degrees. */
static inline void wmr_offset(WMR_REAL lat_0, WMR_REAL lat, WMR_REAL dlat,
                              WMR_REAL dlon, WMR_REAL *east, WMR_REAL *north) {
  const WMR_REAL degree = WMR_C(0.01745329251994329577);
  const WMR_REAL lat1 = lat_0 * degree, lat2 = lat * degree, dlong = dlon * degree;
  const WMR_REAL bearing = wmr_bearing(lat1, lat2, dlat * degree, dlong);
  const WMR_REAL rho =
      wmr_sphere_distance(lat1, lat2, dlat * degree, dlong, WMR_C(6371000.0));
  *east = rho * WMR_F(sin)(bearing);
  *north = rho * WMR_F(cos)(bearing);
}

/* A point in metres east and north of an origin, for example of the start; both in 1e-7
   degrees (11 mm). The integers are subtracted exactly, and then floats will do: a
   float alone holds a latitude of 44 degrees to 4e-6 degrees, which is 0.4 m. Both are
   NaN, which stops the law, if a point is not on the Earth: no fix yet, or latitude and
   longitude mixed up. */
static inline void wmr_local_position_e7(int32_t lat_0, int32_t lon_0, int32_t lat,
                                         int32_t lon, WMR_REAL *east,
                                         WMR_REAL *north) {
  const int32_t pole = 900000000, date_line = 1800000000;
  const int known = -pole <= lat_0 && lat_0 <= pole && -pole <= lat && lat <= pole &&
                    -date_line <= lon_0 && lon_0 <= date_line && -date_line <= lon &&
                    lon <= date_line;
  const int64_t eastward = (int64_t)lon - lon_0, turn = 2 * (int64_t)date_line;
  const int64_t dlon = eastward > date_line    ? eastward - turn
                       : eastward < -date_line ? eastward + turn
                                               : eastward;
  const WMR_REAL unit = WMR_C(1e-7);
  wmr_offset((WMR_REAL)lat_0 * unit, (WMR_REAL)lat * unit,
             known ? (WMR_REAL)(lat - lat_0) * unit : (WMR_REAL)NAN,
             (WMR_REAL)dlon * unit, east, north);
}

#if DBL_MANT_DIG < 53
#define wmr_local_position(lat_0, lon_0, lat, lon, east, north) \
  a_double_has_4_bytes_here_call_wmr_local_position_e7
#else
static inline int wmr_on_earth(double lat, double lon) {
  return fabs(lat) <= 90.0 && fabs(lon) <= 180.0;
}

/* The same for degrees. */
static inline void wmr_local_position(double lat_0, double lon_0, double lat,
                                      double lon, WMR_REAL *east, WMR_REAL *north) {
  const int known = wmr_on_earth(lat_0, lon_0) && wmr_on_earth(lat, lon);
  const double eastward = lon - lon_0;
  const double dlon =
      fabs(eastward) > 180.0 ? eastward - copysign(360.0, eastward) : eastward;
  wmr_offset((WMR_REAL)lat_0, (WMR_REAL)lat,
             known ? (WMR_REAL)(lat - lat_0) : (WMR_REAL)NAN, (WMR_REAL)dlon, east,
             north);
}
#endif

#endif
