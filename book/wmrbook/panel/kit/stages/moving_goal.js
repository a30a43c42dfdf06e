// Chapter 7: a goal that drives round the paper's circle, and the gap between it and the robot.

import {
  cornerOf, driven, gainsOf, goalFromNear, lengthText, ring, stage, summarise,
} from '../drawing.js';

const CORNER = 130; // px, of the picture there
const MARGIN = 1.2, NEAR = 0.5; // m, round the circle, and from the goal to the inset's edge

export default stage('moving_goal', {
  find(values, setup) {
    const { start, law } = values, { feedback, duration } = setup.data;
    const run = driven({ start, reference: 'circle', law, gains: gainsOf(values, setup), feedback,
      duration, dt: 0.1 });
    return { run, gap: summarise(run).residual, tracks: [{ ...run, role: 'path' }] };
  },
  look({ start }, found, { data: { radius } }) {
    const xs = [start[0], 0, -2 * radius], ys = [start[1], radius, -radius];
    return [Math.min(...xs) - MARGIN, Math.min(...ys) - MARGIN, Math.max(...xs) + 2 * MARGIN,
      Math.max(...ys) + MARGIN];
  },
  corner: (values, found, size) => cornerOf(size, CORNER),
  say: (values, { gap }) => ({ gap: gap < 1e-4 ? 'less than 0.1 mm' : lengthText(gap) }),
  draw(pane, values, found, now, { data: { radius } }) {
    pane.line(ring(-radius, 0, radius), 'goal', { width: 1.5, dash: [8, 5] });
  },
  above(pane, values, { run }, { k, pose }, { data: { radius } }) {
    const goal = [run.goalX[k], run.goalY[k], run.goalHeading[k]];
    pane.line([pose, goal], 'rising', { width: 4 });
    pane.pose(goal, 'goal');
    const near = goalFromNear(pane, goal, [[pose, 'path', 0.6]], NEAR, CORNER);
    near.within(() => {
      pane.line(ring(-radius, 0, radius).map(near.at), 'goal', { width: 1.5, dash: [8, 5] });
      pane.line([near.at(pose), near.at(goal)], 'rising', { width: 4 });
    });
  },
});
