// Chapter 5: the paper's robot and another one, which both stop at the same distance.

import {
  DEGREES, cornerOf, driven, endOf, freshRun, gainsOf, goalFromNear, inDegrees, lengthText,
  remembered, stage, wrap, written,
} from '../drawing.js';

const papers = remembered(freshRun), CLOSE = 60; // px a metre, seen from near
const MOST = 170; // px, of the corner's picture
const BESIDE = 60; // px to go, from where the errors are named beside the robot
const THROUGH = 0.5; // of the paper's robot, seen above the other one
const LOOKS = [['path', 0.8], ['ghost', 1]]; // yours and theirs

export default stage('two_drives', {
  find(values, setup) {
    const { start, goal, radius } = values, way = { start, goal, arrivalRadius: radius };
    const yours = driven({ ...way, gains: gainsOf(values, setup) }),
        theirs = papers({ ...way, gains: setup.data.gains });
    return { yours, theirs, tracks: [yours, theirs].map((run, k) =>
      ({ ...run, role: LOOKS[k][0], share: LOOKS[k][1] })) };
  },
  corner: (values, found, size) => cornerOf(size, MOST),
  say: ({ start, goal }, { yours, theirs }) => ({
    yours: endOf(yours, goal), theirs: endOf(theirs, goal), ...sharpestOf(theirs),
    distance: written(theirs.rho[0], 'm', 4), from: inDegrees(start[2], 0),
    to: inDegrees(goal[2], 0),
    east: written(goal[0] - start[0], 'm'), north: written(goal[1] - start[1], 'm'),
  }),
  draw(pane, { goal }, found, { shows, poses: [, pose] }) {
    if (shows.includes('legs'))
      pane.line([pose, [goal[0], pose[1]], goal], 'ink', { width: 1.5, dash: [6, 4] });
  },
  above(pane, { goal }, { theirs }, { shows, time, done, poses, size }) {
    const off = wrap(theirs.heading[theirs.n - 1] - goal[2]), [, pose] = poses;
    if (size > 1) pane.robot(pose, THROUGH, { size, role: 'ghost' });
    // after the robots, so that no robot covers them
    if (shows.includes('legs')) nameLegs(pane, pose, goal);
    if (shows.includes('twist')) {
      const after = theirs.t.findIndex((t) => t > time),
          k = after < 0 ? theirs.n - 1 : Math.min(after, theirs.n) - 1;
      pane.text(`v = ${written(theirs.v[k], 'm/s')}`, pose[0], pose[1], { dx: 26, dy: 12 });
      pane.text(`ω = ${written(theirs.omega[k] * DEGREES, '°/s')}`, pose[0], pose[1],
          { dx: 26, dy: -10 });
    }
    if (pane.view.scale < CLOSE)
      goalFromNear(pane, goal, [...poses.map((pose, k) => [pose, ...LOOKS[k]]).reverse(),
        [poses[1], 'ghost', THROUGH]], 0.7, MOST);
    else if (done)
      pane.angle(goal[0], goal[1], goal[2], off, inDegrees(Math.abs(off), 0), 'ghost', 112);
  },
});

/**
 * How fast a robot turns at most, and how far it is from its goal then.
 * @param {Run} run
 */
function sharpestOf({ omega, rho, n }) {
  const rates = omega.slice(0, n).map(Math.abs), sharpest = Math.max(...rates);
  return { sharpest: written(sharpest, 'rad/s', 2),
    close: lengthText(rho[rates.indexOf(sharpest)], 2) };
}

/**
 * One name a leg, or both beside the goal when the legs are short.
 * @param {Pane} pane @param {number[]} robot @param {number[]} goal
 */
function nameLegs(pane, [x, y], [east, north]) {
  const [right, up] = [east - x, north - y], long = Math.hypot(right, up) * pane.view.scale,
      names = [`x: ${written(right, 'm')}`, `y: ${written(up, 'm')}`];
  if (long < BESIDE) {
    pane.text(names[0], east, north, { dx: 26, dy: 12 });
    pane.text(names[1], east, north, { dx: 26, dy: -10 });
  } else {
    pane.text(names[0], (x + east) / 2, y, { dx: 30, dy: -14 });
    pane.text(names[1], east, (y + north) / 2, { dx: 10 });
  }
}
