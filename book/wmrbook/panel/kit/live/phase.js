// The plane of the angles near the goal, where the distance plays no part: a state, its way home,
// and the damping that makes it a spiral or a sweep.

import { DEGREES, inDegrees, written } from '../style.js';
import { correctedLaw, polarClosingRate } from '../model.js';
import { live } from '../live.js';
import { modes } from '../simulate.js';
import { remembered, timeNear } from '../runs.js';

const DT = 0.01, LENGTH = 8; // s

const homeward = remembered(({ gains, state }) => {
  const run = { t: [0], alpha: [state[0]], theta: [state[1]] };
  const rates = ([alpha, theta]) =>
      polarClosingRate(0, alpha, ...correctedLaw(0, alpha, theta, gains)).slice(1);
  const ahead = (at, rate, dt) => at.map((each, i) => each + dt * rate[i]);
  for (let k = 1, at = state; k <= LENGTH / DT; k += 1) { // Runge-Kutta
    const one = rates(at), two = rates(ahead(at, one, DT / 2)),
        three = rates(ahead(at, two, DT / 2)), four = rates(ahead(at, three, DT));
    at = at.map((each, i) => each + DT / 6 * (one[i] + 2 * two[i] + 2 * three[i] + four[i]));
    run.t[k] = DT * k;
    [run.alpha[k], run.theta[k]] = at;
  }
  return { ...run, across: run.alpha.map((each) => each * DEGREES),
      up: run.theta.map((each) => each * DEGREES) };
});

export default live('phase', {
  find({ damping, alpha, theta, time }, { data: { gains } }) {
    const { naturalFrequency } = modes(gains),
        run = homeward(
        { gains: { ...gains, k_alpha: 2 * damping * naturalFrequency },
        state: [alpha / DEGREES, theta / DEGREES] }), last = run.t.length - 1;
    const size = run.theta.map((each, k) => Math.hypot(each, run.alpha[k])),
        late = size.findLastIndex((each) => each > 0.05 * size[0]) + 1;
    const turns =
        run.theta.slice(1).filter((each, k) => each * run.theta[k] < 0 && k < late).length;
    return { run, late,
        turned: !size[0] ? 'does not move' : turns
        ? `changes its sign ${['', 'once', 'twice'][turns] || `${turns} times`}` : 'keeps its sign',
        k: Math.round(time * last) };
  },
  panes(values, { run, k, turned }) {
    return {
      plane: {
        x: [-60, 60, 'α [°]'], y: [-60, 60, 'θ [°]'], equal: true,
            given: 'The plane of the angles, with the state at alpha 0 and theta 40 degrees, ' +
            'and the goal in its middle.',
        alt: `The plane of the angles: the state is at alpha ${inDegrees(run.alpha[k])} and ` +
            `theta ${inDegrees(run.theta[k])}. Until it is down to a twentieth, theta ${turned}.`,
        scrub: (x, y) => timeNear(run.across, run.up, x, y, 4),
      },
      angles: { x: [0, LENGTH, 'time [s]'], y: [-60, 60, 'α, θ [°]'],
          given: 'Room for both angles over time.',
          alt: `Both angles over time. Until they are down to a twentieth, theta ${turned}.`,
          scrub: (x) => ({ time: Math.min(Math.max(x / LENGTH, 0), 1) }) },
    };
  },
  draw({ plane, angles }, values, { run, k }, hidden, { data: { asked } }) {
    plane.dot(0, 0, 'goal', { hollow: true });
    if (hidden) { plane.dot(...asked, 'path'); return; }
    plane.path(run.across, run.up, 'ghost', { width: 1.5, dash: [2, 5], from: k });
    plane.path(run.across, run.up, 'path', { to: k + 1 });
    plane.dot(run.across[k], run.up[k], 'path');
    for (const [name, column, role, dash] of [['α', run.across, 'alpha', []],
        ['θ', run.up, 'theta', [7, 4]]]) {
      angles.path(run.t, column, role, { dash });
      angles.dot(run.t[k], column[k], role);
      angles.text(name, run.t[30], column[30],
          { role, dx: 6, dy: column[30] < 0 ? -14 : 14, size: 16 });
    }
  },
  handles: ({ alpha, theta }) => [{
    id: 'state', pane: 'plane', at: [alpha, theta],
        says: `the state at first, alpha ${written(alpha)} and theta ${written(theta)} degrees`,
    move: (x, y) =>
        ({ alpha: Math.round(Math.min(Math.max(x, -60), 60)),
        theta: Math.round(Math.min(Math.max(y, -60), 60)) }),
  }],
  say: (values, { run, late, turned }) =>
      ({ turned,
      home: !late ? 'is in the middle already' : late < run.t.length
      ? `is down to a twentieth after ${written(run.t[late], 's')}`
      : `is not down to a twentieth after ${LENGTH} s` }),
});
