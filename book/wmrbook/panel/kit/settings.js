// From the panel's state to what `simulate` takes, and what is wrong with it, in words. The state
// is a flat object, named as in Python.

import { checkedPose, notAllowed } from './setup.js';
import { simulate } from './simulate.js';

const GAINS = ['k_rho', 'k_alpha', 'h', 'v_max'], FEEDBACK = ['k_x', 'k_y', 'k_heading'];
const WHEELS = ['track_width', 'acceleration', 'lag', 'dead_band'];
const LONGEST = { held: 100_000, continuous: 10_000 }; // steps: what a frame still has time for
export const FARTHEST = 1e6; // m: beyond, the plane is no longer a map
export const NEAREST = 0.005; // m, half of what a picture spans at least

const pick = (values, names) => Object.fromEntries(names.map((name) => [name, values[name]]));

// None where all are ideal, or where no command is held; an acceleration of 0 stands for any.
function wheelsOf(state) {
  const { acceleration, ...others } = pick(state, WHEELS);
  const ideal = !(acceleration || others.lag || others.dead_band);
  if (ideal || state.method === 'continuous') return null;
  return acceleration ? { ...others, acceleration } : others;
}

export function settingsOf(state) {
  return {
    start: state.start, goal: state.goal, reference: state.moving ? 'circle' : null, law: state.law,
        method: state.method,
    gains: pick(state, GAINS), feedback: pick(state, FEEDBACK), dt: state.dt,
        duration: state.duration, arrivalRadius: state.arrival_radius, wheels: wheelsOf(state),
  };
}

// One run, with the goal's columns also where it stands still. Throws RangeError, which names what
// is not allowed.
export function runOf(settings) {
  const { dt, duration, goal, method } = settings, longest = LONGEST[method] || LONGEST.held;
  if (duration / dt > longest) throw notAllowed('dt', dt, `at least ${duration / longest} s`);
  for (const [name, pose] of Object.entries({ start: settings.start, goal })) {
    if (pose != null && checkedPose(name, pose).some((value) => Math.abs(value) > FARTHEST))
      throw notAllowed(name, pose, `at most ${FARTHEST} m from the origin`);
  }
  const run = simulate(settings);
  if (run.n === 0) throw new RangeError('the run leaves the range of numbers at its start');
  if (settings.reference === null) {
    ['goalX', 'goalY', 'goalHeading'].forEach((name, i) => {
      run[name] = new Float64Array(run.n).fill(goal[i]);
    });
  }
  return run;
}

export const lawsFor = (setup, moving) =>
    setup.laws.filter((law) => moving || !law.needs_reference);

const isNumber = (value) => Number.isFinite(value) && Math.abs(value) <= FARTHEST;
const isPoint = (value) => Array.isArray(value) && value.length === 3 && value.every(isNumber);
const AT_MOST = `of at most ${FARTHEST}`;

// Throws RangeError, which names a value of another kind than the panel has it. `home`, the state
// that the panel was made with, has every value in its kind.
export function checkKinds(state, setup) {
  for (const [name, usual] of Object.entries(setup.home)) {
    const value = state[name], menu = setup.menus.find((row) => row[0] === name);
    const choices = name === 'law' ? lawsFor(setup, state.moving).map((law) => law.name)
        : menu && menu[3].map(([choice]) => choice);
    const [fits, needed] = choices ? [choices.includes(value), `one of ${choices.join(', ')}`]
        : typeof usual === 'boolean' ? [typeof value === 'boolean', 'true or false']
        : Array.isArray(usual) ? [isPoint(value), `[x, y, heading], each ${AT_MOST},`]
        : name === 'time' ? [value === null || (isNumber(value) && value >= 0),
            `null or a number from 0 to ${FARTHEST}`]
        : name === 'zoom' ? [value === null || (isPoint(value) && value[2] >= NEAREST),
            `null or [x, y, reach], each ${AT_MOST} and the reach at least ${NEAREST},`]
        : [isNumber(value), `a number ${AT_MOST}`];
    if (!fits) throw notAllowed(name, JSON.stringify(value), needed);
  }
}

// Whether a slider or a menu has any effect as things stand.
export function applies(name, state, setup) {
  const law = setup.laws.find((each) => each.name === state.law);
  if ([...GAINS, ...FEEDBACK].includes(name)) return !law || law.gains.includes(name);
  if (name === 'arrival_radius') return !state.moving;
  if (WHEELS.includes(name)) return state.method !== 'continuous';
  return !['metric', 'axes'].includes(name) || state.view === 'gains';
}

const numbers = (...them) => them.every((each) => typeof each === 'number');
const same = (a, b) =>
    (Array.isArray(a) ? Array.isArray(b) && a.every((each, i) => same(each, b[i]))
    : a === b || (numbers(a, b) && Math.abs(a - b) < 1e-9));
export const differences = (state, other) =>
    Object.fromEntries(Object.entries(state).filter(([name, value]) => !same(value, other[name])));

// The number in the menu of the preset that is in force, 0 for none.
export const presetOf = (state, setup) =>
    1 + setup.presets.findIndex((preset) =>
    same(Object.values(preset), Object.keys(preset).map((name) => state[name])));

// What a preset changes. One for a goal that stands still needs a scene of its own if the goal was
// moving.
export function presetValues(preset, state, setup) {
  const [outdoor] = setup.presets, scene = setup.home.moving ? outdoor : setup.home;
  return { ...(state.moving && !preset.moving ? pick(scene, ['start', 'goal']) : {}), ...preset };
}
