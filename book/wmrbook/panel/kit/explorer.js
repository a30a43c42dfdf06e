// Puts the parts together: reads the widget's traits, simulates, draws once a frame, and answers
// hands and keys.

import { buildHandles } from './handles.js';
import { held, made, onArrows, placeOn } from './hands.js';
import { RANGES, buildGainMap, drawMap, gainsAt, mapped } from './gain_map.js';
import { buildControls, keepKeys } from './controls.js';
import { buildFigures, figuresOf, sentenceOf } from './figures.js';
import {
  canLink, copied, csvOf, download, linkOf, pictureOf, pythonOf, stateInLink,
} from './share.js';
import { drawCharts, endOf, timeAxis } from './charts.js';
import { putGains } from './gains.js';
import { drawScene, hasSight, marksOf, nearestOf, viewOf, zoomOf } from './scene.js';
import { inDegrees, written } from './style.js';
import { forgetNames, repainted, sizeOf } from './surface.js';
import { within } from './numbers.js';
import { FARTHEST, NEAREST, applies, presetValues, runOf, settingsOf } from './settings.js';
import { summarise } from './simulate.js';
import { widget } from './widget.js';

const LASTS = 8; // s that playing a run takes at most
const GAINS = ['k_rho', 'k_alpha', 'h', 'v_max'];
const STEERING = ['k_rho', 'k_alpha', 'h', 'k_x', 'k_y', 'k_heading']; // below the picture
const RESTING = 0.3; // where on the run the cursor stands until somebody moves it

const RUN_BUTTONS = [ // what each does, is called, and says
  ['pin', 'Pin', 'keep this run on the picture, to compare the next with'],
  ['unpin', 'Unpin', 'forget the pinned run'],
  ['reset', 'Reset', 'back to how it was opened'],
  ['link', 'Link', 'copy a link to this page with the panel as it is now'],
  ['python', 'Python', 'copy this run as Python'],
  ['csv', 'CSV', 'save this run as a table'],
  ['png', 'PNG', 'save the picture'],
];
const ZOOM_BUTTONS = [
  ['out', '−', 'zoom out (Ctrl and the wheel)'],
  ['in', '+', 'zoom in on the robot (Ctrl and the wheel)'],
  ['near', 'last 2 m', 'the last two metres before the goal, or all of the path'],
];
const button = ([act, text, title]) =>
    `<button type="button" data-do="${act}" title="${title}">${text}</button>`;

function scaffold(el) {
  const root = made(el, 'div', { className: 'wmr' });
  root.dataset.lmSuppressShortcuts = 'true'; // keys are the panel's, not JupyterLab's
  root.innerHTML = `
    <div class="wmr-stage">
      <div class="wmr-status"></div>
      <div class="wmr-view">
        <div class="wmr-bar"><div class="wmr-polar"></div></div>
        <div class="wmr-plane"><canvas class="wmr-scene" role="img"></canvas>
          <div class="wmr-bar wmr-zoom">${ZOOM_BUTTONS.map(button).join('')}</div></div>
        <div class="wmr-steering"></div>
        <div class="wmr-bar wmr-play">${button(['play', 'Play', 'drive along the path'])}
          <input type="range" class="wmr-time" min="0" max="1" step="any"
            aria-label="time cursor"><output class="wmr-clock"></output></div>
      </div>
      <div class="wmr-side">
        <div class="wmr-bar"><div class="wmr-key"></div></div>
        <canvas class="wmr-charts" role="img"></canvas>
        <canvas class="wmr-map" role="img" tabindex="0" hidden></canvas>
        <div class="wmr-figures" role="list"></div>
      </div>
      <details class="wmr-more"><summary>More</summary>
        <div class="wmr-rows" role="group" aria-label="settings"></div>
        <div class="wmr-bar">${RUN_BUTTONS.map(button).join('')}</div></details>
    </div>
    <div class="wmr-aside" role="status" aria-live="polite"></div>`;
  return root;
}

