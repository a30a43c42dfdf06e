// Where V rises under (24) as printed, over the angles, at a distance and with a weight of the
// distance; the robot in that state, and its ways and V over time from there.

import {
  DEGREES, LAWS, freshRun, live, onStops, poseOfError, ratesOfV, remembered, written,
} from '../drawing.js';

const CELLS = 73;
const LAW = [{ name: '(24) as printed', role: 'rising', dash: [8, 5] },
    { name: 'corrected', role: 'path', dash: [] }];
/** @type {(rho: number) => { x: Axis, y: Axis, lawn: boolean }} */
const around = (rho) =>
     ({ x: [-1.3 * rho, 1.3 * rho], y: [-1.3 * rho, 1.3 * rho], lawn: true });

// At angles in degrees, under (24) as printed.
function rateOfV(rho, alpha, theta, gains, L) {
  const [a, t] = [alpha / DEGREES, theta / DEGREES];
  const [distance, angles] =
      ratesOfV(LAWS.printed.formula(rho, a, t, gains), rho, a, t, gains.h, L);
  return distance + angles;
}

// Row by row of theta: where it begins to rise and where it ends, in cells of alpha.
const map = remembered(({ rho, L, gains }) => {
  const middles = Array.from({ length: CELLS }, (_, k) => (k + 0.5) / CELLS * 360 - 180), rows = [];
  let count = 0;
  for (const theta of middles) {
    let from = null;
    middles.forEach((alpha, k) => {
      const up = rateOfV(rho, alpha, theta, gains, L) > 0;
      if (up) count += 1;
      if (up && from === null) from = k;
      if (from !== null && (!up || k === CELLS - 1)) {
        rows.push([theta, from, up ? k + 1 : k]);
        from = null;
      }
    });
  }
  return { rows, share: count / CELLS ** 2 };
});

const runs = remembered(({ rho, alpha, theta, gains }) => ['printed', 'corrected'].map((law) =>
    freshRun({ start: poseOfError(rho, alpha / DEGREES, theta / DEGREES, 0, 0, 0), goal: [0, 0, 0],
      gains, law, dt: 0.06, duration: 3, arrivalRadius: 0 })));

export default live('rising', {
  find({ alpha, theta, rho, L }, { data: { gains } }) {
    const value = (run) => Array.from(run.rho, (away, k) =>
      away ** 2 / (2 * L) + run.alpha[k] ** 2 / 2 + gains.h * run.theta[k] ** 2 / 2);
    const both = runs({ rho, alpha, theta, gains });
    return { rate: rateOfV(rho, alpha, theta, gains, L), ...map({ rho, L, gains }),
        t: Array.from(both[0].t), V: both.map(value), both };
  },
  panes: ({ alpha, theta, rho }, { share, V }, { data: { asked } }, hidden) => ({
    plane: { x: [-180, 180, 'α [°]'], y: [-180, 180, 'θ [°]'],
        given: 'The plane of the two angles, with the state that is asked about.',
        alt: `The plane of alpha and theta: V rises in ${(100 * share).toFixed(0)} percent of ` +
        `it.` },
    robot: { ...around(hidden ? asked.rho : rho), given: 'The robot in that state, on a lawn.',
        alt: `The robot ${written(rho, 'm')} from its goal, alpha ${written(alpha)} and theta ` +
        `${written(theta)} degrees, and where it drives in three seconds with either law.` },
    time: { x: [0, 3, 'time [s]'], y: [0, 3, 'V / V at first'], 
        given: 'V over time under (24) as printed, with L = 1 m².',
        alt: `V over three seconds: times ${written(V[0][V[0].length - 1] / V[0][0])} with the ` +
        `printed law, times ${written(V[1][V[1].length - 1] / V[1][0])} with the corrected one.` },
  }),
  draw({ plane, robot, time }, values, { rows, t, V, rate, both }, hidden, { data: { asked } }) {
    const { alpha, theta, rho } = hidden ? asked : values;
    time.line([[0, 1], [3, 1]], 'ghost', { width: 1.5, dash: [4, 4] });
    if (!hidden)
      both.forEach(({ x, y }, k) => robot.path(x, y, LAW[k].role, { dash: LAW[k].dash }));
    robot.state(rho, alpha / DEGREES, theta / DEGREES);
    V.slice(0, hidden ? 1 : 2).forEach((each, k) => {
      time.path(t, each.map((it) => it / each[0]), LAW[k].role, { dash: LAW[k].dash });
      time.text(LAW[k].name, 2.9, 2.75 - 0.25 * k, { role: LAW[k].role, align: 'right' });
    });
    if (hidden) { plane.dot(alpha, theta, 'rising', { hollow: true }); return; }
    const edge = (k) => k / CELLS * 360 - 180, half = 180 / CELLS;
    for (const [middle, from, to] of rows)
      plane.rect(edge(from), middle - half, edge(to), middle + half, 'rising', 0.3);
    plane.dot(alpha, theta, rate > 0 ? 'rising' : 'path', { hollow: true });
  },
  handles: ({ alpha, theta }, found, setup) => [{
    id: 'state', pane: 'plane', at: [alpha, theta],
        says: `the state, alpha ${alpha} and theta ${theta} degrees`,
    move: (x, y) => onStops(setup, { alpha: x, theta: y }),
  }],
  say: (values, { rate, share }) =>
      ({ rate: written(rate, 'per second'), fate: rate > 0 ? 'rises' : 'does not rise',
      share: `${(100 * share).toFixed(0)} %` }),
});
