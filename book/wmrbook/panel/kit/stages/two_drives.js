// Chapter 5: the paper's robot and another one, which both stop at the same distance.

import {
  driven, endOf, freshRun, gainsOf, goalFromNear, inDegrees, remembered, stage, wrap,
} from '../drawing.js';

const papers = remembered(freshRun), CLOSE = 60; // px a metre, seen from near
const LOOKS = [['path', 0.8], ['ghost', 1]]; // yours and theirs

export default stage('two_drives', {
  find(values, setup) {
    const { start, goal, radius } = values, way = { start, goal, arrivalRadius: radius };
    const yours = driven({ ...way, gains: gainsOf(values, setup) }),
        theirs = papers({ ...way, gains: setup.data.gains });
    return { yours, theirs, tracks: [yours, theirs].map((run, k) =>
      ({ ...run, role: LOOKS[k][0], share: LOOKS[k][1] })) };
  },
  say: ({ goal }, { yours, theirs }) =>
      ({ yours: endOf(yours, goal), theirs: endOf(theirs, goal) }),
  above(pane, { goal }, { theirs }, { done, poses }) {
    const off = wrap(theirs.heading[theirs.n - 1] - goal[2]);
    if (pane.view.scale < CLOSE)
      goalFromNear(pane, goal, poses.map((pose, k) => [pose, ...LOOKS[k]]).reverse(), 0.7, 170);
    else if (done)
      pane.angle(goal[0], goal[1], goal[2], off, inDegrees(Math.abs(off), 0), 'ghost', 112);
  },
});
