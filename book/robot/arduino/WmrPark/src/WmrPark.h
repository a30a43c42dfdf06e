// WmrPark.h: parks a robot by wmr_drive.h and wmr_filter.h, on boards with an AVR.
// Metres, seconds, radians; x is east, headings are counter-clockwise from east.
// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "WmrParts.h"
#include "wmr_drive.h"
#include "wmr_filter.h"

// Inlined, they would need their stack at the same time.
#define WMR_APART __attribute__((noinline))

// Where the robot is, by the filter, and what its wheels are to do, by the drive.
class Pilot {
 public:
  wmr_plan plan;
  wmr_noise noise;
  wmr_memory memory;  // all zeros at first
  wmr_filter filter;
  int32_t lat, lon;          // of the origin, degrees * 1e7
  float delay, compass;      // s, rad: of the receiver's fixes, and the compass's error
  float ahead, left;         // m: the antenna, from the middle between the wheels
  float fence;               // m round the rectangle of origin and goal
  void (*meanwhile)();       // called where a fix takes long, to empty the UART's buffer

  void start(int32_t start_lat, int32_t start_lon) { lat = start_lat, lon = start_lon; }

  // First in a period: what the wheels rolled.
  WMR_APART void roll(float seconds, float rolled, float right) {
    const float dt = seconds > 0 ? seconds : 1;
    seen = wmr_seen();
    seen.seconds = seconds, seen.left = rolled, seen.right = right;
    v = (rolled + right) / 2 / dt;
    if (begun)
      wmr_filter_predict(&filter, v, (right - rolled) / plan.motors.track_width / dt, NAN, dt,
                         noise, WMR_GATE_1);
  }

  // Then, if there is one, a fix; heading is NaN if the compass is silent.
  WMR_APART void fix(const Pvt &pvt, float heading) {
    const int32_t later = (int32_t)(pvt.time - last);
    wmr_local_position_e7(lat, lon, pvt.lat, pvt.lon, &seen.x, &seen.y);
    seen.fresh = 1, seen.heading = heading, seen.quality = pvt.quality, seen.error = pvt.error;
    seen.later = 0.001f * (float)later, seen.inside = inside(seen.x, seen.y);
    if (later > 0 || memory.silence > 1) last = pvt.time;
    const float sigma = fmax(pvt.error, 0.01f);
    const bool good = wmr_rank(pvt.quality) >= wmr_rank(plan.rules.least) &&
                      pvt.error <= plan.rules.largest_error;
    if (!good || later <= 0 || !(fabs(heading) < 4 && fabs(seen.x) < 1e6f)) return;
    if (!begun) {
      wmr_pose pose = {seen.x, seen.y, heading};
      wmr_shift(&pose, -ahead, -left);
      filter = wmr_filter_start(pose, sigma, compass, 0.01f, 0.02f), begun = true;
    } else {
      // The compass errs by the same all the time: many readings say little more than one.
      wmr_filter_heading(&filter, heading, 8 * compass, WMR_GATE_1);
      meanwhile();
      refused = use(sigma) ? 0 : refused + 1;
      if (refused >= PATIENT) wmr_filter_doubt(&filter, 4);  // it may be the filter that errs
      if (refused && wmr_filter_is_lost(&filter)) begun = false;  // the next fix begins anew
    }
    seen.fresh = !refused;
    seen.x = filter.state[0], seen.y = filter.state[1], seen.heading = filter.state[2];
  }

  // Last: the wheels' speeds.
  WMR_APART wmr_wheels drive(float volts) {
    seen.battery = volts, seen.goal_inside = inside(plan.goal.x, plan.goal.y);
    return wmr_drive(&memory, &seen, &plan);
  }

 private:
  enum { PATIENT = 5 };
  wmr_seen seen;
  float v;
  uint32_t last;
  uint8_t refused;
  bool begun;

  // The antenna is where the fix was `delay` ago.
  bool use(float sigma) {
    return wmr_filter_position(&filter, seen.x, seen.y, sigma, ahead - v * delay, left, WMR_GATE_2);
  }

  int inside(float x, float y) const {
    const float east = plan.goal.x, north = plan.goal.y;
    return fmin(0, east) - fence <= x && x <= fmax(0, east) + fence &&
           fmin(0, north) - fence <= y && y <= fmax(0, north) + fence;
  }
};
