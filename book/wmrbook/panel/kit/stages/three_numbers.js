// Chapter 3: the polar errors of a robot, drawn and written down while it drives; its velocity,
// split along and across the line of sight; and the same law with the wrong sign of theta.

import {
  DEGREES, ahead, driven, endOf, gainsOf, heldRun, inDegrees, polarFromPose, poseOfError,
  remembered, stage, trackOf, written,
} from '../drawing.js';

const MARGIN = 2.5; // m
const SECOND = 1; // m of an arrow for each m/s

// A drive by a law that is handed the opposite of theta.
const mistaken = remembered(({ start, goal, gains, dt, steps }) => {
  const sight = (k, pose) => {
    const [rho, alpha, theta] = polarFromPose(...pose, ...goal);
    return poseOfError(rho, alpha, -theta, ...goal);
  };
  const held = heldRun({ start, goal, gains, dt, radius: 0.05, steps, sight });
  const errors = held.poses.map((pose) => polarFromPose(...pose, ...goal));
  const [rho, alpha, theta] = [0, 1, 2].map((i) => errors.map((row) => row[i]));
  return { ...trackOf(held, dt), rho, alpha, theta, v: held.twists.map(([v]) => v),
    outcome: held.arrived ? 'ARRIVED' : 'TIMED_OUT' };
});

/** @param {Pane} pane @param {Pose} pose */
function split(pane, pose, alpha, v) {
  const sight = pose[2] + alpha, [x, y] = pose, tip = ahead(pose, SECOND * v);
  const along = ahead([x, y, sight], SECOND * v * Math.cos(alpha));
  pane.arrow(x, y, ...along, 'rho', { width: 3 });
  pane.arrow(...along, ...tip, 'theta', { width: 3 });
  pane.arrow(x, y, ...tip, 'ink', { width: 3 });
  pane.text('v', ...tip, { dy: 12, dx: -4, size: 17 });
  pane.text('along', ...along, { role: 'rho', dx: 4, dy: -16, size: 15 });
  pane.text('across', (along[0] + tip[0]) / 2, (along[1] + tip[1]) / 2,
      { role: 'theta', dx: 12, dy: 4, size: 15 });
}

export default stage('three_numbers', {
  find(values, setup) {
    const { start, goal, sign } = values, { dt, steps } = setup.data;
    const asked = { start, goal, gains: gainsOf(values, setup) };
    const run = sign === 'wrong' ? mistaken({ ...asked, dt, steps }) : driven(asked);
    return { run, tracks: [{ ...run, role: 'path' }] };
  },
  look({ start, goal }) {
    const [xs, ys] = [0, 1].map((i) => [start[i], goal[i]]);
    return [Math.min(...xs) - MARGIN, Math.min(...ys) - MARGIN, Math.max(...xs) + MARGIN,
      Math.max(...ys) + MARGIN];
  },
  say({ goal }, { run }) {
    const [rho, alpha, v] = [run.rho[0], run.alpha[0], run.v[0]];
    return { ends: endOf(run, goal), rho: written(rho, 'm'), alpha: inDegrees(alpha, 0),
      theta: inDegrees(run.theta[0], 0), v: written(v, 'm/s'),
      along: written(v * Math.cos(alpha), 'm/s'), across: written(v * Math.sin(alpha), 'm/s'),
      swings: rho < 1e-3 ? 'has no direction'
        : `turns at ${written(v * Math.sin(alpha) / rho * DEGREES, '°/s')}` };
  },
  draw(pane, { goal }, { run }, { shows, k, pose }) {
    const [rho, alpha, theta] = [run.rho[k], run.alpha[k], run.theta[k]];
    pane.path(run.x, run.y, 'path', { width: 1.5, dash: [2, 6], from: k });
    if (shows.includes('errors')) pane.errors(pose, [rho, alpha, theta], goal);
    if (shows.includes('split')) {
      pane.line([pose, goal], 'rho', { dash: [6, 4] });
      split(pane, pose, alpha, run.v[k]);
    }
    const { left, top } = pane.box;
    [['rho', `ρ = ${written(rho, 'm')}`], ['alpha', `α = ${inDegrees(alpha, 0)}`],
      ['theta', `θ = ${inDegrees(theta, 0)}`]].forEach(([role, text], row) =>
      pane.text(text, ...pane.view.toWorld(left + 16, top + 22 + 26 * row),
          { role, size: 19, weight: 600, fixed: true }));
  },
});
