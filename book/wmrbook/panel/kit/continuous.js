// The law acting all the time: Dormand and Prince's method of order 8 with Hairer's two estimates
// of its error, as in wmrlib. A sample ends a step, and so does arrival.

import { ARRIVED, COMPLETED, DIVERGED, TIMED_OUT, Unsettled, notAllowed } from './setup.js';
import { controlLaw } from './law.js';
import { LAWS, RULE, circle, polarClosingRate, polarFromPose, poseOfError, wrap } from './model.js';

const STAGES = [...RULE.stages, RULE.weights];
// of a step: m, rad, and behind a goal that stands still a share of the distance
const TOLERANCE = 1e-10;
const SHARP = 1e-12; // so close to the arrival radius a run ends, as a share of it
const GLIMPSE = 1e-6; // s after the end of a step, at which omega is looked at again
const PATIENCE = 20_000; // steps refused or cut before a run counts as beyond this method

// `rates(state, out)` writes the rates of a state of four numbers, `least` is what the first counts
// as if it is less. After `attempt` the new state is in `ahead` and its rates are in `slopes[12]`;
// it returns the error, in tolerances.
function stepper(rates, least) {
  const slopes = Array.from({ length: 13 }, () => new Float64Array(4)), ahead = new Float64Array(4),
      sums = [0, 1].map(() => new Float64Array(4));
  function add(row, out) {
    let a = 0, b = 0, c = 0, d = 0; // all four in one go: a run does little else
    for (let j = 0; j < row.length; j += 1) {
      const weight = row[j], slope = slopes[j];
      if (weight !== 0) {
        a += weight * slope[0];
        b += weight * slope[1];
        c += weight * slope[2];
        d += weight * slope[3];
      }
    }
    out[0] = a; out[1] = b; out[2] = c; out[3] = d;
  }
  function attempt(state, dt) {
    for (let stage = 0; stage < STAGES.length; stage += 1) {
      add(STAGES[stage], ahead);
      for (let i = 0; i < 4; i += 1) ahead[i] = state[i] + dt * ahead[i];
      rates(ahead, slopes[stage + 1]);
    }
    const [fifth, third] = sums;
    let fine = 0, coarse = 0;
    add(RULE.fifth, fifth);
    add(RULE.third, third);
    for (let i = 0; i < 4; i += 1) {
      const scale = Math.max(Math.abs(ahead[i]), i ? 1 : least);
      fine = Math.max(fine, Math.abs(dt * fifth[i]) / scale);
      coarse = Math.max(coarse, 0.1 * Math.abs(dt * third[i]) / scale);
    }
    return fine === 0 ? 0 : fine * fine / Math.hypot(fine, coarse) / TOLERANCE;
  }
  return { attempt, slopes, ahead };
}

