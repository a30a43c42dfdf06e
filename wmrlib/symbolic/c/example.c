/* A drive with wmr_law.h: a robot's main loop, with arithmetic in place of motors and a receiver.
   cc -std=c99 -Wall -Wextra -Werror example.c -o example -lm && ./example */
#include <stdio.h>

#include "wmr_law.h"

static wmr_pose robot; /* stands for the hardware */

static int read_pose(wmr_pose *pose) { /* from GPS and compass; 0 when there is nothing new */
  *pose = robot;
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

int main(void) {
  const wmr_gains gains = {WMR_C(0.2), WMR_C(2.0), WMR_C(2.0), WMR_C(4.0)};
  const WMR_REAL track_width = WMR_C(0.5), max_speed = WMR_C(2.0);
  const WMR_REAL arrived = WMR_C(0.05), period = WMR_C(0.05);
  const int patience = 10; /* periods without a new pose, then stop */
  int count, silent = 0;
  wmr_pose goal = {0, 0, WMR_C(-1.0471975511965976)}, pose = {0, 0, WMR_C(1.2566370614359172)};
  wmr_polar error = {0, 0, 0};
  const wmr_wheels stopped = {0, 0, WMR_STOP};

  wmr_local_position_e7(332735720, 443731600, 332740870, 443732640, &goal.x, &goal.y); /* once */
  robot = pose;

  for (count = 0; count < 2000; ++count) { /* each turn one period of the timer */
    wmr_twist twist = {0, 0, WMR_STOP};
    silent = read_pose(&pose) ? 0 : silent + 1;
    error = wmr_polar_error(pose, goal);
    if (error.rho <= arrived) break;
    if (silent < patience) twist = wmr_law(error, gains);
    set_wheels(wmr_limited_wheels(twist, track_width, max_speed), track_width, period);
  }
  set_wheels(stopped, track_width, period);
  printf("%d %.9f %.9f %.9f\n", count, (double)pose.x, (double)pose.y, (double)pose.heading);
  return 0;
}
