// Chapter 13: the corrected law and another one drive the same wheels from the same start,
// forwards, backwards, or forwards with a last turn on the spot.

import { DEGREES, heldRun, inDegrees, stage, trackOf, wrap, written } from '../drawing.js';

const ROOM = 2; // m round start and goal

/** @param {number[]} pose */
const facingBack = ([x, y, heading]) => [x, y, wrap(heading + Math.PI)];

// Backwards is forwards with both headings turned round, and the speed negated.
/** @param {any} options @returns {any} */
function backwards({ start, goal, ...options }) {
  const { poses, twists, arrived } =
      heldRun({ ...options, start: facingBack(start), goal: facingBack(goal) });
  return { poses: poses.map(facingBack), twists: twists.map(([v, omega]) => [-v, omega]), arrived };
}

/** @param {any} options @returns {any} */
function withLastTurn(options) {
  const { goal, dt, limits: { max_speed, b } } = options, run = heldRun(options);
  const [x, y, heading] = run.poses.at(-1), off = wrap(goal[2] - heading);
  const steps = Math.ceil(Math.abs(off) * b / (2 * max_speed * dt));
  if (!run.arrived || !steps) return run;
  const turns = Array.from({ length: steps }, (_, k) => [x, y, heading + off * (k + 1) / steps]);
  const twists = turns.map(() => [0, off / (steps * dt)]);
  return { ...run, poses: [...run.poses, ...turns],
    twists: [...run.twists.slice(0, -1), ...twists, [0, 0]] };
}

const WAYS = { forwards: heldRun, turn: withLastTurn, backwards };

export default stage('race_of_laws', {
  find({ start, goal, law, drives }, { data: { tuned, limits, dt, radius, steps } }) {
    const [ours, theirs] = ['corrected', law].map((name) =>
      WAYS[drives]({ start, goal, gains: tuned[name], law: name, limits, dt, radius, steps }));
    return { ours, theirs, tracks: [trackOf(ours, dt), trackOf(theirs, dt, 'alpha')] };
  },
  say({ goal, law }, { ours, theirs }, { data: { names, dt } }) {
    const inSay = ({ poses, twists, arrived }) => (arrived
      ? `stops after ${written(dt * (poses.length - 1), 's')}, ${
        inDegrees(Math.abs(wrap(poses.at(-1)[2] - goal[2])), 0)} off, and turns up to ${
        written(DEGREES * Math.max(...twists.map(([, omega]) => Math.abs(omega))), '°/s', 2)}`
      : 'is on its way after a minute');
    const back = theirs.twists.slice(0, -1).reduce((sum, [v]) => sum + dt * Math.max(-v, 0), 0);
    return { other: names[law], ours: inSay(ours), theirs: inSay(theirs),
      back: `${back.toFixed(1)} m` };
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
