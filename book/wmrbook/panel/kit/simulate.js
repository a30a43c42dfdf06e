// The loop over time, what a run amounts to, maps of many runs and the modes near the goal. The
// formulas are those of model.js.

import { ARRIVED, COMPLETED, DIVERGED, TIMED_OUT, Unsettled, checkedSetup } from './setup.js';
import {
  LAWS, circle, fastestWheel, hurry, keepBranch, polarFromPose, roll, saturationScale, turnRate,
  wrap,
} from './model.js';
import { controlLaw } from './law.js';
import { driveContinuously } from './continuous.js';

const OUTCOMES = ['ARRIVED', 'TIMED_OUT', 'DIVERGED', 'COMPLETED'];
export const RUN_COLUMNS = ['t', 'x', 'y', 'heading', 'rho', 'alpha', 'theta', 'v', 'omega', 'V'];
const CIRCLE_COLUMNS = ['goalX', 'goalY', 'goalHeading'];

// A twist within the limits of the wheels.
function limited(twist, alpha, { b, max_speed, min_speed }) {
  const [v, omega] = twist;
  const more = hurry(v, alpha, min_speed);
  const share = more * saturationScale(max_speed, fastestWheel(more * v, more * omega, b));
  return [share * v, share * omega];
}

export const atRest = (body) => Math.abs(body[0]) < 1e-3 && Math.abs(body[1]) < 1e-3;

// One run, sample by sample, told to `record(k, t, pose, seen, twist, goal)`. The law may see what
// `sight(k, pose)` shows of a pose. Gives [samples, outcome].
export function drive(setup, record) {
  const { law, step, gains, dt, samples, arrivalRadius, hysteresis, moving, sight } = setup;
  const { limits = null, motors = null, end = null } = setup;
  let before = NaN, pose = setup.start, goal = [...setup.goal, 0, 0];
  let turning = 0, body = [0, 0, 0, 0]; // turning is as in wmrlib's last_turn
  for (let k = 0; k < samples; k++) {
    if (moving) goal = circle(dt * k);
    const shown = sight ? sight(k, pose) : pose;
    const seen = polarFromPose(shown[0], shown[1], shown[2], goal[0], goal[1], goal[2]);
    if (hysteresis) seen[2] = before = keepBranch(seen[2], before, hysteresis);
    const [rho, alpha, theta] = seen;
    let twist = controlLaw(rho, alpha, theta, gains, law, goal[3], goal[4]);
    if (limits) twist = limited(twist, alpha, limits);
    let arrived = rho <= arrivalRadius;
    if (end) {
      const off = wrap(theta - alpha);
      const near = rho <= arrivalRadius * (turning > 0 ? end.leave : 1);
      const faces = near && Math.abs(off) <= end.tolerance, faced = Math.max(turning - 1, 0);
      turning = near ? 1 + (faces ? faced + dt : 0) : 0;
      arrived = faces && faced >= end.settle - 1e-9;
      const omega = faces ? 0 : turnRate(-off, end.gain, end.min_rate, end.max_rate);
      const most = limits ? saturationScale(limits.max_speed, fastestWheel(0, omega, limits.b)) : 1;
      if (near) twist = [0, most * omega];
    }
    if (motors) {
      arrived &&= !end || atRest(body);
      const [v, omega, ...after] = roll(twist[0], twist[1], ...body, ...motors, dt);
      [twist, body] = [[v, omega], after];
    }
    if (!Number.isFinite(rho + twist[0] + twist[1])) return [k, DIVERGED];
    record(k, dt * k, pose, seen, twist, goal);
    if (arrived) return [k + 1, ARRIVED];
    pose = step(pose[0], pose[1], pose[2], twist[0], twist[1], dt);
  }
  return [samples, moving ? COMPLETED : TIMED_OUT];
}

