// A walk whose points are passed: the way, and V, which is another one after each of them.

import { ahead, alongRoute, live, poseAt, ring, timeNear, within, written } from '../drawing.js';

export default live('passing', {
  find({ radius, time }, { data: { poses, gains } }) {
    const [start, ...goals] = poses,
        radii = goals.map((_, k) => (k < goals.length - 1 ? radius : 0.05)),
        run = alongRoute({ start, goals, radii, gains });
    return { run, k: Math.round(time * (run.n - 1)) };
  },
  panes: ({ radius }, { run }) => ({
    plane: { x: [-8, 54, 'east [m]'], y: [-6, 60, 'north [m]'], equal: true,
        given: 'Five points of a walk, each with its heading, and the first leg.',
        alt: `The walk, its points passed within ${written(radius, 'm')}: ` +
        `${written(run.t[run.n - 1], 's')} long.`,
      scrub: (x, y) => timeNear(run.x, run.y, x, y, 6) },
    value: { x: [0, 60, 'time [s]'], y: [0, 800, 'V'], 
        given: 'V over time, on the first leg.',
        alt: `V over time: ${run.leg[run.n - 1]} jumps between falling legs.`,
        scrub: (x) => ({ time: within(x / run.t[run.n - 1], 0, 1) }) },
  }),
  draw({ plane, value }, { radius }, { run, k }, hidden, { data: { poses } }) {
    poses.forEach(([x, y, heading], i) => {
      const ends = i === 0 ? 'start' : i === poses.length - 1 ? 'goal' : '';
      if (ends) plane.pose([x, y, heading], ends);
      else {
        if (!hidden)
          plane.line(ring(x, y, radius), 'ghost', { width: 1.5, dash: [3, 4] });
        plane.arrow(x, y, ...ahead([x, y, heading], 6), 'theta');
        plane.dot(x, y, 'ink', { hollow: true });
      }
    });
    const shown = hidden ? run.leg.indexOf(1) - 1 : k;
    plane.path(run.x, run.y, 'path', { to: hidden ? shown + 1 : run.n });
    plane.robot(poseAt(run, shown));
    for (let leg = 0, from = 0; leg <= (hidden ? 0 : run.leg[run.n - 1]); leg += 1) {
      const to = run.leg.indexOf(leg + 1) < 0 ? run.n : run.leg.indexOf(leg + 1);
      value.path(run.t, run.V, 'path', { from, to });
      if (to < run.n && !hidden)
        value.line([[run.t[to], run.V[to - 1]], [run.t[to], run.V[to]]], 'rising',
            { width: 2, dash: [5, 4] });
      from = to;
    }
    value.dot(run.t[shown], run.V[shown], 'path', { hollow: true });
  },
  say: (values, { run, k }) =>
      ({ seconds: run.arrived ? written(run.t[run.n - 1], 's') : 'more than two minutes',
      omega: written(run.peakOmega, 'rad/s'), V: written(run.V[k]), v: written(run.v[k], 'm/s') }),
});
