// A robot whose fixes stop: on in good faith, then braking. The way is the area under the speed.

import { live, onStops, written } from '../drawing.js';

export default live('silence', {
  find({ speed, timeout, brake }) {
    const faith = speed * timeout, braking = speed ** 2 / (2 * brake);
    return { faith, braking, far: faith + braking, stands: timeout + speed / brake };
  },
  panes: ({ speed }, { far, stands }) => ({
    road: { x: [-1, 17, 'way after the last fix [m]'], y: [-1.5, 1.5, '', () => ''],
        given: 'The way of the slower robot after its last fix.',
        alt: `The robot rolls ${written(far, 'm')} after its last fix.` },
    speed: { x: [0, 6.2, 'time after the last fix [s]'], y: [0, 4.3, 'speed [m/s]'],
        given: 'The speed of the slower robot over time.',
        alt: `The speed over time: ${written(speed, 'm/s')} at first, 0 after ` +
        `${written(stands, 's')}.` },
  }),
  draw({ road, speed: pane }, { speed, timeout }, { faith, far, stands }) {
    road.line([[-1, 0], [17, 0]], 'ghost', { width: 1.5 });
    road.robot([0, 0, 0], 0.3);
    road.text('last fix', 0, 0.25, { role: 'start', dy: 22, align: 'center' });
    road.rect(0, -0.25, faith, 0.25, 'start', 0.5);
    road.rect(faith, -0.25, far, 0.25, 'rising', 0.5);
    road.robot([far, 0, 0]);
    // both below the way, where nothing else is
    road.text('in good faith', 0, -0.25, { role: 'start', dy: -14, fixed: true });
    road.text('braking', faith, -0.25, { role: 'rising', dy: -32, fixed: true });
    pane.rect(0, 0, timeout, speed, 'start', 0.5);
    pane.area([[timeout, 0], [timeout, speed], [stands, 0]], 'rising', 0.5);
    pane.line([[0, speed], [timeout, speed], [stands, 0]], 'path');
  },
  handles: ({ speed, timeout }, found, setup) => [{
    id: 'corner', pane: 'speed', at: [timeout, speed],
        says: `the timeout and the speed, ${written(timeout, 's')} and ${written(speed, 'm/s')}`,
    move: (x, y) => onStops(setup, { timeout: x, speed: y }),
  }],
  say: (values, { faith, braking, far }) =>
      ({ faith: written(faith, 'm'), braking: written(braking, 'm'), far: written(far, 'm') }),
});
