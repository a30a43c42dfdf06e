// The heading error over the distance left, and the last metre: where one stops decides what is
// left.

import {
  DEGREES, driven, freshRun, inDegrees, live, poseAt, remembered, ring, summarise, within, wrap,
  written,
} from '../drawing.js';

const unsampled = (options) => freshRun({ dt: 120, duration: 120, ...options }),
    approach = remembered(unsampled), stopped = remembered(unsampled);

export default live('heading_left', {
  find({ choice, radius }, { data: { start, goal, gains } }) {
    const here = { goal, gains: gains[choice] },
        near = approach({ start, ...here, arrivalRadius: 1 }),
        run = driven({ start: poseAt(near, near.n - 1), ...here, dt: 0.02, arrivalRadius: 0.001 });
    const stop = stopped({ start, ...here, arrivalRadius: radius });
    const { headingError, time } = summarise(stop),
        error = (k) => wrap(run.theta[k] - run.alpha[k]);
    let k = run.n - 1, largest = Math.abs(headingError);
    for (; k > 0 && run.rho[k - 1] <= radius; k -= 1)
      largest = Math.max(largest, Math.abs(error(k)));
    return { run, k, time, left: headingError, largest, end: poseAt(stop, stop.n - 1), error };
  },
  panes({ radius }, { left }, { data: { goal } }) {
    const stopAt = (distance) => ({ radius: within(distance, 0.005, 0.6) });
    return {
      error: { x: [0, 0.6, 'distance left [m]'], y: [-90, 90, 'heading error [°]'],
          given: 'Room for the heading error over the distance left.',
          alt: `The heading error over the distance left: ${inDegrees(left)} at ` +
          `${written(radius, 'm')}.`, scrub: stopAt },
      near: { x: [goal[0] - 0.7, goal[0] + 0.7, 'x [m]'],
          y: [goal[1] - 0.9, goal[1] + 0.5, 'y [m]'], equal: true,
          given: 'The goal, with a circle of 5 cm and one of 10 cm.',
          alt: `The last metre: the robot stops on a circle round the goal, ` +
          `${inDegrees(left)} off.`,
          scrub: (x, y) => stopAt(Math.hypot(x - goal[0], y - goal[1])) },
    };
  },
  draw({ error: chart, near }, { radius }, { run, k, left, end, error }, hidden,
      { data: { goal, asked } }) {
    const round = (size) =>
        near.line(ring(goal[0], goal[1], size), 'rho', { width: 1.5, dash: [3, 4] });
    near.pose(goal, 'goal');
    if (hidden) { asked.forEach(round); return; }
    round(radius);
    const curve = (from, to) =>
        Array.from({ length: Math.max(to - from, 0) },
        (_, i) => [run.rho[from + i], error(from + i) * DEGREES]);
    chart.line([...curve(0, k), [radius, left * DEGREES]], 'path');
    chart.line([[radius, left * DEGREES], ...curve(k, run.n)], 'ghost',
        { width: 1.5, dash: [2, 5] });
    chart.line([[radius, -90], [radius, 90]], 'rho', { width: 1.5, dash: [3, 4] });
    chart.dot(radius, left * DEGREES);
    near.path(run.x, run.y, 'path', { to: k });
    near.path(run.x, run.y, 'ghost', { width: 1.5, dash: [2, 5], from: k });
    near.robot(end);
  },
  say: (values, { time, left, largest }) =>
      ({ seconds: written(time, 's'), left: inDegrees(Math.abs(left), 0),
      largest: inDegrees(largest, 0) }),
});
