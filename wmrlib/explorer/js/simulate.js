// The loop over time, what a run amounts to, maps of many runs and the modes near the goal: wmrlib's _kernels, metrics and tuning.

const CORRECTED = 0, PRINTED = 1, AICARDI = 2, KANAYAMA = 3;
const POSE_LAW_CODES = { corrected: CORRECTED, printed: PRINTED, aicardi: AICARDI };
const TRACKING_LAW_CODES = { ...POSE_LAW_CODES, kanayama: KANAYAMA };
const ARRIVED = 0, TIMED_OUT = 1, DIVERGED = 2, COMPLETED = 3;
const METHOD_CODES = { euler: 0, arc: 1 };
const OUTCOMES = ['ARRIVED', 'TIMED_OUT', 'DIVERGED', 'COMPLETED'];
const METRICS = ['headingError', 'time', 'peakOmega', 'pathLength', 'distance'];
const RUN_COLUMNS = ['t', 'x', 'y', 'heading', 'rho', 'alpha', 'theta', 'v', 'omega', 'V'];
const CIRCLE_COLUMNS = ['goalX', 'goalY', 'goalHeading'];
const MOST_SAMPLES = 1000000;
const FULL_TURN = 2 * Math.PI;

// The same direction in (-pi, pi]; % on doubles is the exact fmod, as in kinematics.wrap.
function wrap(angle) {
  if (-Math.PI < angle && angle <= Math.PI) return angle;
  angle %= FULL_TURN;
  if (angle > Math.PI) return angle - FULL_TURN;
  return angle <= -Math.PI ? angle + FULL_TURN : angle;
}

// One run, sample by sample, into `columns`; gives [samples, outcome]. Mirrors _kernels.drive operation by operation.
function drive(setup, columns) {
  const { law, arc, dt, samples, arrivalRadius, circle } = setup;
  const { k_rho, k_alpha, h, v_max } = setup.gains, { k_x, k_y, k_heading } = setup.feedback;
  const v_ref = circle ? circleSpeed() : 0, omega_ref = circle ? circleTurn() : 0;
  let [x, y, heading] = setup.start, [goalX, goalY, goalHeading] = setup.goal;
  for (let k = 0; k < samples; k++) {
    if (circle) {
      const angle = circleAngle(dt * k);
      goalX = circleX(angle);
      goalY = circleY(angle);
      goalHeading = circleHeading(angle);
    }
    const east = goalX - x, north = goalY - y, sight = Math.atan2(north, east);
    const rho = Math.hypot(east, north), alpha = wrap(sight - heading), theta = wrap(sight - goalHeading);
    const sinAlpha = Math.sin(alpha), cosAlpha = Math.cos(alpha);
    let v, omega, V;
    if (law === KANAYAMA) {
      const ahead = bodyAhead(rho, cosAlpha), left = bodyLeft(rho, sinAlpha), turn = wrap(alpha - theta);
      v = kanayamaV(ahead, turn, v_ref, k_x);
      omega = kanayamaOmega(left, turn, v_ref, omega_ref, k_y, k_heading);
      V = kanayamaValue(ahead, left, turn, k_y);
    } else {
      const pull = law === AICARDI ? aicardiPull(cosAlpha, k_rho) : correctedPull(rho, cosAlpha, k_rho, v_max);
      v = pull * rho;
      omega = poseOmega(law, alpha, theta, sinAlpha, cosAlpha, pull, k_alpha, h);
      V = lyapunovValue(rho, alpha, theta, h, 1);
    }
    if (!Number.isFinite(rho + v + omega)) return [k, DIVERGED];
    columns[0][k] = dt * k;
    columns[1][k] = x;
    columns[2][k] = y;
    columns[3][k] = heading;
    columns[4][k] = rho;
    columns[5][k] = alpha;
    columns[6][k] = theta;
    columns[7][k] = v;
    columns[8][k] = omega;
    columns[9][k] = V;
    if (circle) {
      columns[10][k] = goalX;
      columns[11][k] = goalY;
      columns[12][k] = goalHeading;
    }
    if (rho <= arrivalRadius) return [k + 1, ARRIVED];
    if (arc) {
      const halfTurn = 0.5 * omega * dt, chord = v * dt * sinc(halfTurn, Math.sin(halfTurn));
      x += chord * Math.cos(heading + halfTurn);
      y += chord * Math.sin(heading + halfTurn);
      heading = wrap(heading + 2 * halfTurn);
    } else {
      x += v * Math.cos(heading) * dt;
      y += v * Math.sin(heading) * dt;
      heading = wrap(heading + omega * dt);
    }
  }
  return [samples, circle ? COMPLETED : TIMED_OUT];
}

function poseOmega(law, alpha, theta, sinAlpha, cosAlpha, pull, k_alpha, h) {
  const sincAlpha = sinc(alpha, sinAlpha);
  if (law === PRINTED) return printedOmega(alpha, theta, sinAlpha, cosAlpha, sincAlpha, pull, k_alpha, h);
  return correctedOmega(alpha, theta, sincAlpha, pull, k_alpha, h);
}

