// The last metre of a robot whose wheels stand below a speed: where it stops, and what mends it.

import { DEGREES, written } from '../style.js';
import { poseAt, remembered } from '../runs.js';
import { live } from '../live.js';
import { simulate, summarise } from '../simulate.js';

const AHEAD = 1.1; // the least speed over the one below which a wheel stands
const toGo = (place) => ['1 m', '10 cm', '1 cm'][place] || '';

const drives = remembered(({ start, goal, gains, wheels, dead, mend, radius }) => {
  const rate = Math.max(2 * AHEAD * dead / wheels.track_width, 0.2), // the wheels must turn
      lastTurn = { tolerance: 0.03, gain: 2, min_rate: rate, max_rate: 1, leave: 2 };
  return simulate({ start, goal, gains, reference: null, law: 'corrected', method: 'arc', dt: 0.05,
    duration: 60, arrivalRadius: radius, lastTurn: mend === 'turn' ? lastTurn : null,
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
        given: 'The goal from near.',
        alt: `The last metre: the robot stands ${written(distance, 'm')} from the goal.` },
    speed: { x: [0, 2.1, 'distance to go', toGo], y: [-0.1, 0.9, 'speed [m/s]'],
        given: 'Axes: the speed over the distance to go, from 1 m to 1 cm.',
        alt: `The speed over the distance to go ends at ${written(distance, 'm')}.` },
  }),
  draw({ near, speed }, { dead, radius }, { run, from, k, stalls }, hidden, { data }) {
    const { goal } = data, circle = [];
    for (let i = 0; i <= 60; i += 1) {
      const turn = i * Math.PI / 30;
      circle.push([goal[0] + radius * Math.cos(turn), goal[1] + radius * Math.sin(turn)]);
    }
    near.pose(goal, 'goal');
    if (hidden) return;
    near.line(circle, 'goal', { width: 1.5, dash: [4, 4] });
    speed.area([[0, -dead], [2.1, -dead], [2.1, dead], [0, dead]], 'rising', 0.2);
    speed.line([[0, 0], [2.1, 0]], 'ghost', { width: 1 });
    near.path(run.x, run.y, 'path', { from, to: k + 1 });
    near.robot(poseAt(run, k), 0.35);
    const points = [];
    for (let i = from; i <= k; i += 1)
      points.push([-Math.log10(Math.max(run.rho[i], 1e-3)), run.v[i]]);
    if (stalls > 0) speed.line([[-Math.log10(stalls), -0.1], [-Math.log10(stalls), 0.9]], 'start',
        { width: 1.5, dash: [5, 4] });
    speed.line([[-Math.log10(radius), -0.1], [-Math.log10(radius), 0.9]], 'goal',
        { width: 1.5, dash: [4, 4] });
    if (stalls > 0) speed.text('(8.9)', -Math.log10(stalls), 0.8, { role: 'start', dx: 6 });
    speed.text('radius', -Math.log10(radius), 0.7, { role: 'goal', dx: 6 });
    speed.text('wheels stand', 0.05, 0.05, { role: 'rising' });
    speed.line(points, 'path');
    speed.dot(...points[points.length - 1], 'path');
  },
  say: (values, { run, arrived, distance, headingError }) => ({
    stops: written(distance, 'm'), off: `${Math.abs(headingError * DEGREES).toFixed(1)}°`,
    ends: arrived ? `parks after ${written(run.t[run.n - 1], 's')}` : 'never parks: it stands',
  }),
});
