// The checks, the odometry and the decisions of a drive, in periods.
// Printed by book/tools/kit.py from wmrrobot's drive, monitor and odometry: change those.

import { sinc, wrap } from './model.js';

export const WAIT = 0, DRIVE = 1, TURN = 2, PARKED = 3, STOPPED = 4;
const NONE = 0, BROKEN = 1, POOR = 2, LATE = 3, STALE = 4, FROZEN = 5, JUMPED = 6,
    TURNED = 7;
const PAST = 8;
export const REASONS = ['', 'battery low', 'goal outside the fence',
    'robot outside the fence', 'goal too far', 'wheel or encoder stuck',
    'wheel turns untold', 'heading disagrees with wheels',
    'wheels turn and robot stands', 'heading disagrees with course',
    'position outruns the wheels', 'drive too long', 'waited too long', 'clock jumped',
    'fix is no number', 'fix of too low quality', 'fix too old',
    'fix time stands or goes back', 'position frozen', 'position jumped', 'no fix',
    'too few good fixes'];

// What a drive remembers: at first nothing.
export const memory = () => ({ state: 0, reason: 0, pose: { x: 0, y: 0, heading: 0 },
    left: { commanded: 0, speed: 0, due: 0, rolled: 0, stuck: 0, loose: 0 }, right: {
    commanded: 0, speed: 0, due: 0, rolled: 0, stuck: 0, loose: 0 }, regular: 0, low: 0,
    silence: 0, good: 0, refused: 0, near: 0, past: { stretches: Array.from({ length:
    PAST }, () => ({ seconds: 0, ahead: 0, turn: 0 })), newest: 0, since: { seconds: 0,
    ahead: 0, turn: 0 } }, fix: { x: 0, y: 0, heading: 0 }, since: 0, x: 0, y: 0, still:
    0, outside: 0, outran: 0, begin: { x: 0, y: 0, heading: 0 }, leg: { x: 0, y: 0,
    heading: 0 }, length: 0, turning: 0, turned: 0, astray: 0, slipping: 0, driven: 0,
    waited: 0, rho: 0, remaining_turn: 0, facing: 0, faced: 0 });

// Move a pose along the arc that the wheels rolled.
function carry(place, ahead, turn) {
  const chord = ahead * sinc(0.5 * turn);
  place.x += chord * Math.cos(place.heading + 0.5 * turn);
  place.y += chord * Math.sin(place.heading + 0.5 * turn);
  place.heading = wrap(place.heading + turn);
}

// Move a pose ahead and to the left, without a turn.
function shift(place, ahead, left) {
  const east = Math.cos(place.heading);
  const north = Math.sin(place.heading);
  place.x += ahead * east - (left * north);
  place.y += ahead * north + left * east;
}

// Copy the other pose into the first.
function copyPlace(place, other) {
  place.x = other.x;
  place.y = other.y;
  place.heading = other.heading;
}

// Add a period to the history, which reaches back a little over `longest` s.
function remember(past, ahead, turn, dt, longest) {
  if (past.stretches[past.newest].seconds * (PAST - 2) >= longest) {
    past.newest = (past.newest + 1) % PAST;
    past.stretches[past.newest].seconds = 0;
    past.stretches[past.newest].ahead = 0;
    past.stretches[past.newest].turn = 0;
  }
  past.stretches[past.newest].seconds += dt;
  past.stretches[past.newest].ahead += ahead;
  past.stretches[past.newest].turn += turn;
}

// Add the next older stretch to a sum, or its share up to an age [s].
function lengthen(since, stretch, age) {
  const share = Math.min((age - since.seconds) / Math.max(stretch.seconds, 1e-09), 1);
  since.seconds += share * stretch.seconds;
  since.ahead += share * stretch.ahead;
  since.turn += share * stretch.turn;
}

// Add up the distance and the turn of the last `age` s.
function lookBack(past, age) {
  past.since.seconds = 0;
  past.since.ahead = 0;
  past.since.turn = 0;
  for (let k = 0; k < PAST; k += 1) {
    if (past.since.seconds < age) {
      lengthen(past.since, past.stretches[(past.newest + PAST - k) % PAST], age);
    }
  }
}

// The order of NMEA's qualities: RTK float, 5, is worse than RTK fixed, 4; 0 is no fix.
function rank(quality) {
  if (quality < 1 || quality > 5) {
    return 0;
  }
  return (quality < 4) ? quality : (9 - quality);
}

// Carry a fix from the antenna to the middle, and on by the odometry since it was measured.
function bringUp(m, seen) {
  lookBack(m.past, seen.age);
  m.fix.x = seen.x;
  m.fix.y = seen.y;
  m.fix.heading = seen.heading;
  shift(m.fix, -seen.antenna_ahead, -seen.antenna_left);
  carry(m.fix, m.past.since.ahead, m.past.since.turn);
}

