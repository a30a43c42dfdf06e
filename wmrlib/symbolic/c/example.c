/* A drive with wmr_law.h: a robot's main loop, with arithmetic in place of its hardware.
   cc -std=c99 -Wall -Wextra -Werror example.c -o example -lm && ./example
   On a robot, -DHARDWARE='"board.h"' names a header with its own five functions. */
#include <stdint.h>
#include <stdio.h>

#include "wmr_law.h"

#define PERIOD_MS 50u
#define OLDEST_MS 300u   /* a fix that is older is not used */
#define PATIENCE_MS 500u /* since the last usable fix, then stop */

typedef struct {
  wmr_pose pose;      /* from receiver and compass */
  uint32_t time, age; /* ms: of the fix, counted on over midnight, and how long ago that was */
  int quality;        /* NMEA's: 1 to 5 are GPS, differential, PPS and RTK, others no fix */
} robot_fix;

#ifdef HARDWARE
#include HARDWARE
#else
static wmr_pose robot = {0, 0, WMR_C(1.2566370614359172)};
static uint32_t now_ms = 0;

static uint32_t clock_ms(void) { return now_ms; }
static void wait_for_timer(void) { now_ms += PERIOD_MS; } /* until the next period begins */
static void feed_watchdog(void) {}                        /* unfed, it resets the board */

static int read_fix(robot_fix *fix) { /* 0 when there is nothing new */
  const robot_fix seen = {robot, now_ms, 0, 4};
  *fix = seen;
  return 1;
}

/* to the wheel loop */
static void set_wheels(wmr_wheels wheels, WMR_REAL track_width, WMR_REAL seconds) {
  const WMR_REAL v = (wheels.left + wheels.right) / WMR_C(2.0);
  const WMR_REAL turn = (wheels.right - wheels.left) / track_width * seconds;
  const WMR_REAL middle = robot.heading + turn / WMR_C(2.0);
  const WMR_REAL chord = v * seconds * wmr_sinc(turn / WMR_C(2.0));
  robot.x += chord * WMR_F(cos)(middle);
  robot.y += chord * WMR_F(sin)(middle);
  robot.heading = wmr_wrap(robot.heading + turn);
}
#endif

/* numbers that are NaN stop wmr_law */
static int is_usable(robot_fix fix) {
  return fix.quality >= 1 && fix.quality <= 5 && fix.age <= OLDEST_MS;
}

/* a frozen receiver repeats the time of its last fix, a confused one goes back */
static int is_later(uint32_t time, uint32_t last_time) {
  return (int32_t)(time - last_time) > 0;
}

int main(void) {
  const wmr_gains gains = {WMR_C(0.2), WMR_C(2.0), WMR_C(2.0), WMR_C(4.0)};
  const WMR_REAL track_width = WMR_C(0.5), max_speed = WMR_C(2.0);
  const WMR_REAL arrived = WMR_C(0.05), period = WMR_C(0.001) * PERIOD_MS;
  int count, has_fix = 0; /* so the wheels wait for the first one */
  uint32_t last_time = 0, seen = 0;
  robot_fix fix;
  wmr_pose goal = {0, 0, WMR_C(-1.0471975511965976)}, pose = {0, 0, 0};
  const wmr_wheels stopped = {0, 0, WMR_STOP};

  wmr_local_position_e7(332735720, 443731600, 332740870, 443732640, &goal.x, &goal.y); /* once */

  for (count = 0; count < 2000; ++count) { /* each turn one period of the timer */
    const uint32_t begin = clock_ms();
    wmr_twist twist = {0, 0, WMR_STOP};
    if (read_fix(&fix) && is_usable(fix) && (!has_fix || is_later(fix.time, last_time))) {
      pose = fix.pose, last_time = fix.time, seen = clock_ms() - fix.age, has_fix = 1;
    }
    if (has_fix && clock_ms() - seen < PATIENCE_MS) {
      const wmr_polar error = wmr_polar_error(pose, goal);
      if (error.rho <= arrived) break;
      twist = wmr_law(error, gains);
    }
    set_wheels(wmr_limited_wheels(twist, track_width, max_speed), track_width, period);
    if (clock_ms() - begin <= PERIOD_MS) feed_watchdog(); /* only by a turn in time */
    wait_for_timer();
  }
  set_wheels(stopped, track_width, period);
  printf("%d %.9f %.9f %.9f\n", count, (double)pose.x, (double)pose.y, (double)pose.heading);
  return 0;
}
