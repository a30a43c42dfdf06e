// Chapter 5: the paper's robot and another one, which both stop at the same distance.

import {
  driven, endOf, freshRun, gainsOf, inDegrees, remembered, stage, wrap,
} from '../drawing.js';

const papers = remembered(freshRun), CLOSE = 60; // px a metre, seen from near

export default stage('two_drives', {
  find(values, setup) {
    const { start, goal, radius } = values, way = { start, goal, arrivalRadius: radius };
    const yours = driven({ ...way, gains: gainsOf(values, setup) }),
        theirs = papers({ ...way, gains: setup.data.gains });
    return { yours, theirs, tracks: [{ ...yours, role: 'path' }, { ...theirs, role: 'ghost',
      share: 0.6 }] };
  },
  say: ({ goal }, { yours, theirs }) =>
      ({ yours: endOf(yours, goal), theirs: endOf(theirs, goal) }),
  draw(pane, { goal }, { theirs }, { done }) {
    if (pane.view.scale < CLOSE || !done) return;
    const off = wrap(theirs.heading[theirs.n - 1] - goal[2]);
    pane.angle(goal[0], goal[1], goal[2], off, inDegrees(Math.abs(off), 0), 'ghost', 112);
  },
});
