// Sliders, each with a number that can be typed over, and menus: the browser's own, named and
// spoken by labels.

import { made, onArrows } from './hands.js';
import { applies, lawsFor, presetOf } from './settings.js';
import { inWords } from './style.js';
import { within } from './numbers.js';

// of each decade
const ROUND = [1, 1.1, 1.2, 1.3, 1.5, 1.7, 2, 2.2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6, 7, 8, 9];

// A key that is pressed here is no command of a notebook's, where b adds a cell. (JupyterLab heeds
// data-lm-suppress-shortcuts only on what has the focus itself.)
export function keepKeys(root) {
  root.addEventListener('keydown', (event) => {
    if (!event.ctrlKey && !event.metaKey && !event.altKey && root.closest('.jp-Notebook'))
      event.stopPropagation();
  });
}

// What a slider can be set to: even steps, or, without a step, the round numbers of each decade.
export function stopsOf(low, high, step) {
  if (step)
    return Array.from({ length: Math.round((high - low) / step) + 1 },
        (_, i) => Number((low + i * step).toPrecision(12)));
  const stops = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); power += 1) {
    for (const each of ROUND) stops.push(Number((each * 10 ** power).toPrecision(2)));
  }
  return stops.filter((each) => each >= low && each <= high);
}

// The place of a value among the stops, between two of them if it is none.
export function placeOf(stops, value) {
  const after = stops.findIndex((each) => each >= value);
  if (after <= 0) return after === 0 ? 0 : stops.length - 1;
  return after - (stops[after] - value) / (stops[after] - stops[after - 1]);
}

/**
 * The stop that is so many stops away.
 * @param {number[]} stops @param {number} value @param {number} by
 */
export function stepped(stops, value, by) {
  const place = placeOf(stops, value);
  const next = by > 0 ? Math.floor(place + by + 1e-9) : Math.ceil(place + by - 1e-9);
  return by ? stops[within(next, 0, stops.length - 1)] : value;
}

/**
 * The stops nearest to what a hand asks of some knobs, by their names.
 * @param {{ knobs: Values[] }} setup @param {Values} asked @returns {any}
 */
export const onStops = ({ knobs }, asked) =>
    Object.fromEntries(Object.entries(asked).map(([name, value]) => {
      const { stops } = knobs.find((knob) => knob.name === name);
      return [name, stops[Math.round(placeOf(stops, value))]];
    }));

/**
 * The same between the stops, where a hand is finer than a slider: in two digits.
 * @param {{ knobs: Values[] }} setup @param {Values} asked @returns {any}
 */
export const inReach = ({ knobs }, asked) =>
    Object.fromEntries(Object.entries(asked).map(([name, value]) => {
      const { stops } = knobs.find((knob) => knob.name === name);
      return [name, Number(within(value, stops[0], stops.at(-1)).toPrecision(2))];
    }));

// A slider over stops, called so by who reads it out. Returns what shows a value and says it.
export function putSlider(row, says, stops, { get, set }) {
  const slider = made(row, 'input',
      { type: 'range', className: 'wmr-slider', min: 0, max: stops.length - 1, step: 'any' },
      { 'aria-label': says });
  slider.addEventListener('input', () => set(stops[Math.round(Number(slider.value))]));
  onArrows(slider, ([across, up]) => set(stepped(stops, get(), across + up)));
  return (value, text) => {
    const place = Number.isFinite(value) ? placeOf(stops, value) : 0;
    slider.value = String(place);
    slider.style.setProperty('--share', String(place / (stops.length - 1)));
    slider.setAttribute('aria-valuetext', text);
  };
}

// A comma is a decimal one: 1,000 could be either, and is neither.
export const fromWords = (text) =>
    (/^[-+−]?(?![1-9]\d{0,2},\d{3}$)(\d+[.,]?\d*|[.,]\d+)(e[-+]?\d+)?$/i.test(text.trim())
    ? Number(text.trim().replace(',', '.').replace('−', '-')) : NaN);

