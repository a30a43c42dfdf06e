// The same numbers read with x east and with x north, on one map with north up.

import { driven, inDegrees, live, poseAt, timeNear, wrap, written } from '../drawing.js';

/** @type {(pose: Pose, axis: string) => Pose} */
const onMap = ([x, y, heading], axis) =>
    (axis === 'east' ? [x, y, heading] : [y, x, Math.PI / 2 - heading]);

export default live('x_axis', {
  find({ axis, time }, { data: { starts, goals, gains } }) {
    const run = driven({ start: starts[axis], goal: goals[axis], gains }), last = run.n - 1;
    const way = Array.from({ length: run.n }, (_, k) => onMap(poseAt(run, k), axis)),
        x = way.map((each) => each[0]), y = way.map((each) => each[1]);
    return { run, way, x, y, k: Math.round(time * last), alpha: run.alpha[0],
        off: wrap(run.theta[last] - run.alpha[last]), start: onMap(starts[axis], axis),
        goal: onMap(goals[axis], axis) };
  },
  panes({ axis }, { off, goal, x, y }) {
    return {
      whole: { x: [-12, 32, 'east [m]'], y: [-5, 70, 'north [m]'], equal: true,
          given: 'The start and the goal on a map, north up, without their headings.',
          alt: `The drive on a map with north up, read with x ${axis}.`,
          scrub: (...at) => timeNear(x, y, ...at.slice(0, 2), 3) },
      near: { x: [goal[0] - 1.5, goal[0] + 1.5, 'east [m]'],
          y: [goal[1] - 2, goal[1] + 1, 'north [m]'], equal: true, given: 'The goal from near.',
          alt: `The last two metres: the robot stops ${inDegrees(off)} off.`,
          scrub: (...at) => timeNear(x, y, ...at.slice(0, 2), 0.2) },
    };
  },
  draw({ whole, near }, values, { way, x, y, k, start, goal }, hidden) {
    whole.line([start, goal], 'rho', { width: 1.2, dash: [2, 4] });
    if (hidden) {
      whole.dot(start[0], start[1], 'start');
      for (const pane of [whole, near]) pane.dot(goal[0], goal[1], 'goal');
      return;
    }
    whole.pose(start, 'start');
    for (const pane of [whole, near]) {
      pane.pose(goal, 'goal');
      pane.path(x, y, 'ghost', { width: 1.5, dash: [2, 5], from: k });
      pane.path(x, y, 'path', { to: k + 1 });
      pane.robot(way[k]);
    }
  },
  say: (values, { run, alpha, off }) =>
      ({ alpha: inDegrees(Math.abs(alpha), 0), seconds: written(run.t[run.n - 1], 's'),
      off: inDegrees(Math.abs(off), 0) }),
});
