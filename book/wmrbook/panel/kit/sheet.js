// A robot's sheet: what it is told, and where it parks, run by run. The rules and their numbers are
// those of wmrrobot/sheets.py, which come with the panel as `rules`.

import { DEGREES } from './style.js';
import { DRIVE, PARKED, TURN, aim, decide, memory, observe } from './drive.js';
import {
  arcStep, correctedLaw, fastestWheel, hurry, polarFromPose, roll, saturationScale, turnRate, wrap,
} from './model.js';
import { atRest } from './simulate.js';
import { notAllowed } from './setup.js';
import { median } from './numbers.js';
import { normals } from './random.js';

const digits = (value, count = 6) => String(Number(value.toPrecision(count)));

// East and north of the start, m, as wmrlib's local_position.
/** @param {Point} start @param {Point} goal @param {number} earth */
export function placeOf([lat, lon], [lat2, lon2], earth) {
  const [from, to, up, across] =
      [lat, lat2, lat2 - lat, lon2 - lon].map((degrees) => degrees / DEGREES);
  const side = Math.sin(across / 2) ** 2,
      e = Math.sin(up / 2) ** 2 + Math.cos(from) * Math.cos(to) * side;
  const east = Math.cos(to) * Math.sin(across),
      north = Math.sin(up) + 2 * Math.sin(from) * Math.cos(to) * side;
  const share = 2 * earth * Math.atan2(Math.sqrt(e), Math.sqrt(1 - e))
      / (Math.hypot(east, north) || 1);
  return [share * east, share * north];
}

// How far the antenna is from the middle between the wheels, m.
/** @param {Values} robot */
const armOf = ({ antenna_ahead: ahead, antenna_left: left }) => Math.hypot(ahead, left);

/** @param {Values} robot @param {Values} rules */
function checkedPlace(robot, { far, earth }) {
  const start = [robot.start_lat, robot.start_lon], goal = [robot.goal_lat, robot.goal_lon];
  const place = placeOf(start, goal, earth), apart = Math.hypot(...place);
  if (apart <= far) return place;
  const swapped = placeOf(start, [Math.min(goal[1], 90), goal[0]], earth);
  throw new RangeError(`the points are ${(apart / 1000).toFixed(0)} km apart: at most ${far / 1000}`
    + ' km is allowed' + (Math.hypot(...swapped) <= far
      ? '; are latitude and longitude of one of them swapped?' : ''));
}

/**
 * What the robot is told, as `sheet` of wmrrobot/sheets.py; throws RangeError, which names what is
 * wrong. @param {Values} robot @param {Values} rules
 */
