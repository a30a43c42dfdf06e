// The axes of every picture: round numbers below a box and beside it, lines through it, and titles.

import { label, line, tickLabel } from './surface.js';

const ORIGIN = 1.5, OTHERS = 0.6; // px, the lines' widths

/**
 * Numbers, what they are called, and where they are on the canvas, below a box and beside it.
 * @typedef {{ ticks: number[], write(value: number): string, at(value: number): number,
 *   title?: string | false }} Ruler
 * @param {CanvasRenderingContext2D} ctx @param {Box} box @param {Colours} colours
 * @param {{ along?: Ruler, up?: Ruler, lines?: boolean }} rulers
 */
export function drawAxes(ctx, { left, top, width, height }, colours, { along, up, lines = true }) {
  const right = left + width, foot = top + height;
  const through = (value, ends) => {
    if (lines) line(ctx, ends, colours.line, value === 0 ? ORIGIN : OTHERS);
  };
  for (const value of along ? along.ticks : []) {
    const x = along.at(value);
    through(value, [[x, top], [x, foot]]);
    tickLabel(ctx, along.write(value), x, foot + 12, colours, 'center');
  }
  for (const value of up ? up.ticks : []) {
    const y = up.at(value);
    through(value, [[left, y], [right, y]]);
    tickLabel(ctx, up.write(value), left - 6, y, colours, 'right');
  }
  if (along && along.title)
    label(ctx, along.title, left + width / 2, foot + 32, colours, { align: 'center' });
  if (up && up.title)
    label(ctx, up.title, 10, top + height / 2, colours, { align: 'center', turn: -Math.PI / 2 });
}
