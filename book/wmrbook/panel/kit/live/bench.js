// Robots that see through receivers, with an error that has a memory, other for each, and late, and
// whose right wheel slips: where they stand in the end.

import { DEGREES, written } from '../style.js';
import { heldRun, remembered } from '../runs.js';
import { live } from '../live.js';
import { normals } from '../random.js';
import { wrap } from '../model.js';

const median = (sorted) =>
    (sorted[Math.floor((sorted.length - 1) / 2)] + sorted[Math.floor(sorted.length / 2)]) / 2;

const cloud = remembered(({ robots, track, seed, sigma, memory, late, slip, ...drive }) => {
  const keep = Math.exp(-drive.dt / memory), share = Math.sqrt(1 - keep * keep);
  const back = Math.round(late / drive.dt);
  const wheels = (v, omega) => {
    const lost = slip * (v + omega * track / 2); // m/s at the wheel
    return [v - lost / 2, omega - lost / track];
  };
  return Array.from({ length: robots }, (_, robot) => {
    const fixes = [];
    let [east, north] = [0, 0];
    const sight = (k, [x, y, heading]) => {
      const fresh = normals(robot, k, seed);
      [east, north] = k ? [keep * east + share * fresh[0], keep * north + share * fresh[1]] : fresh;
      fixes.push([x + sigma * east, y + sigma * north]);
      return [...fixes[Math.max(k - back, 0)], heading];
    };
    const { poses } = heldRun({ ...drive, sight, wheels });
    return { pose: poses.at(-1), n: poses.length - 1 };
  });
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
