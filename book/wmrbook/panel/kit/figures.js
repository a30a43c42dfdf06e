// What a run amounts to, in numbers and in a sentence.

import { LAWS } from './model.js';
import { made } from './hands.js';
import { inDegrees, written } from './style.js';
import { modes } from './simulate.js';

const FIGURES = ['arrival', 'heading', 'peak', 'length', 'window', 'slower'];

// The closed loop near a goal that stands still; a law that needs a moving one has no such figures.
function modesOf(settings) {
  return LAWS[settings.law].modes ? modes(settings.gains, settings.law) : null;
}

// "16 × slower", "1.3 × faster": how the heading's rate compares with the distance's.
function comparedWith(slower) {
  return slower >= 1 ? `${written(slower, '', 2)} × slower`
      : `${written(1 / slower, '', 2)} × faster`;
}

// Where kappa lies with the corrected law, in words, and on a bar from 0 to 6.
function placeInWindow({ kappa }, { h }) {
  const high = Number((1 + h).toPrecision(3)),
      share = (value) => Math.min(value / 6, 1);
  return {
    name: h > 1 ? `κ, window 2–${high}` : 'κ, no window', text: written(kappa),
    note: `k_alpha/(v_max k_rho): near a goal that stands still the heading settles before the ` +
        `distance if it is above 2 and below 1 + h = ${high}`,
    bar: { kappa: share(kappa), low: `${100 * share(2)}%`,
        high: `${100 * share(Math.max(high, 2))}%` },
  };
}

export function figuresOf(settings, run, summary) {
  const near = modesOf(settings), moving = settings.reference !== null;
  const none = near && near.slower === Infinity ? 'the heading is not steered near the goal'
      : 'not defined for this law';
  const known = near && Number.isFinite(near.damping);
  return {
    arrival: moving
      ? { name: 'Distance left', text: written(summary.residual, 'm'),
          note: 'mean distance to the moving goal over the last 5 s' }
      : { name: 'Arrives after', text: summary.arrived ? written(summary.time, 's') : 'never',
          note: 'time until the arrival radius' },
    heading: { name: moving ? 'Heading, end' : 'Heading error',
        text: inDegrees(summary.headingError),
        note: 'heading minus goal heading at the last sample' },
    peak: { name: 'Peak |ω|', text: written(summary.peakOmega, 'rad/s'),
        note: 'largest turning rate' },
    length: { name: 'Path length', text: written(summary.pathLength, 'm'),
        note: 'backward motion included' },
    window: settings.law === 'corrected' ? placeInWindow(near, settings.gains)
        : { name: 'κ', text: '–', note: 'of the corrected law' },
    slower: {
      name: 'Heading settles',
          text: known && Number.isFinite(near.slower) ? comparedWith(near.slower) : '–',
      note: known ? 'than the distance does, near a goal that stands still' : none,
    },
  };
}

export function sentenceOf(settings, run, summary) {
  const end = run.n ? run.t[run.n - 1] : 0;
  if (run.outcome === 'DIVERGED')
    return `The run leaves the range of numbers after ${written(end, 's')}.`;
  if (settings.reference !== null)
    return `Stays ${written(summary.residual, 'm')} from the moving goal (mean of the last 5 s).`;
  const off = inDegrees(Math.abs(summary.headingError));
  if (summary.arrived && end === 0)
    return `The start is already on the goal, ${off} off the goal heading.`;
  if (summary.arrived)
    return `Arrives after ${written(summary.time, 's')}, ${off} off the goal heading.`;
  return `Does not arrive within ${written(settings.duration, 's')}: ` +
      `${written(summary.distance, 'm')} are left, ${off} off the goal heading.`;
}

export function buildFigures(root) {
  const cells = {};
  for (const key of FIGURES) {
    const cell = made(root, 'div', {}, { role: 'listitem' });
    cell.dataset.figure = key;
    cells[key] = ['name', 'value', 'pinned'].map((part) =>
      made(cell, 'div', { className: `wmr-${part}` }));
  }
  return (figures, pinned) => {
    root.classList.toggle('wmr-alone', !pinned);
    for (const key of FIGURES) {
      const [name, value, old] = cells[key];
      name.textContent = figures ? figures[key].name : name.textContent;
      value.textContent = figures ? figures[key].text : '–';
      value.title = name.title = figures ? figures[key].note : '';
      value.removeAttribute('style');
      for (const [part, share] of Object.entries((figures && figures[key].bar) || {}))
        value.style.setProperty(`--${part}`, share);
      old.textContent = pinned ? `pinned: ${pinned[key].text}` : '';
    }
  };
}
