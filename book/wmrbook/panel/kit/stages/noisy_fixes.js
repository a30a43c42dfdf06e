// Chapter 9: the robot sees where its fixes say that it is; on other days they say something else.

import {
  gainsOf, heldRun, inDegrees, inSize, normals, remembered, stage, trackOf, wrap,
} from '../drawing.js';

const drawn = remembered(({ days, steps, seed }) => Array.from({ length: days }, (_, day) =>
  Array.from({ length: steps + 1 }, (__, k) => normals(day, k, seed))));

export default stage('noisy_fixes', {
  find(values, setup) {
    const { start, goal, sigma } = values, { dt, days, steps, seed, radius } = setup.data;
    const fixes = [], runs = drawn({ days, steps, seed }).map((errors, day) => heldRun({
      start, goal, gains: gainsOf(values, setup), dt, radius, steps,
      sight(k, [x, y, heading]) {
        const fix = [x + sigma * errors[k][0], y + sigma * errors[k][1], heading];
        if (!day) fixes.push(fix);
        return fix;
      },
    }));
    return { runs, fixes, tracks: [trackOf(runs[0], dt)] };
  },
  say({ goal }, { runs }) {
    const ends = runs.filter(({ arrived }) => arrived).map(({ poses }) => poses.at(-1));
    const worst = (f) => Math.max(...ends.map(f));
    return { days: runs.length,
      ends: ends.length === 0 ? 'never stops within half a minute'
        : `stops ${ends.length === runs.length ? '' : `${ends.length} times, `}up to ${
          inSize(worst(([x, y]) => Math.hypot(x - goal[0], y - goal[1])))} and ${
          inDegrees(worst((end) => Math.abs(wrap(end[2] - goal[2]))), 0)} off` };
  },
  draw(pane, values, { runs, fixes }, { k, done, size }) {
    for (const [x, y] of fixes.slice(0, k + 1)) pane.dot(x, y, 'rho', { size: 3 });
    for (const { poses, arrived } of runs.slice(1))
      if (done && arrived) pane.robot(poses.at(-1), 0.15, { size });
  },
});
