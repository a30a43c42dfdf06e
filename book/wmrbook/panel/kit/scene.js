// The path in the plane, equal scales: start and goal as arrows, the robot, and the three polar
// errors as angles and a distance.

import { drawAxes } from './axes.js';
import { ROBOT } from './face.js';
import { nearest, within } from './numbers.js';
import { poseAt } from './runs.js';
import {
  disc, halo, head, inside, label, line, multiples, stepFor, surfaceOf, take, takeAlong,
  tickText,
} from './surface.js';

// px from a pose to the handle that turns it; unequal, so that both can be reached when they
// coincide
const ARROW = { start: 52, goal: 68 };
const SPANS = [1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.4, 8, 10];

// Where the picture looks. It moves in steps, so that it doesn't swim while a slider is dragged,
// and depends on nothing but its arguments. `marks` are points that must be seen; the runs are
// followed as far as three times the marks' distance from the first. `zoomed` is null or [x, y,
// metres from there to the nearer edge].
/** @returns {View} */
export function viewOf(runs, marks, arrows, { zoom, width, height }, zoomed) {
  const box =
      { left: 54, top: 10, width: Math.max(width - 66, 40), height: Math.max(height - 56, 40) };
  if (zoomed) {
    const centre = [box.left + box.width / 2, box.top + box.height / 2];
    return viewAt(box, zoom, Math.min(box.width, box.height) / 2 / zoomed[2], zoomed, centre);
  }
  const reach =
      2 + 3 * Math.max(...marks.map(([x, y]) => Math.hypot(x - marks[0][0], y - marks[0][1])));
  const bounds = [Infinity, Infinity, -Infinity, -Infinity];
  const include = (x, y) => {
    bounds[0] = Math.min(bounds[0], x); bounds[1] = Math.min(bounds[1], y);
    bounds[2] = Math.max(bounds[2], x); bounds[3] = Math.max(bounds[3], y);
  };
  marks.forEach(([x, y]) => include(x, y));
  const clip = (value, middle) => within(value, middle - reach, middle + reach);
  for (const run of runs) {
    for (let k = 0; k < run.n; k += 1)
      include(clip(run.x[k], marks[0][0]), clip(run.y[k], marks[0][1]));
  }
  const room = roomFor(arrows);
  const needed = Math.max(
    (bounds[2] - bounds[0]) / Math.max(box.width - room.left - room.right, 20),
        (bounds[3] - bounds[1]) / Math.max(box.height - room.top - room.bottom, 20), 0.004,
  );
  const power = 10 ** Math.floor(Math.log10(needed));
  // px a metre
  const scale = 1 / (SPANS.find((each) => each * power >= needed * (1 - 1e-9)) * power);
  const snap = (value) => Math.round(value * scale / 20) * 20 / scale;
  const middle = [snap((bounds[0] + bounds[2]) / 2), snap((bounds[1] + bounds[3]) / 2)];
  const centre = [box.left + (box.width + room.left - room.right) / 2,
      box.top + (box.height + room.top - room.bottom) / 2];
  return viewAt(box, zoom, scale, middle, centre);
}

// The view that shows the place `middle` at `centre`, with `scale` px a metre.
export const viewAt = (box, zoom, scale, middle, centre) => ({
  box, scale, zoom,
  toScreen: (x, y) => [centre[0] + (x - middle[0]) * scale, centre[1] - (y - middle[1]) * scale],
  toWorld: (x, y) => [middle[0] + (x - centre[0]) / scale, middle[1] - (y - centre[1]) / scale],
});

// What `zoomed` would be for a view as it is.
export const zoomOf = ({ box, scale, toWorld }) =>
    [...toWorld(box.left + box.width / 2, box.top + box.height / 2),
    Math.min(box.width, box.height) / 2 / scale];

// px between the content and the frame, so that an arrow on the rim still shows its tip, and its
// name beside it.
function roomFor(arrows) {
  const most = (least, share) =>
      Math.max(least,
      ...Object.entries(arrows)
      .map(([name, pose]) => (pose ? 14 + ARROW[name] * share(pose[2]) : 0)));
  return { left: most(54, (a) => -Math.cos(a)), right: most(54, Math.cos), top: most(30, Math.sin),
      bottom: most(30, (a) => -Math.sin(a)) };
}

