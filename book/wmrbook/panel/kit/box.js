// The box above a figure's pictures: one line, which asks, judges or says an idea, and one row of
// chips. Its lines lie on one another and so do its rows, so that it is always as high as the
// highest of each, and nothing below it ever moves.

import { made } from './hands.js';
import { putWords } from './symbols.js';

/** @param {HTMLElement} root @param {(text: string) => void} announce for who can't see it */
export function putBox(root, announce) {
  const lines = made(root, 'div', { className: 'live-lines' }),
      rows = made(root, 'div', { className: 'live-chips' });
  let base = null, idea = null;
  const refresh = () => {
    for (const it of /** @type {any} */ (lines.children))
      it.dataset.on = String(it === (idea || base));
  };
  return {
    /** A line that can be shown. @param {string} className @param {string} text */
    line(className, text) {
      const it = made(lines, 'p', { className, tabIndex: -1 });
      putWords(it, text);
      return it;
    },
    /** A row of chips that can be shown. @param {string} className @param {string} says */
    row: (className, says) => made(rows, 'div', { className },
        { role: 'group', 'aria-label': says }),
    show(line, row) {
      base = line;
      for (const it of /** @type {any} */ (rows.children)) it.dataset.on = String(it === row);
      refresh();
    },
    /** In the place of the line, or no longer. */
    overlay(line) {
      idea = line;
      refresh();
      if (line) announce(line.textContent);
    },
  };
}

/** @param {HTMLElement} row @param {string} text @param {() => void} onclick */
export function putChip(row, text, onclick, className = 'live-chip') {
  const it = made(row, 'button', { type: 'button', className, onclick });
  putWords(it, text);
  return it;
}