export function sheetOf(robot, rules) {
  for (const [name, [low, high, unit]] of Object.entries(rules.bounds))
    if (!(robot[name] >= low && robot[name] <= high)
        || (name === 'quality' && robot[name] % 1)) {
      const kind = name === 'quality' ? 'whole number' : 'number';
      const { message } = notAllowed(name, digits(robot[name]),
          `a ${kind} from ${low} to ${high} ${unit}`.trimEnd());
      throw new RangeError(message
        + (name.endsWith('_lat') ? ': are latitude and longitude swapped?' : ''));
    }
  const [x, y] = checkedPlace(robot, rules), { kappa, h } = rules.shape,
      { max_speed: speed, dead_band: dead, acceleration, track_width: width, delay } = robot;
  const late = delay + robot.period, distance = Math.hypot(x, y);
  if (dead > speed / 2)
    throw notAllowed('dead_band', digits(dead), `at most half of max_speed, ${digits(speed / 2)},`);
  const keep = robot.memory ? Math.exp(-2 * rules.fresh / robot.memory) : 0,
      minSpeed = rules.moves * dead, vMax = rules.spare * speed;
  const swing = armOf(robot) * robot.compass / DEGREES,
      radius = Math.max(rules.nearest, robot.sigma * Math.sqrt(1 - keep),
          minSpeed * (late + robot.fix_period), rules.swing * swing);
  if (distance < 4 * radius)
    throw new RangeError(`the points are ${digits(distance, 3)} m apart: at least `
      + `${digits(4 * radius, 3)} m, four times the arrival radius, is needed`);
  const braking = 2 * acceleration / width, // rad/s^2
      step = rules.step / Math.max(5 * robot.period, 2 * late, delay + robot.fix_period),
      agile = Math.sqrt(braking / Math.PI) / kappa;
  const rate = Math.min(rules.brake * vMax / radius, acceleration / vMax, step, agile);
  const minRate = Math.max(0.1, 2 * rules.moves * dead / width),
      maxRate = Math.max(minRate, Math.min(1, speed / width)),
      tolerance = Math.max(0.02, minRate * late + minRate ** 2 / (2 * braking));
  const gain = Math.min(2, 0.5 / late, braking / maxRate);
  if (tolerance > rules.coarse) {
    const [guilty, others] = minRate * delay > 0.5 * tolerance ? ['delay', 'dead band']
        : ['dead_band', 'delay'];
    const { message } = notAllowed(guilty, digits(robot[guilty]),
        `a last turn within ${(rules.coarse * DEGREES).toFixed(0)} deg`);
    throw new RangeError(`${message}; with this width, acceleration and ${others} it is `
      + `${(tolerance * DEGREES).toFixed(0)} deg`);
  }
  const oldest = delay + rules.margin, { usual } = rules,
      error = Math.hypot(robot.sigma, swing, rules.scatter * vMax * delay),
      aged = rules.margin * Math.min(acceleration * robot.fix_period, speed),
      lost = Math.max(0, rules.side * robot.compass / DEGREES - usual.slip) * vMax
        * robot.fix_period,
      jump = Math.max(rules.close, rules.steady * error + aged + lost);
  const k = rate / vMax, near = (rho) => Math.log1p(-Math.exp(-k * rho)),
      travel = (k * (distance - radius) + near(distance) - near(radius)) / rate,
      duration = Math.ceil(60 + 2 * travel);
  return { x, y, heading: wrap((90 - robot.bearing) / DEGREES), distance, radius,
      gains: { k_rho: k, k_alpha: kappa * rate, h, v_max: vMax },
      longest_step: rules.step / rate,
      wheels: { track_width: width, max_speed: speed, min_speed: minSpeed, acceleration, lag: 0,
        dead_band: dead, encoder_step: 0 },
      turn: { tolerance, gain, min_rate: minRate, max_rate: maxRate, leave: rules.leave,
        settle: late + Math.max(minRate, gain * tolerance) / braking },
      duration, rules: { ...usual, arrival_radius: radius, oldest,
        patience: oldest + 2 * Math.max(robot.fix_period, robot.period),
        largest_error: Math.max(radius, 3 * robot.sigma), least: robot.quality, jump,
        course: Math.max(rules.leg, 3 * jump),
        longest_period: Math.max(usual.longest_period, 1.5 * robot.period),
        longest_drive: Math.max(usual.longest_drive, duration),
        farthest: Math.max(usual.farthest, 2 * distance) } };
}

// The sensors of a robot in a run: wrong and late, by fixes that are new in some of the samples.
function sensorsOf(robot, { seed, streams, scatter }, run) {
  const { sigma, memory: lasting, period: dt, antenna_ahead: ahead, antenna_left: left } = robot;
  const [every, late] = [robot.fix_period, robot.delay]
      .map((seconds) => Math.ceil(seconds / dt - 1e-9));
  const period = Math.max(every, 1), past = [],
      off = robot.compass / DEGREES * normals(run, 0, seed, streams.compass)[0];
  const seen = { seconds: dt, left: 0, right: 0, battery: Infinity, goal_inside: 1, inside: 1,
    fresh: 0, x: 0, y: 0, heading: 0, antenna_ahead: ahead, antenna_left: left,
    quality: robot.quality, error: sigma, later: 0, age: 0 };
  let fix = -1, error = [0, 0];
  return (k, pose, rolled) => {
    past.push(pose);
    const now = Math.max(Math.floor(k / period) * period - late, 0);
    [seen.left, seen.right] = rolled;
    seen.fresh = Number(now > fix);
    if (!seen.fresh) return seen;
    if (sigma) {
      const age = fix < 0 ? Infinity : (now - fix) * dt / lasting, keep = Math.exp(-age),
          share = Math.sqrt(-Math.expm1(-2 * age)), fresh = normals(run, now, seed);
      error = error.map((old, i) => keep * old + share * fresh[i]);
    }
    const [x, y, heading] = past[now], east = Math.cos(heading), north = Math.sin(heading);
    seen.x = x + ahead * east - left * north + sigma * error[0];
    seen.y = y + ahead * north + left * east + sigma * error[1];
    seen.heading = wrap(heading + off + scatter * normals(run, now, seed, streams.scatter)[0]);
    seen.later = dt * (now - fix);
    seen.age = dt * (k - now);
    fix = now;
    return seen;
  };
}

// The speeds of the wheels, as `commanded` of wmrrobot/steering.py.
function commanded(m, polar, { gains, wheels, turn }) {
  const [rho, alpha, theta] = polar;
  let v = 0, omega = 0;
  if (m.state === DRIVE) {
    [v, omega] = correctedLaw(rho, alpha, theta, gains);
    const more = hurry(v * rho, alpha, wheels.min_speed);
    [v, omega] = [v * rho * more, omega * more];
  } else if (m.state === TURN && Math.abs(m.remaining_turn) > turn.tolerance)
    omega = turnRate(m.remaining_turn, turn.gain, turn.min_rate, turn.max_rate);
  const scale = saturationScale(wheels.max_speed, fastestWheel(v, omega, wheels.track_width));
  return wheelsOf(scale * v, scale * omega, wheels.track_width);
}