// What the same run to a goal that stands still amounts to, without a record. It moves the goal in the robot's frame (`ahead`, `left`)
// rather than the robot in the plane: that saves three of the seven sines, cosines and the like that a step costs.
function survey(setup, k_rho, k_alpha, h, v_max, summary) {
  const { law, arc, dt, samples, arrivalRadius } = setup;
  const [x, y, heading] = setup.start, [goalX, goalY, goalHeading] = setup.goal;
  let rho = Math.hypot(goalX - x, goalY - y), alpha = wrap(Math.atan2(goalY - y, goalX - x) - heading);
  let sinAlpha = Math.sin(alpha), cosAlpha = Math.cos(alpha), headingError = wrap(heading - goalHeading), peak = 0, length = 0;
  summary.arrived = false;
  for (let k = 0; k < samples; k++) {
    const pull = law === AICARDI ? aicardiPull(cosAlpha, k_rho) : correctedPull(rho, cosAlpha, k_rho, v_max);
    const v = pull * rho, omega = poseOmega(law, alpha, wrap(alpha + headingError), sinAlpha, cosAlpha, pull, k_alpha, h);
    if (!Number.isFinite(rho + v + omega)) return;
    if (Math.abs(omega) > peak) peak = Math.abs(omega);
    if (rho <= arrivalRadius) {
      summary.arrived = true;
      summary.time = k * dt;
      summary.headingError = Math.abs(headingError);
      summary.peakOmega = peak;
      summary.pathLength = length;
      summary.distance = rho;
      return;
    }
    length += Math.abs(v) * dt;
    const half = 0.5 * omega * dt, square = half * half;
    const sincHalf = square < 0.01 ? smallSinc(square) : sinc(half, Math.sin(half));
    const cosHalf = square < 0.01 ? smallCos(square) : Math.cos(half), sinHalf = half * sincHalf;
    const chord = arc ? v * dt * sincHalf : v * dt; // the arc's chord points half the turn aside, the tangent nowhere
    const ahead = bodyAhead(rho, cosAlpha) - (arc ? chord * cosHalf : chord), left = bodyLeft(rho, sinAlpha) - (arc ? chord * sinHalf : 0);
    const cosTurn = cosHalf * cosHalf - sinHalf * sinHalf, sinTurn = 2 * sinHalf * cosHalf;
    const newAhead = ahead * cosTurn + left * sinTurn, newLeft = left * cosTurn - ahead * sinTurn;
    rho = Math.sqrt(newAhead * newAhead + newLeft * newLeft);
    alpha = Math.atan2(newLeft, newAhead);
    cosAlpha = rho > 0 ? newAhead / rho : 1;
    sinAlpha = rho > 0 ? newLeft / rho : 0;
    headingError = wrap(headingError + 2 * half);
  }
}

// Whether even a robot that looks at the goal all the time can't arrive. Speed grows with distance, so none is ever closer than it, as long
// as a step from further away ends further away: dt times the largest slope of the speed is at most 1.
function outOfReach(setup, k_rho, v_max) {
  const { law, dt, samples, arrivalRadius, start, goal } = setup;
  if (dt * k_rho * (law === AICARDI ? 1 : v_max) > 1) return false;
  let rho = Math.hypot(goal[0] - start[0], goal[1] - start[1]) * (1 - 1e-9);
  for (let k = 1; k < samples && rho > arrivalRadius; k++) {
    rho -= dt * rho * (law === AICARDI ? aicardiPull(1, k_rho) : correctedPull(rho, 1, k_rho, v_max));
  }
  return rho > arrivalRadius;
}

// One run: start and goal are [x, y, heading] in m, m, rad; reference is null or 'circle', which takes the goal's place; law 'kanayama'
// is for the circle and is tuned with feedback {k_x, k_y, k_heading}, the others with gains {k_rho, k_alpha, h, v_max}.
// Gives Float64Arrays of n samples (t, x, y, heading, rho, alpha, theta, v, omega, V; for the circle goalX, goalY, goalHeading) and an
// outcome. `into`, an earlier result that is no longer needed, lends its memory. Throws RangeError, which names the argument.
function simulate(options, into = null) {
  const setup = checkedSetup(options);
  const names = setup.circle ? [...RUN_COLUMNS, ...CIRCLE_COLUMNS] : RUN_COLUMNS;
  const needed = names.length * setup.samples;
  const memory = into !== null && into.t.buffer.byteLength >= 8 * needed ? into.t.buffer : new ArrayBuffer(8 * needed);
  const columns = names.map((_, i) => new Float64Array(memory, 8 * i * setup.samples, setup.samples));
  const [n, outcome] = drive(setup, columns), run = { n, outcome: OUTCOMES[outcome] };
  names.forEach((name, i) => { run[name] = columns[i].subarray(0, n); });
  return run;
}

