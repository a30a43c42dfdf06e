// A rover with mass beside the kinematic robot: one law drives both, and MuJoCo moves one of them.

import { inDegrees, inWords, isCalm, written } from './style.js';
import { arcStep, fastestWheel, polarFromPose, saturationScale, wrap } from './model.js';
import { bodyAt, loadedEngine } from './rover_body.js';
import { controlLaw } from './law.js';
import { keepKeys, putSlider, stopsOf } from './controls.js';
import { made } from './hands.js';
import { paneOf } from './board.js';
import { freshRun, poseAt } from './runs.js';
import { repainted } from './surface.js';
import { widget } from './widget.js';

const AT_ONCE = 12; // ms of a frame that the physics may take
const SLOW = 0.3; // m/s, below which a slip angle says little
const LIFTED = 1, CALM = 0.3; // N; the share by which a load follows what it is in a period
const NEAR = 2.2, AWAY = 40; // m about start and goal that are seen at first, and at most

function render({ model, el }) {
  const root = made(el, 'div', { className: 'wmr rover' }), rules = model.get('setup'),
      { start, goal, period, radius, track } = rules;
  keepKeys(root);
  const scene = made(root, 'div', { className: 'rover-scene' }),
      canvases = ['rover-plan', 'rover-side'].map((className) =>
        made(scene, 'canvas', { className }, { role: 'img' }));
  const words = made(root, 'p', { className: 'rover-words' }, { role: 'status' }),
      bar = made(root, 'div', { className: 'wmr-bar' }),
      rows = made(root, 'div', { className: 'wmr-rows' });
  const still = isCalm();
  let colours, mujoco = null, body = null, before = 0, frame = 0, speed = 1, ideal, path, k, told,
      rim, ended, worst, carried, trouble;
  const state = () => model.get('state');

  const button = (textContent, onclick, attributes = {}) =>
      made(bar, 'button', { type: 'button', textContent, onclick }, attributes);
  const loader = button('Give it a body (MuJoCo, 3.5 MB)', async () => {
    loader.disabled = true;
    const asked = performance.now();
    words.textContent = 'MuJoCo is loading …';
    try {
      mujoco = await loadedEngine();
      const held = document.activeElement === loader;
      loader.hidden = true;
      if (held) again.focus(); // a keyboard goes on from there
      restart();
      root.dataset.ready = String(performance.now() - asked); // ms, for tests
    } catch (error) {
      [trouble, loader.disabled] = [`${error.message}.`, false];
      draw();
    }
  });
  const again = button('Drive again', restart);
  const faster = button('Four times as fast', () => {
    speed = speed === 1 ? 4 : 1;
    faster.setAttribute('aria-pressed', String(speed === 4));
  }, { 'aria-pressed': 'false' });
  const shows = rules.sliders.map(([name, text, unit, low, high, by]) => {
    const row = made(rows, 'label', { className: 'wmr-control' });
    made(row, 'span', { textContent: text });
    const show = putSlider(row, text, stopsOf(low, high, by), {
      get: () => state()[name],
      set(value) {
        model.set('state', { ...state(), [name]: value });
        model.save_changes();
      },
    });
    const output = made(row, 'output', { className: 'rover-value' });
    return () => {
      output.textContent = `${inWords(state()[name])}${unit === '°' ? '' : ' '}${unit}`.trim();
      show(state()[name], output.textContent);
    };
  });

  function restart() {
    body?.free();
    body = mujoco && bodyAt(mujoco, rules, { ...rules.rover, ...state() });
    ideal = freshRun({ start, goal, gains: state(), method: 'arc', dt: period,
      duration: rules.longest, arrivalRadius: rules.arrival,
      wheels: { track_width: track, max_speed: rules.fastest } });
    [path, k, before, told, rim, carried, ended, trouble, worst] =
        [[], 0, 0, 0, NEAR, null, false, '', { slip: 0, load: Infinity }];
    shows.forEach((show) => show());
    root.dataset.done = 'false';
    frame ||= requestAnimationFrame(move);
  }

  // A period begins: what the law tells the wheels.
  function command() {
    const pose = body.pose(), polar = polarFromPose(pose[0], pose[1], pose[2], ...goal),
        loads = body.loads(), [ahead, side] = body.speeds();
    path.push(pose);
    carried = carried ? carried.map((it, i) => it + CALM * (loads[i] - it)) : loads;
    worst.load = Math.min(worst.load, ...carried);
    if (Math.abs(ahead) > SLOW)
      worst.slip = Math.max(worst.slip, Math.abs(Math.atan2(side, Math.abs(ahead))));
    ended = polar[0] <= rules.arrival || polar[0] > AWAY || time() >= rules.longest;
    const [v, omega] = controlLaw(...polar, state()),
        share = saturationScale(rules.fastest, fastestWheel(v, omega, track));
    told = Math.min(Math.abs(share * v), told + rules.rover.acceleration * period);
    body.tell(Math.sign(v) * told, share * omega);
  }
  const time = () => k * rules.rover.timestep;
  function move(now) {
    frame = 0;
    const passed = still ? Infinity : before ? Math.min((now - before) / 1000, 0.1) * speed : 0,
        until = performance.now() + AT_ONCE, to = time() + passed;
    before = now;
    const last = ideal.t[ideal.n - 1];
    while (!ended && time() < to && performance.now() < until) {
      if (!body) {
        k += 1;
        ended = time() >= last;
      } else {
        if (k % body.steps === 0) command();
        if (!ended) { body.step(); k += 1; }
      }
    }
    draw();
    if (!ended) frame = requestAnimationFrame(move);
    else root.dataset.done = 'true';
  }

  function draw() {
    const last = ideal.n - 1, at = Math.min(time() / period, last), j = Math.floor(at);
    const [x, y, heading] = poseAt(ideal, j), own = body ? body.pose() : null,
        now = arcStep(x, y, heading, ideal.v[j], ideal.omega[j], j < last ? (at - j) * period : 0);
    const across = [start[0], goal[0]], up = [start[1], goal[1]];
    const out = (value, ends) => Math.max(Math.min(...ends) - value, value - Math.max(...ends));
    if (own) while (rim < AWAY && Math.max(out(own[0], across), out(own[1], up)) > rim) rim *= 1.5;
    const range = (ends) => /** @type {Axis} */
      ([Math.min(...ends) - rim, Math.max(...ends) + rim]);
    const plan = paneOf(canvases[0], colours,
        { x: range(across), y: range(up), lawn: rim > NEAR ? true : 1, alt: '' });
    const size = Math.max(0.5 * plan.view.scale / 27, 0.8);
    plan.path(ideal.x, ideal.y, 'ghost', { width: 2, dash: [2, 5], to: j + 1 });
    plan.line(path, 'path', { width: 3 });
    plan.pose(start, 'start');
    plan.pose(goal, 'goal');
    plan.robot(now, own ? 0.45 : 1, { size, role: own ? 'ghost' : 'path' });
    if (own) plan.robot(own, 1, { size });
    plan.name();
    drawSides();
    say(last);
  }

  // From behind and from the left: the wheels, the load, and what each of three carries.
  function drawSides() {
    const pane = paneOf(canvases[1], colours, { x: [-0.6, 0.6], y: [-1.2, 0.66], equal: true,
      bare: true, alt: '' });
    const { height } = state(), [z, roll, pitch] = body ? body.lean() : [radius, 0, 0],
        loads = carried || [];
    const view = (foot, title, angle, shapes) => {
      const place = ([x, y]) => [x * Math.cos(angle) - y * Math.sin(angle),
        foot + z + x * Math.sin(angle) + y * Math.cos(angle)];
      pane.line([[-0.55, foot], [0.55, foot]], 'soft', { width: 2 });
      for (const [role, points] of shapes) {
        pane.area(points.map(place), role, 0.8);
        pane.line([...points, points[0]].map(place), role, { width: 1.5 });
      }
      pane.text(title, 0, foot - 0.2, { role: 'soft', align: 'center' });
    };
    const box = (x, y, wide, high) => [[x - wide, y - high], [x + wide, y - high],
      [x + wide, y + high], [x - wide, y + high]];
    const ring = (x, y, r) => Array.from({ length: 24 }, (_, i) =>
      [x + r * Math.cos(i * Math.PI / 12), y + r * Math.sin(i * Math.PI / 12)]);
    const ink = (i) => (loads[i] < LIFTED ? 'rising' : 'ink'), top = height - radius;
    view(0, 'from behind', roll, [['soft', box(0, top / 2, 0.02, top / 2)],
      ['path', box(0, top, 0.18, 0.08)],
      [ink(0), box(-track / 2, 0, 0.03, radius)], [ink(1), box(track / 2, 0, 0.03, radius)]]);
    view(-0.95, 'from the right', -pitch, [['soft', box(-0.1, top / 2, 0.02, top / 2)],
      ['path', box(-0.1, top, 0.25, 0.08)],
      ['ink', ring(0, 0, radius)], [ink(2), ring(-0.4, -radius / 2, radius / 2)]]);
    const name = (side, i, x, y) => {
      const load = loads[i] < LIFTED ? 'lifts' : written(loads[i], 'N', 2);
      if (carried) pane.text(`${side} ${load}`, x, y, { role: ink(i), align: 'center' });
    };
    name('left', 0, -0.3, -0.09);
    name('right', 1, 0.3, -0.09);
    name('castor', 2, -0.35, -1.04);
  }

  function say(last) {
    const off = (pose) => inDegrees(Math.abs(wrap(pose[2] - goal[2]))), own = body && body.pose();
    const whole = 'The kinematic robot ' + (ideal.outcome === 'ARRIVED'
      ? `arrives after ${written(ideal.t[last], 's')} and faces ${off(poseAt(ideal, last))} off`
      : 'does not arrive');
    const far = own && Math.hypot(own[0] - goal[0], own[1] - goal[1]);
    const arrived = own && ended && far <= rules.arrival;
    const said = !own ? `${whole}.` : !ended
      ? `${written(time(), 's')}: the rover slips by at most ${inDegrees(worst.slip)}, and `
        + `its lightest wheel carried ${written(worst.load, 'N', 2)}.`
      : `${whole}; the rover ${arrived ? `after ${written(time(), 's')}, ${off(own)} off`
        : 'does not arrive'}. It slipped by up to ${inDegrees(worst.slip)}; its lightest wheel `
        + `${worst.load < LIFTED ? 'lifted' : `carried ${written(worst.load, 'N', 2)}`}.`;
    if (words.textContent !== (trouble || said)) words.textContent = trouble || said;
    canvases[0].setAttribute('aria-label', `The plan: ${said}`);
    canvases[1].setAttribute('aria-label', 'The rover from behind and from the right'
      + `${body ? `, leaning by ${inDegrees(Math.hypot(...body.lean().slice(1)))}` : ''}.`);
    Object.assign(root, { found: { path, ideal, time: time(), worst, arrived } });
  }

  model.on('change:state', restart);
  restart();
  const page = repainted(root, [root], (read) => { colours = read; draw(); });
  return () => {
    page.stop();
    model.off('change:state', restart);
    cancelAnimationFrame(frame);
    body?.free();
  };
}

export default widget('rover', render);
