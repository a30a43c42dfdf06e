// A robot whose position or whose heading is that of a while ago.

import { DEGREES, written } from '../style.js';
import { arcStep, polarFromPose, wrap } from '../model.js';
import { controlLaw } from '../law.js';
import { live } from '../live.js';
import { remembered } from '../runs.js';

const held = remembered(({ start, goal, gains, dt, radius, lost, position, heading }) => {
  const poses = [start], steps = Math.round(lost / dt),
      [back, turnedBy] = [position, heading].map((each) => Math.round(each / dt));
  for (let n = 0; n < steps; n += 1) {
    const [x, y] = poses[Math.max(n - back, 0)],
        [rho, alpha, theta] = polarFromPose(x, y, poses[Math.max(n - turnedBy, 0)][2], ...goal);
    if (rho <= radius) break;
    const [v, omega] = controlLaw(rho, alpha, theta, gains);
    poses.push(arcStep(...poses[n], v, omega, dt));
  }
  return { x: poses.map((each) => each[0]), y: poses.map((each) => each[1]),
      end: poses[poses.length - 1],
      time: poses.length <= steps ? dt * (poses.length - 1) : Infinity };
});

const LATE = { position: 'position', heading: 'heading', both: 'pose' };
const length = ({ time }) =>
    (Number.isFinite(time) ? `${written(time, 's')} long` : 'which does not arrive');

export default live('late', {
  find({ delay, which }, { data }) {
    const run =
        held({ ...data, position: which === 'heading' ? 0 : delay,
        heading: which === 'position' ? 0 : delay });
    return { run, off: wrap(run.end[2] - data.goal[2]) };
  },
  panes: ({ which, delay }, { run }, { data: { goal: [x, y] } }) => ({
    whole: { x: [-25, 40, 'x, east [m]'], y: [-8, 72, 'y, north [m]'], equal: true,
        given: 'The start and the goal, 58 m apart, each with its heading.',
        alt: `The drive with a ${LATE[which]} ${written(delay, 's')} late, ${length(run)}.` },
    near: { x: [x - 3, x + 3, 'x [m]'], y: [y - 3, y + 3, 'y [m]'], equal: true,
        given: 'The goal from near.',
        alt: 'The drive where it is near the goal, and the robot at its end.' },
  }),
  draw({ whole, near }, values, { run }, hidden, { data: { start, goal } }) {
    whole.pose(start, 'start');
    whole.pose(goal, 'goal');
    near.pose(goal, 'goal');
    if (hidden) return;
    for (const pane of [whole, near]) {
      pane.path(run.x, run.y, 'path', { width: 2 });
      pane.robot(run.end);
    }
  },
  say: (values, { run, off }) =>
      ({ end: Number.isFinite(run.time)
      ? `stops after ${written(run.time, 's')}, ${Math.abs(off * DEGREES).toFixed(0)}° off`
      : 'does not arrive within a minute' }),
});
