// A compass that takes its own plane for level, on a robot that leans in a field that dips.

import { DEGREES, inDegrees, live, onStops, wrap } from '../drawing.js';

// Its error [rad] at a heading from magnetic east.
/** @param {number} heading @param {Values} knobs */
function errorAt(heading, { dip, lean }) {
  const north = Math.PI / 2 - heading, [steep, tip] = [dip / DEGREES, lean / DEGREES],
      left = Math.cos(steep) * Math.sin(north) * Math.cos(tip) - Math.sin(steep) * Math.sin(tip);
  return wrap(north - Math.atan2(left, Math.cos(steep) * Math.cos(north)));
}

export default live('leaning_compass', {
  find(values) {
    const turn = Array.from({ length: 181 }, (_, k) => 2 * k - 180),
        errors = turn.map((each) => errorAt(each / DEGREES, values) * DEGREES);
    return { turn, errors, off: errorAt(values.heading / DEGREES, values),
        worst: Math.max(...errors.map(Math.abs)) };
  },
  panes: (values, { off, worst }, setup) => ({
    above: { x: [-60, 60, ''], y: [-48, 58, ''], equal: true, bare: true,
        given: 'A robot from above that faces north.',
        alt: `The robot from above: it faces ${values.heading} degrees and believes it faces ` +
        `${(values.heading + off * DEGREES).toFixed(0)} degrees.` },
    error: { x: [-180, 180, 'heading [°]'], y: [-60, 60, 'error [°]'],
        given: 'The error over the heading: nothing yet.',
        alt: `The compass's error in a full turn, up to ${worst.toFixed(1)} degrees.`,
        scrub: (x) => onStops(setup, { heading: x }) },
  }),
  draw({ above, error }, { heading }, { turn, errors, off }, hidden) {
    const angle = heading / DEGREES, read = angle + off;
    above.arrow(0, 0, 0, 30, 'ghost');
    above.robot([0, 0, hidden ? Math.PI / 2 : angle]);
    if (!hidden) {
      above.arrow(0, 0, 40 * Math.cos(angle), 40 * Math.sin(angle), 'path');
      above.arrow(0, 0, 40 * Math.cos(read), 40 * Math.sin(read), 'theta', { dash: [6, 4] });
    }
    above.text('north', 0, 30, { role: 'ghost', dx: -8, dy: 6, align: 'right' });
    if (hidden) return;
    above.text('believed', 40 * Math.cos(read), 40 * Math.sin(read), { role: 'theta',
      dx: Math.cos(read) < 0 ? -10 : 10, align: Math.cos(read) < 0 ? 'right' : 'left' });
    error.path(turn, errors, 'rising');
    error.line([[heading, 0], [heading, off * DEGREES]], 'ghost', { width: 1.5 });
    error.dot(heading, off * DEGREES, 'rising', { hollow: true });
  },
  say: (values, { off, worst }) =>
      ({ off: inDegrees(Math.abs(off)), worst: `${worst.toFixed(1)}°` }),
});
