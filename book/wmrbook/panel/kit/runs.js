// Runs of the robot as the drawings ask for them, kept while only the time moves.

import { ARRIVED } from './setup.js';
import { arcStep, wrap } from './model.js';
import { drive, simulate, summarise } from './simulate.js';
import { inDegrees, written } from './style.js';
import { nearest } from './numbers.js';

// A function of what JSON can say that keeps its last answer: a run need not be driven anew while
// only the time moves.
export function remembered(f) {
  let key, last;
  return (asked) => {
    const text = JSON.stringify(asked);
    if (text !== key) [key, last] = [text, f(asked)];
    return last;
  };
}

// A run of `simulate`: unless said otherwise of the corrected law, which acts all the time, to a
// goal that stands still.
/** @type {(options: any) => Run} */
export const freshRun = (options) =>
    simulate({ reference: null, law: 'corrected', method: 'continuous', dt: 0.05, duration: 60,
      arrivalRadius: 0.05, ...options });
/** @type {(options: any) => Run} */
export const driven = remembered(freshRun);

/**
 * A drive by commands that are held, of `steps` at most: its poses and twists, and whether it
 * arrived. It may have a sight of its own, see `drive`.
 * @param {Values} options
 */
export function heldRun({ start, goal, gains, dt, radius, steps, ...odd }) {
  const poses = [], twists = [], setup = { law: 'corrected', step: arcStep, moving: false };
  const asked = { start, goal, gains, dt, samples: steps + 1, arrivalRadius: radius, ...odd };
  const [, outcome] = drive({ ...setup, ...asked }, (k, t, pose, seen, twist) => {
    poses.push(pose);
    twists.push(twist);
  });
  return { poses, twists, arrived: outcome === ARRIVED };
}

// A held run as the track of a stage, with places between its ticks.
/** @param {Values} run @param {number} dt */
export function trackOf({ poses, twists }, dt, role = 'path') {
  const parts = Math.max(1, Math.ceil(dt / 0.1 - 1e-9)), n = (poses.length - 1) * parts + 1;
  const places = Array.from({ length: n }, (_, i) => {
    const k = Math.floor(i / parts), part = i % parts;
    return part ? arcStep(...poses[k], ...twists[k], dt * part / parts) : poses[k];
  });
  const [x, y, heading] = [0, 1, 2].map((i) => places.map((pose) => pose[i]));
  return { t: places.map((_, i) => i * dt / parts), x, y, heading, n, role };
}

// A short way, in words.
export const inSize = (metres) => (metres < 0.995 ? written(100 * metres, 'cm', 2)
  : written(metres, 'm', 2));

// How a held run ends, in words.
/** @param {Values} run @param {Pose} goal */
export function endsOf({ poses, arrived }, goal) {
  const [x, y, heading] = poses.at(-1), off = inDegrees(Math.abs(wrap(heading - goal[2])), 0),
      far = inSize(Math.hypot(x - goal[0], y - goal[1]));
  return { off, far, ends: arrived ? `stops ${far} from its goal, ${off} off`
    : 'has not stopped after a minute' };
}

export const poseAt = (run, k) => [run.x[k], run.y[k], run.heading[k]];

/** How a run ends, after "It". @param {Run} run @param {Pose} goal */
export function endOf(run, goal) {
  const last = run.n - 1, off = inDegrees(Math.abs(wrap(run.heading[last] - goal[2])), 0);
  return run.outcome === 'ARRIVED'
      ? `stops after ${written(run.t[last], 's')}, ${off} off its heading`
      : `is still ${written(run.rho[last], 'm')} away after ${written(run.t[last], 's')}`;
}

// Gains between two others, by their logarithms.
export const blended = (from, to, share) => Object.fromEntries(Object.keys(from)
    .map((name) => [name, from[name] ** (1 - share) * to[name] ** share]));

/** The gains on a stage's sliders. @param {Values} values @param {Setup} setup */
export const gainsOf = ({ k_rho, k_alpha, h }, { data: { v_max } }) =>
    ({ k_rho, k_alpha, h, v_max });

// The time, as a share, at which a path comes nearest to a point, or nothing if that is farther
// than `reach`: for `scrub`.
export function timeNear(xs, ys, x, y, reach) {
  const k = nearest(xs.length, (i) => Math.hypot(xs[i] - x, ys[i] - y), reach);
  return k === null ? null : { time: k / (xs.length - 1) };
}

// A chain of goals, sampled, each left behind within its own of the `radii`: columns as of a run,
// and `leg`. As wmrlib's `drive_route`.
export const alongRoute = remembered(({ start, goals, radii, gains }) => {
  const joined = { t: [], x: [], y: [], heading: [], v: [], V: [], leg: [] };
  let pose = start, begin = 0, peakOmega = 0, arrived = true;
  for (let leg = 0; arrived && leg < goals.length; leg += 1) {
    const run = freshRun({ start: pose, goal: goals[leg], gains, method: 'arc', dt: 0.1,
      duration: 120, arrivalRadius: radii[leg] }), last = run.n - 1;
    arrived = run.outcome === 'ARRIVED';
    // where a leg ends stands the next one's first sample
    const kept = arrived && leg < goals.length - 1 ? last : run.n;
    for (let k = 0; k < kept; k += 1)
      for (const [name, column] of Object.entries(joined))
        column.push(name === 't' ? begin + run.t[k] : name === 'leg' ? leg : run[name][k]);
    peakOmega = Math.max(peakOmega, summarise(run).peakOmega);
    [pose, begin] = [poseAt(run, last), begin + run.t[last]];
  }
  return { ...joined, n: joined.t.length, arrived, peakOmega };
});
