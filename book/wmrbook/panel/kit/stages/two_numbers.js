// Chapter 6: a drive whose unit of length is 1/k_rho; in a corner its two numbers, its poles, or
// its distance and its heading over time.

import {
  cornerOf, driven, endOf, gainsOf, inWords, insetOf, insetSize, modes, polesOf, stage, summarise,
  within, wrap, written,
} from '../drawing.js';

const MOST = [8, 6]; // of kappa and h, in the corner
const CORNER = 170; // px, of its picture
const POLES = [[-4.6, 0.9], [-2.2, 2.2]]; // the edges of their plane, in units of v_max k_rho
const DT = 0.03, DURATION = 60; // in units of 1/(v_max k_rho)

export default stage('two_numbers', {
  find(values, setup) {
    const { goal } = values, { start: [x, y, heading], stops } = setup.data;
    const gains = gainsOf(values, setup), unit = 1 / gains.k_rho, clock = unit / gains.v_max;
    const run = driven({ start: [x * unit, y * unit, heading], goal, gains,
      arrivalRadius: stops * unit, dt: DT * clock, duration: DURATION * clock });
    const { kappa } = modes(gains);
    return { run, kappa, unit, start: [x * unit, y * unit],
      inside: kappa > 2 && kappa < 1 + gains.h, tracks: [{ ...run, role: 'path' }] };
  },
  look: (values, { unit }) => [-4.4, -3.2, 1.6, 1.6].map((edge) => edge * unit),
  corner: (values, found, size) => cornerOf(size, CORNER),
  say: ({ h, goal }, { run, kappa, inside }) => ({
    kappa: written(kappa), height: inWords(h), ends: endOf(run, goal),
    metres: written(summarise(run).pathLength, 'm'),
    window: `the heading settles ${inside ? '' : 'no '}sooner than the distance`,
  }),
  draw(pane, values, { start: [x, y] }) { pane.dot(x, y, 'start', { hollow: true }); },
  above(pane, { h }, { run, kappa, inside }, { time, shows }) {
    const corner = shows.includes('poles') ? poles : shows.includes('curves') ? curves : plane;
    corner(pane, { h, run, kappa, inside, time });
  },
});

const framed = (pane, xs, ys) => insetOf(pane, 'left', insetSize(pane, CORNER), xs, ys);
const namer = (pane, inset, size) => (text, x, y, role) => pane.text(text, ...inset.at([x, y]),
  { role, size, weight: 600, align: 'center', fixed: true });

function plane(pane, { h, kappa, inside }) {
  const inset = framed(pane, [-0.6, MOST[0]], [-0.6, MOST[1]]), name = namer(pane, inset, 16);
  inset.within(() => {
    pane.area([[2, 1], [2, MOST[1]], [1 + MOST[1], MOST[1]]].map(inset.at), 'start', 0.3);
    pane.line([[MOST[0], 0], [0, 0], [0, MOST[1]]].map(inset.at), 'soft', { width: 1 });
    pane.dot(...inset.at([within(kappa, 0, MOST[0] - 0.2), within(h, 0, MOST[1] - 0.2)]),
      inside ? 'start' : 'rising', { size: 7 });
  });
  name('κ', 7.4, 0.5, 'alpha');
  name('h', 0.6, 5.4, 'h');
  name('window', 3.4, 4.8, 'start');
}

function poles(pane, { h, kappa }) {
  const [[left, right], [low, high]] = POLES, inset = framed(pane, ...POLES);
  inset.within(() => {
    pane.area([[left, low], [-1, low], [-1, high], [left, high]].map(inset.at), 'start', 0.2);
    pane.line([[left, 0], [right, 0]].map(inset.at), 'soft', { width: 1 });
    pane.line([[0, low], [0, high]].map(inset.at), 'soft', { width: 1 });
    pane.dot(...inset.at([-1, 0]), 'rho', { size: 6 });
    for (const [x, y] of polesOf(kappa, h))
      pane.cross(...inset.at([within(x, left + 0.2, right), within(y, low + 0.2, high - 0.2)]),
        'alpha', 6);
  });
  const name = namer(pane, inset, 13);
  name('distance', -1.9, -0.4, 'rho');
  name('heading', -2.6, 1.8, 'alpha');
}

function curves(pane, { run: { t, rho, alpha, theta, n }, time }) {
  const last = Math.max(t[n - 1], 1e-9);
  const error = (k) => wrap(theta[k] - alpha[k]);
  const most = Math.max(...Array.from({ length: n }, (_, k) => Math.abs(error(k))), 1e-9);
  const inset = framed(pane, [-0.05 * last, 1.05 * last], [-1.2, 1.2]);
  inset.within(() => {
    pane.line([[0, 0], [last, 0]].map(inset.at), 'soft', { width: 1 });
    const later = t.findIndex((second) => second > time), to = later < 0 ? n : later;
    const curve = (height, role) => {
      if (to) pane.line(Array.from({ length: to }, (_, k) => inset.at([t[k], height(k)])), role,
        { width: 2.5 });
    };
    curve((k) => rho[k] / rho[0], 'rho');
    curve((k) => error(k) / most, 'alpha');
  });
  const name = namer(pane, inset, 13);
  name('distance', 0.72 * last, 0.95, 'rho');
  name('heading error', 0.66 * last, -0.95, 'alpha');
}
