// Chapter 12: fixes of a receiver that stands still come in, and their mean over some time.

import { inSize, remembered, stage, written } from '../drawing.js';

const ROOM = 0.6; // m round the fixes
const farthest = (points) => Math.max(...points.map(([x, y]) => Math.hypot(x, y)));

// The means of the last n fixes; of all so far, as long as those are fewer.
const means = remembered(({ fixes, n }) => {
  const sum = [0, 0];
  return fixes.map((fix, k) => {
    const old = fixes[k - n] || [0, 0];
    return fix.map((value, i) => (sum[i] += value - old[i]) / Math.min(n, k + 1));
  });
});

export default stage('standing_still', {
  find({ seconds }, { data: { fixes, every } }) {
    const n = Math.round(seconds / every), places = means({ fixes, n });
    const [x, y] = [0, 1].map((i) => places.map((place) => place[i])),
        t = x.map((_, k) => k * every);
    return { n, places, tracks: [{ t, x, y, heading: x.map(() => 0), n: x.length, role: 'path' }] };
  },
  say: (values, { n, places }, { data: { fixes, every } }) => ({
    seconds: `${n * every} s`, lasts: written(every * fixes.length / 60, 'minutes', 2),
    far: inSize(farthest(fixes)), left: inSize(farthest(places.slice(n - 1))),
  }),
  look(values, run, { data: { fixes } }) {
    const [xs, ys] = [0, 1].map((i) => fixes.map((fix) => fix[i]));
    return [Math.min(...xs) - ROOM, Math.min(...ys) - ROOM, Math.max(...xs) + ROOM,
      Math.max(...ys) + ROOM];
  },
  draw(pane, values, { places }, { k, size }, { data: { fixes } }) {
    pane.robot([0, 0, 0], 0.5, { size });
    fixes.slice(0, k + 1).forEach(([x, y], i) =>
      pane.dot(x, y, 'rho', { size: i === k ? 5 : 2.5 }));
    const [x, y] = places[k];
    pane.dot(x, y, 'path', { size: 8, hollow: true });
    pane.cross(x, y, 'path', 5);
  },
});
