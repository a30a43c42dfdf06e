// Wheels that can't go faster, three rules for what they do then, and the path that each rule
// leaves.

import {
  driven, heldRun, live, poseAt, remembered, saturationScale, timeNear, within, written,
} from '../drawing.js';

const RULES = {
  wheels: (v, turn, most) => {
    const [left, right] = [v - turn, v + turn].map((each) => within(each, -most, most));
    return [(left + right) / 2, (right - left) / 2];
  },
  // together never more than `most`
  apart: (v, turn, most) =>
      [within(v, -0.75 * most, 0.75 * most), within(turn, -0.25 * most, 0.25 * most)],
  both: (v, turn, most) => {
    const share = saturationScale(most, Math.abs(v) + Math.abs(turn));
    return [share * v, share * turn];
  },
};

// What is limited is the speed ahead and half the difference of the wheels' speeds.
const limited = remembered(({ track, limit, rule, ...drive }) => {
  const { poses, twists, arrived } = heldRun({ ...drive, radius: 0.05, steps: 1499,
    wheels(v, omega) {
      const [ahead, turn] = RULES[rule](v, omega * track / 2, limit);
      return [ahead, 2 * turn / track];
    } });
  const column = (of) => poses.map((pose, k) => of(pose, twists[k]));
  return {
    x: column(([x]) => x), y: column(([, y]) => y), heading: column((pose) => pose[2]),
    left: column((_, [v, omega]) => v - omega * track / 2),
    right: column((_, [v, omega]) => v + omega * track / 2),
    t: poses.map((_, k) => drive.dt * k), n: poses.length, arrived,
  };
});

const straying = remembered(({ x, y, free }) => Math.sqrt(Math.max(...x.map((px, k) => {
  let least = Infinity;
  for (let i = 0; i < free.x.length; i += 1) {
    const dx = free.x[i] - px, dy = free.y[i] - y[k], far = dx * dx + dy * dy;
    if (far < least) least = far;
  }
  return least;
}))));

export default live('wheel_limit', {
  find({ limit, rule, time }, { data }) {
    const { start, goal, gains } = data, run = limited({ ...data, limit, rule }),
        whole = driven({ start, goal, gains, dt: 0.005 });
    const free = { x: Array.from(whole.x), y: Array.from(whole.y) };
    return { run, free, strays: straying({ x: run.x, y: run.y, free }),
        k: Math.round(time * (run.n - 1)) };
  },
  panes: ({ limit }, { run, strays }) => ({
    plane: { x: [-5, 8, 'x [m]'], y: [-1.5, 14, 'y [m]'], equal: true,
        given: 'The robot and its goal, 10 m to its left; both look the same way.',
        alt: `The path strays ${written(strays, 'm')} from the one without a limit and in ` +
        `continuous time.`,
      scrub: (x, y) => timeNear(run.x, run.y, x, y, 1.5) },
    speeds: { x: [0, 20, 'time [s]'], y: [-4.4, 4.4, 'wheels [m/s]'],
        given: 'The speeds of the wheels over time: nothing yet.',
        alt: `The speeds of the two wheels over time, never beyond ${written(limit, 'm/s')}.`,
      scrub: (x) => ({ time: within(x / run.t[run.n - 1], 0, 1) }) },
  }),
  draw({ plane, speeds }, { limit }, { run, free, k }, hidden, { data: { start, goal } }) {
    plane.pose(goal, 'goal');
    if (hidden) { plane.robot(start); return; }
    plane.pose(start, 'start');
    plane.path(free.x, free.y, 'ghost', { width: 5, dash: [2, 7] });
    plane.path(run.x, run.y);
    plane.robot(poseAt(run, k));
    for (const each of [limit, -limit])
      speeds.line([[0, each], [20, each]], 'rising', { width: 1.5, dash: [6, 4] });
    speeds.path(run.t, run.left, 'start');
    speeds.path(run.t, run.right, 'goal', { dash: [7, 5] });
    speeds.line([[run.t[k], -9], [run.t[k], 9]], 'ghost', { width: 1.5 });
    speeds.text('left', 17, 3.7, { role: 'start' });
    speeds.text('right', 17, 3, { role: 'goal' });
  },
  say: (values, { run, strays }) =>
      ({ seconds: run.arrived ? written(run.t[run.n - 1], 's') : 'more than 75 s, if at all,',
      strays: written(strays, 'm') }),
});
