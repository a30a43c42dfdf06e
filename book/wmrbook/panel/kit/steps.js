// A scene that grows idea by idea: to each belong a sentence and the places of some knobs.

import { made } from './hands.js';
import { putWords } from './symbols.js';

/**
 * Buttons with numbers, and the sentence of the one that was taken, until `leave` is called.
 * @param {HTMLElement} root @param {{ says: string, to: Values }[]} steps
 * @param {(k: number) => void} take
 */
export function putSteps(root, steps, take) {
  const row = made(root, 'div', { className: 'live-steps' },
      { role: 'group', 'aria-label': 'idea by idea' });
  const buttons = steps.map((step, k) => made(row, 'button',
      { type: 'button', textContent: String(k + 1), onclick: () => go(k) },
      { 'aria-label': `idea ${k + 1} of ${steps.length}` }));
  const says = made(row, 'span', {}, { role: 'status' });
  function mark(k, text) {
    buttons.forEach((each, i) => (i === k ? each.setAttribute('aria-current', 'step')
        : each.removeAttribute('aria-current')));
    putWords(says, text);
  }
  function go(k) {
    take(k);
    mark(k, steps[k].says);
  }
  const leave = () => mark(-1, `One scene, ${steps.length} ideas.`);
  leave();
  return { leave };
}
