// What every canvas here shares: sharp pixels, axes with round numbers, and text that stays
// readable over lines.

import { FONT, readColours } from './style.js';
import { within } from './numbers.js';

// asking an element for its size in the middle of a drag would make the browser lay out the page
const sizes = new WeakMap();

// Width and height in units of `zoom` CSS pixels: a large canvas is meant for an audience at a
// distance, and everything on it grows.
export function measure(canvas) {
  // hidden for a while, as everything is while JupyterLab changes its theme
  if (canvas.clientWidth === 0 || canvas.clientHeight === 0) return;
  // a deck's, for the last row
  const least = Number(getComputedStyle(canvas).getPropertyValue('--zoom')) || 1;
  const zoom = Math.max(Math.min(canvas.clientWidth / 660, 1.4), least);
  sizes.set(canvas, { zoom, width: canvas.clientWidth / zoom, height: canvas.clientHeight / zoom });
}

export const sizeOf = (canvas) => sizes.get(canvas)
    || (measure(canvas), sizes.get(canvas) || { zoom: 1, width: 1, height: 1 });

/**
 * Calls `paint(colours)` now, and whenever the page turns light or dark, a symbol in it lights up,
 * or one of these elements gets another size. Returns what looks after one more, and what ends it.
 * @param {HTMLElement} root @param {Element[]} elements
 * @param {(colours: Colours) => void} paint
 */
export function repainted(root, elements, paint) {
  const repaint = () => {
    root.querySelectorAll('canvas').forEach(measure);
    paint(readColours(root));
  };
  const system = matchMedia('(prefers-color-scheme: dark)'), page = new MutationObserver(repaint),
      resized = new ResizeObserver(repaint), watch = (element) => resized.observe(element),
      attributeFilter = ['data-theme', 'data-mode', 'data-jp-theme-light', 'data-lit'];
  for (const each of [document.documentElement, document.body])
    page.observe(each, { attributeFilter });
  system.addEventListener('change', repaint);
  elements.forEach(watch);
  repaint();
  return { watch, stop() {
    system.removeEventListener('change', repaint);
    page.disconnect();
    resized.disconnect();
  } };
}

// Returns {ctx, width, height} in those units, cleared, with as many real pixels as the screen has.
export function surfaceOf(canvas, colours) {
  const { zoom, width, height } = sizeOf(canvas);
  const ratio = (window.devicePixelRatio || 1) * zoom;
  const [across, down] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== across || canvas.height !== down) {
    canvas.width = across;
    canvas.height = down;
  }
  const ctx = canvas.getContext('2d', { alpha: false });
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.fillStyle = colours.paper;
  ctx.fillRect(0, 0, width, height);
  ctx.lineJoin = ctx.lineCap = 'round';
  canvas.dataset.lit = colours.lit || '';
  const { places = {} } = pictures.get(ctx) || {};
  pictures.set(ctx, { frame: [0, 0, width, height], taken: [], counts: {}, places });
  return { ctx, width, height };
}

// What lies where in a picture, so that no name lies on it: [left, top, right, bottom, weight].
const pictures = new WeakMap();
/** @type {(one: Point, other: Point) => number} */
const overlap = ([left, top, right, bottom], box) =>
    Math.max(Math.min(right, box[2]) - Math.max(left, box[0]), 0)
    * Math.max(Math.min(bottom, box[3]) - Math.max(top, box[1]), 0);

/** As in a picture that is new. @param {HTMLElement} root */
export const forgetNames = (root) =>
  root.querySelectorAll('canvas').forEach((each) => pictures.delete(each.getContext('2d')));

// From now on names keep so many pixels away, in a picture that has any.
/** @type {(ctx: CanvasRenderingContext2D, place: Point, near: number) => void} */
export const take = (ctx, [x, y], near) =>
  pictures.get(ctx)?.taken.push([x - near, y - near, x + near, y + near, 1]);

/** The same along a line. @param {Point[]} points */
export function takeAlong(ctx, points, near = 2) {
  let left = 0; // px to the next place
  points.slice(1).forEach(([x, y], k) => {
    const [x0, y0] = points[k], far = Math.min(Math.hypot(x - x0, y - y0), 2e3);
    for (; left < far; left += 12)
      take(ctx, [x0 + left / far * (x - x0), y0 + left / far * (y - y0)], near);
    left -= far;
  });
}

// What a symbol that is lit in the text stands for has a halo.
export function halo(ctx, colour) {
  ctx.shadowColor = colour;
  ctx.shadowBlur = ctx.canvas.dataset.lit === colour ? 16 : 0;
}

// A step of 1, 2 or 5 times a power of ten that cuts `span` into at most `most` pieces.
export function roundStep(span, most) {
  const rough = Math.max(span, 1e-12) / Math.max(most, 1),
      power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].find((each) => each * power >= rough * (1 - 1e-9)) * power;
}

export function multiples(step, low, high) {
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1)
    found.push(k * step);
  return found;
}

// Such a step with two numbers between the ends at least, for one alone is no scale.
export function stepFor(low, high, most) {
  let step = roundStep(high - low, most);
  while (multiples(step, low, high).length < 2) step = roundStep(step, 2.5); // 5, 2, 1, 0.5
  return step;
}

