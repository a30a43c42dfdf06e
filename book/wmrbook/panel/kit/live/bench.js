// Robots that see through receivers, with an error that has a memory, other for each, and late, and
// whose right wheel slips: how they drive up, and where they park.

import { DEGREES, inDegrees, written } from '../style.js';
import { heldRun, remembered, timeAlong } from '../runs.js';
import { live } from '../live.js';
import { normals } from '../random.js';
import { wrap } from '../model.js';

const BARS = 12, WIDE = 360 / BARS; // deg
const LENGTH = 0.6, ICON = 27; // m and px, the robot's length and that of its drawing

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
    return heldRun({ ...drive, sight, wheels }).poses;
  });
});

export default live('bench', {
  find({ sigma, memory, late, slip, set_off, time }, { data }) {
    const [x, y, heading] = data.start, start = [x, y, heading + set_off / DEGREES],
        ways = cloud({ ...data, start, sigma, memory, late, slip: slip / 100 }),
        ends = ways.map((poses) => ({ pose: poses.at(-1), n: poses.length - 1 })),
        off = ends.map(({ pose }) => wrap(pose[2] - data.goal[2])),
        k = Math.round(time * Math.max(...ends.map(({ n }) => n)));
    const middle = (values) => median([...values].sort((a, b) => a - b));
    return { ways, ends, off, k, start,
        far: middle(ends.map(({ pose }) => Math.hypot(pose[0], pose[1]))),
        turned: middle(off.map(Math.abs)), parked: ends.filter(({ n }) => n <= k).length,
        driving: ends.filter(({ n }) => n === data.steps).length };
  },
  panes: (values, { ways, ends, far, turned, parked }) => ({
    place: { x: [-9, 3], y: [-8.5, 4.5], lawn: true, ghosts: false,
        given: 'The goal, and the robots where they start, 10 m from it.',
        alt: `${parked} of ${ends.length} robots have parked about the goal; in the end half of ` +
        `them are within ${written(far, 'm')}.`,
        scrub: (x, y) => timeAlong(ways, x, y, 3) },
    heading: { x: [-180, 180, 'heading error where it parks [°]'], y: [0, 33, 'robots'],
        given: 'The heading errors: no robot has parked.',
        alt: `How the heading errors of ${parked} parked robots are spread: in the end half of ` +
        `them are within ${(turned * DEGREES).toFixed(0)} degrees.` },
  }),
  draw({ place, heading }, values, found, hidden, { data: { start, goal, radius } }) {
    const { ways, ends, off, k } = found;
    place.line(Array.from({ length: 49 },
        (_, i) => [radius * Math.cos(Math.PI * i / 24), radius * Math.sin(Math.PI * i / 24)]),
    'goal', { width: 1.5, dash: [4, 4] });
    place.pose(goal, 'goal');
    const size = { size: Math.max(LENGTH / place.pixel / ICON, 0.45) };
    heading.line([[0, 0], [0, 33]], 'goal', { width: 1.5, dash: [4, 4] });
    if (hidden) { place.robot(start, 1, size); return; }
    place.pose(found.start, 'start');
    ways.forEach((poses) => place.line(poses.slice(Math.max(k - 15, 0), k + 1), 'path',
        { width: 1 }));
    ways.forEach((poses) => place.robot(poses[Math.min(k, poses.length - 1)],
        k < poses.length - 1 ? 1 : 0.75, size));
    const counts = Array(BARS).fill(0);
    off.forEach((each, robot) => {
      if (ends[robot].n <= k)
        counts[Math.min(Math.floor((each + Math.PI) * DEGREES / WIDE), BARS - 1)] += 1;
    });
    counts.forEach((count, i) => {
      if (count) heading.bar((i + 0.5) * WIDE - 180, 0, count, 'path', 13);
    });
  },
  handles: (values, { start: [x, y, heading] }, { data }) => [{
    id: 'set_off', pane: 'place', at: [x + 1.6 * Math.cos(heading), y + 1.6 * Math.sin(heading)],
    says: `the heading with which they start, ${inDegrees(heading)}`,
    move: (toX, toY) => ({ set_off: 5 * Math.round(wrap(Math.atan2(toY - y, toX - x)
        - data.start[2]) * DEGREES / 5) }),
  }],
  say: (values, { far, turned, driving }) =>
      ({ far: written(far, 'm'), turned: `${(turned * DEGREES).toFixed(0)}°`,
      driving: driving ? `; ${driving} still drive after 40 s` : '' }),
});
