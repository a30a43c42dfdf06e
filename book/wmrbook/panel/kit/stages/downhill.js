// Chapter 4: seven robots drive to one goal; in a corner the number V of each falls.

import { freshRun, gainsOf, insetOf, insetSize, remembered, stage, wrap } from '../drawing.js';

const ROOM = 6; // m, from the goal to the edge
const DT = 0.15; // s, between two samples
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
    return { runs, rises, parked, tracks: runs.map((run, k) =>
      ({ ...run, role: k ? 'ghost' : 'path' })) };
  },
  look({ start, goal }) {
    const [far, up] = [0, 1].map((i) => Math.max(ROOM, Math.abs(start[i] - goal[i]) + 1));
    return [goal[0] - far, goal[1] - up, goal[0] + far, goal[1] + up];
  },
  say: (values, { parked, rises }) => ({ parked, rises: rises ? 'rises' : 'never rises' }),
  draw(pane, values, found, { size }, { data: { others: starts } }) {
    for (const start of starts) pane.robot(start, 0.4, { size, role: 'ghost' });
  },
  above(pane, values, { runs }, { time }) {
    const { width, height } = insetSize(pane, 210);
    const most = Math.max(...runs.map(({ V }) => V[0]), 1e-9),
        last = Math.max(...runs.map(({ t, n }) => t[n - 1]), 1e-9);
    const inset = insetOf(pane, 'left', { width, height: 0.72 * height },
      [-0.06 * last, 1.03 * last], [-0.1 * most, 1.1 * most]);
    inset.within(() => {
      pane.line([[last, 0], [0, 0], [0, 1.1 * most]].map(inset.at), 'soft', { width: 1 });
      for (const [k, { t, V, n }] of [...runs.entries()].reverse()) {
        const shown = t.findIndex((each) => each > time), to = shown < 0 ? n : shown;
        const points = Array.from({ length: to }, (_, i) => inset.at([t[i], V[i]]));
        if (to) pane.line(points, k ? 'ghost' : 'V', { width: k ? 1.5 : 3 });
      }
    });
    pane.text('time', ...inset.at([last, 0]),
        { role: 'soft', size: 12, dx: -4, dy: 9, align: 'right', fixed: true });
    pane.text('V', ...inset.at([last / 2, 0.9 * most]),
        { role: 'V', size: 17, weight: 600, fixed: true });
  },
});
