// A half turn in exact arcs and in Euler's straight steps.

import { STEPS, live, ring, written } from '../drawing.js';

export default live('one_step', {
  find({ dt }, { data: { v, omega } }) {
    const whole = Math.PI / omega,
        times = Array.from({ length: Math.ceil(whole / dt - 1e-9) },
        (_, k) => Math.min(dt, whole - k * dt));
    const way = (step) => times.reduce((poses, time) =>
      [...poses, step(...poses.at(-1), v, omega, time)], [[0, 0, 0]]);
    const arc = way(STEPS.arc), euler = way(STEPS.euler);
    const apart = (k) => Math.hypot(arc.at(k)[0] - euler.at(k)[0], arc.at(k)[1] - euler.at(k)[1]);
    return { arc, euler, miss: apart(1), off: apart(-1) };
  },
  panes: (values, { arc, off }, { data: { v, omega } }) => ({ plane: {
    x: [-1.1 * v / omega, 2.1 * v / omega, 'x [m]'],
        y: [-0.3 * v / omega, 2.7 * v / omega, 'y [m]'], equal: true,
        given: 'The half circle on which the robot turns left, and the straight steps beside it.',
    alt: `A half turn in ${arc.length - 1} steps: the arcs lie on the half circle, Euler's ` +
        `straight steps go outside of it and end ${written(off, 'm')} away.`,
  } }),
  draw({ plane }, values, { arc, euler }, hidden, { data: { v, omega } }) {
    const radius = v / omega;
    plane.line(ring(0, radius, radius, -Math.PI / 2, Math.PI / 2), 'path');
    plane.robot([0, 0, 0], 0.45);
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
