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
enum { WMR_WAIT, WMR_DRIVE, WMR_TURN, WMR_PARKED, WMR_STOPPED };
enum { WMR_NONE, WMR_BROKEN, WMR_POOR, WMR_LATE, WMR_STALE, WMR_FROZEN, WMR_JUMPED,
    WMR_TURNED };
enum { WMR_FINE, WMR_BATTERY_LOW, WMR_GOAL_OUTSIDE_THE_FENCE,
    WMR_ROBOT_OUTSIDE_THE_FENCE, WMR_GOAL_TOO_FAR, WMR_WHEEL_OR_ENCODER_STUCK,
    WMR_WHEEL_TURNS_UNTOLD, WMR_HEADING_DISAGREES_WITH_WHEELS,
    WMR_WHEELS_TURN_AND_ROBOT_STANDS, WMR_HEADING_DISAGREES_WITH_COURSE,
    WMR_POSITION_OUTRUNS_THE_WHEELS, WMR_DRIVE_TOO_LONG, WMR_WAITED_TOO_LONG,
    WMR_CLOCK_JUMPED, WMR_FIX_IS_NO_NUMBER, WMR_FIX_OF_TOO_LOW_QUALITY, WMR_FIX_TOO_OLD,
    WMR_FIX_TIME_STANDS_OR_GOES_BACK, WMR_POSITION_FROZEN, WMR_POSITION_JUMPED,
    WMR_NO_FIX, WMR_TOO_FEW_GOOD_FIXES };
enum { WMR_PAST = 8 };

/* what Python's Wheels, LastTurn, Rules, Seen, Wheel and Memory say of their fields */
typedef struct { WMR_REAL track_width; WMR_REAL max_speed; WMR_REAL min_speed;
    WMR_REAL acceleration; WMR_REAL lag; WMR_REAL dead_band; WMR_REAL encoder_step; }
    wmr_motors;
typedef struct { WMR_REAL tolerance; WMR_REAL gain; WMR_REAL min_rate;
    WMR_REAL max_rate; WMR_REAL leave; WMR_REAL settle; } wmr_last_turn;
typedef struct { WMR_REAL arrival_radius; WMR_REAL patience; WMR_REAL oldest;
    WMR_REAL largest_error; int least; int settle; WMR_REAL jump; WMR_REAL slip;
    WMR_REAL frozen; WMR_REAL course; WMR_REAL astray; WMR_REAL wheel; WMR_REAL share;
    WMR_REAL longest_period; WMR_REAL longest_drive; WMR_REAL longest_wait;
    WMR_REAL farthest; WMR_REAL battery; } wmr_rules;
typedef struct { WMR_REAL seconds; WMR_REAL left; WMR_REAL right; WMR_REAL battery;
    int goal_inside; int inside; int fresh; WMR_REAL x; WMR_REAL y; WMR_REAL heading;
    WMR_REAL antenna_ahead; WMR_REAL antenna_left; int quality; WMR_REAL error;
    WMR_REAL later; WMR_REAL age; } wmr_seen;
typedef struct { WMR_REAL commanded; WMR_REAL speed; WMR_REAL due; WMR_REAL rolled;
    int stuck; int loose; } wmr_wheel;
typedef struct { WMR_REAL seconds; WMR_REAL ahead; WMR_REAL turn; } wmr_stretch;
typedef struct { wmr_stretch stretches[WMR_PAST]; int newest; wmr_stretch since; }
    wmr_past;
typedef struct { int state; int reason; wmr_pose pose; wmr_wheel left; wmr_wheel right;
    int regular; WMR_REAL low; WMR_REAL silence; int good; int refused; int near;
    wmr_past past; wmr_pose fix; WMR_REAL since; WMR_REAL x; WMR_REAL y; WMR_REAL still;
    int outside; int outran; wmr_pose begin; wmr_pose leg; WMR_REAL length;
    WMR_REAL turning; int turned; int astray; int slipping; WMR_REAL driven;
    WMR_REAL waited; WMR_REAL rho; WMR_REAL remaining_turn; int facing; WMR_REAL faced;
    } wmr_memory;
