// A robot whose position or whose heading is that of a while ago.

import { DEGREES, written } from '../style.js';
import { heldRun, remembered } from '../runs.js';
import { live } from '../live.js';
import { wrap } from '../model.js';

const lateRun = remembered(({ lost, position, heading, ...drive }) => {
  const { dt } = drive, [back, turnedBack] = [position, heading].map((it) => Math.round(it / dt));
  const past = [];
  const { poses, arrived } = heldRun({ ...drive, steps: Math.round(lost / dt), sight(k, pose) {
    past.push(pose);
    const [x, y] = past[Math.max(k - back, 0)];
    return [x, y, past[Math.max(k - turnedBack, 0)][2]];
  } });
  const [x, y] = [0, 1].map((axis) => poses.map((pose) => pose[axis]));
  return { x, y, end: poses.at(-1), time: arrived ? dt * (poses.length - 1) : Infinity };
});

const LATE = { position: 'position', heading: 'heading', both: 'pose' };
const length = ({ time }) =>
    (Number.isFinite(time) ? `${written(time, 's')} long` : 'which does not arrive');

export default live('late', {
  find({ delay, which }, { data }) {
    const run =
        lateRun({ ...data, position: which === 'heading' ? 0 : delay,
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