// One run: start and goal are [x, y, heading] in m, m, rad; reference is null or 'circle', which
// takes the goal's place, and which some laws need. A law finds its gains by name in `gains`
// {k_rho, k_alpha, h, v_max} or in `feedback` {k_x, k_y, k_heading}. Its hysteresis in rad is 0
// unless given. Gives Float64Arrays of n
// samples (t, x, y, heading, rho, alpha, theta, v, omega, V; for the circle goalX, goalY,
// goalHeading) and an outcome. `into`, an earlier result that is no longer needed, lends its
// memory. `wheels` and `lastTurn` are the fields of wmrlib's Wheels and LastTurn by name. Throws
// RangeError, which names the argument.
/** @param {Options} options @param {Run | null} into @returns {Run} */
export function simulate(options, into = null) {
  const setup = checkedSetup(options);
  const names = setup.moving ? [...RUN_COLUMNS, ...CIRCLE_COLUMNS] : RUN_COLUMNS;
  const needed = names.length * setup.samples;
  const memory = into !== null && into.t.buffer.byteLength >= 8 * needed ? into.t.buffer
      : new ArrayBuffer(8 * needed);
  const columns =
      names.map((_, i) => new Float64Array(memory, 8 * i * setup.samples, setup.samples));
  const { value } = LAWS[setup.law],
      [t, x, y, heading, rho, alpha, theta, v, omega, V, ...goals] = columns;
  const record = (k, time, pose, seen, twist, goal) => {
    t[k] = time; x[k] = pose[0]; y[k] = pose[1]; heading[k] = pose[2];
    rho[k] = seen[0]; alpha[k] = seen[1]; theta[k] = seen[2]; v[k] = twist[0]; omega[k] = twist[1];
    V[k] = value(seen[0], seen[1], seen[2], setup.gains);
    for (let i = 0; i < goals.length; i++) goals[i][k] = goal[i];
  };
  const [n, outcome, peakOmega, pathLength] =
      (setup.step ? drive : driveContinuously)(setup, record);
  /** @type {any} */
  const run = { n, outcome: OUTCOMES[outcome], peakOmega, pathLength };
  names.forEach((name, i) => { run[name] = columns[i].subarray(0, n); });
  return run;
}

// What a run amounts to: time in s (Infinity if it did not arrive), headingError in rad and
// distance in m at the last sample, peakOmega in rad/s, pathLength in m, and residual, the mean
// distance over the last 5 s, in m. All NaN but time for a run without a sample.
/** @param {Run} run */
export function summarise(run) {
  const last = run.n - 1, arrived = run.outcome === 'ARRIVED';
  let peak = last < 0 ? NaN : 0, length = peak, sum = 0, late = 0;
  for (let k = 0; k <= last; k++) {
    peak = Math.max(peak, Math.abs(run.omega[k]));
    if (k < last) length += Math.abs(run.v[k]) * (run.t[k + 1] - run.t[k]);
    if (run.t[k] >= run.t[last] - 5) {
      sum += run.rho[k];
      late += 1;
    }
  }
  const headingError = last < 0 ? NaN : wrap(run.theta[last] - run.alpha[last]),
      distance = last < 0 ? NaN : run.rho[last];
  // of the motion, where it is known between the samples
  const { peakOmega = peak, pathLength = length } = run;
  return { arrived, time: arrived ? run.t[last] : Infinity, headingError, peakOmega, pathLength,
      distance, residual: sum / late };
}

let scratch = null; // the memory of the last run of a map, lent to the next

// A map of runs as of `simulate` over two of the gains: kx over the numbers xs and ky over ys;
// metric 'headingError', 'time', 'peakOmega', 'pathLength' or 'distance'. Entry j*xs.length + i of
// the Float64Array is of xs[i] and ys[j]; NaN where the robot does not arrive. Behind a moving goal
// nothing arrives: there it is what the end of the run amounts to, and 'residual' in the place of
// 'time'.
/** @param {Options & { kx: string, xs: Float64Array, ky: string, ys: Float64Array,
 *   metric: string }} options */
export function landscape(options) {
  const { kx, xs, ky, ys, metric } = options,
      map = new Float64Array(xs.length * ys.length).fill(NaN), gains = { ...options.gains };
  const still = options.reference === null,
      lasting = !still && metric === 'time' ? 'residual' : metric;
  // no more samples than needed
  const dt = options.method !== 'continuous' ? options.dt : still ? options.duration
      : Math.max(options.dt, 0.25);
  ys.forEach((y, j) => xs.forEach((x, i) => {
    gains[kx] = x;
    gains[ky] = y;
    try {
      scratch = simulate({ ...options, dt, gains }, scratch);
    } catch (error) { if (error instanceof Unsettled) return; throw error; }
    const summary = summarise(scratch);
    map[j * xs.length + i] = still && !summary.arrived ? NaN : Math.abs(summary[lasting]);
  }));
  return map;
}

// How the closed loop settles near the goal (see wmrlib.modes): rate in 1/s, naturalFrequency in
// rad/s, damping, how many times slower the heading settles than the distance (Infinity where the
// heading isn't steered), and kappa.
/** @param {Gains} gains @param {string} law */
export function modes(gains, law = 'corrected') {
  const [rate, a, b] = LAWS[law].modes(gains), [[slow]] = polesOf(a, b);
  return { rate, naturalFrequency: Math.sqrt(b), damping: a / 2 / Math.sqrt(b),
      slower: b === 0 ? Infinity : rate / -slow, kappa: a / rate };
}

// The roots of s^2 + a s + b, the one farther from 0 last.
export function polesOf(a, b) {
  const half = a / 2, gap = half * half - b, root = Math.sqrt(Math.abs(gap));
  if (gap < 0) return [[-half, root], [-half, -root]];
  const far = half < 0 ? root - half : -half - root;
  return [[far ? b / far : 0, 0], [far, 0]]; // so the other one keeps its digits
}
