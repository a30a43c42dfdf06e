// The paper's outdoor drive and its last two metres, and gains between the paper's and gentle ones.

import { DEGREES, blended, driven, inDegrees, live, poseAt, wrap, written } from '../drawing.js';

export default live('last_metres', {
  find({ share, time }, { data: { start, goal, paper, gentle } }) {
    const gains = blended(paper, gentle, share), run = driven({ start, goal, gains }),
        last = run.n - 1;
    return { gains, run, k: Math.round(time * last), off: wrap(run.heading[last] - goal[2]) };
  },
  panes: (values, { run, off }, { data: { goal } }) => ({
    whole: { x: [-9, 23, 'x, east [m]'], y: [-5, 62, 'y, north [m]'], equal: true,
        given: 'The start and the goal, 58 m apart, each with its heading.',
        alt: `The drive from the start to the goal, ${written(run.t[run.n - 1], 's')} long.` },
    near: { x: [goal[0] - 1.5, goal[0] + 1.5, 'x [m]'], y: [goal[1] - 2, goal[1] + 1, 'y [m]'],
        equal: true, given: 'The goal from near, with the heading that is asked for.',
        alt: `The last two metres: the robot stops ` +
        `${Math.abs(off * DEGREES).toFixed(0)} degrees off the heading of the goal.` },
  }),
  draw({ whole, near }, values, { run, k }, hidden, { data: { start, goal } }) {
    whole.pose(start, 'start');
    whole.pose(goal, 'goal');
    near.pose(goal, 'goal');
    if (hidden) return;
    for (const pane of [whole, near]) {
      pane.path(run.x, run.y, 'ghost', { width: 1.5, dash: [2, 5], from: k, to: run.n });
      pane.path(run.x, run.y, 'path', { to: k + 1 });
    }
    near.robot([goal[0], goal[1], goal[2]], 0.25); // where it should stand
    for (const pane of [whole, near]) pane.robot(poseAt(run, k));
  },
  say: (values, { run, gains, off }) => ({
    k_rho: written(gains.k_rho, '1/m'), k_alpha: written(gains.k_alpha, '1/s'), h: written(gains.h),
        seconds: written(run.t[run.n - 1], 's'), off: inDegrees(Math.abs(off), 0),
  }),
});
