// v, omega, the position errors and V over one time axis, with the cursor that ties them to the
// robot on the path.

import { FONT } from './style.js';
import { drawAxes } from './axes.js';
import { disc, inside, label, line, surfaceOf, ticksOf } from './surface.js';
import { within } from './numbers.js';

const CHARTS = [
  { title: 'v [m/s]', lines: [{ role: 'path', of: (run) => run.v }] },
  { title: 'ω [rad/s]', lines: [{ role: 'path', of: (run) => run.omega }] },
  {
    title: 'error [m]',
    lines: [
      { role: 'path', of: (run) => difference(run.goalX, run.x), tag: 'x' },
      { role: 'ink', of: (run) => difference(run.goalY, run.y), tag: 'y', dash: [7, 5] },
    ],
  },
  { title: 'V [1], L = 1 m²', log: true, lines: [{ role: 'path', of: (run) => run.V }] },
];
const AXIS = { left: 62, right: 14, top: 22, bottom: 42, gap: 24 };
const ROUNDING = 1e-6; // a V that grows by less than this share in a step is as good as level

const difference = (a, b) => Float64Array.from(b, (value, k) => a[k] - value);
export const endOf = (run) => (run && run.n ? run.t[run.n - 1] : 0);
const rises = (V, k) => V[k] > V[k - 1] * (1 + ROUNDING) + 1e-15;

export function timeAxis(width, run, ghost) {
  const span = Math.max(endOf(run), endOf(ghost)) || 1;
  const across = Math.max(width - AXIS.left - AXIS.right, 10);
  return { span, toX: (t) => AXIS.left + across * t / span,
      toTime: (x) => within((x - AXIS.left) / across, 0, 1) * span };
}

export function drawCharts(canvas, colours, { run, ghost, cursor, faded }) {
  const { ctx, width, height } = surfaceOf(canvas, colours);
  const time = timeAxis(width, run, ghost);
  const each = (height - AXIS.top - AXIS.bottom - AXIS.gap * (CHARTS.length - 1)) / CHARTS.length;
  const { ticks, write } = ticksOf(0, time.span, Math.max(2, Math.floor(width / 80))),
      x = run && time.toX(run.t[cursor]);
  CHARTS.forEach((chart, i) => {
    const last = i === CHARTS.length - 1, top = AXIS.top + i * (each + AXIS.gap),
        box = { left: AXIS.left, top, width: width - AXIS.left - AXIS.right, height: each };
    const along =
        { ticks, write: last ? write : () => '', at: time.toX, title: last && 'time [s]' };
    drawAxes(ctx, box, colours, { along });
    ctx.globalAlpha = faded ? 0.35 : 1;
    drawChart(ctx, chart, box, time, colours, run, ghost);
    if (run) line(ctx, [[x, top], [x, top + each]], colours.ink, 2);
    if (run && last) disc(ctx, [x, top + each], 5, colours.ink, colours.ink, 2);
    drawTitle(ctx, chart, box, colours);
    ctx.globalAlpha = 1;
  });
}

function drawChart(ctx, chart, box, time, colours, run, ghost) {
  const series = chart.lines.map((each) =>
      ({ ...each, values: run ? each.of(run) : [], old: ghost ? each.of(ghost) : [] }));
  const all = series.flatMap(({ values, old }) => [...values, ...old]),
      axis = (chart.log ? logAxis : linearAxis)(all, box);
  ctx.strokeStyle = colours.line;
  ctx.lineWidth = 1;
  ctx.strokeRect(box.left, box.top, box.width, box.height);
  drawAxes(ctx, box, colours, { up: { ...axis, at: axis.toY } });
  inside(ctx, { ...box, top: box.top - 3, height: box.height + 6 }, () => {
    for (const { old } of series) drawSeries(ctx, ghost, old, time, axis, colours.ghost, 2, [3, 5]);
    for (const { values, role, dash = [] } of series)
      drawSeries(ctx, run, values, time, axis, colours[role], 2.5, dash);
    if (chart.log && run) drawRising(ctx, run, time, axis, colours);
  });
}

function drawTitle(ctx, chart, box, colours) {
  const y = box.top - 11;
  label(ctx, chart.title, box.left, y, colours, { weight: 600, size: 14 });
  ctx.font = `600 14px ${FONT}`;
  let x = box.left + ctx.measureText(chart.title).width + 12;
  for (const { tag, role, dash = [] } of chart.lines.filter((each) => each.tag)) {
    line(ctx, [[x, y], [x + 22, y]], colours[role], 2.5, dash);
    label(ctx, tag, x + 27, y, colours, { colour: colours[role], weight: 600, size: 14 });
    x += 48;
  }
}

function drawSeries(ctx, run, values, time, axis, colour, width, dash) {
  if (!values.length) return;
  const points = Array.from(values, (value, k) => [time.toX(run.t[k]), axis.toY(value)]);
  if (points.length > 1) line(ctx, points, colour, width, dash);
  // a run of one sample is a dot
  else line(ctx, [points[0], [points[0][0] + 1, points[0][1]]], colour, 7);
}

// Red, thicker and dashed, so that it shows without colour too.
function drawRising(ctx, run, time, axis, colours) {
  let points = [];
  const flush = () => {
    if (points.length) line(ctx, points, colours.rising, 5, [8, 6]);
    points = [];
  };
  for (let k = 1; k < run.n; k += 1) {
    if (!rises(run.V, k)) { flush(); continue; }
    if (!points.length) points.push([time.toX(run.t[k - 1]), axis.toY(run.V[k - 1])]);
    points.push([time.toX(run.t[k]), axis.toY(run.V[k])]);
  }
  flush();
}

function linearAxis(values, box) {
  let low = 0, high = 0;
  for (const value of values) { low = Math.min(low, value); high = Math.max(high, value); }
  if (high - low < 1e-9) high = low + 1;
  const room = 0.06 * (high - low);
  const scale = box.height / (high - low + 2 * room);
  return { ...ticksOf(low, high, Math.max(3, Math.floor(box.height / 26))),
      toY: (value) => box.top + (high + room - value) * scale };
}

function logAxis(values, box) {
  let low = Infinity, high = 0;
  for (const value of values) {
    if (value > 0) low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (high === 0) [low, high] = [0.1, 1];
  low = Math.max(low, high * 1e-7);
  const from = Math.floor(Math.log10(low)), to = Math.max(Math.ceil(Math.log10(high)), from + 1);
  const scale = box.height / (to - from),
      every = Math.ceil((to - from) / Math.max(2, box.height / 26));
  const ticks = [];
  for (let power = from; power <= to; power += every) ticks.push(10 ** power);
  const write = (value) =>
      (value >= 0.01 && value < 1e4 ? String(Number(value.toPrecision(1)))
      : `1e${Math.round(Math.log10(value))}`.replace('-', '−'));
  return { ticks, write,
      toY: (value) =>
      box.top + box.height - (Math.log10(Math.max(value, 10 ** from)) - from) * scale };
}
