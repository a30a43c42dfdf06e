// Is V strict under the barrier law? Where it rises among the angles that are drawn, what z3 says
// of all of them, and V along the drive from the state that z3 finds.

import { DEGREES, inDegrees, written } from '../style.js';
import { decay, poseOfError } from '../model.js';
import { live } from '../live.js';
import { remembered } from '../runs.js';
import { simulate } from '../simulate.js';

const HALF = 50, CELLS = 121, SAMPLES = 1000;

// A polynomial in tan(theta/2), tan(alpha/2) and k2, as rows of powers and a factor.
const valueOf = (terms, p, q, k2) =>
    terms.reduce((sum, [i, j, k, factor]) => sum + factor * p ** i * q ** j * k2 ** k, 0);

// Row by row of theta: the cells of alpha in which V rises.
const map = remembered(({ k2, slope }) => {
  const middles = Array.from({ length: CELLS }, (_, k) => ((k + 0.5) / CELLS * 2 - 1) * HALF),
      tangents = middles.map((each) => Math.tan(each / DEGREES / 2));
  return middles.flatMap((theta, i) =>
      middles.map((alpha, j) => [theta, alpha, valueOf(slope, tangents[i], tangents[j], k2)])
        .filter(([, , rate]) => rate > 0));
});

// V along the drive from a state, as a percentage of what it is there.
const drive = remembered(({ k2, p, q, rho, V }) => {
  const gains = { k_rho: 1, k_alpha: k2 * decay(rho, 1), h: 1, v_max: 1 }, dt = 0.04 / (1 + k2),
      [alpha, theta] = [2 * Math.atan(q), 2 * Math.atan(p)],
      run = simulate({ start: poseOfError(rho, alpha, theta, 0, 0, 0), goal: [0, 0, 0], gains,
        reference: null, law: 'barrier', method: 'continuous', dt, duration: SAMPLES * dt,
        arrivalRadius: 0 });
  const values = Array.from(run.t, (_, k) =>
      valueOf(V, Math.tan(run.theta[k] / 2), Math.tan(run.alpha[k] / 2), k2));
  return { t: Array.from(run.t), alpha: Array.from(run.alpha), theta: Array.from(run.theta),
    grown: values.map((each) => 100 * (each / values[0] - 1)) };
});

export default live('strict', {
  find({ k2, answer }, { data }) {
    const known = answer && answer.of.k2 === k2, state = known && answer.is.state,
        run = state && drive({ k2, p: state[0], q: state[1], rho: data.rho, V: data.V });
    return { known, state, run, most: run ? Math.max(...run.grown) : 0,
      rising: map({ k2, slope: data.slope }) };
  },
  panes: ({ k2 }, { known, run, rising, most }) => ({
    plane: { x: [-HALF, HALF, 'α [°]'], y: [-HALF, HALF, 'θ [°]'], equal: true,
        alt: `Alpha and theta up to 50 degrees: V rises in ${rising.length} of ` +
        `${CELLS ** 2} cells${run ? '; a drive from the state that z3 found' : ''}.` },
    time: { x: [0, run ? run.t[ends(run, most)] : 1, 'time [s]'],
        y: [-2 * (most || 1), 1.4 * (most || 1), 'V against the start [%]'],
        alt: run ? `V rises by ${written(most, 'percent')} and then falls.`
        : known ? `No drive: with k2 = ${written(k2)} V falls from every state.`
        : 'No drive: z3 has not been asked.' },
  }),
  draw({ plane, time }, values, { known, run, rising }) {
    const half = HALF / CELLS;
    for (const [theta, alpha] of rising)
      plane.area([[alpha - half, theta - half], [alpha + half, theta - half],
        [alpha + half, theta + half], [alpha - half, theta + half]], 'rising', 0.5);
    plane.cross(0, 0, 'goal');
    time.line([[0, 0], [1e3, 0]], 'ghost', { width: 1.5, dash: [4, 4] });
    if (run) {
      plane.path(run.alpha.map((each) => each * DEGREES), run.theta.map((each) => each * DEGREES));
      plane.dot(run.alpha[0] * DEGREES, run.theta[0] * DEGREES, 'rising', { hollow: true });
      time.path(run.t, run.grown);
      time.dot(0, 0, 'rising', { hollow: true });
    } else time.text(known ? 'V falls from every state' : 'z3 has not been asked', 0.5, 0.3,
        { align: 'center', role: known ? 'path' : 'ghost' });
  },
  say: (values, { rising }) =>
      ({ cells: `${rising.length ? inThousands(rising.length) : 'none'} of the ` +
      `${inThousands(CELLS ** 2)}` }),
  verdict: (values, { known, run, most }) => (!known ? ''
      : run ? `z3: no, not at α = ${inDegrees(run.alpha[0])}, θ = ${inDegrees(run.theta[0])}. ` +
      `Driven from there, V first rises by ${written(most)}\u00a0%.`
      : 'z3: yes, proved.'),
});

const inThousands = (count) => count.toLocaleString('en');

// Where a curve that has risen is as far below its start as twice that.
function ends({ grown, t }, most) {
  const k = grown.findIndex((each) => each < -2 * (most || 1));
  return k < 0 ? t.length - 1 : k;
}