typedef struct {
  wmr_pose goal;
  wmr_gains gains;
  wmr_motors motors;
  wmr_last_turn end; /* a tolerance of 0 is none */
  wmr_rules rules;
} wmr_plan;

/* the rules that Python has unless it is told others */
#define WMR_USUAL_RULES {WMR_C(0.2), WMR_C(0.5), WMR_C(0.3), WMR_C(1.0), 1, 3, \
    WMR_C(1.0), WMR_C(0.2), WMR_C(0.3), WMR_C(4.0), WMR_C(0.8), WMR_C(0.48), \
    WMR_C(0.25), WMR_C(0.15), WMR_C(300.0), WMR_C(60.0), WMR_C(500.0), WMR_C(0.0)}

/* The reason in words. */
static inline const char *wmr_reason(int reason) {
  static const char *const words[] = {
    "",
    "battery low",
    "goal outside the fence",
    "robot outside the fence",
    "goal too far",
    "wheel or encoder stuck",
    "wheel turns untold",
    "heading disagrees with wheels",
    "wheels turn and robot stands",
    "heading disagrees with course",
    "position outruns the wheels",
    "drive too long",
    "waited too long",
    "clock jumped",
    "fix is no number",
    "fix of too low quality",
    "fix too old",
    "fix time stands or goes back",
    "position frozen",
    "position jumped",
    "no fix",
    "too few good fixes"
  };
  return reason >= 0 && reason < (int)(sizeof words / sizeof *words) ? words[reason] : "";
}

/* Move a pose along the arc that the wheels rolled. */
static inline void wmr_carry(wmr_pose *place, WMR_REAL ahead, WMR_REAL turn) {
  const WMR_REAL chord = ahead * wmr_sinc(WMR_C(0.5) * turn);
  place->x += chord * WMR_F(cos)(place->heading + WMR_C(0.5) * turn);
  place->y += chord * WMR_F(sin)(place->heading + WMR_C(0.5) * turn);
  place->heading = wmr_wrap(place->heading + turn);
}

/* Move a pose ahead and to the left, without a turn. */
static inline void wmr_shift(wmr_pose *place, WMR_REAL ahead, WMR_REAL left) {
  const WMR_REAL east = WMR_F(cos)(place->heading);
  const WMR_REAL north = WMR_F(sin)(place->heading);
  place->x += ahead * east - (left * north);
  place->y += ahead * north + left * east;
}

/* Copy the other pose into the first. */
static inline void wmr_copy_place(wmr_pose *place, wmr_pose *other) {
  place->x = other->x;
  place->y = other->y;
  place->heading = other->heading;
}

/* Add a period to the history, which reaches back a little over `longest` s. */
static inline void wmr_remember(wmr_past *past, WMR_REAL ahead, WMR_REAL turn,
    WMR_REAL dt, WMR_REAL longest) {
  if (past->stretches[past->newest].seconds * (WMR_PAST - 2) >= longest) {
    past->newest = (past->newest + 1) % WMR_PAST;
    past->stretches[past->newest].seconds = WMR_C(0.0);
    past->stretches[past->newest].ahead = WMR_C(0.0);
    past->stretches[past->newest].turn = WMR_C(0.0);
  }
  past->stretches[past->newest].seconds += dt;
  past->stretches[past->newest].ahead += ahead;
  past->stretches[past->newest].turn += turn;
}

/* Add the next older stretch to a sum, or its share up to an age [s]. */
static inline void wmr_lengthen(wmr_stretch *since, wmr_stretch *stretch, WMR_REAL age)
    {
  const WMR_REAL share = WMR_F(fmin)((age - since->seconds) /
      WMR_F(fmax)(stretch->seconds, WMR_C(1e-09)), WMR_C(1.0));
  since->seconds += share * stretch->seconds;
  since->ahead += share * stretch->ahead;
  since->turn += share * stretch->turn;
}

