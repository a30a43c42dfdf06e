/* The frame of wmr_drive.h: wmrrobot puts what it prints where the @ signs are. */
/* wmr_drive.h: a state machine round wmr_law.h: it drives while its sensors agree.
   Printed by python -m wmrrobot from wmrrobot's drive and monitor: change those.

   A robot waits for good fixes, drives, turns on the spot, and has parked; whatever is wrong
   with a sensor, a wheel, the clock or the goal makes it wait until that is over, or stop until
   a person resets it. One wmr_memory, all zeros at first, is all that it keeps.

   #define WMR_DRIVE_LAW to another of wmr_law.h's laws before the #include.

   SPDX-License-Identifier: BSD-3-Clause */
#ifndef WMR_DRIVE_H
#define WMR_DRIVE_H

#include "wmr_law.h"

#ifndef WMR_DRIVE_LAW
#define WMR_DRIVE_LAW wmr_law
#endif

/* states, why a fix is not used, and why the robot waits or has stopped */
/* @NAMES@ */

/* what Python's Wheels, LastTurn, Rules, Seen, Wheel and Memory say of their fields */
/* @STRUCTURES@ */
typedef struct {
  wmr_pose goal;
  wmr_gains gains;
  wmr_motors motors;
  wmr_last_turn end; /* a tolerance of 0 is none */
  wmr_rules rules;
} wmr_plan;

/* the rules that Python has unless it is told others */
/* @USUAL@ */

/* The reason in words. */
static inline const char *wmr_reason(int reason) {
  static const char *const words[] = {
/* @REASONS@ */
  };
  return reason >= 0 && reason < (int)(sizeof words / sizeof *words) ? words[reason] : "";
}

/* @FUNCTIONS@ */

/* The first row of the table that fits. */
static inline void wmr_decide(wmr_memory *m, const wmr_seen *seen, const wmr_rules *rules,
                              const wmr_last_turn *end) {
/* @TABLE@ */
}

/* The speeds of the wheels for the next period. */
static inline wmr_wheels wmr_drive(wmr_memory *m, const wmr_seen *seen, const wmr_plan *plan) {
  const wmr_last_turn *end = &plan->end;
  wmr_twist twist = {WMR_C(0.0), WMR_C(0.0), WMR_OK};
  wmr_polar error;
  wmr_wheels wheels;
  wmr_observe(m, seen, &plan->rules, &plan->motors);
  error = wmr_polar_error(m->pose, plan->goal);
  wmr_aim(m, seen, error.rho, error.alpha, error.theta, end);
  wmr_decide(m, seen, &plan->rules, end);
  if (m->state == WMR_DRIVE) {
    twist = WMR_DRIVE_LAW(error, plan->gains);
    if (plan->motors.min_speed > WMR_C(0.0)) {
      const WMR_REAL more = wmr_hurry(twist.v, error.alpha, plan->motors.min_speed);
      twist.v *= more, twist.omega *= more;
    }
  } else if (m->state == WMR_TURN && WMR_F(fabs)(m->remaining_turn) > end->tolerance) {
    twist.omega = wmr_turn_rate(m->remaining_turn, end->gain, end->min_rate, end->max_rate);
  }
  wheels = wmr_limited_wheels(twist, plan->motors.track_width, plan->motors.max_speed);
  m->left.commanded = wheels.left, m->right.commanded = wheels.right;
  return wheels;
}

#endif
