// Chapter 6: a drive whose unit of length is 1/k_rho, and where its two numbers lie.

import {
  cornerOf, driven, endOf, gainsOf, inWords, insetOf, insetSize, modes, stage, summarise, within,
  written,
} from '../drawing.js';

const MOST = [8, 6]; // of kappa and h, in the corner
const CORNER = 170; // px, of its picture
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
  above(pane, { h }, { kappa, inside }) {
    const inset = insetOf(pane, 'left', insetSize(pane, CORNER), [-0.6, MOST[0]], [-0.6, MOST[1]]);
    inset.within(() => {
      pane.area([[2, 1], [2, MOST[1]], [1 + MOST[1], MOST[1]]].map(inset.at), 'start', 0.3);
      pane.line([[MOST[0], 0], [0, 0], [0, MOST[1]]].map(inset.at), 'soft', { width: 1 });
      pane.dot(...inset.at([within(kappa, 0, MOST[0] - 0.2), within(h, 0, MOST[1] - 0.2)]),
        inside ? 'start' : 'rising', { size: 7 });
    });
    const name = (text, x, y, role) => pane.text(text, ...inset.at([x, y]),
      { role, size: 16, weight: 600, align: 'center', fixed: true });
    name('κ', 7.4, 0.5, 'alpha');
    name('h', 0.6, 5.4, 'h');
    name('window', 3.4, 4.8, 'start');
  },
});