/* Add up the distance and the turn of the last `age` s. */
static inline void wmr_look_back(wmr_past *past, WMR_REAL age) {
  past->since.seconds = WMR_C(0.0);
  past->since.ahead = WMR_C(0.0);
  past->since.turn = WMR_C(0.0);
  for (int k = 0; k < WMR_PAST; k += 1) {
    if (past->since.seconds < age) {
      wmr_lengthen(&past->since, &past->stretches[(past->newest + WMR_PAST - k) %
          WMR_PAST], age);
    }
  }
}

/* The order of NMEA's qualities: RTK float, 5, is worse than RTK fixed, 4; 0 is no fix. */
static inline int wmr_rank(int quality) {
  if (quality < 1 || quality > 5) {
    return 0;
  }
  return (quality < 4) ? quality : (9 - quality);
}

/* Carry a fix from the antenna to the middle, and on by the odometry since it was measured. */
static inline void wmr_bring_up(wmr_memory *m, const wmr_seen *seen) {
  wmr_look_back(&m->past, seen->age);
  m->fix.x = seen->x;
  m->fix.y = seen->y;
  m->fix.heading = seen->heading;
  wmr_shift(&m->fix, -seen->antenna_ahead, -seen->antenna_left);
  wmr_carry(&m->fix, m->past.since.ahead, m->past.since.turn);
}

/* Compare the distance that a wheel rolled with its commands. */
static inline void wmr_watch_wheel(wmr_wheel *wheel, WMR_REAL rolled, WMR_REAL dt,
    const wmr_rules *rules, const wmr_motors *wheels) {
  const WMR_REAL commanded = (WMR_F(fabs)(wheel->commanded) < wheels->dead_band) ?
      WMR_C(0.0) : wheel->commanded;
  const WMR_REAL reach = wheels->acceleration * dt;
  wheel->speed += WMR_F(fmin)(WMR_F(fmax)((commanded - wheel->speed) * dt / (wheels->lag
      + dt), -reach), reach);
  wheel->due += wheel->speed * dt;
  wheel->rolled += rolled;
  if (WMR_F(fmax)(WMR_F(fabs)(wheel->due), WMR_F(fabs)(wheel->rolled)) >= rules->wheel)
      {
    const WMR_REAL both = wheel->due * wheel->rolled;
    if (WMR_F(fabs)(wheel->due) >= WMR_F(fabs)(wheel->rolled)) {
      wheel->stuck = both < rules->share * wheel->due * wheel->due;
    } else {
      wheel->loose = both < rules->share * wheel->rolled * wheel->rolled;
    }
    wheel->due = WMR_C(0.0);
    wheel->rolled = WMR_C(0.0);
  }
}

/* The reason why a fix cannot be used, or NONE; the fix is carried on to now. */
static inline int wmr_refusal_of(wmr_memory *m, const wmr_seen *seen,
    const wmr_rules *rules) {
  if (!(WMR_F(fabs)(seen->x) + WMR_F(fabs)(seen->y) + WMR_F(fabs)(seen->heading) <
      WMR_C(1000000000.0) && WMR_F(fabs)(seen->age) < WMR_C(1000000000.0))) {
    return WMR_BROKEN;
  }
  const int good = wmr_rank(seen->quality) >= wmr_rank(rules->least);
  if (!good || !(seen->error <= rules->largest_error)) {
    return WMR_POOR;
  }
  if (seen->age > rules->oldest || seen->age < WMR_C(0.0)) {
    return WMR_LATE;
  }
  wmr_bring_up(m, seen);
  if (!(seen->later > WMR_C(0.0))) {
    return WMR_STALE;
  }
  if (m->still > rules->frozen) {
    return WMR_FROZEN;
  }
  const WMR_REAL gap = wmr_distance(m->fix.x - m->pose.x, m->fix.y - m->pose.y);
  const int jumped = m->refused == WMR_JUMPED && m->driven > WMR_C(0.0);
  m->near = (gap <= rules->jump + (jumped ? WMR_C(0.0) : (rules->slip * m->since))) ?
      (m->near + 1) : 0;
  if (m->near == 0 || (jumped && m->near < rules->settle)) {
    return WMR_JUMPED;
  }
  if (WMR_F(fabs)(wmr_wrap(m->fix.heading - m->leg.heading)) > rules->astray &&
      m->driven > WMR_C(0.0)) {
    return WMR_TURNED;
  }
  return WMR_NONE;
}

