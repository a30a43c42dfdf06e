// The second view: what a run amounts to over two of the gains, as a heat map that a worker
// computes.

import { DEGREES, viridis } from './style.js';
import { LAWS } from './model.js';
import { drawAxes } from './axes.js';
import { label, roundStep, surfaceOf, tickLabel, ticksOf } from './surface.js';
import { landscape } from './simulate.js';
import { within } from './numbers.js';

const MEASURES = {
  headingError: { title: 'heading error on arrival [°]', lasting: 'heading error at the end [°]',
      scale: DEGREES, most: 180 },
  time: { title: 'arrival time [s]', lasting: 'distance left [m]', scale: 1, most: Infinity },
  peakOmega: { title: 'peak |ω| [rad/s]', lasting: 'peak |ω| [rad/s]', scale: 1, most: Infinity },
};
export const RANGES = { k_alpha: 5, h: 5, k_rho: 4 };
const UNITS = { k_alpha: 'k_alpha [1/s]', h: 'h [1]', k_rho: 'k_rho [1/m]' };
const LEVELS = [10, 50]; // cells a side: a first impression, then the whole

export const mapped = (settings) =>
    Object.keys(RANGES).every((name) => LAWS[settings.law].gains.includes(name));
const centres = (name, n) =>
    Float64Array.from({ length: n }, (_, i) => RANGES[name] * (i + 0.5) / n);
const mapOf = ({ settings, kx, ky, n, metric }) =>
    landscape({ ...settings, kx, xs: centres(kx, n), ky, ys: centres(ky, n), metric });

// This module is the worker's too: there it finds no page, and computes what it is sent.
if (typeof document === 'undefined')
  onmessage = ({ data }) => postMessage({ ...data, values: mapOf(data) });

// The worker's script. In a page from the disk, where none may be a module, it is all of the kit,
// which is one function there.
/** @returns {[string, WorkerType]} */
const script = () =>
    (typeof wmrKit === 'function' ? [`(${wmrKit})()`, 'classic']
    : [`import '${import.meta.url}';`, 'module']);

// `update` begins a map if anything that it shows has changed; `onDone` is called for each that is
// there.
export function buildGainMap(onDone) {
  let key = '', job = null, busy = false, done = null, worker = null;
  function begin() {
    const [text, type] = script();
    worker = new Worker(URL.createObjectURL(new Blob([text], { type: 'text/javascript' })),
        { type });
    worker.onmessage = ({ data }) => take(data);
    worker.onerror = (event) => { // this page forbids workers
      event.preventDefault();
      worker = { postMessage: (data) => setTimeout(() => take({ ...data, values: mapOf(data) })),
          terminate() {} };
      next();
    };
  }
  function next() {
    if (!worker) begin();
    busy = job !== null;
    if (busy) worker.postMessage(job);
  }
  // A map that is no longer wanted is shown all the same: under a moving hand any is better than
  // none.
  function take(map) {
    done = { ...map, measure: MEASURES[map.metric] };
    if (map.key === key) job = map.level + 1 < LEVELS.length ? jobOf(map, map.level + 1) : null;
    next();
    onDone();
  }
  /** @param {Values} map @param {number} level */
  const jobOf = ({ values, ...rest }, level) => ({ ...rest, level, n: LEVELS[level] });
  return {
    update(settings, kx, metric) {
      const { [kx]: _x, h: _h, ...others } = settings.gains,
          wanted = JSON.stringify([{ ...settings, gains: others }, kx, metric]);
      if (wanted === key) return;
      key = wanted;
      job = jobOf({ key, settings, kx, ky: 'h', metric }, 0);
      if (!busy) next();
    },
    get map() { return done; },
    get finished() { return job === null; },
    close() { if (worker) worker.terminate(); },
  };
}

function mapBox(width, height) {
  return { left: 62, top: 12, width: Math.max(width - 62 - 96, 20),
      height: Math.max(height - 12 - 46, 20) };
}

export function gainsAt(map, { width, height }, x, y) {
  const box = mapBox(width, height);
  const share = (value, low, size) => within((value - low) / size, 0, 1);
  const round = (value, name) => Math.max(0.05, Math.round(value * RANGES[name] * 20) / 20);
  return { [map.kx]: round(share(x, box.left, box.width), map.kx),
      [map.ky]: round(1 - share(y, box.top, box.height), map.ky) };
}

