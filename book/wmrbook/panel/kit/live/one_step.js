// A half turn in exact arcs and in Euler's straight steps.

import { STEPS } from '../model.js';
import { live } from '../live.js';
import { written } from '../style.js';

export default live('one_step', {
  find({ dt }, { data: { v, omega } }) {
    const whole = Math.PI / omega,
        times = Array.from({ length: Math.ceil(whole / dt - 1e-9) },
        (_, k) => Math.min(dt, whole - k * dt));
    const ways =
        Object.fromEntries(
        ['arc', 'euler'].map((name) =>
        [name, times.reduce((poses, time) =>
        [...poses, STEPS[name](...poses.at(-1), v, omega, time)], [[0, 0, 0]])]));
    const apart = (k) =>
        Math.hypot(ways.arc.at(k)[0] - ways.euler.at(k)[0],
        ways.arc.at(k)[1] - ways.euler.at(k)[1]);
    return { ...ways, miss: apart(1), off: apart(-1) };
  },
  panes: (values, { arc, off }, { data: { v, omega } }) => ({ plane: {
    x: [-1.1 * v / omega, 2.1 * v / omega, 'x [m]'],
        y: [-0.3 * v / omega, 2.7 * v / omega, 'y [m]'], equal: true, tall: true,
        given: 'The robot at the start, and the half circle on which it turns left.',
    alt: `A half turn in ${arc.length - 1} steps: the arcs lie on the half circle, Euler's ` +
        `straight steps go outside of it and end ${written(off, 'm')} away.`,
  } }),
  draw({ plane }, values, { arc, euler }, hidden, { data: { v, omega } }) {
    const radius = v / omega,
        half = Array.from({ length: 61 }, (_, k) => Math.PI * k / 60)
        .map((turn) => [radius * Math.sin(turn), radius - radius * Math.cos(turn)]);
    plane.line(half, 'path');
    plane.robot([0, 0, 0], hidden ? 1 : 0.45);
    if (hidden) return;
    plane.line(euler, 'ghost', { dash: [6, 4] });
    if (arc.length < 40) {
      euler.slice(1, -1).forEach(([x, y]) => plane.dot(x, y, 'ghost', { size: 3, hollow: true }));
      arc.slice(1, -1).forEach(([x, y]) => plane.dot(x, y, 'path', { size: 3 }));
    }
    plane.robot(euler.at(-1), 0.45);
    plane.robot(arc.at(-1));
    plane.text('arc', radius, radius, { role: 'path', dx: -10, align: 'right' });
    const [x, y] = euler[Math.ceil((euler.length - 1) / 2)];
    plane.text('Euler', x, y, { role: 'ghost', dx: 12 });
  },
  say: (values, { arc, miss, off }) =>
      ({ count: `${arc.length - 1} step${arc.length > 2 ? 's' : ''}`, miss: written(miss, 'm'),
      off: written(off, 'm') }),
});