function render({ model, el }) {
  const root = scaffold(el), find = (selector) => root.querySelector(selector),
      setup = model.get('setup');
  keepKeys(root);
  const [scene, charts, mapCanvas] = ['.wmr-scene', '.wmr-charts', '.wmr-map'].map(find);
  const showFigures = buildFigures(find('.wmr-figures')), gainMap = buildGainMap(() => schedule());
  const state = { run: null, settings: null, figures: null, trouble: '', said: '', ghost: null,
      playing: null, colours: null, view: null, held: false };
  let frame = 0, stale = true, spoken = 0, shownKey = '';

  const values = () => model.get('state');
  // The cursor and the zoom are the view's own: a kernel need not hear of each frame.
  const look = (from) => Object.assign(state, { time: from.time, zoom: from.zoom, playing: null });
  function write(changed) {
    model.set('state', { ...values(), ...changed });
    model.save_changes();
  }
  const schedule = () => { if (!frame) frame = requestAnimationFrame(draw); };
  const steers = ([name]) => STEERING.includes(name);
  const refuse = (sentence) => { state.said = sentence; schedule(); };
  const showGains = putGains(find('.wmr-steering'), setup.sliders.filter(steers).map(
      ([name, text, says, low, high, step]) => {
        const [, unit] = text.match(/\[(.*)\]/);
        return { name, says, low, high, step, unit: unit === '1' ? '' : unit };
      }),
      { get: (name) => values()[name], set: (name, value) => write({ [name]: value }), refuse });
  const others = { ...setup, sliders: setup.sliders.filter((each) => !steers(each)) };
  const showSettings = buildControls(find('.wmr-rows'), others, {
    change({ preset, ...changed }) {
      if (preset > 0) {
        const before = values().moving, left = state.run && state.run.rho[cursorOf(state.run)];
        write(presetValues(setup.presets[preset - 1], values(), setup));
        if (values().moving !== before) state.zoom = null; // of another scene
        compute();
        if (state.trouble) { // of a step that was refused
          write({ dt: setup.presets[0].dt });
          compute();
        }
        if (state.run && state.time !== null) { // as near to its goal as before
          const near = state.run.rho.findIndex((rho) => rho <= left);
          state.time = state.run.t.at(near); // or its end
        }
        if (state.playing) state.playing = { from: state.time, since: performance.now() };
      }
      else write(changed);
      showControls(); // the handle goes to the stop that was taken
    },
    refuse,
  });
  function showControls() {
    const now = values();
    showSettings(now);
    showGains(Object.fromEntries(STEERING.filter((name) => applies(name, now, setup))
        .map((name) => [name, now[name]])));
  }
  const placeHandles = buildHandles(find('.wmr-plane'), {
    get: (name) => values()[name], set: (name, pose) => write({ [name]: pose }),
        view: () => state.view,
    hold(holds) { state.held = holds; schedule(); },
  });

  function compute() {
    stale = false;
    const settings = settingsOf(values());
    let run;
    try { run = runOf(settings); } catch (error) { state.trouble = error.message; return; }
    const summary = summarise(run);
    Object.assign(state,
        { run, trouble: '', settings, figures: figuresOf(settings, run, summary),
        sentence: sentenceOf(settings, run, summary) });
  }

  function cursorOf(run) {
    const end = endOf(run),
        time = state.time === null ? RESTING * end : within(state.time, 0, end);
    return end > 0 ? Math.round(time / end * (run.n - 1)) : 0;
  }

  function draw(now) {
    frame = 0;
    if (stale) compute();
    advance(now);
    const { run, ghost, colours, settings } = state, faded = state.trouble !== '';
    const cursor = run ? cursorOf(run) : 0, ghostRun = ghost && ghost.run;
    const poses = settings
        ? { start: settings.start, goal: settings.reference ? null : settings.goal }
        : { start: [0, 0, 0], goal: [1, 0, 0] };
    if (!state.held || !state.view) {
      state.view = viewOf([run, ghostRun].filter(Boolean), marksOf(poses, run), poses,
          sizeOf(scene), state.zoom);
    }
    drawScene(scene, colours,
        { view: state.view, run, ghost: ghostRun, poses, cursor, faded, zoomed: state.zoom });
    // a finger moves the page, or the picture when it is zoomed
    scene.style.touchAction = state.zoom ? 'none' : '';
    placeHandles(poses);
    if (mapShown()) drawLandscape();
    else drawCharts(charts, colours, { run, ghost: ghostRun, cursor, faded });
    describe(run, cursor);
    root.dispatchEvent(new CustomEvent('drawn', { bubbles: true })); // for whoever measures
    if (state.playing) schedule();
  }

  function advance(now) {
    if (!state.playing || !state.run) return;
    const end = endOf(state.run), speed = Math.max(1, end / LASTS);
    // a frame's time is that of its beginning, before a click within it
    const passed = Math.max(now - state.playing.since, 0) / 1000;
    state.time = Math.min(state.playing.from + speed * passed, end);
    if (state.time >= end) state.playing = null;
  }

  const mapShown = () => values().view === 'gains';

  function drawLandscape() {
    const note = !state.settings ? 'no run yet' : mapped(state.settings) ? ''
        : 'This law does not use these gains.';
    if (!note) gainMap.update(state.settings, values().axes, values().metric);
    drawMap(mapCanvas, state.colours,
        { map: gainMap.map, gains: state.settings && state.settings.gains, note });
    mapCanvas.dataset.finished = String(note !== '' || gainMap.finished);
  }

  function describe(run, cursor) {
    const status = find('.wmr-status'), text = state.trouble || state.said || state.sentence || '';
    status.classList.toggle('wmr-trouble',
        state.trouble !== '' || state.said.includes('not allowed'));
    if (status.textContent !== text) { status.textContent = text; announce(text); }
    showKey();
    showFigures(state.trouble ? null : state.figures, state.ghost && state.ghost.figures);
    find('[data-do=play]').textContent = state.playing ? 'Pause' : 'Play';
    find('[data-do=unpin]').hidden = !state.ghost;
    find('[data-do=link]').hidden = !canLink();
    find('[data-do=near]').textContent = state.zoom ? 'whole path' : 'last 2 m';
    if (!run) return;
    const t = run.t[cursor], end = endOf(run), slider = find('.wmr-time');
    Object.assign(slider, { max: end || 1, value: t });
    slider.setAttribute('aria-valuetext', `${written(t, 's')} of ${written(end, 's')}`);
    find('.wmr-clock').textContent = `${t.toFixed(1)} of ${end.toFixed(1)} s`;
    const { rho, alpha, theta, ink } = state.colours,
        angle = (column) => inDegrees(hasSight(run.rho[cursor]) ? column[cursor] : NaN);
    find('.wmr-polar').innerHTML = [
      [rho, 'ρ', written(run.rho[cursor], 'm')], [alpha, 'α', angle(run.alpha)],
      [theta, 'θ', angle(run.theta)], [ink, 'v', written(run.v[cursor], 'm/s')],
      [ink, 'ω', written(run.omega[cursor], 'rad/s')],
    ].map(([colour, name, value]) =>
        `<span style="color: ${colour}"><b>${name}</b> ${value}</span>`).join('');
    scene.setAttribute('aria-label', `Path from start to goal. ${text}`);
    charts.setAttribute('aria-label',
        `Speed, turning rate, position errors and V over time. ${text}`);
    const { k_alpha, h, k_rho } = state.settings.gains;
    mapCanvas.setAttribute('aria-label',
        `Gain landscape; the gains are k_rho ${k_rho}, k_alpha ${k_alpha}, h ${h}; arrow keys ` +
        `change them. ${text}`);
  }

  // A screen reader hears where a drag ends, not each step of it.
  function announce(text) {
    clearTimeout(spoken);
    spoken = setTimeout(() => { find('.wmr-aside').textContent = text; }, 700);
  }

  function showKey() {
    const mark = (name, text) => `<span><i data-mark="${name}"></i>${text}</span>`;
    const pinned = state.ghost ? mark('pinned', 'pinned run') : '';
    const none = state.settings && state.settings.reference ? 'no value' : 'does not arrive';
    const text = mapShown()
      ? `<span>click the map to set the gains</span>${mark('never', none)}`
      : `${mark('run', 'run')}${pinned}${mark('rising', 'V rises')}`;
    if (text !== shownKey) find('.wmr-key').innerHTML = shownKey = text;
  }

  function follow() {
    charts.hidden = mapShown();
    mapCanvas.hidden = !mapShown();
    state.said = '';
    stale = true;
    showControls();
    schedule();
  }

  // Zooms by a factor about a place that stays where it is.
  /** @param {number} factor @param {Point} place */
  function zoomBy(factor, [x, y]) {
    const [cx, cy, reach] = state.zoom || zoomOf(state.view),
        next = within(reach * factor, NEAREST, FARTHEST), share = next / reach;
    state.zoom = [x + (cx - x) * share, y + (cy - y) * share, next];
    schedule();
  }
  const now = (...names) => names.map((name) => state.run[name][cursorOf(state.run)]);

  function copy(text, what) {
    state.said = copied(root, text) ? `Copied: ${what}.` : 'Press Ctrl+C to copy it.';
  }

  const acts = {
    play() {
      if (state.playing) { state.playing = null; return; }
      const end = endOf(state.run),
          time = state.time === null || state.time >= end ? 0 : state.time;
      state.playing = { from: time, since: performance.now() };
    },
    pin() {
      if (state.run && !state.trouble) state.ghost = { run: state.run, figures: state.figures };
    },
    unpin() { state.ghost = null; find('[data-do=pin]').focus(); }, // its own button goes
    reset() { state.ghost = null; forgetNames(root); look(setup.home); write(setup.home); },
    in() { if (state.run) zoomBy(1 / 1.5, now('x', 'y')); },
    out() { if (state.run) zoomBy(1.5, now('x', 'y')); },
    near() { state.zoom = state.zoom || !state.run ? null : [...now('goalX', 'goalY'), 2]; },
    link() {
      const link = linkOf(setup.home, { ...values(), time: state.time, zoom: state.zoom });
      history.replaceState(history.state, '', link);
      copy(link, 'a link to this page with the panel as it is now');
    },
    python() { if (state.settings) copy(pythonOf(state.settings), 'this run as Python'); },
    csv() {
      if (state.run) download('run.csv', new Blob([csvOf(state.run)], { type: 'text/csv' }));
    },
    png() {
      const shown = [scene, mapShown() ? mapCanvas : charts];
      pictureOf(shown, find('.wmr-status').textContent, state.colours)
          .then((blob) => download('run.png', blob));
    },
  };
  root.addEventListener('click', (event) => {
    const act = /** @type {any} */ (event.target).closest('[data-do]');
    if (act) { acts[act.dataset.do](); schedule(); }
  });
  find('.wmr-time').addEventListener('input', (event) => {
    Object.assign(state, { time: Number(event.target.value), playing: null });
    schedule();
  });

  held(charts, { drag(event) {
    const [x] = placeOn(charts, event);
    Object.assign(state,
        { time: timeAxis(sizeOf(charts).width, state.run, state.ghost && state.ghost.run).toTime(x),
        playing: null });
    schedule();
  } });
  scene.addEventListener('wheel', (event) => {
    if (!state.run || !(event.ctrlKey || event.metaKey)) return; // without, the wheel is the page's
    event.preventDefault();
    zoomBy(1.2 ** Math.sign(event.deltaY), state.view.toWorld(...placeOn(scene, event)));
  }, { passive: false });
  // the place in the plane that is held, where it was taken, and whether that was a tap
  let grip = null;
  held(scene, { take: () => state.view, drag(event, first) {
    const [x, y] = placeOn(scene, event);
    const [wx, wy] = state.view.toWorld(x, y);
    if (first) {
      grip = { wx, wy, x, y, tap: true };
      const k = nearestOf(state.run, state.view, x, y); // a tap on the path takes the robot there
      if (k !== null) Object.assign(state, { time: state.run.t[k], playing: null });
      schedule();
      return;
    }
    if (event.pointerType !== 'mouse' && !state.zoom) return;
    grip.tap &&= Math.hypot(x - grip.x, y - grip.y) < 4; // a hand trembles
    if (grip.tap) return;
    const [cx, cy, reach] = state.zoom || zoomOf(state.view);
    state.zoom = [cx + grip.wx - wx, cy + grip.wy - wy, reach];
    state.view = viewOf([], [], {}, sizeOf(scene), state.zoom);
    schedule();
  } });
  held(mapCanvas, {
    take: () => gainMap.map && mapped(state.settings),
    drag: (event) =>
      write(gainsAt(gainMap.map, sizeOf(mapCanvas), ...placeOn(mapCanvas, event))),
  });
  onArrows(mapCanvas, ([across, up]) => {
    const { map } = gainMap;
    if (!map) return false;
    const nudge = (name, by) => within(Math.round(values()[name] * 20 + by) / 20, 0, RANGES[name]);
    write({ [map.kx]: nudge(map.kx, across), [map.ky]: nudge(map.ky, up) });
    return true;
  });

  function visit() {
    let linked = {}, trouble = '';
    try { linked = stateInLink(setup); } catch (error) { trouble = error.message; }
    if (linked === null) return;
    look({ ...setup.home, ...linked });
    write({ ...setup.home, ...linked });
    if (trouble) state.said = `In the link, ${trouble}. The panel is as it was opened.`;
    schedule();
    root.scrollIntoView({ block: 'nearest' });
  }
  model.on('change:state', follow);
  addEventListener('hashchange', visit);
  look(values());
  const page = repainted(root, [root, scene, charts, mapCanvas], (colours) => {
    state.colours = colours;
    schedule();
  });
  follow();
  visit();
  return () => {
    removeEventListener('hashchange', visit);
    page.stop();
    gainMap.close();
    cancelAnimationFrame(frame);
    clearTimeout(spoken);
    model.off('change:state', follow);
  };
}

// In Python the gains are traits too, for `jslink`. The state keeps them, and the traits
// follow it before anything is sent, so that one message has both.
/** @param {Model} model */
function mirrorGains(model) {
  const followState = () =>
    GAINS.forEach((name) => model.set(name, model.get('state')[name]));
  model.on('change:state', followState);
  for (const name of GAINS) {
    model.on(`change:${name}`, () => {
      const state = model.get('state'), value = model.get(name);
      if (state[name] !== value) model.set('state', { ...state, [name]: value });
    });
  }
}

export default widget('explorer', render, mirrorGains);