// What must be seen: start and goal, or start and the goal's whole way.
export function marksOf(poses, run) {
  const way = [];
  if (poses.goal === null && run)
    for (let k = 0; k < run.n; k += Math.ceil(run.n / 60)) way.push([run.goalX[k], run.goalY[k]]);
  return [poses.goal, poses.start, ...way].filter(Boolean);
}

export const knobOf = (view, pose, name) => {
  const [x, y] = view.toScreen(pose[0], pose[1]);
  return [x + ARROW[name] * Math.cos(pose[2]), y - ARROW[name] * Math.sin(pose[2])];
};

export function drawScene(canvas, colours, { view, run, ghost, poses, cursor, faded, zoomed }) {
  const { ctx } = surfaceOf(canvas, colours);
  const now = (column) => column[cursor], pose = run && poseAt(run, cursor),
      robot = run && view.toScreen(pose[0], pose[1]),
      goal = poses.goal || [run.goalX, run.goalY, run.goalHeading].map(now);
  drawGrid(ctx, view, colours);
  ctx.globalAlpha = faded ? 0.35 : 1;
  inside(ctx, view.box, () => {
    if (ghost) drawPath(ctx, view, ghost.x, ghost.y, ghost.n, colours.ghost, 2.5, [3, 6]);
    if (poses.goal === null && run)
      drawPath(ctx, view, run.goalX, run.goalY, run.n, colours.goal, 1.5, [8, 5]);
    if (run) drawPath(ctx, view, run.x, run.y, run.n, colours.path, 3, []);
    drawPose(ctx, view, goal, 'goal', colours);
    drawPose(ctx, view, poses.start, 'start', colours);
    if (run)
      drawAngles(ctx, view, pose, [now(run.rho), now(run.alpha), now(run.theta)], goal, colours);
    if (run) drawRobot(ctx, robot, pose[2], colours);
  });
  if (run && poses.goal && !zoomed && view.scale * LAST < 40)
    drawLast(ctx, view, run, poses, colours);
  inside(ctx, view.box, () => { // over the robot and the corner, where they are in the way
    drawName(ctx, view, goal, 'goal', colours);
    drawName(ctx, view, poses.start, 'start', colours);
  });
  ctx.globalAlpha = 1;
}

const LAST = 1.5; // m round the goal: what a picture of the whole way is too small for

// How the run ends, in the corner where least is in its way, over a ghost of the robot that has
// parked as it should.
function drawLast(ctx, view, run, poses, colours) {
  const { box } = view, size = Math.min(0.38 * Math.min(box.width, box.height), 190), gap = 8;
  const right = box.left + box.width - size - gap, bottom = box.top + box.height - size - gap;
  const frames = [[right, bottom], [box.left + gap, bottom],
      [box.left + gap, box.top + gap]].map(([left, top]) =>
      ({ left, top, width: size, height: size }));
  // with their names
  const points = ['start', 'goal'].flatMap((name) => {
    const [x, y] = view.toScreen(poses[name][0], poses[name][1]);
    return [[x - 45, y], [x, y], [x + 45, y], knobOf(view, poses[name], name)];
  });
  for (let k = 0; k < run.n; k += Math.ceil(run.n / 200))
    points.push(view.toScreen(run.x[k], run.y[k]));
  const crowd = ({ left, top }) => points.filter(([x, y]) =>
    Math.max(Math.abs(x - left - size / 2), Math.abs(y - top - size / 2)) < size / 2 + 20).length;
  const frame = frames.reduce((best, each) => (crowd(each) < crowd(best) ? each : best));
  const near = viewAt(frame, view.zoom, size / 2 / LAST, poses.goal,
      [frame.left + size / 2, frame.top + size / 2]), last = run.n - 1, alpha = ctx.globalAlpha;
  inside(ctx, frame, () => {
    ctx.fillStyle = colours.paper;
    ctx.fillRect(frame.left, frame.top, size, size);
    drawPath(ctx, near, run.x, run.y, run.n, colours.path, 3, []);
    ctx.globalAlpha = 0.3 * alpha;
    drawRobot(ctx, near.toScreen(poses.goal[0], poses.goal[1]), poses.goal[2], colours);
    ctx.globalAlpha = alpha;
    line(ctx, [near.toScreen(poses.goal[0], poses.goal[1]), knobOf(near, poses.goal, 'start')],
        colours.goal, 3, [2, 5]);
    if (run.outcome === 'ARRIVED')
      drawRobot(ctx, near.toScreen(run.x[last], run.y[last]), run.heading[last], colours);
    label(ctx, `within ${LAST} m`, frame.left + 6, frame.top + 12, colours,
        { colour: colours.soft });
  });
  ctx.lineWidth = 1.5;
  ctx.strokeStyle = colours.soft;
  ctx.strokeRect(frame.left, frame.top, size, size);
}

