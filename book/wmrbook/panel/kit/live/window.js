// The plane of the two numbers that shape a path, kappa and h, with the window in which the heading
// settles before the distance, and how such a robot comes to its goal. All is in lengths of 1/k_rho
// and times of 1/(v_max k_rho), so the loop is that of gains (1, kappa, h, 1).

import {
  DEGREES, between, driven, live, modes, poseAt, within, wrap, written,
} from '../drawing.js';

const GOAL = [0, 0, 0], MOST = 6; // of kappa and h
const NEAR = 0.15; // a hand so near a named point means that point
const RADII = [0.1, 0.01]; // in lengths of 1/k_rho, where the sentence says what is left
const FAN = 0.62; // so long are the headings of the last tenth
const COMING = [1.1, 0.6, 0.3]; // from the goal: where a pale robot shows how it comes
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
    const first = (radius) => run.rho.findIndex((rho) => rho <= radius);
    const late = RADII.map((radius) => { // from the radius itself on, between two samples
      const k = first(radius),
          place = k - 1 + (run.rho[k - 1] - radius) / (run.rho[k - 1] - run.rho[k]);
      return Math.max(...[between(error, place), ...error.slice(k)].map(Math.abs));
    });
    const last = error.slice(first(RADII[0]));
    return { run, late, slower, inside: kappa > 2 && kappa < 1 + h,
      coming: COMING.map(first), near: first(RADII[0]),
      fan: [Math.min(0, ...last), Math.max(0, ...last)] };
  },
  panes: ({ kappa, h }, { inside, late, fan }, { data: { named } }) => ({
    plane: { x: [0, MOST, 'κ'], y: [0, MOST, 'h'],
        given: 'The plane of kappa and h, with some gains by name.',
        alt: `The plane of kappa and h: the window lies right of kappa 2 and above the line h = ` +
        `kappa minus 1. The point, ${written(kappa)} and ${written(h)}, is ` +
        `${inside ? 'in' : 'out'}side.`,
        scrub: (x, y, moved) => (moved ? pointAt(x, y, named) : null) },
    path: { x: [-1.5, 0.85], y: [-1.15, 1.15], lawn: true, main: true,
        given: "The last metres of the path with the paper's gains.",
        alt: `The robot comes to its goal. Over the last tenth of a length its heading is from ` +
        `${fan[0].toFixed(0)} to ${fan[1].toFixed(0)} degrees off, ${late[0].toFixed(1)} ` +
        `at most.` },
  }),
  draw({ plane, path }, { kappa, h }, { run, inside, coming, near, fan }, hidden,
      { data: { named } }) {
    const role = inside ? 'start' : 'rising';
    if (!hidden) {
      plane.area([[2, 1], [2, 99], [100, 99]], 'start', 0.25);
      plane.line([[2, 99], [2, 1], [100, 99]], 'start', { width: 1.5 });
      plane.curve((x) => x * x / 4, 'ghost', { width: 1.5, dash: [5, 4] });
      plane.text('damping 1', 3.2, 1.3, { role: 'ghost', size: 13 });
      plane.text('window', 2, 5.55, { role: 'start', dx: 8, size: 16, weight: 650, fixed: true });
      plane.text('2 < κ < 1 + h', 2, 5.05, { role: 'start', dx: 8, size: 14, fixed: true });
      plane.text('outside', 1.85, 5.55, { role: 'rising', size: 14, align: 'right' });
      const edge = Array.from({ length: 41 }, (_, k) => {
        const angle = (fan[0] + (fan[1] - fan[0]) * k / 40) / DEGREES;
        return [FAN * Math.cos(angle), FAN * Math.sin(angle)];
      });
      path.area([[0, 0], ...edge], role, 0.35);
      path.line([[0, 0], ...edge, [0, 0]], role, { width: 1.5 });
    }
    for (const [name, x, y] of named) {
      plane.dot(x, y, 'ink', { size: 4 });
      const [dx, dy, align] = x > MOST / 2 ? [-15, -3, 'right']
          : x < 0.5 ? [0, 20, 'left'] : [15, -3, 'left'];
      plane.text(name, x, y, { dx, dy, size: 13, align });
    }
    plane.dot(kappa, h, hidden ? 'path' : role, { size: 8 });
    path.path(run.x, run.y);
    path.pose(GOAL, 'goal');
    coming.forEach((k) => path.robot(poseAt(run, k), 0.4));
    path.robot(poseAt(run, near));
    if (hidden) return;
    path.text(`its heading still turns by ${(fan[1] - fan[0]).toFixed(0)}°`, 0.8, -0.85,
        { role, size: 15, weight: 600, align: 'right', fixed: true });
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