const wheelsOf = (v, omega, width) => [v - omega * width / 2, v + omega * width / 2];

// One run until the robot stands, parked or stopped, as `trial` of wmrrobot/trials.py: where it
// ends, seen from the goal, m and rad; infinitely far if it has not parked in time.
export function parkedRun(robot, told, rules, run) {
  const { wheels, turn } = told, { track_width: width, period: dt } = robot,
      longest = told.rules.longest_drive + told.rules.longest_wait,
      samples = Math.floor(longest / dt + 1e-9) + 1,
      look = sensorsOf(robot, rules, run), m = memory();
  let pose = [0, 0, wrap(Math.atan2(told.y, told.x) + Math.PI * ((run * rules.golden) % 1 - 0.5))],
      body = [0, 0, 0, 0], rolled = [0, 0];
  for (let k = 0; k < samples; k++) {
    const seen = look(k, pose, rolled);
    observe(m, seen, told.rules, wheels);
    const polar = polarFromPose(m.pose.x, m.pose.y, m.pose.heading, told.x, told.y, told.heading);
    aim(m, seen, polar[0], polar[1], polar[2], turn);
    decide(m, seen, told.rules, turn);
    const [left, right] = commanded(m, polar, told);
    m.left.commanded = left;
    m.right.commanded = right;
    if (m.state >= PARKED && atRest(body)) {
      if (m.state !== PARKED) break;
      const [x, y] = [pose[0] - told.x, pose[1] - told.y], turned = wrap(pose[2] - told.heading);
      return { at: [x, y, pose[2]], time: k * dt, place: Math.hypot(x, y),
          heading: Math.abs(turned) };
    }
    const [v, omega, ...after] = roll((left + right) / 2, (right - left) / width, body[0], body[1],
        body[2], body[3], width, wheels.acceleration, rules.lag, wheels.dead_band, 0, dt);
    body = after;
    rolled = wheelsOf(dt * v, dt * omega, width);
    pose = arcStep(pose[0], pose[1], pose[2], v, omega, dt);
  }
  return { place: Infinity, heading: Infinity, time: Infinity };
}

// Which of the runs' sorted values is the bound, as `sure` of wmrrobot/sheets.py.
export function sure(runs, share) {
  let chance = share ** runs, total = chance, beyond = 0;
  while (total <= 1 - share) {
    chance *= (runs - beyond) / (beyond + 1) * (1 - share) / share;
    beyond += 1;
    total += chance;
  }
  return runs - beyond + 1;
}

// What the runs amount to, as `certificate`.
export function certified(ends, { share }) {
  const parked = ends.filter(({ time }) => Number.isFinite(time)), least = sure(ends.length, share);
  const sorted = (name) => Float64Array.from(ends, (end) => end[name]).sort();
  const rms = (name) => (parked.length
    ? Math.sqrt(parked.reduce((sum, end) => sum + end[name] ** 2, 0) / parked.length) : Infinity);
  const bound = (name) => (least <= ends.length ? sorted(name)[least - 1] : Infinity);
  return { parked: parked.length, place_rms: rms('place'), heading_rms: rms('heading'),
      place_bound: bound('place'), heading_bound: bound('heading'),
      time: median(ends.map(({ time }) => time)) };
}

// The files for the robot, by name, out of their templates.
export function filesOf(robot, told, rules, templates) {
  const number = (value) => {
    const text = Number(value.toPrecision(6)).toFixed(10).replace(/0+$/, '');
    return text.endsWith('.') ? `${text}0` : text;
  };
  const words = {}, { gains, wheels, turn } = told;
  const parts = { robot, sheet: told, gains, wheels, turn, rules: told.rules };
  for (const [part, values] of Object.entries(parts))
    for (const [name, value] of Object.entries(values))
      if (typeof value === 'number') words[`${part}.${name}`] = number(value);
  for (const name of ['start_lat', 'start_lon', 'goal_lat', 'goal_lon']) {
    words[`robot.${name}_e7`] = String(Math.floor(1e7 * robot[name] + 0.5));
    words[`robot.${name}`] = robot[name].toFixed(7);
  }
  words['robot.compass_sigma'] = number(Math.max(robot.compass, rules.surest) / DEGREES);
  return Object.fromEntries(Object.entries(templates).map(([name, text]) =>
    [name, text.replace(/@([a-z0-9_.]+)@/g, (_, word) => words[word])]));
}
