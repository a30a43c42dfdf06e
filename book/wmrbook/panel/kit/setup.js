// What `simulate` may be asked for, and what a run can end as.

import { LAWS, STEPS } from './model.js';

export const ARRIVED = 0, TIMED_OUT = 1, DIVERGED = 2, COMPLETED = 3;
const POSITIVE = ['v_max', 'k_y', 'track_width', 'max_speed']; // what may not be 0
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

// The wheels as `drive` takes them: limits of a twist, and motors, or null where they are ideal.
function checkedWheels(options) {
  if (options.wheels == null) return { limits: null, motors: null };
  const { acceleration = Infinity, ...given } = options.wheels;
  /** @type {Record<string, number>} */
  const checked = {};
  for (const [name, value] of Object.entries({ lag: 0, dead_band: 0, encoder_step: 0,
    min_speed: 0, ...given }))
    if (name !== 'max_speed' || value !== Infinity)
      checked[name] = checkedNumber(`wheels.${name}`, value, POSITIVE.includes(name));
  const { track_width: b, max_speed = Infinity, min_speed, lag, dead_band, encoder_step } = checked;
  if (acceleration !== Infinity) checkedNumber('wheels.acceleration', acceleration, true);
  const ideal = acceleration === Infinity && lag + dead_band + encoder_step === 0;
  return { limits: { b, max_speed, min_speed }, motors: ideal ? null
      : [b, acceleration, lag, dead_band, encoder_step] };
}

function checkedTurn({ lastTurn = null }) {
  if (lastTurn === null) return null;
  const end = { tolerance: 0.02, gain: 2, min_rate: 0.2, max_rate: 1, leave: 2, settle: 0,
    ...lastTurn };
  for (const name of ['tolerance', 'gain', 'min_rate', 'max_rate'])
    checkedNumber(`lastTurn.${name}`, end[name], true);
  checkedNumber('lastTurn.settle', end.settle);
  return end;
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
  const wheels = checkedWheels(options), end = checkedTurn(options);
  if ((wheels.limits || end) && options.method === 'continuous')
    throw notAllowed('method', options.method, "'arc' or 'euler'");
  return {
    ...wheels,
    end,
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