export function drawMap(canvas, colours, { map, gains, note }) {
  const { ctx, width, height } = surfaceOf(canvas, colours);
  const box = mapBox(width, height);
  if (!map || note) {
    ctx.strokeStyle = colours.line;
    ctx.strokeRect(box.left, box.top, box.width, box.height);
    label(ctx, note || 'computing ...', width / 2, height / 2, colours,
        { align: 'center', size: 14 });
    return;
  }
  const top = topOf(map);
  ctx.imageSmoothingEnabled = false;
  ctx.drawImage(imageOf(map, top, colours), box.left, box.top, box.width, box.height);
  const ranges = [RANGES[map.kx], RANGES[map.ky]],
      across = (gain) => box.left + box.width * Math.min(gain / ranges[0], 1),
      up = (gain) => box.top + box.height * (1 - Math.min(gain / ranges[1], 1));
  drawAxes(ctx, box, colours, {
    lines: false,
    along: { ...ticksOf(0, ranges[0], box.width / 60), title: UNITS[map.kx], at: across },
    up: { ...ticksOf(0, ranges[1], box.height / 40), title: UNITS[map.ky], at: up },
  });
  drawColourBar(ctx, box, map, top, colours);
  const x = across(gains[map.kx]), y = up(gains[map.ky]);
  for (const [colour, thick] of [['#000000', 6], ['#ffffff', 2.5]]) {
    ctx.strokeStyle = colour;
    ctx.lineWidth = thick;
    ctx.beginPath();
    ctx.arc(x, y, 10, 0, 2 * Math.PI);
    ctx.moveTo(x - 18, y); ctx.lineTo(x - 4, y); ctx.moveTo(x + 4, y); ctx.lineTo(x + 18, y);
    ctx.moveTo(x, y - 18); ctx.lineTo(x, y - 4); ctx.moveTo(x, y + 4); ctx.lineTo(x, y + 18);
    ctx.stroke();
  }
}

const shown = (map, i) => Math.abs(map.values[i]) * map.measure.scale;

// The top of the colour bar: a round number above 95 % of the cells, so that a few wild ones don't
// flatten the rest.
function topOf(map) {
  const values = Array.from(map.values, (_, i) => shown(map, i)).filter(Number.isFinite)
      .sort((a, b) => a - b);
  if (!values.length) return 1;
  const high = Math.max(values[Math.min(values.length - 1, Math.floor(0.95 * values.length))],
      1e-6), step = roundStep(high, 4);
  return Math.min(Math.ceil(high / step - 1e-9) * step, map.measure.most);
}

function imageOf(map, top, colours) {
  const { n } = map, image = document.createElement('canvas');
  image.width = image.height = n;
  const ctx = image.getContext('2d'), pixels = ctx.createImageData(n, n),
      dark = parseInt(colours.paper.slice(1, 3), 16) < 128;
  for (let i = 0; i < n * n; i += 1) {
    const row = n - 1 - Math.floor(i / n), column = i % n, value = shown(map, i),
        stripe = (row + column) % 4 < 2;
    const colour = Number.isFinite(value) ? viridis(value / top)
        : Array(3).fill((dark ? 60 : 200) + (stripe ? 25 : 0));
    pixels.data.set([...colour, 255], 4 * (row * n + column));
  }
  ctx.putImageData(pixels, 0, 0);
  return image;
}

function drawColourBar(ctx, box, map, top, colours) {
  const left = box.left + box.width + 14, wide = 16;
  for (let i = 0; i < box.height; i += 1) {
    ctx.fillStyle = `rgb(${viridis(1 - i / box.height)})`;
    ctx.fillRect(left, box.top + i, wide, 1.5);
  }
  const { ticks, write } = ticksOf(0, top, 5);
  for (const value of ticks) {
    tickLabel(ctx, (value >= top * (1 - 1e-9) && top < map.measure.most ? '≥ ' : '') + write(value),
        left + wide + 5, box.top + box.height * (1 - value / top), colours, 'left');
  }
  label(ctx, map.settings.reference === null ? map.measure.title : map.measure.lasting,
      box.left + box.width + 84, box.top + box.height / 2, colours,
      { align: 'center', turn: -Math.PI / 2 });
}
