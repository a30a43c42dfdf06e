// Five laws from one start, with the same wheels: their paths, and how each of them ends.

import {
  DEGREES, heldRun, inDegrees, live, onStops, remembered, wrap, written,
} from '../drawing.js';

/** @type {Record<string, [string, number[]]>} */
const LOOKS = { corrected: ['path', []], printed: ['rising', [2, 5]], aicardi: ['alpha', [9, 4]],
    barrier: ['theta', [9, 3, 2, 3]], graceful: ['goal', [4, 4]] };
const raced = remembered(({ start, goal, tuned, dt, seconds, radius, track, most }) => {
  const limits = { b: track, max_speed: most, min_speed: 0 }, steps = Math.round(seconds / dt);
  return Object.entries(tuned).map(([law, gains]) => {
    const how = { start, goal, gains, dt, radius, law, limits, steps };
    const { poses, twists, arrived } = heldRun(how), end = poses.at(-1);
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
    x: [-4, 4, 'x [m]'], y: [-3, 3, 'y [m]'], equal: true, ghosts: false,
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
  handles: ({ x, y }, found, setup) => [{
    id: 'start', pane: 'plane', at: [x, y],
        says: `the start, at ${written(x, 'm')} and ${written(y, 'm')}`,
    move: (toX, toY) => onStops(setup, { x: toX, y: toY }),
  }],
  say: (values, { chosen: { arrived, time, left, back } }, { data: { most, track } }) => ({
    ends: arrived ? `arrives after ${written(time, 's')}` : 'is on its way after a minute',
    back: `${back.toFixed(1)} m`, left: inDegrees(left, 0),
        turn: `${(left * track / 2 / most).toFixed(1)} s`,
  }),
});
