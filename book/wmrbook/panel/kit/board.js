// What is drawn on: panes with axes in the world's units. A colour is a role of the panel's (alpha,
// goal, path ...), the same as in formulas and figures.

import { drawAngle, drawAngles, drawName, drawPose, drawRobot } from './scene.js';
import { drawAxes } from './axes.js';
import { drawLawn, drawScale } from './lawn.js';
import {
  disc, head, inside, label, line, onCanvas, sizeOf, surfaceOf, take, takeAlong, ticksOf,
} from './surface.js';
import { poseOfError } from './model.js';
import { written } from './style.js';

// A pane is { x: [from, to, title, write], y: [from, to, title, write], equal, bare, lawn }:
// `equal` scales keep circles round, a `bare` one has no axes, a `lawn`, true or its stripes' width
// in metres, has a bar for its scale, and `write`, if given, says what a tick's value is called.
/** @param {HTMLCanvasElement} canvas @param {Colours} colours @param {Spec} spec */
export function paneOf(canvas, colours, spec) {
  const { ctx, width, height } = surfaceOf(canvas, colours), { zoom } = sizeOf(canvas),
      room = spec.lawn ? [0, 0, 0, 0] : spec.bare ? [4, 4, 4, 4]
          : [10, spec.x[2] ? 40 : 24, spec.y[2] ? 56 : 34, 12];
  const box = { left: room[2], top: room[0], width: Math.max(width - room[2] - room[3], 20),
      height: Math.max(height - room[0] - room[1], 20) };
  let [x0, x1] = spec.x, [y0, y1] = spec.y,
      [across, up] = [box.width / (x1 - x0), box.height / (y1 - y0)];
  if (spec.equal || spec.lawn) {
    across = up = Math.min(across, up);
    [x0, x1] = [(x0 + x1 - box.width / across) / 2, (x0 + x1 + box.width / across) / 2];
    [y0, y1] = [(y0 + y1 - box.height / up) / 2, (y0 + y1 + box.height / up) / 2];
  }
  const at = (x, y) =>
      [box.left + (x - x0) * across, box.top + box.height - (y - y0) * up].map(onCanvas);
  const ink = (role) => colours[role] || role,
      view = { box, zoom, scale: across, toScreen: at,
      toWorld: (px, py) => [x0 + (px - box.left) / across, y0 + (box.top + box.height - py) / up] };
  const cut = (draw) => inside(ctx, box, draw), names = [], trail = [];
  /** @type {Pane} */
  const pane = {
    ctx, box, view, at, ink, trail, range: [x0, x1, y0, y1], pixel: 1 / across,
    line(points, role = 'path', { width: w = 2.5, dash = [] } = {}) {
      const places = points.map(([x, y]) => at(x, y));
      cut(() => line(ctx, places, ink(role), w, dash));
      if (role !== 'path' || dash.length || points.length <= 8) return;
      trail.push(points); // a ghost later
      takeAlong(ctx, places);
    },
    // Columns of a run, from sample `from` to before `to`.
    path(xs, ys, role = 'path', { width: w = 2.5, dash = [], from = 0, to = xs.length } = {}) {
      pane.line(
          Array.from({ length: Math.max(to - from, 0) }, (_, k) => [xs[from + k], ys[from + k]]),
          role, { width: w, dash });
    },
    curve(f, role = 'path', looks = {}) {
      const n = Math.max(Math.round(box.width / 2), 2);
      pane.line(Array.from({ length: n + 1 }, (_, k) => x0 + (x1 - x0) * k / n)
          .map((x) => [x, f(x)]).filter(([, y]) => Number.isFinite(y)), role, looks);
    },
    area(points, role, share = 0.25) {
      cut(() => {
        ctx.globalAlpha = share; ctx.fillStyle = ink(role); ctx.beginPath();
        points.forEach(([x, y]) => ctx.lineTo(...at(x, y)));
        ctx.fill(); ctx.globalAlpha = 1;
      });
    },
    dot(x, y, role = 'ink', { size = 6, hollow = false } = {}) {
      cut(() => disc(ctx, at(x, y), size, hollow ? colours.paper : ink(role), ink(role)));
      if (size > 4) take(ctx, at(x, y), size);
    },
    cross(x, y, role = 'ink', size = 6) {
      const [px, py] = at(x, y);
      take(ctx, [px, py], size);
      cut(() =>
          [-1, 1].forEach((s) =>
          line(ctx, [[px - size, py - s * size], [px + size, py + s * size]], ink(role), 3)));
    },
    arrow(x, y, toX, toY, role = 'ink', { width: w = 3, dash = [] } = {}) {
      const from = at(x, y), to = at(toX, toY), [dx, dy] = [from[0] - to[0], from[1] - to[1]],
          size = Math.min(11, Math.hypot(dx, dy) / 1.5);
      line(ctx, [from, to], ink(role), w, dash);
      head(ctx, to, Math.atan2(dy, dx), size, 0.5, ink(role), w);
      takeAlong(ctx, [from, to.map((each, k) => each + 0.1 * [dx, dy][k])], 3);
    },
    // `dx` and `dy`, in pixels, to the right and up, keep a text clear of what it names; unless it
    // is `fixed` it may go to the other side of that.
    text(said, x, y, { role = 'ink', dx = 0, dy = 0, size = 14, align = 'left', weight = 500,
      fixed = false } = {}) {
      const [px, py] = at(x, y), turned = { left: 'right', right: 'left' }[align] || align,
          or = fixed ? [] : [[dx, -dy, align], [-dx, dy, turned], [-dx, -dy, turned]]
              .map(([across, up, to]) => [px + across, py - up, to]);
      label(ctx, said, px + dx, py - dy, colours, { colour: ink(role), size, align, weight, or });
    },
    angle(x, y, from, by, name, role, radius = 34) {
      drawAngle(ctx, at(x, y), from, by, radius, name, ink(role), colours);
    },
    robot([x, y, heading], share = 1, { size = 1, role = 'path' } = {}) {
      const [px, py] = at(x, y);
      // out of sight
      if (px < box.left - 20 || px > box.left + box.width + 20 || py < box.top - 20
          || py > box.top + box.height + 20) return;
      ctx.globalAlpha = share;
      drawRobot(ctx, [px, py], heading, { ...colours, path: ink(role) }, size);
      ctx.globalAlpha = 1;
    },
    // the robot in a state of polar errors, before a goal at the origin that faces right
    state(rho, alpha, theta) {
      const pose = poseOfError(rho, alpha, theta, 0, 0, 0), goal = [0, 0, 0];
      pane.pose(goal, 'goal');
      drawAngles(ctx, view, pose, [rho, alpha, theta], goal, colours);
      pane.robot(pose);
    },
    // the polar errors of a robot anywhere, before a goal anywhere
    errors(pose, errors, goal) { drawAngles(ctx, view, pose, errors, goal, colours); },
    pose(pose, name) { drawPose(ctx, view, pose, name, colours); names.push([pose, name]); },
    // at last, for no path may strike one out
    name() {
      if (spec.lawn) drawScale(ctx, view, colours, (metres) =>
        (metres < 1e-5 ? written(1e6 * metres, 'µm', 1)
            : metres < 0.01 ? written(1000 * metres, 'mm', 1) : written(metres, 'm', 1)));
      names.forEach(([pose, name]) => drawName(ctx, view, pose, name, colours));
    },
    rect(left, bottom, right, top, role, share = 0.85) {
      pane.area([[left, bottom], [right, bottom], [right, top], [left, top]], role, share);
    },
  };
  if (spec.lawn) drawLawn(ctx, view, colours, Number(spec.lawn === true ? 0 : spec.lawn));
  else if (!spec.bare) drawAxes(ctx, box, colours, axesOf(pane, spec, pane.range));
  return pane;
}

/** As many numbers as have room. @param {Pane} pane @param {Spec} spec @param {number[]} range */
function axesOf({ box, at }, { x, y, equal }, [x0, x1, y0, y1]) {
  const most = equal ? Math.max(Math.min(box.width, box.height) / 45, 2) : 0,
      along = ticksOf(x0, x1, most || box.width / 60),
      up = ticksOf(y0, y1, most || box.height / 36);
  return {
    along: { ...along, title: x[2], write: x[3] || along.write, at: (value) => at(value, y0)[0] },
    up: { ...up, title: y[2], write: y[3] || up.write, at: (value) => at(x0, value)[1] },
  };
}
