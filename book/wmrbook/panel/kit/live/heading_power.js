// Graceful's heading error over the distance left, on logarithmic scales: a power of it.

import {
  DEGREES, driven, freshRun, inReach, live, remembered, summarise, written,
} from '../drawing.js';

const LEAST = 1e-4; // degrees, the lower border
const power = (value) => (Number.isInteger(value) ? String(+(10 ** value).toPrecision(1)) : '');
const stopped = remembered(freshRun), shipped = remembered(({ all, ...how }) =>
    all.map((gains) => freshRun({ ...how, gains })));
const off = (run, k) => Math.abs(run.theta[k] - run.alpha[k]) * DEGREES;
const curve = (run) =>
    Array.from({ length: run.n }, (_, k) => [Math.log10(run.rho[k]), Math.log10(off(run, k))])
    .filter(([, y]) => y >= Math.log10(LEAST));

export default live('heading_power', {
  find({ k_phi, k_delta, radius }, { data: { start, goal, gains, defaults } }) {
    const steer = (phi, delta) => ({ ...gains, h: phi, k_alpha: delta }),
        how = { start, goal, law: 'graceful', duration: 120, arrivalRadius: 0.005 },
        here = { ...how, gains: steer(k_phi, k_delta) }, run = driven(here);
    const { headingError, time } = summarise(stopped({ ...here, arrivalRadius: radius }));
    const others = shipped({ ...how, all: Object.values(defaults).map((each) => steer(...each)) });
    return { run, others, time, left: Math.abs(headingError), power: Math.min(k_phi, k_delta) };
  },
  panes: ({ radius }, { left, power: slope }, setup) => ({ error: {
    x: [-2.3, 0.6, 'distance left [m]', power],
        y: [-4, 2.4, 'heading error [°]', power],
    given: 'The heading error over the distance left, down to 10 cm, on logarithmic scales.',
    alt: `The heading error over the distance left, both on logarithmic scales: near the goal a ` +
        `line of slope ${written(slope)}; ${written(left * DEGREES, '°')} at ` +
        `${written(radius, 'm')}. Thin lines are Nav2's two defaults.`,
    scrub: (x) => inReach(setup, { radius: 10 ** x }),
  } }),
  draw({ error }, { radius }, { run, others, left, power: slope }, hidden, { data }) {
    const at = [Math.log10(radius), Math.log10(Math.max(left * DEGREES, LEAST))];
    error.line(curve(run).filter(([x]) => !hidden || x >= at[0]), 'path');
    error.dot(at[0], at[1]);
    if (hidden) return;
    Object.keys(data.defaults).forEach((name, i) => {
      const points = curve(others[i]), [x, y] = points[points.length - 1];
      error.line(points, 'ghost', { width: 1.5, dash: i ? [2, 5] : [7, 4] });
      error.text(name, x, y, { role: 'ghost', dx: 4, dy: -12, size: 12 });
    });
    error.line([-1, 1].map((by) => [at[0] + by, at[1] + by * slope]), 'goal',
        { width: 1.5, dash: [3, 4] });
    error.line([[at[0], -4], [at[0], 2.4]], 'rho', { width: 1.5, dash: [3, 4] });
  },
  say: ({ k_phi, k_delta }, { time, left, power: slope }) => ({
    power: written(slope) + (k_phi === k_delta ? ', times a logarithm,' : ''),
    seconds: written(time, 's'),
    left: left * DEGREES < 0.001 ? 'less than 0.001°' : written(left * DEGREES, '°'),
  }),
});
