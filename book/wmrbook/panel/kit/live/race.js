// Five laws from one start, with the same wheels: their paths, and how each of them ends.

import { DEGREES, written } from '../style.js';
import { heldRun, remembered } from '../runs.js';
import { live } from '../live.js';
import { wrap } from '../model.js';

/** @type {Record<string, [string, number[]]>} */
const LOOKS = { corrected: ['path', []], printed: ['rising', [2, 5]], aicardi: ['alpha', [9, 4]],
    barrier: ['theta', [9, 3, 2, 3]], graceful: ['goal', [4, 4]] };
const raced = remembered(({ start, goal, tuned, dt, seconds, radius, track, most }) => {
  const wheels = (v, omega) => {
    const fastest = Math.abs(v) + Math.abs(omega) * track / 2,
        share = Math.min(1, most / Math.max(fastest, 1e-12));
    return [share * v, share * omega];
  };
  return Object.entries(tuned).map(([law, gains]) => {
    const how = { start, goal, gains, dt, radius, law, wheels, steps: Math.round(seconds / dt) };
    const { poses, twists, arrived } = heldRun(how), end = poses[poses.length - 1];
    return { law, arrived, end, x: poses.map(([x]) => x), y: poses.map(([, y]) => y),
        time: dt * (poses.length - 1), left: Math.abs(wrap(end[2] - goal[2])),
        back: twists.slice(0, -1).reduce((sum, [v]) => sum + dt * Math.max(-v, 0), 0) };
  });
});

export default live('race', {
  find({ x, y, heading, law }, { data }) {
    const runs = raced({ ...data, start: [x, y, heading / DEGREES] });
    return { runs, chosen: runs.find((each) => each.law === law) };
  },
  panes: (values, { runs }) => ({ plane: {
    x: [-4, 4, 'x [m]'], y: [-3, 3, 'y [m]'], equal: true, tall: true, ghosts: false,
        given: 'A goal, and a robot with the goal straight behind it.',
    alt: `Five paths to the goal. ${runs.map(({ law, arrived, time }) =>
        `${law}: ${arrived ? written(time, 's') : 'does not arrive'}`).join('; ')}.`,
  } }),
  draw({ plane }, { x, y, heading, law }, { runs }, hidden, { data: { goal, start } }) {
    plane.pose(goal, 'goal');
    if (hidden) { plane.robot(start); return; }
    runs.forEach((run) => {
      const [role, dash] = LOOKS[run.law];
      plane.path(run.x, run.y, role, { width: run.law === law ? 4 : 1.5, dash });
      plane.robot(run.end, run.law === law ? 1 : 0.2);
    });
    plane.robot([x, y, heading / DEGREES], 0.5);
    const [left, , , top] = plane.range;
    Object.entries(LOOKS).forEach(([name, [role, dash]], i) => {
      const [from, at] = [left + 10 * plane.pixel, top - (10 + 16 * i) * plane.pixel];
      plane.line([[from, at], [from + 30 * plane.pixel, at]], role, { dash });
      plane.text(name[0].toUpperCase() + name.slice(1), from, at, { role, dx: 36, size: 12 });
    });
  },
  handles: ({ x, y }) => [{
    id: 'start', pane: 'plane', at: [x, y],
        says: `the start, at ${written(x, 'm')} and ${written(y, 'm')}`,
    move(toX, toY) {
      const [nx, ny] = [toX, toY].map((it, i) =>
          Math.round(10 * Math.min(Math.max(it, i ? -2.5 : -3.5), i ? 2.5 : 3.5)) / 10);
      return { x: nx, y: ny };
    },
  }],
  say: (values, { chosen: { arrived, time, left, back } }, { data: { most, track } }) => ({
    ends: arrived ? `arrives after ${written(time, 's')}` : 'is on its way after a minute',
    back: `${back.toFixed(1)} m`, left: `${(left * DEGREES).toFixed(0)}°`,
        turn: `${(left * track / 2 / most).toFixed(1)} s`,
  }),
});
