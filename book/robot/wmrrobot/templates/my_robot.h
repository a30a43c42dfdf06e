/* my_robot.h: one robot's numbers, for example.c and for the Arduino sketch.
   Metres, seconds, radians; x is east of the start, headings are counter-clockwise from east. */
#ifndef MY_ROBOT_H
#define MY_ROBOT_H

#include "wmr_drive.h"

/* Degrees * 1e7. wmr_local_position_e7(MY_START_E7, lat, lon, &x, &y) is the place of a fix. */
#define MY_START_E7 @robot.start_lat_e7@, @robot.start_lon_e7@
#define MY_GOAL_E7 @robot.goal_lat_e7@, @robot.goal_lon_e7@
#define MY_PERIOD WMR_C(@robot.period@) /* of the loop: longest step @sheet.longest_step@ s */
#define MY_TRACK_WIDTH WMR_C(@wheels.track_width@)
#define MY_MAX_SPEED WMR_C(@wheels.max_speed@)
#define MY_ACCELERATION WMR_C(@wheels.acceleration@)

/* The antenna, from the middle between the wheels: wmr_seen takes both with each fix. */
#define MY_ANTENNA_AHEAD WMR_C(@robot.antenna_ahead@)
#define MY_ANTENNA_LEFT WMR_C(@robot.antenna_left@)

/* What the numbers presume of the receiver, and of the compass in degrees. */
#define MY_DELAY WMR_C(@robot.delay@)
#define MY_SIGMA WMR_C(@robot.sigma@)
#define MY_MEMORY WMR_C(@robot.memory@)
#define MY_FIX_PERIOD WMR_C(@robot.fix_period@)
#define MY_COMPASS_DEG WMR_C(@robot.compass@)

/* All that wmr_drive is told. */
static inline void my_plan(wmr_plan *plan) {
  wmr_local_position_e7(MY_START_E7, MY_GOAL_E7, &plan->goal.x, &plan->goal.y);
  plan->goal.heading = WMR_C(@sheet.heading@);

  plan->gains.k_rho = WMR_C(@gains.k_rho@);
  plan->gains.k_alpha = WMR_C(@gains.k_alpha@);
  plan->gains.h = WMR_C(@gains.h@);
  plan->gains.v_max = WMR_C(@gains.v_max@);

  plan->motors.track_width = MY_TRACK_WIDTH;
  plan->motors.max_speed = MY_MAX_SPEED;
  plan->motors.min_speed = WMR_C(@wheels.min_speed@); /* over the dead band */
  plan->motors.acceleration = MY_ACCELERATION;
  plan->motors.lag = WMR_C(@wheels.lag@);
  plan->motors.dead_band = WMR_C(@wheels.dead_band@);
  plan->motors.encoder_step = WMR_C(@wheels.encoder_step@);

  /* within the arrival radius it turns on the spot until it has faced the goal so long */
  plan->end.tolerance = WMR_C(@turn.tolerance@);
  plan->end.gain = WMR_C(@turn.gain@);
  plan->end.min_rate = WMR_C(@turn.min_rate@);
  plan->end.max_rate = WMR_C(@turn.max_rate@);
  plan->end.leave = WMR_C(@turn.leave@);
  plan->end.settle = WMR_C(@turn.settle@); /* s, for the heading is seen late */

  /* the checks: Rules in Python says what they mean */
  plan->rules.arrival_radius = WMR_C(@rules.arrival_radius@);
  plan->rules.patience = WMR_C(@rules.patience@);
  plan->rules.oldest = WMR_C(@rules.oldest@);
  plan->rules.largest_error = WMR_C(@rules.largest_error@);
  plan->rules.least = (int)@rules.least@; /* NMEA's quality: 4 is RTK fixed */
  plan->rules.settle = (int)@rules.settle@; /* fixes */
  plan->rules.jump = WMR_C(@rules.jump@);
  plan->rules.slip = WMR_C(@rules.slip@);
  plan->rules.frozen = WMR_C(@rules.frozen@);
  plan->rules.course = WMR_C(@rules.course@);
  plan->rules.astray = WMR_C(@rules.astray@);
  plan->rules.wheel = WMR_C(@rules.wheel@);
  plan->rules.share = WMR_C(@rules.share@);
  plan->rules.longest_period = WMR_C(@rules.longest_period@);
  plan->rules.longest_drive = WMR_C(@rules.longest_drive@);
  plan->rules.longest_wait = WMR_C(@rules.longest_wait@);
  plan->rules.farthest = WMR_C(@rules.farthest@);
  plan->rules.battery = WMR_C(@rules.battery@); /* V; 0 is none */
}

#endif
