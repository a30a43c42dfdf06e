// Robots that see through receivers, with an error that has a memory, other for each, and late, and
// whose right wheel slips: how they drive up, and where they park.

import {
  DEGREES, ahead, heldRun, inDegrees, live, median, onStops, remembered, ring, sightOf,
  timeAlong, wrap, written,
} from '../drawing.js';

const BARS = 12, WIDE = 360 / BARS; // deg
const LENGTH = 0.6, ICON = 27; // m and px, the robot's length and that of its drawing

const cloud = remembered(({ robots, track, seed, sigma, memory, late, slip, ...drive }) => {
  const { dt } = drive, receiver = { sigma, memory, fix_period: dt, delay: late, period: dt };
  const wheels = (v, omega) => {
    const lost = slip * (v + omega * track / 2); // m/s at the wheel
    return [v - lost / 2, omega - lost / track];
  };
  return Array.from({ length: robots }, (_, robot) => {
    const seen = sightOf(receiver, robot, seed);
    const sight = (k, pose) => [...seen(k, pose).slice(0, 2), pose[2]]; // a compass is not late
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
    return { ways, ends, off, k, start,
        far: median(ends.map(({ pose }) => Math.hypot(pose[0], pose[1]))),
        turned: median(off.map(Math.abs)), parked: ends.filter(({ n }) => n <= k).length,
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
    place.line(ring(0, 0, radius), 'goal', { width: 1.5, dash: [4, 4] });
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
      const left = i * WIDE - 180;
      if (count) heading.rect(left + 2, 0, left + WIDE - 2, count, 'path');
    });
  },
  handles: (values, { start }, setup) => [{
    id: 'set_off', pane: 'place', at: ahead(start, 1.6),
    says: `the heading with which they start, ${inDegrees(start[2])}`,
    move(x, y) {
      const turn = Math.atan2(y - start[1], x - start[0]) - setup.data.start[2];
      return onStops(setup, { set_off: wrap(turn) * DEGREES });
    },
  }],
  say: (values, { far, turned, driving }) =>
      ({ far: written(far, 'm'), turned: inDegrees(turned, 0),
      driving: driving ? `; ${driving} still drive after 40 s` : '' }),
});
