// Chapter 14: a robot drives straight on, and two fixes tell less and less wrongly where it looks.

import { inDegrees, inWords, normals, ring, stage } from '../drawing.js';

const HEADING = 0.4, LONG = 4, LENGTH = 40; // rad; m of an arm of the cone; samples of the drive

// two fixes err across the way by sqrt(2) sigma, (14.1)
const openness = (sigma, far) => Math.atan2(Math.SQRT2 * sigma, far);

export default stage('course_from_gps', {
  find({ sigma, far }) {
    const along = Array.from({ length: LENGTH + 1 }, (_, k) => far * k / LENGTH);
    const [x, y] = [Math.cos, Math.sin].map((part) => along.map((s) => s * part(HEADING)));
    return { off: openness(sigma, far), tracks: [{ t: along, x, y,
      heading: along.map(() => HEADING), n: along.length, role: 'path' }] };
  },
  say: ({ sigma, far }, { off }) => ({ sigma: `${inWords(sigma)} m`, far: `${inWords(far)} m`,
    off: inDegrees(off) }),
  look({ far }) {
    const most = Math.max(far, 5) + LONG;
    return [-3, -3, most, 0.6 * most + 1];
  },
  draw(pane, { sigma }, run, { pose: [x, y], time }, { data: { pairs, seed } }) {
    const open = openness(sigma, time), long = Math.max(LONG, time);
    pane.area([[0, 0], ...ring(0, 0, long + time, HEADING - open, HEADING + open)], 'path', 0.25);
    for (const [east, north] of [[0, 0], [x, y]]) {
      pane.line(ring(east, north, sigma), 'rho', { width: 1.5, dash: [4, 4] });
      pane.dot(east, north, 'rho', { size: 4 });
    }
    for (let k = 0; k < pairs; k += 1)
      [[0, 0], [x, y]].forEach(([east, north], i) => {
        const [dx, dy] = normals(k, i, seed);
        pane.dot(east + sigma * dx, north + sigma * dy, 'rho', { size: 2 });
      });
  },
});
