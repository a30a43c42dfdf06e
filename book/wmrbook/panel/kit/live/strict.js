// Is V strict under the barrier law? Where it rises among the angles that are drawn, what z3 says
// of all of them, and V along a drive: from the state that z3 finds, if it finds one.

import { DEGREES, decay, freshRun, live, poseOfError, remembered, written } from '../drawing.js';

const HALF = 50, CELLS = 121, SAMPLES = 3000;

// A polynomial in tan(theta/2), tan(alpha/2) and k2, as rows of powers and a factor: its
// coefficients along a row of theta, and its value there.
function along(terms, p, k2) {
  const row = new Array(1 + Math.max(...terms.map(([, j]) => j))).fill(0);
  for (const [i, j, k, factor] of terms) row[j] += factor * p ** i * k2 ** k;
  return row;
}
const at = (row, q) => row.reduceRight((sum, each) => sum * q + each, 0);

// Row by row of theta: the cells of alpha in which V rises.
const map = remembered(({ k2, slope }) => {
  const middles = Array.from({ length: CELLS }, (_, k) => ((k + 0.5) / CELLS * 2 - 1) * HALF),
      half = (degrees) => Math.tan(degrees / DEGREES / 2);
  return middles.flatMap((theta) => {
    const row = along(slope, half(theta), k2);
    return middles.filter((alpha) => at(row, half(alpha)) > 0).map((alpha) => [theta, alpha]);
  });
});

// V along the drive from a state, as a percentage of what it is there.
const drive = remembered(({ k2, p, q, rho, V }) => {
  const gains = { k_rho: 1, k_alpha: k2 * decay(rho, 1), h: 1, v_max: 1 }, dt = 0.01 / (1 + k2),
      [alpha, theta] = [2 * Math.atan(q), 2 * Math.atan(p)],
      run = freshRun({ start: poseOfError(rho, alpha, theta, 0, 0, 0), goal: [0, 0, 0], gains,
        law: 'barrier', dt, duration: SAMPLES * dt, arrivalRadius: 0 });
  const values = Array.from(run.t, (_, k) =>
      at(along(V, Math.tan(run.theta[k] / 2), k2), Math.tan(run.alpha[k] / 2)));
  return { t: Array.from(run.t), alpha: Array.from(run.alpha), theta: Array.from(run.theta),
    grown: values.map((each) => 100 * (each / values[0] - 1)) };
});

export default live('strict', {
  find({ k2, answer }, { data }) {
    const known = answer && answer.of.k2 === k2, state = known && answer.is.state,
        [p, q] = state || data.state, run = drive({ k2, p, q, rho: data.rho, V: data.V }),
        most = Math.max(...run.grown, 1e-9),
        [low, high] = state ? [-2 * most, 1.4 * most] : [-100, 20],
        end = run.grown.findIndex((each) => each < 0.98 * low);
    return { known, state, run, most, low, high, ...unitFor(high),
      end: end < 0 ? run.t.length - 1 : end, rising: map({ k2, slope: data.slope }) };
  },
  panes: (values, { state, run, low, high, end, rising, most, scale, unit }) => ({
    plane: { x: [-HALF, HALF, 'α [°]'], y: [-HALF, HALF, 'θ [°]'], equal: true,
        alt: `Alpha and theta up to 50 degrees: V rises in ${rising.length} of ${CELLS ** 2} ` +
        `cells. A drive from ${state ? 'the state that z3 found' : 'a state farther out'}.` },
    time: { x: [0, run.t[end], 'time, scaled'],
        y: [low / scale, high / scale, `V against the start [${unit}]`],
        alt: state ? `V rises by ${written(most, 'percent')} and then falls.`
        : `V falls by ${written(-run.grown[end], 'percent')}.` },
  }),
  draw({ plane, time }, values, { state, run, rising, scale }) {
    const half = HALF / CELLS, role = state ? 'rising' : 'path';
    for (const [theta, alpha] of rising)
      plane.rect(alpha - half, theta - half, alpha + half, theta + half, 'rising', 0.5);
    plane.cross(0, 0, 'goal');
    plane.path(run.alpha.map((each) => each * DEGREES), run.theta.map((each) => each * DEGREES));
    plane.dot(run.alpha[0] * DEGREES, run.theta[0] * DEGREES, role, { hollow: true });
    time.line([[0, 0], [1e3, 0]], 'ghost', { width: 1.5, dash: [4, 4] });
    time.path(run.t, run.grown.map((each) => each / scale));
    time.dot(0, 0, role, { hollow: true });
  },
  say: (values, { rising }) =>
      ({ cells: `${rising.length ? inThousands(rising.length) : 'none'} of the ` +
      `${inThousands(CELLS ** 2)}` }),
  verdict: (values, { known, state, run, most }) => (!known ? ''
      : state ? `z3: no, not at α = ${written(run.alpha[0] * DEGREES, '°')}, ` +
      `θ = ${written(run.theta[0] * DEGREES, '°')}. ` +
      `Driven from there, V first rises by ${small(most)}\u00a0%.`
      : 'z3: yes, proved.'),
});

// Percent, or for less than a tenth of one a power of ten.
function unitFor(high) {
  const power = Math.floor(Math.log10(high));
  if (power >= -1) return { scale: 1, unit: '%' };
  const raised = [...String(2 - power)].map((each) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(each)]).join('');
  return { scale: 10 ** power, unit: `10⁻${raised}` };
}

const small = (share) => (share < 0.001 ? 'less than 0.001' : written(share));
const inThousands = (count) => count.toLocaleString('en');
