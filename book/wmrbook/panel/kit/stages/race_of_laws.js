// Chapter 13: the corrected law and another one drive the same wheels from the same start.

import { DEGREES, heldRun, inDegrees, stage, trackOf, wrap, written } from '../drawing.js';

const ROOM = 2; // m round start and goal

export default stage('race_of_laws', {
  find({ start, goal, law }, { data: { tuned, limits, dt, radius, steps } }) {
    const [ours, theirs] = ['corrected', law].map((name) =>
      heldRun({ start, goal, gains: tuned[name], law: name, limits, dt, radius, steps }));
    return { ours, theirs, tracks: [trackOf(ours, dt), trackOf(theirs, dt, 'alpha')] };
  },
  say({ goal, law }, runs, { data: { names, dt } }) {
    const inSay = ({ poses, twists, arrived }) => (arrived
      ? `stops after ${written(dt * (poses.length - 1), 's')}, ${
        inDegrees(Math.abs(wrap(poses.at(-1)[2] - goal[2])), 0)} off, and turns up to ${
        written(DEGREES * Math.max(...twists.map(([, omega]) => Math.abs(omega))), '°/s', 2)}`
      : 'is on its way after a minute');
    return { other: names[law], ours: inSay(runs.ours), theirs: inSay(runs.theirs) };
  },
  look: ({ start, goal }) => [0, 1].map((i) => Math.min(start[i], goal[i]) - ROOM)
      .concat([0, 1].map((i) => Math.max(start[i], goal[i]) + ROOM)),
  draw(pane, { law }, { tracks }, { k }) {
    tracks.forEach(({ x, y, n, role }, i) => {
      const at = Math.min(k, n - 1);
      if (at > 0) pane.text(i ? law : 'corrected', x[at], y[at], { role, dx: 20, dy: 24 });
    });
  },
});
