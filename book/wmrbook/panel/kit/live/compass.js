// A compass on a robot with magnets and steel: the field that it feels, and the heading that it
// makes of it.

import { DEGREES, inDegrees, live, onStops, wrap } from '../drawing.js';

// The field in the robot's frame, [ahead, left], and the heading that follows from it; the robot's
// heading in radians from magnetic east.
/** @param {number} heading @param {Values} knobs @param {number} field */
function felt(heading, { iron, soft }, field) {
  const s = soft / 100,
      at = [(1 + s) * field * Math.sin(heading) + iron, (1 - s) * field * Math.cos(heading)];
  return { at, read: wrap(Math.PI / 2 - Math.atan2(at[1], at[0])) };
}

export default live('compass', {
  find(values, { data: { field } }) {
    const turn = Array.from({ length: 181 }, (_, k) => 2 * k - 180),
        errors = turn.map((each) =>
        wrap(felt(each / DEGREES, values, field).read - each / DEGREES) * DEGREES);
    const heading = values.heading / DEGREES,
        { at: [ahead, left], read } = felt(heading, values, field),
        [cos, sin] = [Math.cos(heading), Math.sin(heading)];
    return { turn, errors, worst: Math.max(...errors.map(Math.abs)), read, cos, sin,
        sum: [ahead * cos - left * sin, ahead * sin + left * cos] };
  },
  panes: (values, { read, worst }, setup) => ({
    above: { x: [-60, 60, ''], y: [-48, 58, ''], equal: true, bare: true,
        given: 'A robot from above that looks east, and the field that points north.',
        alt: `The robot from above and the fields that it feels: it looks to ` +
        `${values.heading} degrees and believes it looks to ` +
        `${(read * DEGREES).toFixed(0)} degrees.` },
    error: { x: [-180, 180, 'heading [°]'], y: [-90, 90, 'error [°]'],
        given: 'The error over the heading: nothing yet.',
        alt: `The heading's error in a full turn, up to ${worst.toFixed(0)} degrees.`,
        scrub: (x) => onStops(setup, { heading: x }) },
  }),
  draw({ above, error }, { heading }, { turn, errors, read, cos, sin, sum: [east, north] }, hidden,
      { data: { field } }) {
    above.arrow(0, 0, 0, field, 'ghost');
    above.robot([0, 0, hidden ? 0 : Math.atan2(sin, cos)]);
    if (!hidden) {
      above.line([[0, field], [east, north]], 'goal', { width: 2 });
      above.arrow(0, 0, east, north, 'rising', { dash: [6, 4] });
      above.arrow(0, 0, 40 * cos, 40 * sin, 'path');
      above.arrow(0, 0, 40 * Math.cos(read), 40 * Math.sin(read), 'theta', { dash: [6, 4] });
    }
    above.text('north', 0, field, { role: 'ghost', dx: -8, dy: 6, align: 'right' });
    if (hidden) return;
    above.text('believed', 40 * Math.cos(read), 40 * Math.sin(read), { role: 'theta',
      dx: Math.cos(read) < 0 ? -10 : 10, align: Math.cos(read) < 0 ? 'right' : 'left' });
    above.text('felt', east, north, { role: 'rising', dx: 10, dy: north > 0 ? 8 : -8 });
    const off = wrap(read - heading / DEGREES) * DEGREES;
    error.path(turn, errors, 'rising');
    error.line([[heading, 0], [heading, off]], 'ghost', { width: 1.5 });
    error.dot(heading, off, 'rising', { hollow: true });
  },
  say: (values, { read, worst }) => ({ read: inDegrees(read), worst: `${worst.toFixed(0)}°` }),
});