// Compare the distance that a wheel rolled with its commands.
function watchWheel(wheel, rolled, dt, rules, wheels) {
  const commanded = (Math.abs(wheel.commanded) < wheels.dead_band) ? 0 :
      wheel.commanded;
  const reach = wheels.acceleration * dt;
  wheel.speed += Math.min(Math.max((commanded - wheel.speed) * dt / (wheels.lag + dt),
      -reach), reach);
  wheel.due += wheel.speed * dt;
  wheel.rolled += rolled;
  if (Math.max(Math.abs(wheel.due), Math.abs(wheel.rolled)) >= rules.wheel) {
    const both = wheel.due * wheel.rolled;
    if (Math.abs(wheel.due) >= Math.abs(wheel.rolled)) {
      wheel.stuck = Number(both < rules.share * wheel.due * wheel.due);
    } else {
      wheel.loose = Number(both < rules.share * wheel.rolled * wheel.rolled);
    }
    wheel.due = 0;
    wheel.rolled = 0;
  }
}

// The reason why a fix cannot be used, or NONE; the fix is carried on to now.
function refusalOf(m, seen, rules) {
  if (!(Math.abs(seen.x) + Math.abs(seen.y) + Math.abs(seen.heading) < 1000000000 &&
      Math.abs(seen.age) < 1000000000)) {
    return BROKEN;
  }
  const good = rank(seen.quality) >= rank(rules.least);
  if (!good || !(seen.error <= rules.largest_error)) {
    return POOR;
  }
  if (seen.age > rules.oldest || seen.age < 0) {
    return LATE;
  }
  bringUp(m, seen);
  if (!(seen.later > 0)) {
    return STALE;
  }
  if (m.still > rules.frozen) {
    return FROZEN;
  }
  const gap = Math.hypot(m.fix.x - m.pose.x, m.fix.y - m.pose.y);
  const jumped = m.refused === JUMPED && m.driven > 0;
  m.near = (gap <= rules.jump + (jumped ? 0 : (rules.slip * m.since))) ? (m.near + 1) :
      0;
  if (m.near === 0 || (jumped && m.near < rules.settle)) {
    return JUMPED;
  }
  if (Math.abs(wrap(m.fix.heading - m.leg.heading)) > rules.astray && m.driven > 0) {
    return TURNED;
  }
  return NONE;
}

// Compare a leg by fixes with the same leg by the wheels, and begin the next leg.
function compare(m, rules) {
  const east = m.leg.x - m.begin.x;
  const north = m.leg.y - m.begin.y;
  const x = m.fix.x - m.begin.x;
  const y = m.fix.y - m.begin.y;
  const rolled = Math.hypot(east, north);
  if (rolled >= rules.course) {
    m.slipping = Number(Math.hypot(x, y) < 0.5 * rolled);
    m.outran = Number(Math.hypot(x, y) > 2 * rolled);
    m.astray = Number(Math.abs(Math.atan2(east * y - (north * x), east * x + north * y))
        > rules.astray);
  }
  const curls = m.length > 4 * rules.course || m.turning > 3;
  if (rolled >= rules.course || curls || m.driven === 0) {
    copyPlace(m.begin, m.fix);
    copyPlace(m.leg, m.fix);
    m.length = 0;
    m.turning = 0;
  }
}

// Use a fix or note why not; before the first drive a jump is a new beginning.
function takeFix(m, seen, rules) {
  if (seen.x !== m.x || seen.y !== m.y) {
    m.still = 0;
  }
  m.x = seen.x;
  m.y = seen.y;
  m.refused = refusalOf(m, seen, rules);
  m.turned = (m.refused === TURNED) ? (m.turned + 1) : 0;
  const first = m.refused === JUMPED && m.driven === 0;
  const again = m.refused === STALE;
  m.good = (first || (m.refused !== NONE && !again)) ? 0 : m.good;
  if (m.refused === NONE || first) {
    m.good += 1;
    m.silence = seen.age;
    m.since = 0;
    m.outside = Number(!seen.inside);
    copyPlace(m.pose, m.fix);
    compare(m, rules);
  }
}

// Check the readings of a period, carry the pose on, and use a new fix.
export function observe(m, seen, rules, wheels) {
  const sound = Math.abs(seen.left) + Math.abs(seen.right) < 1000000000;
  m.regular = Number(seen.seconds > 0 && seen.seconds <= rules.longest_period && sound);
  const passed = (seen.seconds > 0) ? seen.seconds : 0;
  const dt = Math.min(passed, rules.longest_period);
  const left = sound ? seen.left : 0;
  const right = sound ? seen.right : 0;
  const ahead = 0.5 * (left + right);
  const turn = (right - left) / wheels.track_width;
  if (m.regular) {
    watchWheel(m.left, left, dt, rules, wheels);
    watchWheel(m.right, right, dt, rules, wheels);
  }
  carry(m.pose, ahead, turn);
  carry(m.leg, ahead, turn);
  remember(m.past, ahead, turn, dt, rules.oldest);
  m.since += Math.abs(ahead);
  m.still += Math.abs(ahead);
  m.length += Math.abs(ahead);
  m.turning += Math.abs(turn);
  m.silence += passed;
  m.low = (!(seen.battery >= rules.battery)) ? (m.low + dt) : 0;
  m.waited = (m.state === WAIT && m.driven > 0) ? (m.waited + dt) : 0;
  m.driven += (m.state === DRIVE || m.state === TURN) ? dt : 0;
  m.good = (m.regular && m.silence <= rules.patience) ? m.good : 0;
  if (seen.fresh) {
    takeFix(m, seen, rules);
  }
}

