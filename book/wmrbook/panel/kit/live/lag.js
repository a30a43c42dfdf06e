// Behind a goal that drives round: a camera rides with the goal, and shows the distance that is
// left; beside it that distance over time, and what (7.2) says of it.

import { driven, live, onStops, poseAt, summarise, within, written } from '../drawing.js';

const NEAR = 0.22; // m round the goal, or as far as the robot is

export default live('lag', {
  find({ k_rho, v_max, time }, { data: { start, gains, speed } }) {
    const run =
        driven({ start, gains: { ...gains, k_rho, v_max }, reference: 'circle', dt: 0.1,
        duration: 40 });
    return { run, k: Math.round(time * (run.n - 1)), residual: summarise(run).residual,
        predicted: -Math.log(1 - speed / v_max) / k_rho };
  },
  panes(values, { run, k, residual }) {
    const near = Math.max(NEAR, 1.25 * run.rho[k]),
        around = (at) => /** @type {Axis} */ ([at - near, at + near]);
    return {
      circle: { x: around(run.goalX[k]), y: around(run.goalY[k]), lawn: 0.25,
          given: 'The goal from near, and the robot that stays behind it.',
          alt: `The robot ${written(run.rho[k], 'm')} behind the goal, seen from a camera that ` +
          `rides with the goal.` },
      distance: { x: [0, 40, 'time [s]'], y: [0, 0.4, 'distance to the goal [m]'],
          given: 'The distance over time, with the gains at first.',
          alt: `The distance over time levels out at ${written(residual, 'm')}.`,
          scrub: (x) => ({ time: within(x / 40, 0, 1) }) },
    };
  },
  draw({ circle: picture, distance }, values, { run, k, predicted }) {
    const pose = poseAt(run, k), [x, y] = pose,
        goal = [run.goalX[k], run.goalY[k], run.goalHeading[k]];
    picture.path(run.goalX, run.goalY, 'goal', { width: 1.5, dash: [3, 4] });
    picture.path(run.x, run.y, 'path', { to: k + 1 });
    picture.pose(goal, 'goal');
    picture.robot(pose);
    picture.arrow(x, y, goal[0], goal[1], 'rho');
    picture.text(written(run.rho[k], 'm'), (x + goal[0]) / 2, (y + goal[1]) / 2,
        { role: 'rho', dx: 40 * Math.sin(goal[2]), dy: -40 * Math.cos(goal[2]), align: 'center' });
    distance.line([[0, predicted], [40, predicted]], 'start', { width: 1.5, dash: [6, 4] });
    distance.text('(7.2)', 39, predicted, { role: 'start', dy: 11, align: 'right' });
    distance.path(run.t, run.rho, 'rho');
    distance.dot(run.t[k], run.rho[k], 'rho');
  },
  handles: ({ v_max }, { predicted }, setup) => [{
    id: 'predicted', pane: 'distance', at: [34, predicted],
    says: `the distance that stays, ${written(predicted, 'm')}`,
    // the k_rho with which (7.2) says this distance
    move: (x, y) => onStops(setup,
        { k_rho: -Math.log(1 - setup.data.speed / v_max) / Math.max(y, 0.01) }),
  }],
  say: (values, { residual, predicted }) =>
      ({ residual: written(residual, 'm'), predicted: written(predicted, 'm') }),
});