export function ticksOf(low, high, most) {
  const step = stepFor(low, high, most);
  return { ticks: multiples(step, low, high), write: (value) => tickText(value, step) };
}

export function tickText(value, step) {
  const size = Math.max(Math.abs(value), step);
  if (size >= 1e5 || step < 1e-4)
    return value === 0 ? '0' : value.toExponential(0).replace('-', '−');
  return value.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9))).replace('-', '−');
}

// Canvases lose their way with coordinates beyond the range of 32-bit pixels.
export const onCanvas = (pixels) => within(pixels, -1e5, 1e5);

/**
 * @param {CanvasRenderingContext2D} ctx @param {Point[]} points @param {string} colour
 * @param {number[]} dash
 */
export function line(ctx, points, colour, width = 1.5, dash = []) {
  ctx.save();
  halo(ctx, colour);
  ctx.strokeStyle = colour;
  ctx.lineWidth = width;
  ctx.setLineDash(dash);
  ctx.beginPath();
  points.forEach(([x, y]) => ctx.lineTo(onCanvas(x), onCanvas(y)));
  ctx.stroke();
  ctx.restore();
}

/** The head of an arrow, which points away from the angle `back`. @param {Point} tip */
export function head(ctx, tip, back, size, spread, colour, width) {
  const barb = (turn) =>
      [tip[0] + size * Math.cos(back + turn), tip[1] + size * Math.sin(back + turn)];
  line(ctx, [barb(spread), tip, barb(-spread)], colour, width);
}

/** A dot with a rim. @param {CanvasRenderingContext2D} ctx @param {Point} place */
export function disc(ctx, [x, y], radius, fill, rim, width = 2.5) {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.fillStyle = fill;
  ctx.fill();
  ctx.lineWidth = width;
  ctx.strokeStyle = rim;
  ctx.stroke();
}

// The numbers of an axis: plain text, for there are many, and nothing crosses them.
export function tickLabel(ctx, text, x, y, colours, align) {
  ctx.font = `13px ${FONT}`;
  ctx.textAlign = align;
  ctx.textBaseline = 'middle';
  ctx.fillStyle = colours.soft;
  ctx.fillText(text, x, y);
  const wide = ctx.measureText(text).width, left = x - (align === 'right' ? wide : wide / 2);
  pictures.get(ctx).taken.push([left, y - 7, left + wide, y + 7, 4]);
}

/**
 * Where a text is to begin, of some places [x, y, align]: at the first where least is in its way,
 * but where it was before unless that is clearly worse, else it would flicker while things move.
 * Whole in the picture; null if most of it would lie outside.
 * @param {CanvasRenderingContext2D} ctx @param {Point[]} places
 */
function clearest(ctx, text, size, places) {
  const picture = pictures.get(ctx), { frame, taken, counts } = picture,
      wide = ctx.measureText(text).width, high = 1.2 * size,
      kind = text.replace(/[-−\d.]+/g, ''), key = kind + (counts[kind] = (counts[kind] || 0) + 1);
  const boxes = places.map(([x, y, align]) => {
    const left = x - wide * (align === 'right' ? 1 : align === 'center' ? 0.5 : 0),
        top = y - high / 2;
    return [left, top, left + wide, top + high];
  });
  // in 40 px²: a corner that is touched is no crowd
  const crowd = boxes.map((box) => Math.round((wide * high - overlap(box, frame)
    + taken.reduce((sum, each) => sum + each[4] * overlap(box, each), 0)) / 40));
  if (!(crowd[picture.places[key]] <= Math.min(...crowd) + 4))
    picture.places[key] = crowd.indexOf(Math.min(...crowd));
  const best = boxes[picture.places[key]];
  if (overlap(best, frame) < wide * high / 2) return null;
  const left = within(best[0], 3, Math.max(frame[2] - wide - 3, 3)),
      top = within(best[1], 0, Math.max(frame[3] - high, 0));
  taken.push([left, top, left + wide, top + high, 4]);
  return [left, top + high / 2];
}

// Text with a rim in the colour of the paper; unless it is turned it may stand at one of `or`,
// [x, y, align], too.
export function label(ctx, text, x, y, colours,
    { colour = colours.ink, size = 13, align = 'left', weight = 400, turn = 0, or = [] } = {}) {
  ctx.save();
  ctx.font = `${weight} ${size}px ${FONT}`;
  ctx.textAlign = turn ? align : 'left';
  ctx.textBaseline = 'middle';
  const place = turn ? [x, y] : clearest(ctx, text, size, [[x, y, align], ...or]);
  if (!place) { ctx.restore(); return; }
  ctx.translate(place[0], place[1]);
  ctx.rotate(turn);
  ctx.lineWidth = 4;
  ctx.strokeStyle = colours.paper;
  ctx.strokeText(text, 0, 0);
  halo(ctx, colour);
  ctx.fillStyle = colour;
  ctx.fillText(text, 0, 0);
  ctx.restore();
}

/** @param {CanvasRenderingContext2D} ctx @param {Box} box @param {() => void} draw */
export function inside(ctx, box, draw) {
  ctx.save();
  ctx.beginPath();
  ctx.rect(box.left, box.top, box.width, box.height);
  ctx.clip();
  draw();
  ctx.restore();
}
