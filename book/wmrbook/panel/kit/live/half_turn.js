// A goal behind the robot: a hair to either side of straight behind, and the robot turns the other
// way.

import { DEGREES, driven, inDegrees, live, poseAt, written } from '../drawing.js';

// the goal lies `off` degrees to the right of straight behind
const away = (start, off) => [start[0], start[1], Math.PI - off / DEGREES];

export default live('half_turn', {
  find({ off, time }, { data: { start, goal, gains } }) {
    const run = driven({ start: away(start, off), goal, gains }), last = run.n - 1;
    return { run, k: Math.round(time * last), turns: run.omega[0] > 0 ? 'left' : 'right' };
  },
  panes: (values, { run, turns }) => ({
    plane: { x: [-12.5, 4, 'x [m]'], y: [-4.5, 4.5, 'y [m]'], equal: true,
        given: 'The robot looks away from the goal, 10 m straight behind it.',
        alt: `The robot sets off ${run.v[0] < 0 ? 'backwards' : 'forwards'}, turns ${turns}, ` +
        `and drives to the goal; dashed, the mirror image.` },
  }),
  draw({ plane }, values, { run, k }, hidden, { data: { start, goal } }) {
    plane.pose(goal, 'goal');
    if (hidden) { plane.robot(start); return; }
    plane.line(Array.from(run.x, (x, i) => [x, -run.y[i]]), 'ghost', { width: 1.5, dash: [2, 5] });
    plane.path(run.x, run.y, 'path', { width: 1.5, from: k });
    plane.path(run.x, run.y, 'path', { width: 4, to: k + 1 });
    plane.robot(poseAt(run, 0), 0.35);
    plane.robot(poseAt(run, k));
  },
  say: (values, { run, turns }) => ({
    alpha: inDegrees(run.alpha[0]), omega: written(Math.abs(run.omega[0]), 'rad/s'),
        sets: run.v[0] < 0 ? 'backwards' : 'forwards', turns,
    end: run.outcome === 'ARRIVED' ? `is there after ${written(run.t[run.n - 1], 's')}`
        : 'is still on its way after a minute',
  }),
});
