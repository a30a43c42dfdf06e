// Chapter 8: the robot looks, and holds its command until it looks again.

import { endsOf, gainsOf, heldRun, inWords, stage, trackOf } from '../drawing.js';

export default stage('late_looks', {
  find(values, setup) {
    const { start, goal, dt } = values, { radius, seconds } = setup.data;
    const run = heldRun({ start, goal, gains: gainsOf(values, setup), dt, radius,
      steps: Math.floor(seconds / dt) });
    return { run, tracks: [trackOf(run, dt)] };
  },
  say: ({ dt, goal }, { run }) => ({ every: `${inWords(dt)} s`, looks: run.poses.length,
    ...endsOf(run, goal) }),
  draw(pane, { dt }, { run: { poses } }, { time }) {
    for (const [x, y] of poses.slice(0, Math.floor(time / dt + 1e-9) + 1))
      pane.dot(x, y, 'path', { size: 4, hollow: true });
  },
});
