// The front page's picture: a lawn, a robot that drives to a pose, and a camera that follows it to
// the last metre. Both poses are handles, the gains one slider; the last drives stay as ghosts.

import { DEGREES, inDegrees, isCalm, written } from './style.js';
import { buildHandles } from './handles.js';
import { drawAngle, drawName, drawPath, drawPose, drawRobot, viewAt } from './scene.js';
import { drawLawn } from './lawn.js';
import { blended, driven, poseAt } from './runs.js';
import { label, line, repainted, sizeOf, surfaceOf } from './surface.js';
import { made } from './hands.js';
import { putSlider, stopsOf } from './controls.js';
import { widget } from './widget.js';
import { within } from './numbers.js';
import { wrap } from './model.js';

const DRIVE = 4000, LOOK = 2200, MEND = 1500; // ms: a drive, what it came to, the slider's glide
const ROBOT = 0.6, ICON = 27; // m and px, the robot's length and that of its drawing
const NEAR = 1.25; // m from the goal to the picture's edge, at last
const PARKED = 3 / DEGREES; // rad off, which nobody sees
const STOPS = stopsOf(0, 1, 0.02);
const ease = (share) => share * share * (3 - 2 * share);

function render({ model, el }) {
  const root = made(el, 'div', { className: 'wmr front' }),
      { start, goal, paper, gentle } = model.get('setup');
  const host = made(root, 'div', { className: 'front-scene' }),
      canvas = made(host, 'canvas', {}, { role: 'img' }),
      words = made(root, 'p', { className: 'front-words' }),
      row = made(root, 'div', { className: 'wmr-control front-row' });
  const poses = { start, goal };
  let ghosts = [];
  const still = isCalm();
  let colours, share = model.get('state').share, run, off, view, whole = true, begin = 0, at = 0,
      near = 0, frame = 0, later = 0, mending = !still, holds = false,
      stays = false; // whoever wants to see the whole way goes on seeing it

  const drive = () => {
    run = driven({ ...poses, gains: blended(paper, gentle, share) });
    off = Math.abs(wrap(run.heading[run.n - 1] - poses.goal[2]));
  };
  const keep = () => { ghosts = [...ghosts, run].slice(-3); };

  made(row, 'span', { textContent: 'paper’s gains' });
  const showSlider = putSlider(row, 'gains, from the paper’s to gentle ones', STOPS,
      { get: () => share, set(value) { byHand(); change(value); end(); } });
  made(row, 'span', { textContent: 'gentle gains' });
  const again = made(row, 'button', { type: 'button', textContent: 'Drive again' });
  const zoom = made(row, 'button', { type: 'button' });
  again.addEventListener('click', () => { byHand(); keep(); play(); });
  zoom.addEventListener('click', () => { byHand(); stays = whole = !whole; move(); });
  const handles = buildHandles(host, {
    get: (name) => poses[name],
    set(name, pose) { byHand(); poses[name] = pose; drive(); end(); },
    view: () => view,
    hold(on) { holds = on; if (on) keep(); else play(); },
  });

  // What a hand does ends what plays by itself.
  function byHand() { mending = false; clearTimeout(later); }
  function change(value) { share = value; model.set('state', { share }); drive(); }
  function end() { at = run.n - 1; begin = 0; draw(); }
  function play() {
    if (still) { whole = stays; end(); move(); return; }
    [at, whole, begin] = [0, true, performance.now()];
    move();
  }
  function move() { frame ||= requestAnimationFrame(step); }

  function step(now) {
    frame = 0;
    if (begin) {
      const passed = within((now - begin) / DRIVE, 0, 1), last = run.n - 1;
      // as a film that slows down towards its end
      at = Math.round((1 - (1 - passed) ** 2) * last);
      if (run.rho[at] < 12 && !stays) whole = false;
      if (passed === 1) { begin = 0; if (mending) later = window.setTimeout(mend, LOOK); }
    }
    const to = whole ? 0 : 1, speed = still ? 1 : 0.035;
    near = Math.abs(to - near) < speed ? to : near + Math.sign(to - near) * speed;
    draw();
    if (begin || near !== to) move();
  }
  // The slider goes over to the gentle gains, and they drive.
  function mend() {
    mending = false;
    keep();
    const from = share, first = performance.now();
    const glide = (now) => {
      const done = within((now - first) / MEND, 0, 1);
      change(STOPS[Math.round((from + ease(done) * (1 - from)) * (STOPS.length - 1))]);
      if (done < 1) { end(); frame = requestAnimationFrame(glide); } else { frame = 0; play(); }
    };
    frame = requestAnimationFrame(glide);
  }

  function look({ width, height }) {
    const box = { left: 0, top: 0, width, height }, { zoom: units } = sizeOf(canvas);
    const xs = [poses.start[0], poses.goal[0]], ys = [poses.start[1], poses.goal[1]];
    const reach = Math.max(Math.abs(xs[0] - xs[1]) / (0.55 * width),
        Math.abs(ys[0] - ys[1]) / (0.66 * height), 0.02);
    const far = 1 / reach, close = Math.min(width, height) / 2 / NEAR, t = ease(near);
    const scale = far * (close / far) ** t, mid = (a, b, k) => a + (b - a) * k;
    // the goal stays where the eye is while the scale grows
    const centre = [width * (width > 640 ? 0.66 : 0.5), height * (width > 640 ? 0.53 : 0.6)];
    const slide = (far / scale) * (1 - t);
    const middle = [mid(poses.goal[0], mid(...xs, 0.5), slide),
        mid(poses.goal[1], mid(...ys, 0.5), slide)];
    return viewAt(box, units, scale, middle, centre);
  }
  function draw() {
    const { ctx, width, height } = surfaceOf(canvas, colours);
    if (width < 2) return;
    if (!holds || !view) view = look({ width, height });
    drawLawn(ctx, view, colours);
    const icon = Math.max(view.scale * ROBOT / ICON, 1), done = at === run.n - 1 && !begin;
    for (const { x, y, n } of ghosts) drawPath(ctx, view, x, y, n, colours.ghost, 1.5, [2, 5]);
    drawPath(ctx, view, run.x, run.y, at + 1, colours.path, 3);
    ctx.globalAlpha = 0.35;
    drawRobot(ctx, view.toScreen(poses.goal[0], poses.goal[1]), poses.goal[2], colours, icon);
    ctx.globalAlpha = 1;
    drawPose(ctx, view, poses.start, 'start', colours);
    const pose = poseAt(run, at), place = view.toScreen(pose[0], pose[1]);
    drawRobot(ctx, place, pose[2], colours, icon);
    drawPose(ctx, view, poses.goal, 'goal', colours); // on the robot that stands on it
    if (done && !whole && off > PARKED) { // from the way it looks to the way it should
      const radius = 25 * icon, ahead = [place[0] + 1.2 * radius * Math.cos(pose[2]),
        place[1] - 1.2 * radius * Math.sin(pose[2])];
      line(ctx, [place, ahead], colours.rising, 3, [3, 7]);
      drawAngle(ctx, place, pose[2], wrap(poses.goal[2] - pose[2]), radius,
          inDegrees(off, 0), colours.rising, colours);
    }
    for (const name of ['start', 'goal'])
      drawName(ctx, view, poses[name], name, colours);
    const times = icon * ICON / view.scale / ROBOT;
    label(ctx, times > 1.5 ? `the robot is drawn ${written(times, '', 2)} times its size`
        : 'the robot is drawn to scale', width - 12, height - 14, colours,
    { colour: colours.soft, align: 'right' });
    say(done);
    if (!matchMedia('print').matches)
      label(ctx, 'drag a circle or an arrow', width - 12, height - 34, colours,
          { colour: colours.soft, align: 'right' });
    const inView = (name) => {
      const [x, y] = view.toScreen(poses[name][0], poses[name][1]);
      return x > 0 && x < width && y > 0 && y < height ? poses[name] : null;
    };
    handles({ start: inView('start'), goal: inView('goal') });
  }
  function say(done) {
    const arrived = run.outcome === 'ARRIVED';
    words.textContent = 'It is told where to stop and which way to face. '
        + `${share < 0.5 ? 'With the paper’s gains' : 'With gentler gains'} it ${!done ? 'drives …'
          : !arrived ? 'has not arrived after a minute.'
            : off < PARKED ? 'parks.' : `arrives and faces ${inDegrees(off, 0)} the wrong way.`}`;
    canvas.setAttribute('aria-label', 'A lawn from above, with a robot on its way from a start to '
        + `a goal ${written(Math.hypot(poses.goal[0] - poses.start[0],
          poses.goal[1] - poses.start[1]), 'm')} away. ${done ? words.textContent : ''}`);
    showSlider(share, share < 0.5 ? 'the paper’s gains' : 'gentle gains');
    zoom.textContent = whole ? 'The last metre' : 'The whole way';
    root.dataset.done = String(done && !mending && !frame);
  }

  drive();
  const page = repainted(root, [canvas], (read) => { colours = read; draw(); });
  play();
  return () => {
    page.stop();
    byHand();
    cancelAnimationFrame(frame);
  };
}

export default widget('front', render);
