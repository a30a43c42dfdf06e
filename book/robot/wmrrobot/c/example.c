/* A drive with wmr_drive.h: a robot's main loop, with arithmetic in place of its hardware.
   cc -std=c99 -Wall -Wextra -Werror example.c -o example -lm && ./example
   -DMY_ROBOT takes the numbers of my_robot.h, and drives them on a simulated robot, plant.h:
   its wheels lag, its fixes err and come late. ./example 7 has other errors than ./example.
   On a robot, -DHARDWARE='"board.h"' names a header with its own nine functions. */
#include <stdint.h>
#include <stdio.h>

#include "wmr_drive.h"

#ifdef MY_ROBOT
#include "my_robot.h"
#else /* one that drives over the paper's two points */
#define MY_PERIOD WMR_C(0.05)
#define MY_ANTENNA_AHEAD WMR_C(0.0)
#define MY_ANTENNA_LEFT WMR_C(0.0)
#define MY_TRACK_WIDTH WMR_C(0.5)
static void my_plan(wmr_plan *plan) {
  const wmr_plan mine = {{0, 0, WMR_C(-1.0471975511965976)},
                         {WMR_C(0.2), WMR_C(2.0), WMR_C(2.0), WMR_C(4.0)},
                         {MY_TRACK_WIDTH, 2, WMR_C(0.1), (WMR_REAL)INFINITY, 0, 0, 0},
                         {WMR_C(0.02), 2, WMR_C(0.2), 1, 2, 0},
                         WMR_USUAL_RULES};
  *plan = mine;
  plan->rules.arrival_radius = WMR_C(0.05);
  plan->rules.battery = WMR_C(22.0);
  wmr_local_position_e7(332735720, 443731600, 332740870, 443732640, &plan->goal.x, &plan->goal.y);
}
#endif
#define PERIOD_MS ((uint32_t)(1000 * MY_PERIOD + WMR_C(0.5))) /* rounded, for the watchdog */
#define COUNT_M WMR_C(0.0005) /* what a wheel rolls in a count of its encoder */
/* periods: then it gives up; so many more than a drive may take, for the waits */
#define MOST (20000 + (long)(plan.rules.longest_drive / MY_PERIOD))

typedef struct {
  wmr_pose pose;      /* of the antenna, from receiver and compass */
  uint32_t time, age; /* ms: of the fix, counted on over midnight, and how long ago that was */
  int quality;        /* NMEA's: 1 to 5 are GPS, differential, PPS and RTK, others no fix */
  WMR_REAL error;     /* m, by the receiver's own word; 0 if it says nothing */
} robot_fix;

#ifdef HARDWARE
#include HARDWARE
#elif defined MY_ROBOT
#include "plant.h"
#else
static wmr_pose robot = {0, 0, WMR_C(1.2566370614359172)};
static WMR_REAL rolled[2] = {0, 0};
static uint32_t now_ms = 1000;

static uint32_t clock_ms(void) { return now_ms; }
static void wait_for_timer(void) { now_ms += PERIOD_MS; } /* until the next period begins */
static void feed_watchdog(void) {}                        /* unfed, it resets the board */
static WMR_REAL battery_volts(void) { return WMR_C(24.0); }
static void cut_power(void) {} /* of the motors: opens their relay, which sets the brakes */

static int is_inside(WMR_REAL x, WMR_REAL y) { /* the fence */
  return -20 < x && x < 30 && -20 < y && y < 80;
}

static int read_fix(robot_fix *fix) { /* 0 when there is nothing new */
  const robot_fix seen = {robot, now_ms, 0, 4, WMR_C(0.02)};
  *fix = seen;
  return 1;
}

static void read_encoders(int32_t *left, int32_t *right) { /* forwards counts up */
  *left = (int32_t)(rolled[0] / COUNT_M + WMR_C(0.5));
  *right = (int32_t)(rolled[1] / COUNT_M + WMR_C(0.5));
}

/* to the wheel loop */
static void set_wheels(wmr_wheels wheels, WMR_REAL seconds) {
  const WMR_REAL left = wheels.left * seconds, right = wheels.right * seconds;
  wmr_carry(&robot, (left + right) / WMR_C(2.0), (right - left) / MY_TRACK_WIDTH);
  rolled[0] += left, rolled[1] += right;
}
#endif

/* What the sensors say. `last` is the time of the last fix that went on; after a second of
   silence a receiver may begin anew. */
static wmr_seen look(wmr_pose goal, uint32_t past_ms, WMR_REAL silence) {
  static uint32_t last = 0;
  static int32_t left = 0, right = 0, counted = 0;
  const uint32_t left_before = (uint32_t)left, right_before = (uint32_t)right;
  robot_fix fix;
  wmr_seen seen = {0};
  read_encoders(&left, &right);
  seen.seconds = WMR_C(0.001) * (WMR_REAL)(int32_t)past_ms; /* a clock that goes back shows */
  if (counted) { /* the first count is only remembered; a counter may begin anew at its end */
    seen.left = COUNT_M * (WMR_REAL)(int32_t)((uint32_t)left - left_before);
    seen.right = COUNT_M * (WMR_REAL)(int32_t)((uint32_t)right - right_before);
  }
  counted = 1;
  seen.battery = battery_volts();
  seen.goal_inside = is_inside(goal.x, goal.y);
  seen.fresh = read_fix(&fix);
  if (!seen.fresh) return seen;
  seen.inside = is_inside(fix.pose.x, fix.pose.y);
  seen.x = fix.pose.x, seen.y = fix.pose.y, seen.heading = fix.pose.heading;
  seen.antenna_ahead = MY_ANTENNA_AHEAD, seen.antenna_left = MY_ANTENNA_LEFT;
  seen.quality = fix.quality, seen.error = fix.error;
  seen.age = WMR_C(0.001) * (WMR_REAL)fix.age;
  seen.later = WMR_C(0.001) * (WMR_REAL)(int32_t)(fix.time - last);
  if (seen.later > 0 || silence > 1) last = fix.time;
  return seen;
}

#ifdef PLANT
int main(int argc, char **argv) {
#else
int main(void) {
#endif
  wmr_plan plan;
  static wmr_memory memory; /* all zeros */
  const wmr_wheels none = {0};
  uint32_t begun = clock_ms() - PERIOD_MS;
  long count;
  int reason = 0;
  my_plan(&plan);
#ifdef PLANT
  plant_begin(&plan, argc > 1 ? argv[1] : "1");
#endif
  for (count = 0; count < MOST && memory.state != WMR_PARKED; ++count) { /* one period each */
    const uint32_t past_ms = clock_ms() - begun;
    const wmr_seen seen = look(plan.goal, past_ms, memory.silence);
    const wmr_wheels wheels = wmr_drive(&memory, &seen, &plan);
    begun += past_ms;
    if (memory.state == WMR_STOPPED) cut_power(); /* until a person switches it on again */
    set_wheels(wheels, MY_PERIOD);
    if (memory.reason != reason) printf("%s\n", wmr_reason(reason = memory.reason));
    if (clock_ms() - begun <= PERIOD_MS) feed_watchdog(); /* only by a turn in time */
    wait_for_timer();
  }
  set_wheels(none, 0);
  cut_power(); /* parked, or out of time */
  printf("%ld %.9f %.9f %.9f\n", count, (double)memory.pose.x, (double)memory.pose.y,
         (double)memory.pose.heading);
#ifdef PLANT
  plant_end(&plan, memory.state);
#endif
  return 0;
}