/* Compare a leg by fixes with the same leg by the wheels, and begin the next leg. */
static inline void wmr_compare(wmr_memory *m, const wmr_rules *rules) {
  const WMR_REAL east = m->leg.x - m->begin.x;
  const WMR_REAL north = m->leg.y - m->begin.y;
  const WMR_REAL x = m->fix.x - m->begin.x;
  const WMR_REAL y = m->fix.y - m->begin.y;
  const WMR_REAL rolled = wmr_distance(east, north);
  if (rolled >= rules->course) {
    m->slipping = wmr_distance(x, y) < WMR_C(0.5) * rolled;
    m->outran = wmr_distance(x, y) > WMR_C(2.0) * rolled;
    m->astray = WMR_F(fabs)(WMR_F(atan2)(east * y - (north * x), east * x + north * y))
        > rules->astray;
  }
  const int curls = m->length > WMR_C(4.0) * rules->course || m->turning > WMR_C(3.0);
  if (rolled >= rules->course || curls || m->driven == WMR_C(0.0)) {
    wmr_copy_place(&m->begin, &m->fix);
    wmr_copy_place(&m->leg, &m->fix);
    m->length = WMR_C(0.0);
    m->turning = WMR_C(0.0);
  }
}

/* Use a fix or note why not; before the first drive a jump is a new beginning. */
static inline void wmr_take_fix(wmr_memory *m, const wmr_seen *seen,
    const wmr_rules *rules) {
  if (seen->x != m->x || seen->y != m->y) {
    m->still = WMR_C(0.0);
  }
  m->x = seen->x;
  m->y = seen->y;
  m->refused = wmr_refusal_of(m, seen, rules);
  m->turned = (m->refused == WMR_TURNED) ? (m->turned + 1) : 0;
  const int first = m->refused == WMR_JUMPED && m->driven == WMR_C(0.0);
  const int again = m->refused == WMR_STALE;
  m->good = (first || (m->refused != WMR_NONE && !again)) ? 0 : m->good;
  if (m->refused == WMR_NONE || first) {
    m->good += 1;
    m->silence = seen->age;
    m->since = WMR_C(0.0);
    m->outside = !seen->inside;
    wmr_copy_place(&m->pose, &m->fix);
    wmr_compare(m, rules);
  }
}

/* Check the readings of a period, carry the pose on, and use a new fix. */
static inline void wmr_observe(wmr_memory *m, const wmr_seen *seen,
    const wmr_rules *rules, const wmr_motors *wheels) {
  const int sound = WMR_F(fabs)(seen->left) + WMR_F(fabs)(seen->right) <
      WMR_C(1000000000.0);
  m->regular = seen->seconds > WMR_C(0.0) && seen->seconds <= rules->longest_period &&
      sound;
  const WMR_REAL passed = (seen->seconds > WMR_C(0.0)) ? seen->seconds : WMR_C(0.0);
  const WMR_REAL dt = WMR_F(fmin)(passed, rules->longest_period);
  const WMR_REAL left = sound ? seen->left : WMR_C(0.0);
  const WMR_REAL right = sound ? seen->right : WMR_C(0.0);
  const WMR_REAL ahead = WMR_C(0.5) * (left + right);
  const WMR_REAL turn = (right - left) / wheels->track_width;
  if (m->regular) {
    wmr_watch_wheel(&m->left, left, dt, rules, wheels);
    wmr_watch_wheel(&m->right, right, dt, rules, wheels);
  }
  wmr_carry(&m->pose, ahead, turn);
  wmr_carry(&m->leg, ahead, turn);
  wmr_remember(&m->past, ahead, turn, dt, rules->oldest);
  m->since += WMR_F(fabs)(ahead);
  m->still += WMR_F(fabs)(ahead);
  m->length += WMR_F(fabs)(ahead);
  m->turning += WMR_F(fabs)(turn);
  m->silence += passed;
  m->low = (!(seen->battery >= rules->battery)) ? (m->low + dt) : WMR_C(0.0);
  m->waited = (m->state == WMR_WAIT && m->driven > WMR_C(0.0)) ? (m->waited + dt) :
      WMR_C(0.0);
  m->driven += (m->state == WMR_DRIVE || m->state == WMR_TURN) ? dt : WMR_C(0.0);
  m->good = (m->regular && m->silence <= rules->patience) ? m->good : 0;
  if (seen->fresh) {
    wmr_take_fix(m, seen, rules);
  }
}

