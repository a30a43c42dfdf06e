// Two wheel speeds make a speed and a turning rate, and the point about which the robot turns.

import { TRACK, live, onStops, ring, twistOf, written } from '../drawing.js';

const motion = (v, omega, centre) =>
    (omega ? `It turns about a point ${written(centre, 'm')} to its left.` : v
    ? 'It drives straight on.' : 'It stands.');

export default live('turning_centre', {
  find: ({ left, right }, { data: { track } }) => {
    const { v, omega } = twistOf(left, right, track);
    return { v, omega, centre: v / omega, wheels: [[left, track / 2], [right, -track / 2]] };
  },
  panes: (values, { v, omega, centre }) => ({ plane: {
    x: [-1.6, 1.6, 'ahead [m]'], y: [-1.7, 1.7, 'left [m]'], equal: true,
    given: 'A robot seen from above, with the speeds of its two wheels as arrows.',
    alt: `The robot from above, its wheels' speeds as arrows. ${motion(v, omega, centre)}`,
  } }),
  draw({ plane }, values, { v, omega, centre, wheels }, hidden, { data: { track } }) {
    if (!hidden && omega && Math.abs(centre) < 50) {
      plane.line(ring(0, centre, Math.abs(centre)), 'ghost', { width: 1.5, dash: [4, 4] });
      plane.line([[wheels[0][0], wheels[0][1]], [0, centre], [wheels[1][0], wheels[1][1]]], 'rho',
          { width: 1.2, dash: [2, 4] });
    }
    plane.robot([0, 0, 0], 1, { size: track / plane.pixel / TRACK }); // its own wheels are these
    for (const [speed, side] of wheels) if (speed) plane.arrow(0, side, speed, side, 'path');
    if (!hidden && v) plane.arrow(0, 0, v, 0, 'start');
    if (hidden || !omega || centre < plane.range[2] || centre > plane.range[3]) return;
    plane.cross(0, centre, 'goal'); // over the robot that it may lie under
    plane.text('turning centre', 0, centre, { role: 'goal', dx: 20, dy: -20 });
  },
  handles: (values, { wheels }, setup) => ['left', 'right'].map((name, k) => ({
    id: name, pane: 'plane', at: wheels[k],
        says: `the ${name} wheel's speed, ${written(values[name], 'm/s')}`,
    move: (x) => onStops(setup, { [name]: x }),
  })),
  say: (values, { v, omega, centre }) => ({
    speed: written(v, 'm/s'), turning: written(omega, 'rad/s'),
    centre: omega
        ? (v ? `turns about a point ${written(Math.abs(centre), 'm')} to its ` +
        `${centre > 0 ? 'left' : 'right'}` : 'turns on the spot') : v ? 'drives straight on'
        : 'stands',
  }),
});
