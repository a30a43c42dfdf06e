// Chapter 6: a drive whose unit of length is 1/k_rho; in a corner its two numbers, its poles, its
// distance and its heading over time, or v/rho as a share of its value at the goal.

import {
  cornerOf, driven, endOf, gainsOf, inWords, insetOf, insetSize, modes, polesOf, stage, summarise,
  within, wrap, written,
} from '../drawing.js';

const MOST = [8, 6]; // of kappa and h, in the corner
const CORNER = 170; // px, of its picture
const POLES = [[-4.6, 0.9], [-2.2, 2.2]]; // the edges of their plane, in units of v_max k_rho
const DT = 0.03, DURATION = 60; // in units of 1/(v_max k_rho)
const FAR = 4; // in units of 1/k_rho, the right edge of the share's curve

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
  look: (values, { unit }) => [-4.4, -3.2, 2.6, 1.6].map((edge) => edge * unit),
  corner: (values, found, size) => cornerOf(size, CORNER),
  say: ({ h, goal }, { run, kappa, unit, inside }) => ({
    kappa: written(kappa), height: inWords(h), ends: endOf(run, goal),
    metres: written(summarise(run).pathLength, 'm'),
    share: `${(100 * shareAt(run.rho[0] / unit)).toFixed(0)} %`,
    window: `the heading settles ${inside ? '' : 'no '}sooner than the distance`,
  }),
  draw(pane, values, { start: [x, y] }) { pane.dot(x, y, 'start', { hollow: true }); },
  above(pane, { h }, { run, kappa, unit, inside }, { time, k, shows }) {
    const [corner = plane] = shows.map((name) => ({ poles, curves, share })[name]);
    corner(pane, { h, run, kappa, unit, inside, time, k });
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

const shareAt = (r) => (r > 0 ? -Math.expm1(-r) / r : 1); // of v/rho, straight ahead

function share(pane, { run, unit, k }) {
  const inset = framed(pane, [-0.4, FAR + 0.3], [-0.22, 1.3]), r = run.rho[k] / unit;
  inset.within(() => {
    pane.line([[FAR, 0], [0, 0], [0, 1.2]].map(inset.at), 'soft', { width: 1 });
    pane.line([[0, 1], [FAR, 1]].map(inset.at), 'soft', { width: 1, dash: [4, 4] });
    pane.line(Array.from({ length: 41 }, (_, step) => FAR * step / 40)
      .map((far) => inset.at([far, shareAt(far)])), 'alpha', { width: 2.5 });
    pane.dot(...inset.at([within(r, 0, FAR), shareAt(r)]), 'path', { size: 7 });
  });
  const name = namer(pane, inset, 13);
  name('as at the goal', 2.4, 1.13, 'soft');
  name('distance', 3.1, -0.13, 'rho');
}
