// The last metre of a robot whose wheels stand below a speed: where it stops, and what mends it.

import {
  freshRun, inDegrees, live, poseAt, remembered, ring, summarise, written,
} from '../drawing.js';

const AHEAD = 1.1; // the least speed over the one below which a wheel stands
const GIVEN = 0.4; // m before the goal, as far as the question shows the drive
const toGo = (place) => ['1 m', '10 cm', '1 cm'][place] || '';

const drives = remembered(({ start, goal, gains, wheels, dead, mend, radius }) => {
  const rate = Math.max(2 * AHEAD * dead / wheels.track_width, 0.2), // the wheels must turn
      lastTurn = { tolerance: 0.03, gain: 2, min_rate: rate, max_rate: 1, leave: 2 };
  return freshRun({ start, goal, gains, method: 'arc', arrivalRadius: radius,
    lastTurn: mend === 'turn' ? lastTurn : null,
    wheels: { ...wheels, dead_band: dead, min_speed: mend === 'none' ? 0 : AHEAD * dead } });
});

export default live('parking', {
  find({ dead, mend, radius, time }, { data }) {
    const run = drives({ ...data, dead, mend, radius }), end = run.n - 1,
        from = Math.max(run.rho.findLastIndex((rho) => rho > 1), 0);
    const still = (k) => Math.abs(run.x[k] - run.x[end]) + Math.abs(run.y[k] - run.y[end]) +
        Math.abs(run.heading[k] - run.heading[end]) < 1e-3;
    let last = end; // where it stands
    while (last > from && still(last - 1)) last -= 1;
    return { run, from, k: Math.round(from + time * (last - from)), ...summarise(run),
      stalls: -Math.log1p(-dead / data.gains.v_max) / data.gains.k_rho };
  },
  panes: (values, { distance }, { data: { goal } }) => ({
    near: { x: [goal[0] - 0.55, goal[0] + 0.35, 'x [m]'],
        y: [goal[1] - 0.4, goal[1] + 0.5, 'y [m]'], equal: true,
        given: 'The goal from near, and the robot on its way to it.',
        alt: `The last metre: the robot stands ${written(distance, 'm')} from the goal.` },
    speed: { x: [0, 2.1, 'distance to go', toGo], y: [-0.1, 0.9, 'speed [m/s]'],
        given: 'The speed over the distance to go, down to 40 cm.',
        alt: `The speed over the distance to go ends at ${written(distance, 'm')}.` },
  }),
  draw({ near, speed }, { dead, radius }, { run, from, k, stalls }, hidden, { data }) {
    const { goal } = data;
    near.pose(goal, 'goal');
    speed.line([[0, 0], [2.1, 0]], 'ghost', { width: 1 });
    const to = hidden ? run.rho.findIndex((rho) => rho < GIVEN) : k;
    near.path(run.x, run.y, 'path', { from, to: to + 1 });
    near.robot(poseAt(run, to), 0.35);
    const points = Array.from(run.v.subarray(from, to + 1), (v, i) =>
      [-Math.log10(Math.max(run.rho[from + i], 1e-3)), v]);
    speed.line(points, 'path');
    speed.dot(...points.at(-1), 'path');
    if (hidden) return;
    near.line(ring(goal[0], goal[1], radius), 'goal', { width: 1.5, dash: [4, 4] });
    speed.rect(0, -dead, 2.1, dead, 'rising', 0.2);
    const mark = (name, distance, y, role, dash) => {
      const x = -Math.log10(distance);
      speed.line([[x, -0.1], [x, 0.9]], role, { width: 1.5, dash });
      speed.text(name, x, y, { role, dx: 6 });
    };
    if (stalls > 0) mark('(8.9)', stalls, 0.8, 'start', [5, 4]);
    mark('radius', radius, 0.7, 'goal', [4, 4]);
    speed.text('wheels stand', 0.05, 0.05, { role: 'rising' });
  },
  say: (values, { run, arrived, distance, headingError }) => ({
    stops: written(distance, 'm'), off: inDegrees(Math.abs(headingError)),
    ends: arrived ? `parks after ${written(run.t[run.n - 1], 's')}` : 'never parks: it stands',
  }),
});
