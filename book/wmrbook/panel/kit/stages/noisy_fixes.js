// Chapter 9: the robot sees where its fixes say that it is; on other days they say something else.

import {
  endsOf, gainsOf, heldRun, inDegrees, inSize, normals, remembered, stage, trackOf, wrap,
} from '../drawing.js';

const ROOM = 2; // m, from the drive to the edge

// The errors of every day, in standard deviations: each keeps a share of the one before.
const drawn = remembered(({ days, steps, seed, keep }) =>
  Array.from({ length: days }, (_, day) => {
    const errors = [normals(day, 0, seed)], fresh = Math.sqrt(1 - keep ** 2);
    for (let k = 1; k <= steps; k += 1)
      errors.push(normals(day, k, seed).map((it, i) => keep * errors[k - 1][i] + fresh * it));
    return errors;
  }));

export default stage('noisy_fixes', {
  find(values, setup) {
    const { start, goal, sigma, radius, memory, late, scene } = values,
        { dt, days, steps, seed, keep, back, turn } = setup.data;
    const errors = drawn({ days, steps, seed, keep: keep[memory] }), end = scene === 'turn' && turn;
    const drives = errors.map((own) => {
      const past = [], fixes = [];
      const run = heldRun({ start, goal, gains: gainsOf(values, setup), dt, radius, steps, end,
        sight(k, pose) {
          past.push(pose);
          const before = Math.max(k - back, 0), fix = late === 'position' ? before : k,
              [x, y] = past[fix], [east, north] = own[fix];
          fixes.push([x + sigma * east, y + sigma * north]);
          return [...fixes[k], past[late === 'heading' ? before : k][2]];
        } });
      return { run, fixes };
    });
    const runs = drives.map(({ run }) => run);
    return { runs, errors, fixes: drives[0].fixes, tracks: [trackOf(runs[0], dt)] };
  },
  look: ({ start, goal }) => [0, 1].map((i) => Math.min(start[i], goal[i]) - ROOM)
      .concat([0, 1].map((i) => Math.max(start[i], goal[i]) + ROOM)),
  say({ goal }, { runs }) {
    const ends = runs.filter(({ arrived }) => arrived).map(({ poses }) => poses.at(-1));
    const worst = (f) => Math.max(...ends.map(f));
    return { days: runs.length, one: endsOf(runs[0], goal).ends,
      ends: ends.length === 0 ? 'never stops within a minute'
        : `stops ${ends.length === runs.length ? '' : `${ends.length} times, `}up to ${
          inSize(worst(([x, y]) => Math.hypot(x - goal[0], y - goal[1])))} and ${
          inDegrees(worst((end) => Math.abs(wrap(end[2] - goal[2]))), 0)} off` };
  },
  draw(pane, values, { runs, fixes }, { k, done, size, shows }) {
    if (shows.includes('sight')) return;
    for (const [x, y] of fixes.slice(0, k + 1)) pane.dot(x, y, 'rho', { size: 3 });
    for (const { poses, arrived } of runs.slice(1))
      if (done && arrived) pane.robot(poses.at(-1), 0.15, { size });
  },
  above(pane, { sigma, goal }, { errors }, { k, shows, pose: [x, y] }) {
    if (!shows.includes('sight')) return;
    for (const { [k]: [east, north] } of errors) {
      const fix = [x + sigma * east, y + sigma * north];
      pane.line([fix, goal], 'alpha', { width: 1 });
      pane.dot(...fix, 'rho', { size: 3 });
    }
  },
});
