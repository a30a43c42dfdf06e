// Chapter 15: two robots start half a degree apart, on both sides of the line where theta jumps.
// They wrap it in each sample, as a real one does; a run in continuous time would not.

import { DEGREES, endOf, freshRun, ring, stage, written } from '../drawing.js';

/** @type {[string, string, number][]} */
const ROBOTS = [['blue', 'path', 1], ['pink', 'alpha', -1]];

export default stage('seam', {
  find({ side, facing, goal }, { data: { gains, away, hair } }) {
    const tracks = ROBOTS.map(([robot, role, sign]) => {
      const angle = (side + sign * hair) / DEGREES,
          start = [goal[0] + away * Math.cos(angle), goal[1] + away * Math.sin(angle),
            facing / DEGREES];
      return { robot, role, ...freshRun({ start, goal, gains, method: 'arc', dt: 0.02 }) };
    });
    return { tracks };
  },
  say({ goal }, { tracks }) {
    const [one, other] = tracks.map(({ theta }) => Math.sign(theta.reduce((sum, it) => sum + it)));
    return { ways: one === other ? 'the same side' : 'different sides',
      ...Object.fromEntries(tracks.flatMap((track) => [[track.robot, endOf(track, goal)],
        [`${track.robot}_value`, written(track.V[0])]])) };
  },
  look: ({ goal: [x, y] }, run, { data: { away } }) => [x - 3, y - 4.5, x + away + 3, y + 4.5],
  draw(pane, { goal: [x, y] }, run, now, { data: { away } }) {
    pane.line([[x, y], [x + 2 * away, y]], 'rising', { width: 1.5, dash: [6, 5] });
    pane.text('seam', x + away + 0.6, y, { role: 'rising', dy: 12 });
    pane.line(ring(x, y, away, -0.2, 0.2), 'ink', { width: 1, dash: [2, 4] });
  },
});
