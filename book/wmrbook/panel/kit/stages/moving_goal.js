// Chapter 7: a goal that drives round the paper's circle, and the gap between it and the robot.

import {
  cornerOf, driven, gainsOf, goalFromNear, inDegrees, insetOf, insetSize, lengthText, ring, stage,
  summarise, wrap, written,
} from '../drawing.js';

const CORNER = 130, PLOT = 210, FLAT = 0.72; // px, of the pictures there, and a height to a width
const MARGIN = 1.2, NEAR = 0.5; // m, round the circle, and from the goal to the inset's edge
const FAR = 0.3, FAST = 1.6; // m and m/s, where the axes of the plot end
const BARE = ['goal', 'frame']; // what is shown without a corner

// How far the goal is ahead of a robot and to its left, and by what angle it is turned.
/** @param {number[]} pose @param {number[]} goal */
const inFrame = ([x, y, heading], [goalX, goalY, goalHeading]) => {
  const [dx, dy] = [goalX - x, goalY - y], [cos, sin] = [Math.cos(heading), Math.sin(heading)];
  return [cos * dx + sin * dy, cos * dy - sin * dx, wrap(goalHeading - heading)];
};
const goalAt = (run, k) => [run.goalX[k], run.goalY[k], run.goalHeading[k]];
const toASide = (value, text, [one, other]) => `${text} ${value < 0 ? other : one}`;

export default stage('moving_goal', {
  find(values, setup) {
    const { start, law } = values, { feedback, duration } = setup.data;
    const run = driven({ start, reference: 'circle', law, gains: gainsOf(values, setup), feedback,
      duration, dt: 0.1 });
    const share = values.scene === 'goal' ? 0.5 : 1; // the goal is looked at first
    return { run, gap: summarise(run).residual, tracks: [{ ...run, role: 'path', share }] };
  },
  look({ start, scene }, { run }, { data: { radius } }) {
    if (scene === 'frame') {
      const [x, y] = goalAt(run, 0), room = 2 * MARGIN;
      return [Math.min(start[0], x) - room, Math.min(start[1], y) - room,
        Math.max(start[0], x) + room, Math.max(start[1], y) + room];
    }
    const xs = [start[0], 0, -2 * radius], ys = [start[1], radius, -radius];
    return [Math.min(...xs) - MARGIN, Math.min(...ys) - MARGIN, Math.max(...xs) + 3 * MARGIN,
      Math.max(...ys) + MARGIN];
  },
  corner: (values, found, size, { shows }) => (shows.includes('speeds')
    ? cornerOf(size, PLOT, FLAT) : shows.some((it) => BARE.includes(it)) ? null
    : cornerOf(size, CORNER)),
  say({ start }, { run, gap }) {
    const [ahead, left, turned] = inFrame(start, goalAt(run, 0));
    return {
      gap: gap < 1e-4 ? 'less than 0.1 mm' : lengthText(gap),
      ahead: toASide(ahead, written(Math.abs(ahead), 'm'), ['ahead', 'behind']),
      aside: toASide(left, written(Math.abs(left), 'm'), ['to the left', 'to the right']),
      turned: toASide(turned, inDegrees(Math.abs(turned), 0), ['further left', 'further right']),
    };
  },
  draw(pane, values, { run }, { shows, k, pose }, { data: { radius } }) {
    pane.line(ring(-radius, 0, radius), 'goal', { width: 1.5, dash: [8, 5] });
    if (!shows.includes('frame')) return;
    const goal = goalAt(run, k), [ahead, left] = inFrame(pose, goal), [x, y, heading] = pose;
    const foot = [x + ahead * Math.cos(heading), y + ahead * Math.sin(heading)];
    pane.arrow(x, y, ...foot, 'rising');
    pane.arrow(...foot, goal[0], goal[1], 'rising');
    pane.text(`ahead ${written(ahead, 'm')}`, (x + foot[0]) / 2, (y + foot[1]) / 2,
        { dy: 30, align: 'center' });
    pane.text(`left ${written(left, 'm')}`, (foot[0] + goal[0]) / 2, (foot[1] + goal[1]) / 2,
        { dx: 14 });
  },
  above(pane, values, { run }, { k, pose, shows }, { data: { radius, speed, v_max } }) {
    const goal = goalAt(run, k);
    pane.pose(goal, 'goal');
    if (shows.some((it) => BARE.includes(it))) return;
    pane.line([pose, goal], 'rising', { width: 4 });
    if (!shows.includes('speeds')) {
      const near = goalFromNear(pane, goal, [[pose, 'path', 0.6]], NEAR, CORNER);
      near.within(() => {
        pane.line(ring(-radius, 0, radius).map(near.at), 'goal', { width: 1.5, dash: [8, 5] });
        pane.line([near.at(pose), near.at(goal)], 'rising', { width: 4 });
      });
      return;
    }
    const { width, height } = insetSize(pane, PLOT);
    const inset = insetOf(pane, 'left', { width, height: FLAT * height }, [-0.02, FAR],
        [-0.15, FAST]);
    const asked = Array.from({ length: 61 }, (_, i) => FAR * i / 60)
        .map((rho) => [rho, v_max * (1 - Math.exp(-values.k_rho * rho))]);
    inset.within(() => {
      pane.line([[FAR, 0], [0, 0], [0, FAST]].map(inset.at), 'soft', { width: 1 });
      pane.line([[0, speed], [FAR, speed]].map(inset.at), 'goal', { width: 2, dash: [6, 4] });
      pane.line(asked.map(inset.at), 'path', { width: 2.5 });
      if (run.rho[k] < FAR) pane.dot(...inset.at([run.rho[k], run.v[k]]), 'rising');
    });
    const note = (text, place, role, looks) =>
      pane.text(text, ...inset.at(place), { role, size: 13, fixed: true, ...looks });
    note('the goal', [FAR, speed], 'goal', { dx: -4, dy: -10, align: 'right' });
    note('the law', [FAR, 1.1], 'path', { align: 'right', dx: -4 });
    note('distance', [FAR, 0], 'soft', { dx: -4, dy: 8, align: 'right' });
    note('speed', [0, FAST], 'soft', { dx: 5, dy: -10 });
  },
});
