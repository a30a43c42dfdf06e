// Chapter 8: the robot looks, and holds its command until it looks again.

import {
  freshRun, gainsOf, inDegrees, inSize, inWords, poseAt, remembered, stage, trackOf, wrap,
} from '../drawing.js';

const drives = remembered(freshRun);

// Within the radius it turns on the spot; if it looks seldom, it must be content with more.
const lastTurn = (dt) => ({ tolerance: Math.max(0.03, 0.3 * dt), gain: Math.min(2, 1 / dt),
  min_rate: 0.5, max_rate: 1, leave: 2 });

// Where it does not move any more.
function lastMove({ n, v, omega }) {
  let k = n - 1;
  while (k > 0 && !v[k - 1] && !omega[k - 1]) k -= 1;
  return k;
}

export default stage('late_looks', {
  find(values, setup) {
    const { start, goal, dt, wheels } = values, { data: { radius, seconds } } = setup;
    const turns = wheels === 'turn', of = setup.data.wheels[turns ? 'least' : wheels];
    const run = drives({ start, goal, gains: gainsOf(values, setup), method: 'arc', dt,
      duration: seconds, arrivalRadius: radius, wheels: of,
      lastTurn: turns ? lastTurn(dt) : null });
    const last = lastMove(run), ks = Array.from({ length: last + 1 }, (_, k) => k);
    const poses = ks.map((k) => poseAt(run, k)), twists = ks.map((k) => [run.v[k], run.omega[k]]);
    return { run, poses, tracks: [trackOf({ poses, twists }, dt)],
      arrived: run.outcome === 'ARRIVED', stands: last < run.n - 1 };
  },
  say({ dt, goal }, { poses, arrived, stands }) {
    const [x, y, heading] = poses.at(-1), off = inDegrees(Math.abs(wrap(heading - goal[2])), 0),
        where = `${inSize(Math.hypot(x - goal[0], y - goal[1]))} from its goal, ${off} off`;
    return { every: `${inWords(dt)} s`, looks: poses.length, off,
      ends: arrived ? `stops ${where}` : stands ? `stands still ${where}, and stays there`
      : 'has not stopped after a minute' };
  },
  draw(pane, { dt }, { poses }, { time }) {
    for (const [x, y] of poses.slice(0, Math.floor(time / dt + 1e-9) + 1))
      pane.dot(x, y, 'path', { size: 4, hollow: true });
  },
});