// What a run amounts to: time in s (Infinity if it did not arrive), headingError in rad and distance in m at the last sample, peakOmega in
// rad/s, pathLength in m, and residual, the mean distance over the last 5 s, in m. All NaN but time for a run without a sample.
function summarise(run) {
  const last = run.n - 1, arrived = run.outcome === 'ARRIVED';
  let peakOmega = last < 0 ? NaN : 0, pathLength = peakOmega, sum = 0, late = 0;
  for (let k = 0; k <= last; k++) {
    peakOmega = Math.max(peakOmega, Math.abs(run.omega[k]));
    if (k < last) pathLength += Math.abs(run.v[k]) * (run.t[k + 1] - run.t[k]);
    if (run.t[k] >= run.t[last] - 5) {
      sum += run.rho[k];
      late += 1;
    }
  }
  const headingError = last < 0 ? NaN : wrap(run.theta[last] - run.alpha[last]), distance = last < 0 ? NaN : run.rho[last];
  return { arrived, time: arrived ? run.t[last] : Infinity, headingError, peakOmega, pathLength, distance, residual: sum / late };
}

// A map of runs as of `simulate`, to a goal that stands still, over two of the gains: kx over the numbers xs and ky over ys; metric
// 'headingError' (its size), 'time', 'peakOmega', 'pathLength' or 'distance'. Entry j*xs.length + i of the Float64Array is of xs[i] and
// ys[j]; NaN where the robot does not arrive. The runs have the same dt and stop at the same radius: the map shows what simulate gives.
function landscape(options) {
  const { kx, xs, ky, ys, metric } = options;
  const setup = checkedSetup(options), gains = { ...setup.gains }, summary = {}, hopeless = new Map();
  for (const [name, key, values] of [['kx', kx, xs], ['ky', ky, ys]]) {
    if (!Object.hasOwn(gains, key)) throw notAllowed(name, key, `one of ${Object.keys(gains).join(', ')}`);
    for (const value of values) checkedNumber(key, value, key === 'v_max');
  }
  if (!METRICS.includes(metric)) throw notAllowed('metric', metric, `one of ${METRICS.join(', ')}`);
  if (setup.circle) throw notAllowed('reference', options.reference, 'null');
  const map = new Float64Array(xs.length * ys.length).fill(NaN);
  for (let j = 0; j < ys.length; j++) {
    gains[ky] = ys[j];
    for (let i = 0; i < xs.length; i++) {
      gains[kx] = xs[i];
      const speeds = `${gains.k_rho} ${gains.v_max}`;
      if (!hopeless.has(speeds)) hopeless.set(speeds, outOfReach(setup, gains.k_rho, gains.v_max));
      if (hopeless.get(speeds)) continue;
      survey(setup, gains.k_rho, gains.k_alpha, gains.h, gains.v_max, summary);
      if (summary.arrived) map[j * xs.length + i] = summary[metric];
    }
  }
  return map;
}

// How the closed loop settles near the goal (see wmrlib.modes): rate in 1/s, naturalFrequency in rad/s, damping, and how many times slower
// the heading settles than the distance. Infinity and NaN where a gain of 0 leaves no mode; for 'printed', whose heading never settles.
function modes(gains, law = 'corrected') {
  const { k_rho, k_alpha, h, v_max } = gains;
  const rate = law === 'aicardi' ? k_rho : v_max * k_rho;
  if (law === 'printed') return { rate, naturalFrequency: NaN, damping: NaN, slower: Infinity };
  const slower = rate / modeSettling(rate, k_alpha, h);
  return { rate, naturalFrequency: modeFrequency(rate, h), damping: modeDamping(rate, k_alpha, h), slower };
}

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
  const circle = options.reference === 'circle', codes = circle ? TRACKING_LAW_CODES : POSE_LAW_CODES;
  if (!circle && options.reference != null) throw notAllowed('reference', options.reference, "null or 'circle'");
  if (!Object.hasOwn(codes, options.law)) throw notAllowed('law', options.law, `one of ${Object.keys(codes).join(', ')}`);
  if (!Object.hasOwn(METHOD_CODES, options.method)) throw notAllowed('method', options.method, `one of ${Object.keys(METHOD_CODES).join(', ')}`);
  const gains = {}, feedback = { k_x: 0, k_y: 1, k_heading: 0 };
  for (const name of ['k_rho', 'k_alpha', 'h', 'v_max']) gains[name] = checkedNumber(name, options.gains[name], name === 'v_max');
  if (options.law === 'kanayama') {
    for (const name of Object.keys(feedback)) feedback[name] = checkedNumber(name, options.feedback[name], name === 'k_y');
  }
  const dt = checkedNumber('dt', options.dt, true), duration = checkedNumber('duration', options.duration, true);
  if (dt > duration) throw notAllowed('dt', dt, `at most the duration, ${duration},`);
  if (duration / dt > MOST_SAMPLES) throw notAllowed('duration', duration, `at most ${MOST_SAMPLES} steps of dt = ${dt}`);
  return {
    law: codes[options.law],
    arc: METHOD_CODES[options.method] === 1,
    circle,
    gains,
    feedback,
    dt,
    samples: Math.floor(duration / dt + 1e-9) + 1,
    start: checkedPose('start', options.start),
    goal: circle ? [0, 0, 0] : checkedPose('goal', options.goal),
    arrivalRadius: circle ? -1 : checkedNumber('arrivalRadius', options.arrivalRadius),
  };
}
