// The three numbers that the controller sees, of a robot that is moved and turned, and of a goal
// that is turned.

import {
  DEGREES, ahead, inDegrees, live, onStops, polarFromPose, wrap, written,
} from '../drawing.js';

const toward = (from, x, y) => Math.atan2(y - from[1], x - from[0]) * DEGREES;
const LONG = 1.5; // m

/** @param {Values} values */
function find({ x, y, heading, goal_heading }, { data: { goal } }) {
  const robot = [x, y, heading / DEGREES], aim = [goal[0], goal[1], goal_heading / DEGREES],
      [rho, alpha, theta] = polarFromPose(...robot, ...aim);
  if (rho < 0.05)
    throw new RangeError(
        'On the goal itself the line of sight has no direction, and the angles mean nothing.');
  return { robot, goal: aim, rho, alpha, theta, gamma: wrap(robot[2] - aim[2]),
      sight: robot[2] + alpha };
}

export default live('polar_angles', {
  find,
  panes: (values, { rho, alpha, theta }) => ({ plane: {
    x: [-1, 8, 'x [m]'], y: [-1, 6, 'y [m]'], equal: true,
        given: 'A robot as a dot, the goal with its heading, and the line of sight from the ' +
        'robot to the goal.',
    alt: `The goal is ${written(rho, 'm')} away; alpha, from the robot's heading to the line of ` +
        `sight, is ${inDegrees(alpha)}; theta, from the goal's heading to it, is ` +
        `${inDegrees(theta)}.`,
  } }),
  draw({ plane }, values, { robot, goal, alpha, theta, sight }, hidden, { data, step = 9 }) {
    const [from, to] = hidden ? [data.start, data.goal] : [robot, goal];
    plane.line([from, to], 'rho', { dash: [4, 4] });
    plane.text('ρ', 0.6 * from[0] + 0.4 * to[0], 0.6 * from[1] + 0.4 * to[1],
        { role: 'rho', dy: 16, dx: -12, size: 17 });
    plane.pose(to, 'goal');
    if (hidden) { plane.dot(from[0], from[1], 'path'); return; }
    if (step > 0) {
      plane.line([robot, ahead(robot, LONG)], 'alpha', { width: 1.5, dash: [6, 4] });
      plane.angle(robot[0], robot[1], robot[2], alpha, 'α', 'alpha', 40);
    }
    if (step > 1) {
      plane.line([goal, ahead([goal[0], goal[1], sight], LONG)], 'rho',
          { dash: [4, 4], width: 1.5 });
      plane.angle(goal[0], goal[1], goal[2], theta, 'θ', 'theta', 46);
    }
    plane.robot(robot);
  },
  handles: (values, { robot, goal }, setup) => [
    { id: 'robot', pane: 'plane', at: robot.slice(0, 2),
        says: `the robot, at ${written(robot[0], 'm')} and ${written(robot[1], 'm')}`, move(x, y) {
      const to = onStops(setup, { x, y });
      find({ ...values, ...to }, setup);
      return to;
    } },
    { id: 'heading', pane: 'plane', at: ahead(robot, LONG),
        says: `the robot's heading, ${inDegrees(robot[2])}`,
        move: (x, y) => onStops(setup, { heading: toward(robot, x, y) }) },
    { id: 'goal', pane: 'plane', at: ahead(goal, LONG),
        says: `the goal's heading, ${inDegrees(goal[2])}`,
        move: (x, y) => onStops(setup, { goal_heading: toward(goal, x, y) }) },
  ],
  say: (values, { rho, alpha, theta, gamma }) => ({
    rho: written(rho, 'm'), alpha: inDegrees(alpha), theta: inDegrees(theta),
        beta: inDegrees(-theta), gamma: inDegrees(gamma),
    way: Math.abs(alpha) < 1e-9 ? 'goes straight on' : `turns ${alpha > 0 ? 'left' : 'right'}`,
  }),
});