/* Whether there were enough good fixes to know the pose. */
static inline int wmr_placed(wmr_memory *m, const wmr_rules *rules) {
  return m->good >= rules->settle || m->driven > WMR_C(0.0);
}

/* Whether the robot is outside its fence. */
static inline int wmr_outside(wmr_memory *m, const wmr_rules *rules) {
  return wmr_placed(m, rules) && m->outside != 0;
}

/* Whether the goal is too far away to be intended. */
static inline int wmr_too_far(wmr_memory *m, const wmr_rules *rules) {
  return wmr_placed(m, rules) && m->rho > rules->farthest;
}

/* Whether a wheel, or its encoder, stands although it was commanded to roll. */
static inline int wmr_stuck(wmr_memory *m) {
  return m->left.stuck != 0 || m->right.stuck != 0;
}

/* Whether a wheel rolls although it was not commanded to. */
static inline int wmr_loose(wmr_memory *m) {
  return m->left.loose != 0 || m->right.loose != 0;
}

/* Whether several fixes in a row have another heading than the wheels. */
static inline int wmr_turned(wmr_memory *m, const wmr_rules *rules) {
  return m->turned >= rules->settle;
}

/* Whether the last usable fix is too long ago. */
static inline int wmr_silent(wmr_memory *m, const wmr_rules *rules) {
  return m->silence > rules->patience;
}

/* Whether it is, and the last fix was refused for this reason. */
static inline int wmr_silent_by(wmr_memory *m, const wmr_rules *rules, int reason) {
  return wmr_silent(m, rules) && m->refused == reason;
}

/* Note where the goal is, and how long the last turn has been within its tolerance. */
static inline void wmr_aim(wmr_memory *m, const wmr_seen *seen, WMR_REAL rho,
    WMR_REAL alpha, WMR_REAL theta, const wmr_last_turn *end) {
  m->rho = rho;
  m->remaining_turn = wmr_wrap(alpha - theta);
  const int faces = m->state == WMR_TURN && WMR_F(fabs)(m->remaining_turn) <=
      end->tolerance;
  m->facing = faces ? (m->facing + 1) : 0;
  m->faced = faces ? (m->faced + seen->seconds) : WMR_C(0.0);
}


