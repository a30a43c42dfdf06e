// The heading error over the distance still to go, and a robot that stops wherever one wants.

import {
  DEGREES, between, freshRun, inDegrees, inReach, live, nearest, remembered, wrap, written,
} from '../drawing.js';

const toGo = (place) => ['1 m', '10 cm', '1 cm'][place] || '';
const NEAR = 0.25; // m: a pointer this near the path is on it
const approach = (start, goal, gains) => {
  const run = freshRun({ start, goal, gains, dt: 0.005, arrivalRadius: 0.01 });
  return { run, from: run.rho.findIndex((rho) => rho < 2),
      off: Array.from(run.heading, (heading) => wrap(heading - goal[2])) };
};
const runs = remembered(({ start, goal, paper, gentle }) =>
    ({ paper: approach(start, goal, paper), gentle: approach(start, goal, gentle) }));

export default live('stopping', {
  find({ gains, stop }, { data }) {
    const all = runs(data), { run, off, from } = all[gains],
        at = run.rho.findIndex((rho) => rho <= stop), k = at < 0 ? run.n - 1 : Math.max(at, 1);
    const place = k - 1 + (run.rho[k - 1] - stop) / (run.rho[k - 1] - run.rho[k]);
    return { all, run, from, k, t: between(run.t, place), off: between(off, place),
        pose: [run.x, run.y, run.heading].map((column) => between(column, place)) };
  },
  panes: ({ stop }, { off }, { data: { goal }, ...setup }) => ({
    near: {
      x: [goal[0] - 1.4, goal[0] + 0.8, 'x [m]'], y: [goal[1] - 1.4, goal[1] + 0.8, 'y [m]'],
          equal: true, given: 'The robot 5 cm before its goal.',
      alt: `The robot stops ${written(stop, 'm')} before the goal, ` +
          `${Math.abs(off * DEGREES).toFixed(0)} degrees off.`,
      scrub(x, y, moved, values, { run, from }) {
        const k = nearest(run.n, (i) => Math.hypot(run.x[i] - x, run.y[i] - y), NEAR, from);
        return k && inReach(setup, { stop: run.rho[k] });
      },
    },
    errors: {
      x: [-0.35, 2.1, 'distance to go', toGo], y: [-90, 180, 'heading error [°]'],
          given: 'The heading error over the distance to go, down to 5 cm.',
      alt: `The heading error over the distance to go, from 2 m to 1 cm: ` +
          `${(off * DEGREES).toFixed(0)} degrees at ${written(stop, 'm')}.`,
      scrub: (x) => inReach(setup, { stop: 10 ** -x }),
    },
  }),
  draw({ near, errors }, { gains, stop }, { all, run, k, off, pose }, hidden, { data: { goal } }) {
    near.pose(goal, 'goal');
    for (const name of hidden ? [gains] : ['paper', 'gentle']) {
      const each = all[name], role = name === gains ? 'path' : 'ghost', points = [];
      for (let i = each.from; i < (hidden ? k : each.run.n); i += 1)
        points.push([-Math.log10(each.run.rho[i]), each.off[i] * DEGREES]);
      errors.line(points, role, name === gains ? {} : { width: 1.5, dash: [5, 4] });
      const [x, y] = points[Math.floor(points.length / 6)];
      errors.text(name, x, y, { role, dx: 8, dy: 12 });
    }
    errors.line([[-Math.log10(stop), -90], [-Math.log10(stop), 180]], 'ink',
        { width: 1, dash: [2, 3] });
    errors.dot(-Math.log10(stop), off * DEGREES, 'path');
    if (!hidden) near.path(run.x, run.y, 'ghost', { width: 1.5, dash: [2, 5], from: k });
    near.path(run.x, run.y, 'path', { from: Math.max(all[gains].from - 200, 0), to: k + 1 });
    near.robot([goal[0], goal[1], goal[2]], 0.25);
    near.robot(pose);
  },
  say: (values, { t, off }) =>
      ({ seconds: written(t, 's'),
      off: `${inDegrees(Math.abs(off), 0)} too far to the ${off < 0 ? 'right' : 'left'}` }),
});
