// Chapter 4: seven robots drive to one goal; in a corner the number V of each falls.

import {
  cornerOf, freshRun, gainsOf, inDegrees, insetOf, insetSize, remembered, stage, wrap, written,
} from '../drawing.js';

const ROOM = 6; // m, from the goal to the edge
const DT = 0.15; // s, between two samples
const MOST = 210, FLAT = 0.72; // px, of the corner's picture, and its height to that
const ALONE = ['bowl', 'parts']; // scenes with one robot
const own = remembered(freshRun), others = remembered(({ starts, ...options }) =>
    starts.map((start) => freshRun({ start, ...options })));

export default stage('downhill', {
  find(values, setup) {
    const { start, goal } = values, { others: starts, radius, near, seconds } = setup.data;
    const options = { goal, gains: gainsOf(values, setup), arrivalRadius: radius, dt: DT,
      duration: seconds };
    const runs = [own({ ...options, start }), ...others({ ...options, starts })];
    const rises = runs.reduce((sum, { V, n }) =>
      sum + V.filter((value, k) => k && k < n && value > V[k - 1] + 1e-9).length, 0);
    const parked = runs.filter(({ outcome, heading, n }) =>
      outcome === 'ARRIVED' && Math.abs(wrap(heading[n - 1] - goal[2])) < near).length;
    const driving = ALONE.includes(values.scene) ? runs.slice(0, 1) : runs;
    return { runs, rises, parked, tracks: driving.map((run, k) =>
      ({ ...run, role: k ? 'ghost' : 'path' })) };
  },
  look({ start, goal }) {
    const [far, up] = [0, 1].map((i) => Math.max(ROOM, Math.abs(start[i] - goal[i]) + 1));
    return [goal[0] - far, goal[1] - up, goal[0] + far, goal[1] + up];
  },
  corner: (values, found, size, { shows }) =>
      (shows.includes('errors') ? null : cornerOf(size, MOST, FLAT)),
  say: (values, { parked, rises, runs: [run] }) => ({
    parked, rises: rises ? 'rises' : 'never rises',
    distance: written(run.rho[0], 'm'), alpha: inDegrees(run.alpha[0], 0),
    theta: inDegrees(run.theta[0], 0), value: written(run.V[0], ''),
  }),
  draw(pane, { goal, scene }, { runs: [run] }, { size, shows, k, pose }, { data }) {
    if (!ALONE.includes(scene))
      for (const start of data.others) pane.robot(start, 0.4, { size, role: 'ghost' });
    if (shows.includes('errors'))
      pane.errors(pose, [run.rho[k], run.alpha[k], run.theta[k]], goal);
  },
  above(pane, values, { runs: all }, { time, shows }) {
    if (shows.includes('errors')) return; // before the drive
    const { width, height } = insetSize(pane, MOST), parts = shows.includes('parts');
    const runs = parts ? all.slice(0, 1) : all;
    const most = Math.max(...runs.map(({ V }) => V[0]), 1e-9),
        last = Math.max(...runs.map(({ t, n }) => t[n - 1]), 1e-9);
    const inset = insetOf(pane, 'left', { width, height: FLAT * height },
      [-0.06 * last, 1.03 * last], [-0.1 * most, 1.1 * most]);
    inset.within(() => {
      pane.line([[last, 0], [0, 0], [0, 1.1 * most]].map(inset.at), 'soft', { width: 1 });
      const curve = ({ t, n }, height, role, wide) => {
        const later = t.findIndex((second) => second > time), to = later < 0 ? n : later;
        const points = Array.from({ length: to }, (_, i) => inset.at([t[i], height(i)]));
        if (to) pane.line(points, role, { width: wide });
      };
      for (const [k, run] of [...runs.entries()].reverse())
        curve(run, (i) => run.V[i], k ? 'ghost' : 'V', k ? 1.5 : 3);
      if (parts) {
        const [run] = runs;
        curve(run, (i) => run.rho[i] ** 2 / 2, 'rho', 2);
        curve(run, (i) => run.V[i] - run.rho[i] ** 2 / 2, 'alpha', 2);
      }
    });
    if (parts) {
      pane.text('of the distance', ...inset.at([0.36 * last, 0.72 * most]),
          { role: 'rho', size: 13, fixed: true });
      pane.text('of the angles', ...inset.at([0.36 * last, 0.54 * most]),
          { role: 'alpha', size: 13, fixed: true });
    }
    pane.text('time', ...inset.at([last, 0]),
        { role: 'soft', dx: -4, dy: 9, align: 'right', fixed: true });
    pane.text('V', ...inset.at([0.4 * last, 0.9 * most]),
        { role: 'V', size: 17, weight: 600, fixed: true });
  },
});
