// Chapter 0: from two GPS points to a robot that has arrived, and has not parked.

import { DEGREES, driven, gainsOf, inDegrees, stage, wrap, written } from '../drawing.js';

const ROOM = [14, 8, 14, 20]; // m round the drive, for the angles at its ends

export default stage('first_drive', {
  find(values, setup) {
    const { start, goal } = values, run = driven({ start, goal, gains: gainsOf(values, setup) });
    return { run, tracks: [{ ...run, role: 'path' }],
      off: wrap(run.heading[run.n - 1] - goal[2]) };
  },
  look({ scene, start, goal }, { run }) {
    if (scene !== 'sees') return null;
    const xs = [start[0], goal[0], ...run.x], ys = [start[1], goal[1], ...run.y];
    return [Math.min(...xs) - ROOM[0], Math.min(...ys) - ROOM[1], Math.max(...xs) + ROOM[2],
      Math.max(...ys) + ROOM[3]];
  },
  say: (values, { run, off }) => ({
    seconds: run.outcome === 'ARRIVED' ? written(run.t[run.n - 1], 's') : 'more than a minute',
    off: inDegrees(Math.abs(off), 0),
    distance: written(run.rho[0], 'm', 4), alpha: inDegrees(run.alpha[0]),
    theta: inDegrees(run.theta[0]), east: written(values.goal[0] - values.start[0], 'm'),
    north: written(values.goal[1] - values.start[1], 'm'),
  }),
  draw(pane, { start, goal }, { run }, { shows, k, pose }, { data: { points } }) {
    if (shows.includes('points'))
      [start, goal].forEach(([x, y], i) => {
        points[i].forEach((text, row) =>
          pane.text(text, x, y, { role: i ? 'goal' : 'start', dx: 22, dy: 8 - 18 * row }));
      });
    if (shows.includes('map')) {
      const corner = [goal[0], start[1]];
      pane.line([start, corner, goal], 'ink', { width: 1.5, dash: [6, 4] });
      pane.line([start, goal], 'rho', { width: 2.5 });
      pane.text('east', ...corner, { dx: 10, dy: -2 }); // clear of the robot
      pane.text('north', goal[0], (start[1] + goal[1]) / 2, { dx: 10 });
      pane.text('ρ', (start[0] + goal[0]) / 2, (start[1] + goal[1]) / 2,
          { role: 'rho', dx: -16, size: 18 });
    }
    if (shows.includes('errors'))
      pane.errors(pose, [run.rho[k], run.alpha[k], run.theta[k]], goal);
    if (shows.includes('twist')) {
      pane.text(`v = ${written(run.v[k], 'm/s')}`, pose[0], pose[1], { dx: 26, dy: 12 });
      pane.text(`ω = ${written(run.omega[k] * DEGREES, '°/s')}`, pose[0], pose[1],
          { dx: 26, dy: -10 });
    }
  },
});