// Whether there were enough good fixes to know the pose.
function placed(m, rules) {
  return m.good >= rules.settle || m.driven > 0;
}

// Whether the robot is outside its fence.
function outside(m, rules) {
  return placed(m, rules) && m.outside !== 0;
}

// Whether the goal is too far away to be intended.
function tooFar(m, rules) {
  return placed(m, rules) && m.rho > rules.farthest;
}

// Whether a wheel, or its encoder, stands although it was commanded to roll.
function stuck(m) {
  return m.left.stuck !== 0 || m.right.stuck !== 0;
}

// Whether a wheel rolls although it was not commanded to.
function loose(m) {
  return m.left.loose !== 0 || m.right.loose !== 0;
}

// Whether several fixes in a row have another heading than the wheels.
function turned(m, rules) {
  return m.turned >= rules.settle;
}

// Whether the last usable fix is too long ago.
function silent(m, rules) {
  return m.silence > rules.patience;
}

// Whether it is, and the last fix was refused for this reason.
function silentBy(m, rules, reason) {
  return silent(m, rules) && m.refused === reason;
}

// Note where the goal is, and how long the last turn has been within its tolerance.
export function aim(m, seen, rho, alpha, theta, end) {
  m.rho = rho;
  m.remaining_turn = wrap(alpha - theta);
  const faces = m.state === TURN && Math.abs(m.remaining_turn) <= end.tolerance;
  m.facing = faces ? (m.facing + 1) : 0;
  m.faced = faces ? (m.faced + seen.seconds) : 0;
}

function go(m, state, reason) {
  m.state = state;
  m.reason = reason;
}

// The first row of the table that fits.
export function decide(m, seen, rules, end) {
  if (m.state <= TURN && m.low > rules.patience) return go(m, STOPPED, 1);
  if (m.state <= TURN && seen.goal_inside === 0) return go(m, STOPPED, 2);
  if (m.state <= TURN && outside(m, rules)) return go(m, STOPPED, 3);
  if (m.state <= TURN && tooFar(m, rules)) return go(m, STOPPED, 4);
  if (m.state <= TURN && stuck(m)) return go(m, STOPPED, 5);
  if (m.state <= TURN && loose(m)) return go(m, STOPPED, 6);
  if (m.state <= TURN && turned(m, rules)) return go(m, STOPPED, 7);
  if (m.state <= TURN && m.slipping !== 0) return go(m, STOPPED, 8);
  if (m.state <= TURN && m.astray !== 0) return go(m, STOPPED, 9);
  if (m.state <= TURN && m.outran !== 0) return go(m, STOPPED, 10);
  if (m.state <= TURN && m.driven > rules.longest_drive) return go(m, STOPPED, 11);
  if (m.state <= WAIT && m.waited > rules.longest_wait) return go(m, STOPPED, 12);
  if (m.state <= TURN && m.regular === 0) return go(m, WAIT, 13);
  if (m.state <= TURN && silentBy(m, rules, BROKEN)) return go(m, WAIT, 14);
  if (m.state <= TURN && silentBy(m, rules, POOR)) return go(m, WAIT, 15);
  if (m.state <= TURN && silentBy(m, rules, LATE)) return go(m, WAIT, 16);
  if (m.state <= TURN && silentBy(m, rules, STALE)) return go(m, WAIT, 17);
  if (m.state <= TURN && silentBy(m, rules, FROZEN)) return go(m, WAIT, 18);
  if (m.state <= TURN && silentBy(m, rules, JUMPED)) return go(m, WAIT, 19);
  if (m.state <= TURN && silent(m, rules)) return go(m, WAIT, 20);
  if (m.state <= WAIT && m.good >= rules.settle) return go(m, DRIVE, 0);
  if (m.state <= WAIT && m.good < rules.settle) return go(m, WAIT, 21);
  if (m.state === DRIVE && (m.rho <= rules.arrival_radius && end.tolerance > 0))
      return go(m, TURN, 0);
  if (m.state === DRIVE && m.rho <= rules.arrival_radius) return go(m, PARKED, 0);
  if (m.state === TURN && m.rho > end.leave * rules.arrival_radius) return go(m, DRIVE,
      0);
  if (m.state === TURN && (m.facing >= rules.settle && m.faced >= end.settle))
      return go(m, PARKED, 0);
}
