// Sliders for gains, as formulas write them: a coloured symbol, a track as wide as there is room,
// and a value that can be typed over, with its unit.
//
//   const show = putGains(parent, gains, { get, set, refuse });
//   show(values);
//
// `gains` are { name, says, low, high, step, unit }: `name` as in Python ('k_alpha'), `says` in
// words what it does, for a screen reader and as a tip, and `unit` as '1/s', or '' for none.
// Without a `step` the slider stops at round numbers. `get(name)` is the value now; `set(name,
// value)` is called for each move of a hand and for a number that was typed; `refuse(sentence)` for
// anything else that was typed. `show(values)` puts the rows to values by name, and hides a row
// whose name `values` does not have. Rows carry data-control=NAME, their inputs the classes
// wmr-slider and wmr-typed.

import { putSlider, putTyped, spokenUnit, stopsOf } from './controls.js';
import { inWords } from './style.js';
import { made } from './hands.js';
import { putSymbol, roleOf } from './symbols.js';

/**
 * @param {HTMLElement} parent @param {Values[]} gains
 * @param {{ get(name: string): number, set(name: string, value: number): void,
 *   refuse(sentence: string): void }} hand
 */
export function putGains(parent, gains, { get, set, refuse }) {
  const root = made(parent, 'div', { className: 'wmr-gains' },
      { role: 'group', 'aria-label': 'gains' });
  const rows = gains.map(({ name, says, low, high, step, unit, label }) => {
    const row = made(root, 'div', { className: 'wmr-gain', title: says }),
        role = roleOf(name), called = unit ? `${name} [${unit}]` : name;
    row.dataset.control = name;
    if (role) row.style.setProperty('--knob-colour', `var(--${role})`);
    if (label) made(row, 'span', { textContent: label }); else putSymbol(row, name);
    const showSlider = putSlider(row, `${name}, ${says}`, stopsOf(low, high, step),
        { get: () => get(name), set: (value) => set(name, value) });
    const showTyped = putTyped(row, called, { set: (value) => set(name, value), refuse });
    made(row, 'span', { textContent: unit });
    return { name, row, show(value) {
      const text = inWords(value);
      showSlider(value, `${text} ${spokenUnit(unit)}`.trim());
      showTyped(text);
    } };
  });
  /** @param {Values} values */
  return (values) => rows.forEach(({ name, row, show }) => {
    row.hidden = !(name in values);
    if (!row.hidden) show(values[name]);
  });
}
