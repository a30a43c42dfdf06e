// Robots that see through receivers, with an error that has a memory, other for each, and late, and
// whose right wheel slips: where they stand in the end.

import { DEGREES, written } from '../style.js';
import { arcStep, polarFromPose, wrap } from '../model.js';
import { controlLaw } from '../law.js';
import { live } from '../live.js';
import { remembered } from '../runs.js';

// mulberry32, and the rule of Box and Muller: wmrbook.live.noise draws the same numbers.
const normals = remembered(({ count, seed }) => {
  let state = seed;
  const even = () => {
    state = (state + 0x6D2B79F5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return (((mixed ^ (mixed >>> 14)) >>> 0) + 0.5) / 2 ** 32;
  };
  return Float64Array.from({ length: count }, () => {
    const size = even();
    return Math.sqrt(-2 * Math.log(size)) * Math.cos(2 * Math.PI * even());
  });
});

const median = (sorted) =>
    (sorted[Math.floor((sorted.length - 1) / 2)] + sorted[Math.floor(sorted.length / 2)]) / 2;

const cloud = remembered(({ start, goal, gains, dt, radius, robots, track, steps, seed, sigma,
    memory, late, slip }) => {
  const fresh = normals({ count: 2 * robots * steps, seed }), keep = Math.exp(-dt / memory),
      share = Math.sqrt(1 - keep * keep), back = Math.round(late / dt), ends = [];
  for (let robot = 0; robot < robots; robot += 1) {
    const fixes = [];
    let pose = start, n = 0, [east, north] = [fresh[robot], fresh[robots + robot]];
    for (; n < steps; n += 1) {
      if (n) {
        east = keep * east + share * fresh[2 * n * robots + robot];
        north = keep * north + share * fresh[(2 * n + 1) * robots + robot];
      }
      fixes.push([pose[0] + sigma * east, pose[1] + sigma * north]);
      const [x, y] = fixes[Math.max(n - back, 0)],
          [rho, alpha, theta] = polarFromPose(x, y, pose[2], goal[0], goal[1], goal[2]);
      if (rho <= radius) break;
      // m/s at the wheel
      const [v, omega] = controlLaw(rho, alpha, theta, gains),
          lost = slip * (v + omega * track / 2);
      pose = arcStep(pose[0], pose[1], pose[2], v - lost / 2, omega - lost / track, dt);
    }
    ends.push({ pose, n });
  }
  return ends;
});

export default live('bench', {
  find({ sigma, memory, late, slip }, { data }) {
    const ends = cloud({ ...data, sigma, memory, late, slip: slip / 100 }),
        off = ends.map(({ pose }) => wrap(pose[2] - data.goal[2]));
    const middle = (values) => median([...values].sort((a, b) => a - b));
    return { ends, off, far: middle(ends.map(({ pose }) => Math.hypot(pose[0], pose[1]))),
        turned: middle(off.map(Math.abs)),
        driving: ends.filter(({ n }) => n === data.steps).length };
  },
  panes: (values, { far, turned }) => ({
    place: { x: [-3, 3, 'east of the goal [m]'], y: [-2.4, 2.4, 'north [m]'], equal: true,
        given: 'The goal, with the heading that is asked for.',
        alt: `The robots about the goal, half of them within ${written(far, 'm')}.` },
    heading: { x: [-180, 180, 'heading error [°]'], y: [0, 33, 'robots'],
        given: 'The heading errors: nothing yet.',
        alt: `How the heading errors are spread: half of the robots are within ` +
        `${(turned * DEGREES).toFixed(0)} degrees.` },
  }),
  draw({ place, heading }, values, { ends, off }, hidden, { data: { goal, radius } }) {
    const circle = Array.from({ length: 49 },
        (_, k) => [radius * Math.cos(Math.PI * k / 24), radius * Math.sin(Math.PI * k / 24)]);
    if (!hidden) {
      for (const { pose: [x, y, angle] } of ends)
        place.arrow(x - 0.1 * Math.cos(angle), y - 0.1 * Math.sin(angle),
            x + 0.22 * Math.cos(angle), y + 0.22 * Math.sin(angle), 'path', { width: 2 });
      const counts = Array(12).fill(0);
      for (const each of off) counts[Math.min(Math.floor((each + Math.PI) / Math.PI * 6), 11)] += 1;
      counts.forEach((count, k) => {
        if (count) heading.bar(-165 + 30 * k, 0, count, 'path', 13);
      });
    }
    place.line(circle, 'goal', { width: 1.5, dash: [4, 4] });
    place.pose(goal, 'goal');
  },
  say: (values, { far, turned, driving }) =>
      ({ far: written(far, 'm'), turned: `${(turned * DEGREES).toFixed(0)}°`,
      driving: driving ? `; ${driving} still drive after 40 s` : '' }),
});
