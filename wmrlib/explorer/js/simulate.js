// The loop over time, what a run amounts to, maps of many runs and the modes near the goal. The formulas are those of model.js.

const ARRIVED = 0, TIMED_OUT = 1, DIVERGED = 2, COMPLETED = 3;
const OUTCOMES = ['ARRIVED', 'TIMED_OUT', 'DIVERGED', 'COMPLETED'];
const RUN_COLUMNS = ['t', 'x', 'y', 'heading', 'rho', 'alpha', 'theta', 'v', 'omega', 'V'];
const CIRCLE_COLUMNS = ['goalX', 'goalY', 'goalHeading'];
const POSITIVE = ['v_max', 'k_y']; // the gains that may not be 0
const MOST_SAMPLES = 1000000;

// One run, sample by sample, told to `record(k, t, pose, seen, twist, goal)`. Gives [samples, outcome].
function drive(setup, record) {
  const { step, gains, dt, samples, arrivalRadius, moving } = setup, { command } = setup.law;
  let pose = setup.start, goal = [...setup.goal, 0, 0];
  for (let k = 0; k < samples; k++) {
    if (moving) goal = circle(dt * k);
    const seen = polarFromPose(pose[0], pose[1], pose[2], goal[0], goal[1], goal[2]), rho = seen[0];
    const twist = command(rho, seen[1], seen[2], gains, goal[3], goal[4]);
    if (!Number.isFinite(rho + twist[0] + twist[1])) return [k, DIVERGED];
    record(k, dt * k, pose, seen, twist, goal);
    if (rho <= arrivalRadius) return [k + 1, ARRIVED];
    pose = step(pose[0], pose[1], pose[2], twist[0], twist[1], dt);
  }
  return [samples, moving ? COMPLETED : TIMED_OUT];
}

// One run: start and goal are [x, y, heading] in m, m, rad; reference is null or 'circle', which takes the goal's place, and which some laws
// need. A law finds its gains by name in `gains` {k_rho, k_alpha, h, v_max} or in `feedback` {k_x, k_y, k_heading}.
// Gives Float64Arrays of n samples (t, x, y, heading, rho, alpha, theta, v, omega, V; for the circle goalX, goalY, goalHeading) and an
// outcome. `into`, an earlier result that is no longer needed, lends its memory. Throws RangeError, which names the argument.
function simulate(options, into = null) {
  const setup = checkedSetup(options);
  const names = setup.moving ? [...RUN_COLUMNS, ...CIRCLE_COLUMNS] : RUN_COLUMNS;
  const needed = names.length * setup.samples;
  const memory = into !== null && into.t.buffer.byteLength >= 8 * needed ? into.t.buffer : new ArrayBuffer(8 * needed);
  const columns = names.map((_, i) => new Float64Array(memory, 8 * i * setup.samples, setup.samples));
  const { value } = setup.law, [t, x, y, heading, rho, alpha, theta, v, omega, V, ...goals] = columns;
  const record = (k, time, pose, seen, twist, goal) => {
    t[k] = time; x[k] = pose[0]; y[k] = pose[1]; heading[k] = pose[2];
    rho[k] = seen[0]; alpha[k] = seen[1]; theta[k] = seen[2]; v[k] = twist[0]; omega[k] = twist[1];
    V[k] = value(seen[0], seen[1], seen[2], setup.gains);
    for (let i = 0; i < goals.length; i++) goals[i][k] = goal[i];
  };
  const [n, outcome, peakOmega, pathLength] = (setup.step ? drive : driveContinuously)(setup, record);
  const run = { n, outcome: OUTCOMES[outcome], peakOmega, pathLength };
  names.forEach((name, i) => { run[name] = columns[i].subarray(0, n); });
  return run;
}

// What a run amounts to: time in s (Infinity if it did not arrive), headingError in rad and distance in m at the last sample, peakOmega in
// rad/s, pathLength in m, and residual, the mean distance over the last 5 s, in m. All NaN but time for a run without a sample.
function summarise(run) {
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
  const headingError = last < 0 ? NaN : wrap(run.theta[last] - run.alpha[last]), distance = last < 0 ? NaN : run.rho[last];
  const { peakOmega = peak, pathLength = length } = run; // of the motion, where it is known between the samples
  return { arrived, time: arrived ? run.t[last] : Infinity, headingError, peakOmega, pathLength, distance, residual: sum / late };
}

