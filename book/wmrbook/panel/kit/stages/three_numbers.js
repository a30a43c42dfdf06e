// Chapter 3: the polar errors of a robot, drawn and written down while it drives.

import { driven, endOf, gainsOf, inDegrees, stage, written } from '../drawing.js';

const MARGIN = 2.5; // m

export default stage('three_numbers', {
  find(values, setup) {
    const { start, goal } = values, run = driven({ start, goal, gains: gainsOf(values, setup) });
    return { run, tracks: [{ ...run, role: 'path' }] };
  },
  look({ start, goal }) {
    const [xs, ys] = [0, 1].map((i) => [start[i], goal[i]]);
    return [Math.min(...xs) - MARGIN, Math.min(...ys) - MARGIN, Math.max(...xs) + MARGIN,
      Math.max(...ys) + MARGIN];
  },
  say: ({ goal }, { run }) => ({
    ends: endOf(run, goal), rho: written(run.rho[0], 'm'), alpha: inDegrees(run.alpha[0], 0),
    theta: inDegrees(run.theta[0], 0),
  }),
  draw(pane, { goal }, { run }, { shows, k, pose }) {
    const [rho, alpha, theta] = [run.rho[k], run.alpha[k], run.theta[k]];
    pane.path(run.x, run.y, 'path', { width: 1.5, dash: [2, 6], from: k });
    if (shows.includes('errors')) pane.errors(pose, [rho, alpha, theta], goal);
    const { left, top } = pane.box;
    [['rho', `ρ = ${written(rho, 'm')}`], ['alpha', `α = ${inDegrees(alpha, 0)}`],
      ['theta', `θ = ${inDegrees(theta, 0)}`]].forEach(([role, text], row) =>
      pane.text(text, ...pane.view.toWorld(left + 16, top + 22 + 26 * row),
          { role, size: 19, weight: 600, fixed: true }));
  },
});