function drawGrid(ctx, view, colours) {
  const { box } = view;
  const [left, bottom] = view.toWorld(box.left, box.top + box.height);
  const [right, top] = view.toWorld(box.left + box.width, box.top);
  // the same both ways
  const finest = (low, high) => stepFor(low, high, (high - low) * view.scale / 55),
      step = Math.min(finest(left, right), finest(bottom, top));
  const write = (value) => tickText(value, step);
  drawAxes(ctx, box, colours, {
    along: {
      ticks: multiples(step, left, right), write, title: 'x [m]',
      at: (value) => view.toScreen(value, 0)[0],
    },
    up: {
      ticks: multiples(step, bottom, top), write, title: 'y [m]',
      at: (value) => view.toScreen(0, value)[1],
    },
  });
}

// The first `n` samples of a way.
export function drawPath(ctx, view, xs, ys, n, colour, width, dash = []) {
  const points = Array.from({ length: n }, (_, k) => view.toScreen(xs[k], ys[k]));
  line(ctx, points, colour, width, dash);
  if (!dash.length) takeAlong(ctx, points);
}

export function drawPose(ctx, view, pose, name, colours) {
  const place = view.toScreen(pose[0], pose[1]), tip = knobOf(view, pose, name),
      colour = colours[name];
  line(ctx, [place, tip], colour, 3);
  head(ctx, tip, Math.PI - pose[2], 13, 0.45, colour, 3);
  disc(ctx, place, 8, colours.paper, colour, 3);
  take(ctx, place, 10);
  takeAlong(ctx, [place, tip], 5);
}

// Behind a pose's arrow, out of its way, or farther off, where nothing else is.
export function drawName(ctx, view, pose, name, colours) {
  const [x, y] = view.toScreen(pose[0], pose[1]), { left, top, width, height } = view.box;
  if (x < left || x > left + width || y < top || y > top + height) return;
  const side = Math.cos(pose[2]) > 0 ? -16 : 16, // px
      down = Math.sin(pose[2]) > 0 ? 16 : -16;
  const [first, ...or] = [1, 2.2, 4].flatMap((far) => [[1, 1], [1, -1], [-1, 1], [-1, -1]]
      .map(([across, up]) => [x + far * across * side, y + far * up * down,
        across * side < 0 ? 'right' : 'left']));
  label(ctx, name, first[0], first[1], colours,
      { colour: colours[name], weight: 600, size: 14, align: first[2], or });
}

// How large a robot 0.6 m long is drawn, which has 27 px, where a metre has so many.
export const sizeAt = (scale) => scale * 0.6 / 27;

/**
 * The robot from above: two wheels, a body with a nose, the castor's lid, and a shadow. It is 27 px
 * long, times `size`.
 * @param {CanvasRenderingContext2D} ctx @param {Point} place @param {number} heading
 * @param {Colours} colours
 */
export function drawRobot(ctx, [x, y], heading, colours, size = 1) {
  const body = new Path2D(ROBOT.body);
  take(ctx, [x, y], 14 * size);
  ctx.save();
  ctx.translate(x, y);
  ctx.save(); // light falls from one side, wherever the robot looks
  ctx.translate(1.5 * size, 2.5 * size);
  ctx.rotate(-heading);
  ctx.scale(size, size);
  ctx.globalAlpha *= 0.2;
  ctx.fillStyle = '#000000';
  ctx.fill(body);
  ctx.restore();
  ctx.rotate(-heading);
  ctx.scale(size, size);
  ctx.fillStyle = colours.ink;
  ctx.fill(new Path2D(ROBOT.wheels));
  ctx.fillStyle = colours.path;
  ctx.fill(body);
  ctx.lineWidth = 1.6;
  ctx.strokeStyle = ctx.fillStyle = colours.paper;
  ctx.stroke(body);
  ctx.fill(new Path2D(ROBOT.nose));
  ctx.beginPath();
  ctx.arc(-8, 0, 2.2, 0, 2 * Math.PI);
  ctx.fill();
  ctx.restore();
}

