// Chapter 11: where the robot is, and, pale, where it believes that it is.

import { DEGREES, ahead, endsOf, heldRun, inDegrees, stage, trackOf } from '../drawing.js';

export default stage('crooked_compass', {
  find({ start, goal, bias, arm, takes }, { data: { gains, dt, radius, steps } }) {
    const sight = (k, pose) => [...ahead(pose, arm),
      (takes === 'bearing' ? Math.PI / 2 - pose[2] : pose[2]) + bias / DEGREES];
    const run = heldRun({ start, goal, gains, dt, radius, steps, sight });
    return { run, sight, tracks: [trackOf(run, dt)] };
  },
  say: ({ goal, bias }, { run }) => ({ bias: inDegrees(Math.abs(bias / DEGREES), 0),
    ...endsOf(run, goal) }),
  draw(pane, values, { sight }, { k, pose, size }) { pane.robot(sight(k, pose), 0.4, { size }); },
  above(pane, { arm }, run, { pose }) {
    const [x, y] = ahead(pose, arm);
    pane.dot(x, y, 'rho', { size: 6 });
  },
});
