// A scene that grows idea by idea: to each belong a title, a sentence and the places of some knobs.

import { putChip } from './box.js';

/**
 * A chip for each idea. The sentence of the one that was taken stands in the box until `leave` is
 * called.
 * @param {ReturnType<typeof import('./box.js').putBox>} box @param {HTMLElement} row
 * @param {{ title: string, says: string, to: Values }[]} steps
 * @param {(k: number) => void} take
 */
export function putSteps(box, row, steps, take) {
  const lines = steps.map(({ says }) => box.line('live-says', says));
  const chips = steps.map(({ title }, k) => putChip(row, title || String(k + 1), () => {
    take(k);
    mark(k);
  }));
  function mark(k) {
    chips.forEach((each, i) => (i === k ? each.setAttribute('aria-current', 'step')
        : each.removeAttribute('aria-current')));
    box.overlay(k < 0 ? null : lines[k]);
  }
  return { leave: () => mark(-1) };
}
