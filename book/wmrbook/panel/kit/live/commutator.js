// Forward, left, back, right, and again: where moves that cancel lead.

import { DEGREES, arcStep, live, written } from '../drawing.js';

const WAYS = [{ first: 0, name: 'forward', role: 'path', dash: [], dy: 10 },
    { first: 2, name: 'back', role: 'ghost', dash: [6, 4], dy: -14 }];

export default live('commutator', {
  find({ step, turn, moves }) {
    const round = [[step, 0], [0, turn / DEGREES], [-step, 0], [0, -turn / DEGREES]],
        poses = [[0, 0, 0]];
    for (let k = 0; k < 12; k += 1) poses.push(arcStep(...poses[k], ...round[k % 4], 1));
    const done = Math.min(Math.floor(moves), 11),
        now = arcStep(...poses[done], ...round[done % 4], moves - done);
    return { poses, done, now };
  },
  panes: (values, { now }) => ({ plane: {
    x: [-0.2, 1.2, 'ahead [m]'], y: [-1.2, 0.2, 'left [m]'], equal: true, tall: true,
        given: 'The robot at the start, looking ahead.',
    alt: `The way of the four moves, three times: the robot is ${written(now[0], 'm')} ahead ` +
        `and ${written(-now[1], 'm')} to the right of where it began.`,
  } }),
  draw({ plane }, values, { poses, done, now }, hidden) {
    if (!hidden) {
      plane.robot([0, 0, 0], 0.45);
      for (const { first, name, role, dash, dy } of WAYS) {
        for (let k = first; k <= done; k += 4)
          plane.line([poses[k], k === done ? now : poses[k + 1]], role, { dash });
        const [x, y] = poses[1 + first / 2];
        if (done >= first) plane.text(name, x, y, { role, dx: 20, dy });
      }
      for (let k = 4; k <= done; k += 4) plane.robot(poses[k], 0.45);
    }
    plane.text('start', 0, 0, { role: 'start', dy: 22, align: 'center' });
    plane.robot(hidden ? [0, 0, 0] : now);
  },
  say: ({ moves }, { poses, now }) => ({
    right: written(-poses[4][1], 'm'), ahead: written(poses[4][0], 'm'),
        number: `${Math.round(100 * moves) / 100} ${moves === 1 ? 'move' : 'moves'}`,
    where: `${written(-now[1], 'm')} to the right and ${written(now[0], 'm')} ahead`,
  }),
});
