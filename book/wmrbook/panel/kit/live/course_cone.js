// Two fixes, each somewhere in its circle, and the cone of headings that they allow; drawn in units
// of the distance between them.

import { DEGREES, live, ring, written } from '../drawing.js';

const degrees = (angle) => (angle > 2 ? 'nothing' : written(angle * DEGREES, '°'));

export default live('course_cone', {
  find: ({ sigma, distance }, { data: { usable } }) => ({
    off: Math.SQRT2 * sigma / distance, needed: Math.SQRT2 * sigma / usable,
  }),
  panes: ({ sigma, distance }, { off }) => ({
    above: { x: [-0.8, 1.8, ''], y: [-1, 1, ''], equal: true, bare: true,
        given: 'Two fixes, and the path between them.',
        alt: `Two fixes ${written(distance, 'm')} apart in circles of ` +
        `${written(sigma, 'm')}, and a cone of ${degrees(off)} to either side of the path.` },
  }),
  draw({ above }, { sigma, distance }, { off }, hidden) {
    // in units of the distance, and of a wide cone what has room
    const half = Math.min(off, Math.PI),
        reach = Math.min(1.7, 0.97 / Math.sin(Math.min(half, Math.PI / 2)));
    above.line([[0, 0], [1, 0]], 'ghost', { width: 2 });
    for (const x of [0, 1]) above.dot(x, 0, 'start');
    above.text('first fix', 0, 0, { role: 'start', dy: 22, align: 'center' });
    if (hidden) return;
    for (const x of [0, 1]) above.line(ring(x, 0, sigma / distance), 'start', { width: 1.5 });
    above.area([[0, 0], ...ring(0, 0, reach, -half, half)], 'rising', 0.25);
    above.line([[0, 0], [reach, 0]], 'path', { dash: [6, 4] });
  },
  say: (values, { off, needed }) => ({ off: degrees(off), needed: written(needed, 'm') }),
});