// One run, sample by sample, told to `record(k, t, pose, seen, twist, goal)`. Gives [samples,
// outcome, peak omega, path length].
export function driveContinuously(setup, record) {
  const { law, gains, dt, samples, start, arrivalRadius, moving } = setup;
  // The state is the polar error; behind a goal that moves, how far that is ahead and to the left,
  // and turned to the left: there a robot that follows is at rest, and its steps are long.
  // which a circle keeps
  const goalAt = (t) => (moving ? circle(t) : setup.goal),
      [vGoal, omegaGoal] = moving ? circle(0).slice(3) : [0, 0];
  const seenFrom = (y) => {
    if (!moving) return y;
    const alpha = Math.atan2(y[1], y[0]);
    return [Math.sqrt(y[0] * y[0] + y[1] * y[1]), alpha, wrap(alpha - y[2])];
  };
  const twistOf = (y) => {
    const [rho, alpha, theta] = seenFrom(y);
    return controlLaw(rho, alpha, theta, gains, law, vGoal, omegaGoal);
  };
  function rates(y, out) {
    if (moving) {
      const [v, omega] = twistOf(y);
      out[0] = omega * y[1] - v + vGoal * Math.cos(y[2]);
      out[1] = vGoal * Math.sin(y[2]) - omega * y[0];
      out[2] = omegaGoal - omega;
      out[3] = Math.abs(v);
      return;
    }
    const [vOverRho, omega] = LAWS[law].formula(y[0], y[1], y[2], gains);
    [out[0], out[1], out[2]] = polarClosingRate(y[0], y[1], vOverRho, omega);
    out[3] = Math.abs(y[0] * vOverRho);
  }
  const [rho, alpha, theta] = polarFromPose(...start, ...goalAt(0)),
      begin = moving ? [rho * Math.cos(alpha), rho * Math.sin(alpha), alpha - theta]
      : [rho, alpha, theta];
  const { attempt, slopes, ahead } = stepper(rates, moving ? 1 : 1e-150), ends = [],
      patience = PATIENCE + samples;
  let t = 0, trials = 0, next = 0.01, y = Float64Array.from([...begin, 0]);
  const put = (k, time, at) => {
    const goal = goalAt(time), seen = seenFrom(at);
    record(k, time, poseOfError(seen[0], seen[1], seen[2], goal[0], goal[1], goal[2]), seen,
        twistOf(at), goal);
  };
  // With the rate of omega, seen a little later; `rates(y, slopes[0])` has been called.
  const keep = () => {
    const omega = twistOf(y)[1], later = y.map((it, i) => it + GLIMPSE * slopes[0][i]);
    ends.push({ t, y, omega, swing: (twistOf(later)[1] - omega) / GLIMPSE });
  };
  const omegaAfter = (end, time) => {
    rates(end.y, slopes[0]);
    attempt(end.y, time - end.t);
    return twistOf(ahead)[1];
  };
  const over = (n, outcome) => [n, outcome, peakOf(ends, omegaAfter), y[3]];

  put(0, 0, y);
  rates(y, slopes[0]);
  keep();
  if (y[0] <= arrivalRadius && !moving) return over(1, ARRIVED);
  for (let k = 1; k < samples; k += 1) {
    const until = dt * k;
    while (t < until) {
      const cut = next >= until - t, step = cut ? until - t : next, error = attempt(y, step);
      trials += 1;
      if (trials > patience)
        throw new Unsettled(
            notAllowed('method', 'continuous', "'arc' or 'euler', or slower gains,").message);
      // 0.2 for NaN too
      const growth = error > 0 ? Math.min(Math.max(0.9 / error ** 0.125, 0.2), 5) : error === 0 ? 5
          : 0.2;
      if (!(error <= 1)) {
        next = growth * step;
        if (next < 1e-14 * Math.max(t, 1e-3)) return over(k, DIVERGED);
        continue;
      }
      const arrived = !moving && arrivalRadius > 0 && ahead[0] <= arrivalRadius * (1 + SHARP);
      const taken = arrived ? arrivalIn(attempt, ahead, slopes, y, step, arrivalRadius) : step;
      next = cut ? Math.max(next, growth * step) : growth * step;
      t = cut && !arrived ? until : t + taken;
      y = ahead.slice();
      slopes[0].set(slopes[12]);
      keep();
      if (arrived) { put(k, t, y); return over(k + 1, ARRIVED); }
    }
    if (!Number.isFinite(y[0] + y[1] + y[2])) return over(k, DIVERGED);
    put(k, t, y);
  }
  return over(samples, moving ? COMPLETED : TIMED_OUT);
}

// How long a step may be to end on the radius that it passes; rho falls all the way. By Newton's
// method, and by halving where that leaves.
function arrivalIn(attempt, ahead, slopes, y, step, radius) {
  let low = 0, high = step, at = step;
  for (let k = 0; k < 60 && Math.abs(ahead[0] - radius) > SHARP * radius; k += 1) {
    if (ahead[0] > radius) low = at; else high = at;
    const guess = at - (ahead[0] - radius) / slopes[12][0];
    at = guess > low && guess < high ? guess : (low + high) / 2;
    attempt(y, at);
  }
  return at;
}

// The largest |omega|, also between the ends of the steps: by golden section in every step within
// which omega turns round, by its cubic, near the largest.
function peakOf(ends, omegaAfter) {
  const share = (Math.sqrt(5) - 1) / 2;
  let best = ends.reduce((top, end) => Math.max(top, Math.abs(end.omega)), 0);
  const steps =
      ends.slice(1).map((to, i) => ({ from: ends[i], to, top: crestOf(ends[i], to, best) }));
  for (const { from, to, top } of steps.sort((one, other) => other.top - one.top)) {
    if (top < 0.99 * best) break;
    const at = (time) => Math.abs(omegaAfter(from, time)), part = (to.t - from.t) / 8;
    const looks = [1, 2, 3, 4, 5, 6, 7].map((i) => at(from.t + i * part)); // it may turn twice
    const middle = from.t + part * (1 + looks.indexOf(Math.max(...looks)));
    let [low, high] = [middle - part, middle + part];
    for (let k = 0; k < 25 && high > low; k += 1) {
      const left = high - share * (high - low), right = low + share * (high - low);
      const [one, two] = [at(left), at(right)];
      best = Math.max(best, one, two);
      if (one > two) high = right; else low = left;
    }
  }
  return best;
}

// About how large |omega| gets in a step, by the cubic with its values and rates at both ends; 0 if
// it is largest at an end, or larger by rounding only.
function crestOf(from, to, best) {
  const dt = to.t - from.t, rise = to.omega - from.omega, m0 = from.swing * dt, m1 = to.swing * dt;
  const cubic = (s) => from.omega
    + s * (m0 + s * (3 * rise - 2 * m0 - m1 + s * (m0 + m1 - 2 * rise)));
  const within = Array.from({ length: 15 }, (_, i) => Math.abs(cubic((i + 1) / 16)));
  const top = Math.max(...within), outer = Math.max(Math.abs(from.omega), Math.abs(to.omega));
  const turns = m0 * m1 < 0 || top > outer;
  return turns && Math.max(Math.abs(m0), Math.abs(m1)) > 1e-8 * (1 + best) ? Math.max(top, outer)
      : 0;
}
