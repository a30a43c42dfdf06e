// The plane of the two numbers that shape a path, kappa and h, with the window in which the heading
// settles before the distance. All is in lengths of 1/k_rho and times of 1/(v_max k_rho), so the
// loop is that of gains (1, kappa, h, 1).

import {
  DEGREES, between, complex, driven, inDegrees, live, modes, polesOf, poseAt, within, wrap,
  written,
} from '../drawing.js';

const GOAL = [0, 0, 0], MOST = 6; // of kappa and h
const NEAR = 0.15; // a hand so near a named point means that point
const RADII = [0.1, 0.01]; // in lengths of 1/k_rho, where the sentence says what is left
const tick = (place) => ['1', '0.1', '0.01'][place] || '';
const allowed = (value) => Number(within(value, 0.05, MOST).toFixed(2));

function pointAt(x, y, named) {
  const known = named.find(([, kappa, h]) => Math.hypot(kappa - x, h - y) < NEAR);
  return known ? { kappa: known[1], h: known[2] } : { kappa: allowed(x), h: allowed(y) };
}

export default live('window', {
  find({ kappa, h }, { data: { start } }) {
    const gains = { k_rho: 1, k_alpha: kappa, h, v_max: 1 }, { slower } = modes(gains),
        run = driven({ start, goal: GOAL, gains, dt: 0.02, duration: 90, arrivalRadius: 1e-6 }),
        error = Array.from(run.theta, (theta, k) => wrap(theta - run.alpha[k]) * DEGREES);
    const late = RADII.map((radius) => { // from the radius itself on, between two samples
      const k = run.rho.findIndex((rho) => rho <= radius),
          place = k - 1 + (run.rho[k - 1] - radius) / (run.rho[k - 1] - run.rho[k]);
      return Math.max(...[between(error, place), ...error.slice(k)].map(Math.abs));
    });
    return { run, error, late, poles: polesOf(kappa, h), slower,
        inside: kappa > 2 && kappa < 1 + h };
  },
  panes: ({ kappa, h }, { poles, inside, run, error, late }, { data: { named } }) => ({
    plane: { x: [0, MOST, 'κ'], y: [0, MOST, 'h'],
        given: 'The plane of kappa and h, with some gains by name.',
        alt: `The plane of kappa and h: the window lies right of kappa 2 and above the line h = ` +
        `kappa minus 1. The point, ${written(kappa)} and ${written(h)}, is ` +
        `${inside ? 'in' : 'out'}side.`,
        scrub: (x, y, moved) => (moved ? pointAt(x, y, named) : null) },
    path: { x: [-4, 2, 'k_rho x'], y: [-5, 1, 'k_rho y'], equal: true, main: true,
        given: 'The path before the gains are doubled.',
        alt: `The path: the robot stops ${inDegrees(error[run.n - 1] / DEGREES)} off.` },
    poles: { x: [-MOST - 0.3, 0.6, 'real part / λ'], y: [-3.2, 3.2, 'imaginary part / λ'],
        given: 'The plane of the poles, with the distance\'s at minus 1.',
        alt: `The poles of the angles at ${poles.map(complex).join(' and ')}; the distance's at ` +
        `minus 1.` },
    left: { x: [-0.75, 2.3, 'distance left, r', tick], y: [-180, 180, 'heading error [°]'],
        given: 'The heading error over the distance left, before the gains are doubled.',
        alt: `The heading error over the distance left, at most ${late[0].toFixed(1)} degrees ` +
        `from r = 0.1 on.` },
  }),
  draw({ plane, poles: roots, left, path }, { kappa, h }, { poles, run, error }, hidden,
      { data: { start, named } }) {
    if (!hidden) plane.area([[2, 1], [2, 99], [100, 99]], 'start', 0.2);
    if (!hidden) plane.curve((x) => x * x / 4, 'ghost', { width: 1.5, dash: [5, 4] });
    if (!hidden) plane.text('damping 1', 3.1, 1.3, { role: 'ghost', size: 13 });
    if (!hidden) plane.text('window', 2, 5.5, { role: 'start', dx: 6, size: 13 });
    for (const [name, x, y] of named) {
      plane.dot(x, y, 'ink', { size: 4 });
      const [dx, dy, align] = x > MOST / 2 ? [-15, -3, 'right']
          : x < 0.5 ? [0, 20, 'left'] : [15, -3, 'left'];
      plane.text(name, x, y, { dx, dy, size: 13, align });
    }
    roots.rect(-1, -9, 9, 9, 'rising', 0.12);
    roots.text('slower', 0.6, -2.7, { role: 'rising', align: 'right', size: 13 });
    roots.dot(-1, 0, 'rho', { hollow: true });
    path.pose(GOAL, 'goal');
    left.line(error.map((each, k) => [-Math.log10(run.rho[k]), each]), 'path');
    path.path(run.x, run.y);
    path.robot(start, 0.35);
    path.robot(poseAt(run, run.n - 1));
    plane.dot(kappa, h, 'path', { size: 8 });
    if (hidden) return;
    for (const [re, im] of poles) roots.cross(re, im, 'alpha', 8);
    for (const at of RADII.map((radius) => -Math.log10(radius)))
      left.line([[at, -180], [at, 180]], 'ink', { width: 1, dash: [2, 3] });
  },
  handles: ({ kappa, h }, found, { data: { named } }) => [{
    id: 'point', pane: 'plane', at: [kappa, h], says: `kappa ${written(kappa)}, h ${written(h)}`,
    move: (x, y, exact) => (exact ? { kappa: allowed(x), h: allowed(y) }
        : pointAt(x, y, named)),
  }],
  say: (values, { slower, inside, late }) => ({
    place: inside ? 'in the window' : 'outside the window',
    compared: slower >= 1 ? `${written(slower, '', 2)} times slower`
        : `${written(1 / slower, '', 2)} times faster`,
    late: `${late[0].toFixed(1)}°`, later: `${late[1].toFixed(1)}°`,
  }),
});
