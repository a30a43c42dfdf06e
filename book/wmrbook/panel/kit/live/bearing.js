// One direction, counted in two ways: clockwise from north and counter-clockwise from east; and
// where one goes who swaps the two.

import { DEGREES, inDegrees, live, onStops, wrap, written } from '../drawing.js';

const clockwise = (angle) => `${((angle * DEGREES + 360) % 360).toFixed(1)}°`;

function find({ east, north }) {
  const rho = Math.hypot(east, north);
  if (rho < 1)
    throw new RangeError(
        'Point 2 would lie on point 1: there is no direction from one to the other.');
  const bearing = Math.atan2(east, north), sight = Math.atan2(north, east);
  return { rho, bearing, sight, off: Math.abs(wrap(bearing - sight)) };
}

export default live('bearing', {
  find,
  panes: ({ east, north }, { bearing, sight }) => ({ map: {
    x: [-66, 66, 'east [m]'], y: [-66, 66, 'north [m]'], equal: true,
    given: 'A map around point 1, east to the right and north up.',
    alt: `Point 2 is ${written(east, 'm')} east and ${written(north, 'm')} north of point 1: ` +
        `${clockwise(bearing)} clockwise from north, ${inDegrees(sight)} counter-clockwise from ` +
        `east.`,
  } }),
  draw({ map }, { east, north }, { bearing, sight }, hidden) {
    map.arrow(0, 0, 0, 62, 'ink', { width: 1.5 });
    map.text('north', 0, 62, { dx: 8 });
    map.arrow(0, 0, 62, 0, 'ink', { width: 1.5 });
    map.text('east', 62, 0, { dy: -12, align: 'center' });  // the guess begins above it
    map.dot(0, 0, 'start');
    map.text('point 1', 0, 0, { role: 'start', dx: -10, dy: -14, align: 'right' });
    if (hidden) return;
    map.arrow(0, 0, north, east, 'ghost', { dash: [5, 5] });
    map.text('br from east', north, east,
        { role: 'ghost', dy: east > 0 ? 12 : -12, align: north > 20 ? 'right' : 'left' });
    map.line([[0, 0], [east, north]], 'rho');
    map.dot(east, north, 'goal');
    map.text('point 2', east, north,
        { role: 'goal', dx: east > 30 ? -10 : 10, dy: north > 0 ? 14 : -14,
        align: east > 30 ? 'right' : 'left' });
    map.angle(0, 0, Math.PI / 2, -((bearing + 2 * Math.PI) % (2 * Math.PI)), 'br', 'ink', 34);
    map.angle(0, 0, 0, sight, 'θ', 'theta', 54);
  },
  handles: ({ east, north }, found, setup) => [{
    id: 'point', pane: 'map', at: [east, north],
        says: `point 2, ${written(east, 'm')} east and ${written(north, 'm')} north`,
    move(x, y) {
      const to = onStops(setup, { east: x, north: y });
      find(to);
      return to;
    },
  }],
  say: (values, { bearing, sight, off }) =>
      ({ bearing: clockwise(bearing), angle: inDegrees(sight), off: inDegrees(off, 0) }),
});