/* The first row of the table that fits. */
static inline void wmr_decide(wmr_memory *m, const wmr_seen *seen, const wmr_rules *rules,
                              const wmr_last_turn *end) {
  if (m->state <= WMR_TURN && m->low > rules->patience) {
    m->state = WMR_STOPPED, m->reason = WMR_BATTERY_LOW;
    return;
  }
  if (m->state <= WMR_TURN && seen->goal_inside == 0) {
    m->state = WMR_STOPPED, m->reason = WMR_GOAL_OUTSIDE_THE_FENCE;
    return;
  }
  if (m->state <= WMR_TURN && wmr_outside(m, rules)) {
    m->state = WMR_STOPPED, m->reason = WMR_ROBOT_OUTSIDE_THE_FENCE;
    return;
  }
  if (m->state <= WMR_TURN && wmr_too_far(m, rules)) {
    m->state = WMR_STOPPED, m->reason = WMR_GOAL_TOO_FAR;
    return;
  }
  if (m->state <= WMR_TURN && wmr_stuck(m)) {
    m->state = WMR_STOPPED, m->reason = WMR_WHEEL_OR_ENCODER_STUCK;
    return;
  }
  if (m->state <= WMR_TURN && wmr_loose(m)) {
    m->state = WMR_STOPPED, m->reason = WMR_WHEEL_TURNS_UNTOLD;
    return;
  }
  if (m->state <= WMR_TURN && wmr_turned(m, rules)) {
    m->state = WMR_STOPPED, m->reason = WMR_HEADING_DISAGREES_WITH_WHEELS;
    return;
  }
  if (m->state <= WMR_TURN && m->slipping != 0) {
    m->state = WMR_STOPPED, m->reason = WMR_WHEELS_TURN_AND_ROBOT_STANDS;
    return;
  }
  if (m->state <= WMR_TURN && m->astray != 0) {
    m->state = WMR_STOPPED, m->reason = WMR_HEADING_DISAGREES_WITH_COURSE;
    return;
  }
  if (m->state <= WMR_TURN && m->outran != 0) {
    m->state = WMR_STOPPED, m->reason = WMR_POSITION_OUTRUNS_THE_WHEELS;
    return;
  }
  if (m->state <= WMR_TURN && m->driven > rules->longest_drive) {
    m->state = WMR_STOPPED, m->reason = WMR_DRIVE_TOO_LONG;
    return;
  }
  if (m->state <= WMR_WAIT && m->waited > rules->longest_wait) {
    m->state = WMR_STOPPED, m->reason = WMR_WAITED_TOO_LONG;
    return;
  }
  if (m->state <= WMR_TURN && m->regular == 0) {
    m->state = WMR_WAIT, m->reason = WMR_CLOCK_JUMPED;
    return;
  }
  if (m->state <= WMR_TURN && wmr_silent_by(m, rules, WMR_BROKEN)) {
    m->state = WMR_WAIT, m->reason = WMR_FIX_IS_NO_NUMBER;
    return;
  }
  if (m->state <= WMR_TURN && wmr_silent_by(m, rules, WMR_POOR)) {
    m->state = WMR_WAIT, m->reason = WMR_FIX_OF_TOO_LOW_QUALITY;
    return;
  }
  if (m->state <= WMR_TURN && wmr_silent_by(m, rules, WMR_LATE)) {
    m->state = WMR_WAIT, m->reason = WMR_FIX_TOO_OLD;
    return;
  }
  if (m->state <= WMR_TURN && wmr_silent_by(m, rules, WMR_STALE)) {
    m->state = WMR_WAIT, m->reason = WMR_FIX_TIME_STANDS_OR_GOES_BACK;
    return;
  }
  if (m->state <= WMR_TURN && wmr_silent_by(m, rules, WMR_FROZEN)) {
    m->state = WMR_WAIT, m->reason = WMR_POSITION_FROZEN;
    return;
  }
  if (m->state <= WMR_TURN && wmr_silent_by(m, rules, WMR_JUMPED)) {
    m->state = WMR_WAIT, m->reason = WMR_POSITION_JUMPED;
    return;
  }
  if (m->state <= WMR_TURN && wmr_silent(m, rules)) {
    m->state = WMR_WAIT, m->reason = WMR_NO_FIX;
    return;
  }
  if (m->state <= WMR_WAIT && m->good >= rules->settle) {
    m->state = WMR_DRIVE, m->reason = WMR_FINE;
    return;
  }
  if (m->state <= WMR_WAIT && m->good < rules->settle) {
    m->state = WMR_WAIT, m->reason = WMR_TOO_FEW_GOOD_FIXES;
    return;
  }
  if (m->state == WMR_DRIVE && m->rho <= rules->arrival_radius && end->tolerance >
      WMR_C(0.0)) {
    m->state = WMR_TURN, m->reason = WMR_FINE;
    return;
  }
  if (m->state == WMR_DRIVE && m->rho <= rules->arrival_radius) {
    m->state = WMR_PARKED, m->reason = WMR_FINE;
    return;
  }
  if (m->state == WMR_TURN && m->rho > end->leave * rules->arrival_radius) {
    m->state = WMR_DRIVE, m->reason = WMR_FINE;
    return;
  }
  if (m->state == WMR_TURN && m->facing >= rules->settle && m->faced >= end->settle) {
    m->state = WMR_PARKED, m->reason = WMR_FINE;
    return;
  }
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
