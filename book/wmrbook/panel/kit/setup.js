// What `simulate` may be asked for, and what a run can end as.

import { LAWS, STEPS } from './model.js';

export const ARRIVED = 0, TIMED_OUT = 1, DIVERGED = 2, COMPLETED = 3;
const POSITIVE = ['v_max', 'k_y']; // the gains that may not be 0
const MOST_SAMPLES = 1000000;

export class Unsettled extends RangeError {} // a run that a method can't finish

export function notAllowed(name, value, needed) {
  return new RangeError(`${name} = ${value} is not allowed: ${needed} is needed`);
}

function checkedNumber(name, value, positive = false) {
  if (typeof value === 'number' && Number.isFinite(value) && (positive ? value > 0 : value >= 0))
    return value;
  throw notAllowed(name, value, `a finite number ${positive ? 'above' : 'at least'} 0`);
}

export function checkedPose(name, pose) {
  if (Array.isArray(pose) && pose.length === 3 && pose.every(Number.isFinite)) return pose;
  throw notAllowed(name, pose, '[x, y, heading], all finite,');
}

/** @param {Options} options */
export function checkedSetup(options) {
  const moving = options.reference === 'circle',
      laws = Object.keys(LAWS).filter((name) => moving || !LAWS[name].needsReference);
  if (!moving && options.reference != null)
    throw notAllowed('reference', options.reference, "null or 'circle'");
  if (!laws.includes(options.law))
    throw notAllowed('law', options.law, `one of ${laws.join(', ')}`);
  const methods = [...Object.keys(STEPS), 'continuous'];
  if (!methods.includes(options.method))
    throw notAllowed('method', options.method, `one of ${methods.join(', ')}`);
  const { law } = options, given = { ...options.gains, ...options.feedback }, gains = {};
  for (const name of LAWS[law].gains)
    gains[name] = checkedNumber(name, given[name], POSITIVE.includes(name));
  const dt = checkedNumber('dt', options.dt, true),
      duration = checkedNumber('duration', options.duration, true);
  if (dt > duration) throw notAllowed('dt', dt, `at most the duration, ${duration},`);
  if (duration / dt > MOST_SAMPLES)
    throw notAllowed('duration', duration, `at most ${MOST_SAMPLES} steps of dt = ${dt}`);
  const hysteresis = checkedNumber('hysteresis', options.hysteresis ?? 0);
  if (hysteresis && (moving || options.method === 'continuous'))
    throw notAllowed('hysteresis', hysteresis, '0, or a goal and a twist that are held,');
  return {
    law,
    step: STEPS[options.method],
    moving,
    gains,
    dt,
    hysteresis,
    samples: Math.floor(duration / dt + 1e-9) + 1,
    start: checkedPose('start', options.start),
    goal: moving ? [0, 0, 0] : checkedPose('goal', options.goal),
    arrivalRadius: moving ? -1 : checkedNumber('arrivalRadius', options.arrivalRadius),
  };
}
