// Symbols among words, as in the formulas: Greek, with their index, and in their colour.

import { COLOURS } from './face.js';
import { made } from './hands.js';

const SYMBOLS = { rho: 'ρ', alpha: 'α', theta: 'θ', omega: 'ω', beta: 'β', gamma: 'γ', lambda: 'λ',
    kappa: 'κ', sigma: 'σ', phi: 'φ', delta: 'δ' };
const SHORT = { heading: 'h' }; // k_heading is k_h in formulas
const NAMED = RegExp(`\\b((?:k|v)_(?:${Object.keys(SYMBOLS).join('|')}|max|x|y)|${
  Object.keys(SYMBOLS).join('|')})\\b`);

/** The colour of a symbol such as k_alpha, or ''. The h of k_h is no gain. @param {string} name */
export function roleOf(name) {
  const [stem, index] = name.split('_');
  return stem in COLOURS ? stem : index in COLOURS ? index : '';
}

/** @param {HTMLElement} parent @param {string} name */
export function putSymbol(parent, name) {
  const [stem, ...index] = name.split('_'), role = roleOf(name);
  const it = made(parent, 'i', { className: 'live-symbol', textContent: SYMBOLS[stem] || stem });
  if (role) { it.style.color = `var(--${role})`; it.dataset.role = role; }
  if (index.length) made(it, 'sub', { textContent: SYMBOLS[index[0]] || SHORT[index[0]]
    || index.join(' ') });
}

// A text in which symbols have their names and degrees are "deg".
export function putWords(parent, text) {
  parent.textContent = '';
  text.replace(/(\d) deg\b/g, '$1°').split(NAMED).forEach((piece, k) => {
    if (k % 2) putSymbol(parent, piece); else parent.append(piece);
  });
}
