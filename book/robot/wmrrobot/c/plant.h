/* plant.h: a simulated robot for example.c, as the sheet of my_robot.h describes it. The sheet does
   not know the lag of its wheels and how its compass shakes. Metres, seconds, radians. */
#ifndef PLANT
#define PLANT
#include <stdlib.h>

#define PLANT_LAG 0.1        /* s, of a wheel */
#define PLANT_SHAKE 0.02     /* rad, of the compass, new in each fix */
#define PLANT_STEP_MS 5u
#define PLANT_PAST 1024      /* steps that are remembered: more than the longest delay */

typedef struct { double x, y, heading; } plant_pose;

static struct {
  const wmr_plan *plan;
  plant_pose past[PLANT_PAST];       /* past[now] is the pose of now */
  unsigned now;
  double wanted[2], speed[2], rolled[2]; /* m/s, m/s, m: left, right */
  double error[2], compass;          /* m, rad */
  uint32_t ms, due, stood;           /* since the start; of the next fix; since when it stands */
  double until;                      /* ms: the end of the period */
  unsigned long chance;
} plant;

static double plant_uniform(void) { /* in (0, 1), by Park and Miller */
  plant.chance = (unsigned long)((unsigned long long)plant.chance * 48271u % 2147483647u);
  return (double)plant.chance / 2147483647.0;
}
static double plant_normal(void) {
  const double size = sqrt(-2.0 * log(plant_uniform()));
  return size * cos(6.283185307179586 * plant_uniform());
}

static uint32_t clock_ms(void) { return 10000u + plant.ms; }
static void feed_watchdog(void) {}
static WMR_REAL battery_volts(void) { return WMR_C(24.0); }
static int is_inside(WMR_REAL x, WMR_REAL y) { return (x - x) + (y - y) == 0; }

static void set_wheels(wmr_wheels wheels, WMR_REAL seconds) {
  (void)seconds;
  plant.wanted[0] = (double)wheels.left, plant.wanted[1] = (double)wheels.right;
}
static void cut_power(void) { plant.wanted[0] = plant.wanted[1] = 0.0; }

static void plant_step(void) {
  const double dt = 0.001 * PLANT_STEP_MS, reach = (double)plant.plan->motors.acceleration * dt;
  plant_pose pose = plant.past[plant.now];
  double ahead, turn;
  for (int side = 0; side < 2; ++side) {
    const double dead = (double)plant.plan->motors.dead_band;
    const double to = fabs(plant.wanted[side]) < dead ? 0.0 : plant.wanted[side];
    const double change = (to - plant.speed[side]) * dt / (PLANT_LAG + dt);
    plant.speed[side] += fmin(fmax(change, -reach), reach);
    plant.rolled[side] += plant.speed[side] * dt;
  }
  ahead = 0.5 * (plant.speed[0] + plant.speed[1]) * dt;
  turn = (plant.speed[1] - plant.speed[0]) * dt / (double)plant.plan->motors.track_width;
  pose.x += ahead * cos(pose.heading + 0.5 * turn);
  pose.y += ahead * sin(pose.heading + 0.5 * turn);
  pose.heading += turn;
  plant.now = (plant.now + 1) % PLANT_PAST, plant.past[plant.now] = pose;
  plant.ms += PLANT_STEP_MS;
  if (fabs(plant.speed[0]) + fabs(plant.speed[1]) > 1e-3) plant.stood = plant.ms;
}
static void wait_for_timer(void) { /* to the nearest step: no error adds up */
  plant.until += 1000.0 * (double)MY_PERIOD;
  while (plant.ms + 0.5 * PLANT_STEP_MS < plant.until) plant_step();
}

static int read_fix(robot_fix *fix) {
  const double every = (double)MY_FIX_PERIOD, delay = (double)MY_DELAY;
  const double keep = MY_MEMORY > 0 ? exp(-every / (double)MY_MEMORY) : 0.0;
  const unsigned late = (unsigned)(1000.0 * delay / PLANT_STEP_MS + 0.5);
  const plant_pose pose = plant.past[(plant.now + PLANT_PAST - late) % PLANT_PAST];
  const double ahead = (double)MY_ANTENNA_AHEAD, left = (double)MY_ANTENNA_LEFT;
  const double east = cos(pose.heading), north = sin(pose.heading);
  if (plant.ms < plant.due) return 0;
  plant.due = plant.ms + (uint32_t)(1000.0 * every + 0.5);
  for (int axis = 0; axis < 2; ++axis)
    plant.error[axis] = keep * plant.error[axis] +
                        sqrt(1.0 - keep * keep) * (double)MY_SIGMA * plant_normal();
  fix->pose.x = (WMR_REAL)(pose.x + ahead * east - left * north + plant.error[0]);
  fix->pose.y = (WMR_REAL)(pose.y + ahead * north + left * east + plant.error[1]);
  fix->pose.heading =
      wmr_wrap((WMR_REAL)(pose.heading + plant.compass + PLANT_SHAKE * plant_normal()));
  fix->age = late * PLANT_STEP_MS, fix->time = clock_ms() - fix->age;
  fix->quality = plant.plan->rules.least, fix->error = MY_SIGMA;
  return 1;
}

static void read_encoders(int32_t *left, int32_t *right) {
  *left = (int32_t)floor(plant.rolled[0] / (double)COUNT_M + 0.5);
  *right = (int32_t)floor(plant.rolled[1] / (double)COUNT_M + 0.5);
}

/* It first faces the goal to within a quarter turn, as in the certificate. */
static void plant_begin(const wmr_plan *plan, const char *seed) {
  const double towards = atan2((double)plan->goal.y, (double)plan->goal.x);
  plant.plan = plan;
  plant.chance = strtoul(seed, NULL, 10) % 1000000u * 2000u + 1u;
  for (int k = 0; k < 20; ++k) plant_uniform(); /* seeds beside each other begin alike */
  for (int axis = 0; axis < 2; ++axis) plant.error[axis] = (double)MY_SIGMA * plant_normal();
  plant.compass = (double)MY_COMPASS_DEG / 57.29577951308232 * plant_normal();
  plant.past[0].heading = towards + 3.141592653589793 * (plant_uniform() - 0.5);
  for (int k = 1; k < PLANT_PAST; ++k) plant.past[k] = plant.past[0];
}

static void plant_end(const wmr_plan *plan, int state) {
  const plant_pose pose = plant.past[plant.now];
  const double turned = pose.heading - (double)plan->goal.heading;
  printf("%s: %.3f m and %.1f deg from the goal, %.1f s\n",
         state == WMR_PARKED ? "parked" : state == WMR_STOPPED ? "stopped" : "on its way",
         hypot(pose.x - (double)plan->goal.x, pose.y - (double)plan->goal.y),
         fabs(remainder(turned, 6.283185307179586)) * 57.29577951308232,
         0.001 * plant.stood);
}

#endif
