// Chapter 13: the corrected law and another one drive the same wheels from the same start,
// forwards, backwards, forwards with a last turn on the spot, or on a clock that runs ahead.

import {
  DEGREES, arcStep, heldRun, inDegrees, polarFromPose, stage, trackOf, wrap, written,
} from '../drawing.js';

const ROOM = 2; // m round start and goal

/** @param {number[]} pose */
const facingBack = ([x, y, heading]) => [x, y, wrap(heading + Math.PI)];

// Backwards is forwards with both headings turned round, and the speed negated.
/** @param {any} options @returns {any} */
function backwards({ start, goal, ...options }) {
  const { poses, twists, arrived } =
      heldRun({ ...options, start: facingBack(start), goal: facingBack(goal) });
  return { poses: poses.map(facingBack), twists: twists.map(([v, omega]) => [-v, omega]), arrived };
}

/** @param {any} options @returns {any} */
function withLastTurn(options) {
  const { goal, dt, limits: { max_speed, b } } = options, run = heldRun(options);
  const [x, y, heading] = run.poses.at(-1), off = wrap(goal[2] - heading);
  const steps = Math.ceil(Math.abs(off) * b / (2 * max_speed * dt));
  if (!run.arrived || !steps) return run;
  const turns = Array.from({ length: steps }, (_, k) => [x, y, heading + off * (k + 1) / steps]);
  const twists = turns.map(() => [0, off / (steps * dt)]);
  return { ...run, poses: [...run.poses, ...turns],
    twists: [...run.twists.slice(0, -1), ...twists, [0, 0]] };
}

// By a given time: the law's own clock reads t/(1 - t/T), and the wheels are ideal.
/** @param {any} options @returns {any} */
function hurried({ by, steps, ...options }) {
  const { dt } = options;
  const { poses, twists, arrived } = heldRun({ ...options, steps: 20 * steps, limits: null });
  const tick = dt / 5, last = poses.length - 1, ends = last * dt / (1 + last * dt / by);
  const states = Array.from({ length: Math.ceil(ends / tick - 1e-9) }, (_, k) => {
    const clock = k * tick / (1 - k * tick / by), i = Math.min(Math.floor(clock / dt), last);
    const pose = arcStep(...poses[i], ...twists[i], clock - i * dt);
    return [pose, twists[i].map((rate) => rate * (1 + clock / by) ** 2)];
  });
  states.push([poses[last], [0, 0]]);
  return { poses: states.map(([pose]) => pose), twists: states.map(([, twist]) => twist), arrived,
    tick };
}

const WAYS = { forwards: heldRun, turn: withLastTurn, backwards, hurried };

// At a given speed, by (13.3) with equal gains, on the side on which the goal is. Between two ticks
// the robot drives in steps that are short for its distance.
/** @param {any} options @param {number} speed @returns {any} */
function atSpeed({ start, goal, dt, radius, steps, settles }, speed) {
  const ahead = Math.abs(polarFromPose(...start, ...goal)[1]) < Math.PI / 2;
  const [away, end] = ahead ? [start, goal] : [facingBack(start), facingBack(goal)];
  /** @param {number[]} error */
  const steer = ([rho, alpha, theta]) => {
    const c = Math.cos(alpha), zeta = Math.tan(alpha) + settles * theta;
    return speed * c / rho
        * (Math.tan(alpha) + c * c * (settles * Math.tan(alpha) + settles * zeta + theta));
  };
  const poses = [], twists = [];
  const errorOf = ([x, y, heading]) => polarFromPose(x, y, heading, end[0], end[1], end[2]);
  let pose = away, error = errorOf(away);
  while (error[0] > radius && poses.length < steps) {
    poses.push(pose);
    twists.push([speed, steer(error)]);
    for (let left = dt; left > 1e-9 && error[0] > radius;) {
      const step = Math.min(left, 0.01 * error[0] / speed), [x, y, heading] = pose;
      pose = arcStep(x, y, heading, speed, steer(error), step);
      error = errorOf(pose);
      left -= step;
    }
  }
  const run = { poses: [...poses, pose], twists: [...twists, [0, 0]], arrived: error[0] <= radius };
  return ahead ? run : { ...run, poses: run.poses.map(facingBack),
    twists: run.twists.map(([v, omega]) => [-v, omega]) };
}

export default stage('race_of_laws', {
  find({ start, goal, law, drives, speed }, { data: { tuned, settles, ...asked } }) {
    const { limits, dt, radius, steps, by } = asked, same = { start, goal, dt, radius, steps };
    const ruled = (name) => WAYS[drives]({ ...same, gains: tuned[name], law: name, limits,
      ...(drives === 'hurried' && { by }) });
    const ours = ruled('corrected');
    const theirs = speed === 'own' ? ruled(law) : atSpeed({ ...same, settles }, Number(speed));
    const tracks = [[ours, 'path'], [theirs, 'alpha']].map(([run, role]) =>
      trackOf(run, run.tick || dt, role));
    return { ours, theirs, tracks };
  },
  say({ goal, law, speed }, { ours, theirs }, { data: { names, dt } }) {
    const inSay = ({ poses, twists, arrived, tick = dt }) => (arrived
      ? `stops after ${written(tick * (poses.length - 1), 's')}, ${
        inDegrees(Math.abs(wrap(poses.at(-1)[2] - goal[2])), 0)} off, and turns up to ${
        written(DEGREES * Math.max(...twists.map(([, omega]) => Math.abs(omega))), '°/s', 2)}`
      : 'is on its way after a minute');
    const { tick = dt } = theirs;
    const back = theirs.twists.slice(0, -1).reduce((sum, [v]) => sum + tick * Math.max(-v, 0), 0);
    const other = speed === 'own' ? names[law] : 'the law (13.3)';
    return { other, ours: inSay(ours), theirs: inSay(theirs),
      back: `${back.toFixed(1)} m` };
  },
  look: ({ start, goal }) => [0, 1].map((i) => Math.min(start[i], goal[i]) - ROOM)
      .concat([0, 1].map((i) => Math.max(start[i], goal[i]) + ROOM)),
  above(pane, { law, speed }, { tracks }, { k, size }, { data: { names } }) {
    const other = speed === 'own' ? names[law].replace('the ', '') : 'law (13.3)';
    const labels = ['corrected law', other]; // no robot covers them
    tracks.forEach(({ x, y, n, role }, i) => {
      const at = Math.min(k, n - 1);
      if (at > 0) pane.text(labels[i], x[at], y[at], { role, dx: 20 * size, dy: 24 * size });
    });
  },
});
