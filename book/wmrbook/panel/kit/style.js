// Colours by role, the page's theme, and how numbers are written.

import { COLOURS, FONTS } from './face.js';
import { within } from './numbers.js';

export const FONT = FONTS.sans;
export const DEGREES = 180 / Math.PI;

function pageIsDark(root) {
  const named = root.closest('[data-theme], [data-jp-theme-light]')
      || document.querySelector('body[data-jp-theme-light]');
  if (named && named.dataset.jpThemeLight) return named.dataset.jpThemeLight === 'false';
  if (named && /^(dark|light)$/.test(named.dataset.theme)) return named.dataset.theme === 'dark';
  return matchMedia('(prefers-color-scheme: dark)').matches;
}

// Whether whoever reads wants nothing to move by itself.
export const isCalm = () => matchMedia('(prefers-reduced-motion: reduce)').matches;

// Marks the panel as light or dark; gives it the book's colours and fonts as variables, and returns
// the colours for the canvases.
export function readColours(root) {
  const dark = pageIsDark(root), theme = dark ? 'dark' : 'light';
  root.dataset.wmrTheme = theme;
  const colours = {};
  for (const [role, codes] of Object.entries(COLOURS)) {
    colours[role] = codes[Number(dark)];
    root.style.setProperty(`--${role}`, colours[role]);
  }
  colours.lit = colours[document.documentElement.dataset.lit];
  for (const [role, names] of Object.entries(FONTS)) root.style.setProperty(`--${role}`, names);
  return colours;
}

// viridis at 17 even steps (matplotlib, CC0); between them, straight lines in sRGB are within two
// levels of the full table.
const VIRIDIS = [
  [68, 1, 84], [72, 24, 106], [71, 45, 123], [66, 64, 134], [59, 82, 139], [51, 99, 141],
      [44, 114, 142], [38, 130, 142], [33, 145, 140],
  [31, 160, 136], [40, 174, 128], [63, 188, 115], [94, 201, 98], [132, 212, 75], [173, 220, 48],
      [216, 226, 25], [253, 231, 37],
];

export function viridis(share) {
  const place = within(share, 0, 1) * (VIRIDIS.length - 1);
  const low = Math.min(Math.floor(place), VIRIDIS.length - 2);
  return VIRIDIS[low].map((from, i) =>
      Math.round(from + (place - low) * (VIRIDIS[low + 1][i] - from)));
}

// A number and i times another one, in words.
export const complex = ([re, im]) =>
    `${written(re)} ${im < 0 ? 'minus' : 'plus'} ${written(Math.abs(im))} i`;

// Three significant digits, with a real minus sign.
export function written(value, unit = '', digits = 3) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  const text = size === 0 ? '0' : size >= 1e5
    ? value.toExponential(1)
    : value.toFixed(
        Math.max(0, Math.min(3, digits - 1 - Math.floor(Math.log10(Math.max(size, 0.01))))));
  const gap = unit === '°' || unit === '' ? '' : ' ';
  return text.replace(/^-(?=[0.]*$)/, '').replace('-', '−') + gap + unit;
}

// A length in the unit that suits it.
export const lengthText = (metres, digits = 3) => {
  const [size, unit] = metres >= 1e3 ? [1e-3, 'km'] : metres >= 0.999 ? [1, 'm'] : metres >= 0.00999
      ? [100, 'cm'] : metres >= 0.0000999 ? [1e3, 'mm'] : [1e6, 'µm'];
  return written(metres * size, unit, digits);
};

// As many digits as it was typed with, or as a slider's step has.
export const inWords = (value) =>
    (Number.isFinite(value) ? String(Number(value.toPrecision(6))).replace('-', '−')
    : String(value));

export function inDegrees(angle, digits = 1) {
  if (!Number.isFinite(angle)) return '–';
  const text = (angle * DEGREES).toFixed(digits);
  return `${text.replace(/^-(?=[0.]*$)/, '').replace('-', '−')}°`;
}
