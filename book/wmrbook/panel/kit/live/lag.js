// Behind a goal that drives round: the distance that is left, in the picture and over time, and
// what (6.2) says of it.

import { driven, poseAt, timeNear } from '../runs.js';
import { live } from '../live.js';
import { summarise } from '../simulate.js';
import { written } from '../style.js';

export default live('lag', {
  find({ k_rho, v_max, time }, { data: { start, gains, speed } }) {
    const run =
        driven({ start, gains: { ...gains, k_rho, v_max }, reference: 'circle', dt: 0.1,
        duration: 40 });
    return { run, k: Math.round(time * (run.n - 1)), residual: summarise(run).residual,
        predicted: -Math.log(1 - speed / v_max) / k_rho };
  },
  panes: (values, { run, k, residual }) => ({
    circle: { x: [-8.6, 2.6, 'x [m]'], y: [-4.8, 4.8, 'y [m]'], equal: true,
        given: 'The circle of the goal and the robot where it starts.',
        alt: `The robot ${written(run.rho[k], 'm')} behind the goal, which drives round a circle.`,
        scrub: (x, y) => timeNear(run.x, run.y, x, y, 0.5) },
    distance: { x: [0, 40, 'time [s]'], y: [0, 0.4, 'distance to the goal [m]'],
        given: 'Room for the distance over time.',
        alt: `The distance over time levels out at ${written(residual, 'm')}.`,
        scrub: (x) => ({ time: Math.min(Math.max(x / 40, 0), 1) }) },
  }),
  draw({ circle: picture, distance }, values, { run, k, predicted }, hidden, { data: { start } }) {
    picture.path(run.goalX, run.goalY, 'goal', { width: 1.2, dash: [3, 4] });
    if (hidden) { picture.robot(start); return; }
    picture.path(run.x, run.y, 'path', { to: k + 1 });
    picture.pose([run.goalX[k], run.goalY[k], run.goalHeading[k]], 'goal');
    picture.robot(poseAt(run, k));
    distance.line([[0, predicted], [40, predicted]], 'start', { width: 1.5, dash: [6, 4] });
    distance.text('(6.2)', 39, predicted, { role: 'start', dy: 11, align: 'right' });
    distance.path(run.t, run.rho, 'rho');
    distance.dot(run.t[k], run.rho[k], 'rho');
  },
  say: (values, { residual, predicted }) =>
      ({ residual: written(residual, 'm'), predicted: written(predicted, 'm') }),
});