let scratch = null; // the memory of the last run of a map, lent to the next

// A map of runs as of `simulate` over two of the gains: kx over the numbers xs and ky over ys; metric 'headingError', 'time', 'peakOmega',
// 'pathLength' or 'distance'. Entry j*xs.length + i of the Float64Array is of xs[i] and ys[j]; NaN where the robot does not arrive. Behind a
// moving goal nothing arrives: there it is what the end of the run amounts to, and 'residual' in the place of 'time'.
function landscape(options) {
  const { kx, xs, ky, ys, metric } = options, map = new Float64Array(xs.length * ys.length).fill(NaN), gains = { ...options.gains };
  const still = options.reference === null, lasting = !still && metric === 'time' ? 'residual' : metric;
  const dt = options.method !== 'continuous' ? options.dt : still ? options.duration : Math.max(options.dt, 0.25); // no more samples than needed
  ys.forEach((y, j) => xs.forEach((x, i) => {
    gains[kx] = x;
    gains[ky] = y;
    try { scratch = simulate({ ...options, dt, gains }, scratch); } catch (error) { if (error instanceof Unsettled) return; throw error; }
    const summary = summarise(scratch);
    map[j * xs.length + i] = still && !summary.arrived ? NaN : Math.abs(summary[lasting]);
  }));
  return map;
}

// How the closed loop settles near the goal (see wmrlib.modes): rate in 1/s, naturalFrequency in rad/s, damping, and how many times slower
// the heading settles than the distance: Infinity where the heading isn't steered.
function modes(gains, law = 'corrected') {
  const [rate, a, b] = LAWS[law].modes(gains), half = a / 2, gap = half * half - b;
  const settling = gap > 0 ? b / (half + Math.sqrt(gap)) : half;
  return { rate, naturalFrequency: Math.sqrt(b), damping: half / Math.sqrt(b), slower: b === 0 ? Infinity : rate / settling };
}

class Unsettled extends RangeError {} // a run that a method can't finish

function notAllowed(name, value, needed) {
  return new RangeError(`${name} = ${value} is not allowed: ${needed} is needed`);
}

function checkedNumber(name, value, positive = false) {
  if (typeof value === 'number' && Number.isFinite(value) && (positive ? value > 0 : value >= 0)) return value;
  throw notAllowed(name, value, `a finite number ${positive ? 'above' : 'at least'} 0`);
}

function checkedPose(name, pose) {
  if (Array.isArray(pose) && pose.length === 3 && pose.every(Number.isFinite)) return pose;
  throw notAllowed(name, pose, '[x, y, heading], all finite,');
}

function checkedSetup(options) {
  const moving = options.reference === 'circle', laws = Object.keys(LAWS).filter((name) => moving || !LAWS[name].needsReference);
  if (!moving && options.reference != null) throw notAllowed('reference', options.reference, "null or 'circle'");
  if (!laws.includes(options.law)) throw notAllowed('law', options.law, `one of ${laws.join(', ')}`);
  const methods = [...Object.keys(STEPS), 'continuous'];
  if (!methods.includes(options.method)) throw notAllowed('method', options.method, `one of ${methods.join(', ')}`);
  const law = LAWS[options.law], given = { ...options.gains, ...options.feedback }, gains = {};
  for (const name of law.gains) gains[name] = checkedNumber(name, given[name], POSITIVE.includes(name));
  const dt = checkedNumber('dt', options.dt, true), duration = checkedNumber('duration', options.duration, true);
  if (dt > duration) throw notAllowed('dt', dt, `at most the duration, ${duration},`);
  if (duration / dt > MOST_SAMPLES) throw notAllowed('duration', duration, `at most ${MOST_SAMPLES} steps of dt = ${dt}`);
  return {
    law,
    step: STEPS[options.method],
    moving,
    gains,
    dt,
    samples: Math.floor(duration / dt + 1e-9) + 1,
    start: checkedPose('start', options.start),
    goal: moving ? [0, 0, 0] : checkedPose('goal', options.goal),
    arrivalRadius: moving ? -1 : checkedNumber('arrivalRadius', options.arrivalRadius),
  };
}