/**
 * A number that can be typed over; `refuse` is told, in a sentence, of what is none. Returns what
 * shows a text in it.
 * @param {HTMLElement} parent @param {string} called
 * @param {{ set(value: number): void, refuse(sentence: string): void }} hand
 */
export function putTyped(parent, called, { set, refuse }) {
  const it = made(parent, 'input',
      { className: 'wmr-typed', inputMode: 'decimal', autocomplete: 'off' },
      { 'aria-label': `${called}, typed` });
  it.addEventListener('change', () => {
    const value = fromWords(it.value);
    if (Number.isFinite(value)) set(value);
    else refuse(`${called} = ${it.value} is not allowed: a number is needed. The value stays as ` +
        'it was.');
    it.value = it.dataset.shown;
  });
  it.addEventListener('keydown', (event) => event.stopPropagation());
  return (text) => { if (it.dataset.shown !== text) it.value = it.dataset.shown = text; };
}

/** A unit as it is read out: "1/s" is "1 per s". @param {string} unit */
export const spokenUnit = (unit) =>
    unit.replace(/^1\/?/, (each) => (each === '1' ? '' : 'per '));

// `change(values)` is told what a hand does, `refuse(sentence)` what is typed that is no number.
// Returns what shows a state.
export function buildControls(root, setup, { change, refuse }) {
  let now = {};
  const folds = setup.folded.map(([title, names]) => {
    const fold = made(root, 'details', { className: 'wmr-fold' });
    made(fold, 'summary', { textContent: title });
    return { fold, names };
  });
  const row = (name, text, tip) => {
    const { fold = root } = folds.find(({ names }) => names.includes(name)) || {};
    const it = made(fold, 'label', { className: 'wmr-control', title: tip });
    it.dataset.control = name;
    made(it, 'span', { textContent: text });
    return it;
  };
  const menus = setup.menus.map(([name, text, tip, choices]) => {
    const it = row(name, text, tip),
        select = made(it, 'select', {}, { 'aria-label': `${text}: ${tip}` });
    select.addEventListener('change',
        () => change(name === 'preset' ? { preset: select.selectedIndex }
        : { [name]: select.value }));
    return { name, it, select, choices };
  });
  const sliders = setup.sliders.map(([name, text, tip, ...ends]) => {
    const stops = stopsOf(...ends), [symbol, unit] = text.match(/^(\S+) \[(.*)\]$/).slice(1),
        it = row(name, text, tip);
    const showSlider = putSlider(it, `${symbol}, ${tip}`, stops, {
      get: () => now[name], set: (value) => change({ [name]: value }),
    });
    const showTyped = putTyped(it, text, { set: (value) => change({ [name]: value }), refuse });
    return { name, it, showSlider, showTyped, unit };
  });
  root.append(...folds.map(({ fold }) => fold)); // below the others
  return (state) => {
    now = state;
    for (const { fold, names } of folds)
      fold.hidden = !names.some((name) => applies(name, state, setup));
    for (const { name, it, select, choices } of menus) {
      it.hidden = !applies(name, state, setup);
      const options = name === 'law'
          ? lawsFor(setup, state.moving).map((law) => [law.name, law.title]) : choices;
      const key = JSON.stringify(options),
          value = name === 'preset' ? String(presetOf(state, setup)) : state[name];
      if (select.dataset.key !== key) {
        select.dataset.key = key;
        select.replaceChildren(...options.map(([each, title]) => new Option(title, each)));
      }
      if (select.value !== value) select.value = value;
    }
    for (const { name, it, showSlider, showTyped, unit } of sliders) {
      const value = state[name], text = inWords(value);
      it.hidden = !applies(name, state, setup);
      showSlider(value, `${text} ${spokenUnit(unit)}`.trim());
      showTyped(text);
    }
  };
}