// The sample of a run that is drawn nearest to a place on the screen, or null if none is near.
export function nearestOf(run, view, x, y) {
  return nearest(run ? run.n : 0, (k) => {
    const [px, py] = view.toScreen(run.x[k], run.y[k]);
    return Math.hypot(px - x, py - y);
  }, 20); // px
}

// On the goal itself the line of sight has no direction, and the angles mean nothing.
export const hasSight = (rho) => rho > 1e-6;

// rho along the line of sight; alpha at the robot, from its heading; theta at the goal, from the
// goal's heading: Fig. 2 of the paper.
export function drawAngles(ctx, view, pose, [rho, alpha, theta], aim, colours) {
  if (!hasSight(rho)) return;
  const robot = view.toScreen(pose[0], pose[1]), goal = view.toScreen(aim[0], aim[1]),
      sight = pose[2] + alpha;
  const ahead = ([x, y], angle, length) =>
      [x + length * Math.cos(angle), y - length * Math.sin(angle)];
  for (const [points, colour, dash] of [
    [[robot, goal], colours.rho, [2, 5]],
    [[robot, ahead(robot, pose[2], 58)], colours.alpha, [6, 4]],
    [[goal, ahead(goal, sight, 58)], colours.rho, [2, 5]],
    [[goal, ahead(goal, aim[2], 58)], colours.theta, [6, 4]],
  ]) {
    line(ctx, points, colour, 1.5, dash);
    takeAlong(ctx, points);
  }
  drawAngle(ctx, robot, pose[2], alpha, 36, 'α', colours.alpha, colours);
  const distance = Math.hypot(goal[0] - robot[0], goal[1] - robot[1]);
  // beyond the name of alpha
  drawAngle(ctx, goal, aim[2], theta, distance < 40 ? 72 : 46, 'θ', colours.theta, colours);
  if (distance > 90) {
    const side = alpha < 0 ? 12 : -12; // px; the other side of the line than alpha's arc
    const [first, ...or] = [0.5, 0.35, 0.65].map((share) =>
      [robot[0] + share * (goal[0] - robot[0]) + side * Math.sin(sight),
        robot[1] + share * (goal[1] - robot[1]) + side * Math.cos(sight), 'center']);
    label(ctx, 'ρ', first[0], first[1], colours,
        { colour: colours.rho, size: 17, weight: 600, align: 'center', or });
  }
}

/**
 * @param {CanvasRenderingContext2D} ctx @param {Point} place @param {number} from
 * @param {number} angle @param {number} radius @param {string} name @param {string} colour
 * @param {Colours} colours
 */
export function drawAngle(ctx, [x, y], from, angle, radius, name, colour, colours) {
  ctx.strokeStyle = colour;
  ctx.lineWidth = 3;
  ctx.beginPath();
  ctx.arc(x, y, radius, -from, -(from + angle), angle > 0);
  halo(ctx, colour);
  ctx.stroke();
  ctx.shadowBlur = 0;
  if (Math.abs(angle) * radius < 4) return; // px: there is nothing to name
  for (const share of [0.1, 0.3, 0.5, 0.7, 0.9]) {
    const along = from + share * angle;
    take(ctx, [x + radius * Math.cos(along), y - radius * Math.sin(along)], 4);
  }
  const [first, ...or] = [13, 30].flatMap((more) => [0, 1, -1].map((aside) => {
    const away = radius + more, at = from + angle / 2 + aside * (angle / 4 + 14 / away);
    return [x + away * Math.cos(at), y - away * Math.sin(at), 'center'];
  }));
  label(ctx, name, first[0], first[1], colours,
      { colour, size: 17, weight: 600, align: 'center', or });
}
