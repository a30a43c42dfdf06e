// The LQR of the error behind a circle: its gains by the sign of the Hamiltonian matrix, its poles,
// and the robot that it drives.

import {
  LAWS, complex, driveContinuously, live, polesOf, poseAt, remembered, timeNear, written,
} from '../drawing.js';

const transposed = (a) => a[0].map((_, j) => a.map((row) => row[j]));
const product = (a, b) => a.map((row) => transposed(b).map((column) =>
  row.reduce((sum, each, k) => sum + each * column[k], 0)));

// By Gauss and Jordan, with the largest pivot.
function inverse(matrix) {
  const n = matrix.length,
      rows = matrix.map((row, i) => [...row, ...row.map((_, j) => Number(i === j))]);
  for (let i = 0; i < n; i += 1) {
    let best = i;
    for (let k = i; k < n; k += 1) if (Math.abs(rows[k][i]) > Math.abs(rows[best][i])) best = k;
    [rows[i], rows[best]] = [rows[best], rows[i]];
    rows[i] = rows[i].map((each) => each / rows[i][i]);
    rows.forEach((row, k) => {
      if (k !== i) rows[k] = row.map((each, j) => each - row[i] * rows[i][j]);
    });
  }
  return rows.map((row) => row.slice(n));
}

// K for Q = q times the identity and R the identity. The columns of I - sign(H) span the states
// that fade, and there P times the state is the costate.
const regulator = remembered(({ A, B, q }) => {
  const across = product(B, transposed(B));
  let sign = [...A.map((row, i) => [...row, ...across[i].map((each) => -each)]),
      ...transposed(A).map((row, i) =>
      [...row.map((_, j) => -q * Number(i === j)), ...row.map((each) => -each)])];
  for (let k = 0, moved = 1; k < 60 && moved > 1e-14; k += 1) {
    const back = inverse(sign);
    moved = Math.max(...back.flatMap((row, i) => row.map((each, j) => Math.abs(each - sign[i][j]))))
        / Math.max(...sign.flat().map(Math.abs));
    sign = sign.map((row, i) => row.map((each, j) => (each + back[i][j]) / 2));
  }
  const half = sign.map((row, i) => row.slice(0, 3).map((each, j) => Number(i === j) - each)),
      P = product(half.slice(3), inverse(half.slice(0, 3)));
  return product(transposed(B), P);
});

// The roots of s^3 + a s^2 + b s + c, all with a real part below 0: one by halving, two by what it
// leaves.
function cubic(a, b, c) {
  let [low, high] = [-a, 0];
  for (let k = 0; k < 80; k += 1) {
    const s = (low + high) / 2;
    if (((s + a) * s + b) * s + c < 0) low = s; else high = s;
  }
  return [[low, 0], ...polesOf(a + low, b + low * (a + low))];
}

const drove = remembered(({ gains, start }) => {
  const run = { t: [], x: [], y: [], heading: [], rho: [], omega: [], goal: [] };
  driveContinuously({ law: 'linear', gains, start, dt: 0.1, samples: 401, moving: true,
      arrivalRadius: -1, goal: [0, 0, 0] }, (k, t, pose, [rho], [, omega], goal) => {
    Object.entries({ t, x: pose[0], y: pose[1], heading: pose[2], rho, omega,
        goal: goal.slice(0, 3) }).forEach(([name, value]) => {
      run[name][k] = value;
    });
  });
  return run;
});

export default live('lqr', {
  find({ q, time }, { data: { A, B, start } }) {
    const K = regulator({ A, B, q }),
        gains = Object.fromEntries(LAWS.linear.gains.map((name, i) => [name, -K.flat()[i]])),
        run = drove({ gains, start });
    const fed = product(B, K), M = A.map((row, i) => row.map((each, j) => each - fed[i][j])),
        minor = (i, j) => M[i][i] * M[j][j] - M[i][j] * M[j][i];
    const volume = M[0][0] * minor(1, 2) - M[0][1] * (M[1][0] * M[2][2] - M[1][2] * M[2][0])
        + M[0][2] * (M[1][0] * M[2][1] - M[1][1] * M[2][0]);
    const poles =
        cubic(-(M[0][0] + M[1][1] + M[2][2]), minor(0, 1) + minor(0, 2) + minor(1, 2), -volume);
    return { K, poles, run, k: Math.round(time * 400),
        slowest: -Math.max(...poles.map(([re]) => re)),
        peak: Math.max(...run.omega.map(Math.abs)) };
  },
  panes: (values, { run, k, poles }) => ({
    plane: { x: [-10.8, 0.8, 'real part [1/s]'], y: [-2, 2, 'imaginary part [1/s]'],
        given: 'The poles at q = 1.', alt: `The poles at ${poles.map(complex).join(', ')}.` },
    circle: { x: [-8.6, 2.6, 'x [m]'], y: [-4.8, 4.8, 'y [m]'], equal: true, main: true,
        given: 'The circle of the goal and the way of the robot at q = 1.',
        alt: `The robot ${written(run.rho[k], 'm')} from the goal after ${written(run.t[k], 's')}.`,
        scrub: (x, y) => timeNear(run.x, run.y, x, y, 0.5) },
  }),
  draw({ plane, circle: picture }, values, { poles, run, k }) {
    plane.rect(0, -9, 9, 9, 'rising', 0.12);
    picture.line(run.goal, 'goal', { width: 1.2, dash: [3, 4] });
    for (const [re, im] of poles) plane.cross(re, im, 'path', 8);
    picture.path(run.x, run.y, 'path', { to: k + 1 });
    picture.pose(run.goal[k], 'goal');
    picture.robot(poseAt(run, k));
  },
  say: (values, { slowest, peak, run }) =>
      ({ slowest: written(slowest, '1/s'), peak: written(peak, 'rad/s'),
      seconds: written(run.t[run.rho.findLastIndex((each) => each > 0.1) + 1], 's') }),
});
