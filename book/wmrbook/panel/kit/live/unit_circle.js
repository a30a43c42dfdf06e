// The poles of one time step near the goal, on the unit circle's plane, and the end of the drive
// that is sampled so.

import {
  DEGREES, LAWS, complex, driven, inDegrees, live, polesOf, poseAt, ring, within, wrap, written,
} from '../drawing.js';

// What one step makes of (alpha, theta): chapter 8's (8.3), with the angle of the chord 0, or half
// the turn.
function stepMatrix({ k_rho, k_alpha, h, v_max }, method, dt) {
  const rate = k_rho * v_max, c = rate * dt, turn = [dt * (k_alpha + rate), dt * rate * h],
      chord = turn.map((each) => (method === 'arc' ? each / 2 : 0));
  const sight = [c * (1 - chord[0]) / (1 - c), -c * chord[1] / (1 - c)];
  return [[1 + sight[0] - turn[0], sight[1] - turn[1]], [sight[0], 1 + sight[1]]];
}

const WIDE = 1.6;

const endOf = ({ outcome }, off) =>
    (outcome === 'ARRIVED' ? `stops ${Math.abs(off * DEGREES).toFixed(0)} degrees off`
    : 'does not arrive');

export default live('unit_circle', {
  find({ times, gains: name, method }, { data: { gains, longest, start, goal } }) {
    const dt = times * longest[name][method], [rate] = LAWS.corrected.modes(gains[name]),
        [[a, b], [c, d]] = stepMatrix(gains[name], method, dt),
        poles = polesOf(-a - d, a * d - b * c),
        run = driven({ start, goal, gains: gains[name], method, dt });
    return { dt, poles, size: Math.max(...poles.map((each) => Math.hypot(...each))), run,
        off: wrap(run.heading[run.n - 1] - goal[2]), longest: longest[name][method], rate,
        kept: 1 - dt * rate };
  },
  panes: (values, { poles, run, off }, { data: { goal: [x, y] } }) => ({
    plane: { x: [-WIDE, WIDE, 'real part'], y: [-WIDE, WIDE, 'imaginary part'], equal: true,
        given: 'The unit circle.',
        alt: `The unit circle, and the poles at ${poles.map(complex).join(' and ')}.` },
    near: { x: [x - 1.6, x + 1.6, 'x [m]'], y: [y - 1.1, y + 2.1, 'y [m]'], equal: true,
        given: 'The goal, with the heading that is asked for.',
        alt: `The last two metres, sample by sample: the robot ${endOf(run, off)}.` },
  }),
  draw({ plane, near }, values, { poles, run, kept, size }, hidden, { data: { goal } }) {
    plane.area(ring(0, 0, 1), 'path', 0.1);
    plane.line(ring(0, 0, 1), 'ink', { width: 1.5 });
    near.pose(goal, 'goal');
    if (hidden) return;
    plane.dot(kept, 0, 'rho', { hollow: true });
    for (const [re, im] of poles) {
      const inside = within(re, -WIDE, WIDE);
      plane.cross(inside, im, size > 1 ? 'rising' : 'alpha', 8);
      if (inside !== re)
        plane.text(`${written(re)}`, inside, im,
            { role: 'rising', dy: 18, dx: re < 0 ? 12 : -12, align: re < 0 ? 'left' : 'right' });
    }
    plane.text('distance', kept, 0, { role: 'rho', dx: 11 });
    near.path(run.x, run.y);
    for (let k = 0; k < run.n; k += Math.max(1, Math.round(run.n / 400)))
      near.dot(run.x[k], run.y[k], 'path', { size: 1.5 });
    near.robot(poseAt(run, run.n - 1));
  },
  say: (values, { dt, longest, rate, kept, size, run, off }) => ({
    dt: written(dt, 's'), longest: written(longest, 's'), rate: written(rate), step: written(dt),
        kept: written(kept), size: written(size),
        fate: size < 1 ? 'shrink' : size > 1 + 1e-9 ? 'grow from step to step'
        : 'neither shrink nor grow',
    end: run.outcome === 'ARRIVED'
        ? `ends after ${written(run.t[run.n - 1], 's')}, ${inDegrees(Math.abs(off), 0)} off`
        : 'does not end within a minute',
  }),
});
