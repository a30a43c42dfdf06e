// Chapter 7: a goal that drives round the paper's circle, and the gap between it and the robot.

import {
  ahead, driven, gainsOf, insetOf, insetSize, lengthText, ring, stage, summarise,
} from '../drawing.js';

// m: round the circle, to the inset's edge, and a pixel of the robot's drawing
const MARGIN = 1.2, NEAR = 0.5, ROBOT = 0.6 / 27;

export default stage('moving_goal', {
  find(values, setup) {
    const { start, law } = values, { feedback, duration } = setup.data;
    const run = driven({ start, reference: 'circle', law, gains: gainsOf(values, setup), feedback,
      duration, dt: 0.1 });
    return { run, gap: summarise(run).residual, tracks: [{ ...run, role: 'path' }] };
  },
  look({ start }, found, { data: { radius } }) {
    const xs = [start[0], 0, -2 * radius], ys = [start[1], radius, -radius];
    return [Math.min(...xs) - MARGIN, Math.min(...ys) - MARGIN, Math.max(...xs) + MARGIN,
      Math.max(...ys) + MARGIN];
  },
  say: (values, { gap }) => ({ gap: gap < 1e-4 ? 'less than 0.1 mm' : lengthText(gap) }),
  draw(pane, values, { run }, { k, pose }, { data: { radius } }) {
    const goal = [run.goalX[k], run.goalY[k], run.goalHeading[k]];
    pane.line(ring(-radius, 0, radius), 'goal', { width: 1.5, dash: [8, 5] });
    pane.line([pose, goal], 'rising', { width: 4 });
    pane.pose(goal, 'goal');
    const { width, height } = insetSize(pane, 130), side = Math.min(width, height);
    const [x, y] = goal, scale = side / 2 / NEAR,
        near = insetOf(pane, 'left', { width: side, height: side }, [x - NEAR, x + NEAR],
            [y - NEAR, y + NEAR]);
    near.within(() => {
      pane.line(ring(-radius, 0, radius).map(near.at), 'goal', { width: 1.5, dash: [8, 5] });
      pane.robot([...near.at(pose), pose[2]], 0.6, { size: scale * ROBOT });
      pane.line([near.at(pose), near.at(goal)], 'rising', { width: 4 });
      pane.dot(...near.at(goal), 'goal', { hollow: true });
      pane.arrow(...near.at(goal), ...near.at(ahead(goal, 0.4)), 'goal');
    });
  },
});
