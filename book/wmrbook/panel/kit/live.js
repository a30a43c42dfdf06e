// A small thing to move: pictures, a sentence with numbers that can be dragged or typed, a slider
// for each, and, before it opens, a prediction.

import { NARROW, fitted, widestOf } from './layout.js';
import { buildGate } from './gate.js';
import { held, made, placeOn } from './hands.js';
import { inWords, isCalm, written } from './style.js';
import { keepKeys } from './controls.js';
import { paneOf } from './board.js';
import { putBox } from './box.js';
import { putKnobs } from './knobs.js';
import { putSteps } from './steps.js';
import { repainted } from './surface.js';
import { showHandles } from './grips.js';
import { widget } from './widget.js';
import { within } from './numbers.js';

const REST = 700; // ms between two moves of a knob after which the next is a new run
const GHOSTS = 2;

// An explorable is, in a file of its own,
//   panes(values, found, setup, hidden): the panes by name, see board.js, with `alt`, what it shows
//     in words, `main` for the one that stands with the sliders on a telephone (else the first),
//     and `scrub(x, y, moved, values, found)`: what a
//     pointer on it changes, or nothing; `moved` is [dx, dy] since the last call while it is held,
//     or null while it passes over;
//   find(values, setup): what follows from the knobs; throws RangeError, in words, where nothing
//   does; draw(panes, values, found, hidden, setup): `hidden` before the prediction, when only what
//   is given may be drawn, in each pane something, and `values` are the first ones; say(values,
//   found, setup): the results in the sentence, by name;
//   handles(values, found, setup): [{ id, pane, at: [x, y], says, move(x, y): what changes; throws
//   RangeError, in words, where nothing can }].
/** @param {string} name @param {Drawing} explorable */
export const live = (name, explorable) => widget(`live/${name}`, ({ model, el }) => {
  const setup = structuredClone(model.get('setup')),
      root = made(el, 'div', { className: 'wmr live' });
  root.dataset.open = String(!setup.ask);
  keepKeys(root);
  root.innerHTML =
      '<div class="live-ask"></div><div class="live-panes"></div>'
    + '<div class="live-rows" role="group" aria-label="controls"></div>'
    + '<p class="live-sentence"></p><p class="live-trouble" role="alert"></p>'
    + '<div class="wmr-aside" role="status" aria-live="polite"></div>';
  const find = (selector) => root.querySelector(selector), canvases = {},
      values = () => model.get('state');
  const home = Object.fromEntries(setup.knobs.map(({ name, value }) => [name, value]));
  let frame = 0, spoken = 0, colours = null, found = null, refused = '', specs = {};
  let ghosts = {}, changed = -REST; // paths of the runs before, by pane; when a knob last moved
  let steps = null;
  const panes = {};
  const keep = () => {
    const now = performance.now(), rested = now - changed > REST;
    changed = now;
    for (const [name, { trail }] of Object.entries(rested ? panes : {})) {
      const [last = []] = ghosts[name] ||= [];
      if (trail.length && JSON.stringify(trail) !== JSON.stringify(last))
        ghosts[name] = [trail, ...ghosts[name]].slice(0, GHOSTS);
    }
  };
  const schedule = () => { if (!frame) frame = requestAnimationFrame(draw); };
  // a hand stops what plays; a kernel hears where it ends
  const set = (changes, playing = false) => {
    refused = '';
    if (!playing) knobs.stop();
    if (changes && Object.keys(changes).some((each) => each !== 'time' && each in home)) {
      keep();
      if (!playing) steps?.leave(); // what an idea says is said of where it put the knobs
    }
    if (changes) model.set('state', { ...values(), ...changes });
    if (changes && !playing) model.save_changes();
    schedule();
  };
  const refuse = (sentence) => { knobs.stop(); refused = sentence; schedule(); };
  const give = (change, atOnce = false) => {
    try {
      const changes = change() || {};
      for (const { name, low, high, says, symbol, unit } of setup.knobs) {
        if (low !== undefined && name in changes
            && !(changes[name] >= low && changes[name] <= high))
            throw new RangeError(
                `${symbol || says} would be ${written(changes[name], unit)}; ${inWords(low)} to ` +
                `${inWords(high)} is allowed.`);
      }
      set(changes);
    } catch (error) { if (!(error instanceof RangeError)) throw error; refuse(error.message); }
    if (atOnce) { cancelAnimationFrame(frame); draw(); } // the next key goes on from here
    return !refused;
  };
  const say = () => {
    clearTimeout(spoken);
    spoken = setTimeout(() => {
      find('.wmr-aside').textContent = find('.live-sentence').textContent
          ? [...root.querySelectorAll('.live-result')].map((each) => each.textContent).join(', ')
          : '';
    }, 700);
  };
  const knobs = putKnobs(root, setup, { get: values, set, refuse, changed: say });
  const announce = (text) => {
    clearTimeout(spoken);
    find('.wmr-aside').textContent = text;
  };
  const ask = find('.live-ask'), box = putBox(ask, announce),
      after = box.row('live-steps', 'ideas');
  ask.hidden = !setup.ask && !setup.steps.length;
  steps = setup.steps.length ? putSteps(box, after, setup.steps, (k) => {
    setup.step = k;
    knobs.stop();
    // what it says is said of the other knobs where they were at first
    const { time, ...to } = { ...home, ...setup.steps[k].to };
    if (isCalm()) set(time === undefined ? to : { ...to, time: 1 });
    else knobs.glide([to], () => set({}));
  }) : null;
  const gate = setup.ask
      ? buildGate(ask, box, after, setup.ask,
      { get: values, set, panes: () => panes, host: (name) => canvases[name].parentElement,
      way: () => found.run, reveal, close, announce })
      : null;
  if (!gate) box.show(null, after);
  function close() {
    steps?.leave();
    set({ ...home });
    ghosts = {};
    delete setup.step;
  }

  // The picture goes from what was given to what was asked, place by place, and then it plays.
  function reveal(moving) {
    const asked = setup.ask.asked || [];
    if (!moving || isCalm()) set(Object.assign({}, ...asked));
    else {
      set({});
      knobs.glide(asked, () => set({}));
    }
  }

  function build(name, spec) {
    const host = made(find('.live-panes'), 'div',
        { className: `live-pane${spec.main ? ' live-main' : ''}` }),
        canvas = canvases[name] = made(host, 'canvas', {}, { role: 'img' });
    const scrub = (event, moved) => {
      if (!specs[name].scrub || !panes[name] || !found || (gate && !gate.open())) return;
      const [x, y] = panes[name].view.toWorld(...placeOn(canvas, event));
      const changes = specs[name].scrub(x, y, moved, values(), found);
      // what passes over a picture only moves the robot
      if (changes && (moved || (Object.keys(changes).every((each) => each === 'time')
          && !knobs.moving()))) set(changes);
    };
    let last = null;
    held(canvas, {
      take: () => specs[name].scrub,
      drag(event, first) {
        const { clientX, clientY } = event,
            moved = first ? [0, 0] : [clientX - last[0], clientY - last[1]];
        last = [clientX, clientY];
        scrub(event, moved);
      },
      drop() { last = null; },
    });
    canvas.addEventListener('pointermove', (event) => { if (!last) scrub(event, null); });
    page.watch(canvas);
  }
  function draw() {
    frame = 0;
    if (!colours) return;
    const hidden = Boolean(gate && !gate.open()),
        now = hidden ? { ...values(), ...home } : values();
    let trouble = refused, sound = true;
    try { found = explorable.find(now, setup); } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      [trouble, sound] = [error.message, false];
    }
    if (found) paint(now, hidden);
    // words after pictures: a font on a canvas waits for the styles of all that has changed
    find('.live-trouble').textContent = hidden && found ? '' : trouble;
    knobs.show(now);
    if (!found) return;
    const handles = hidden ? [] : explorable.handles ? explorable.handles(now, found, setup) : [];
    for (const name of Object.keys(specs))
      showHandles(canvases[name].parentElement, handles.filter((each) => each.pane === name),
          panes[name], give);
    if (!hidden) knobs.showResults(sound ? explorable.say(now, found, setup) : null);
  }
  function paint(now, hidden) {
    root.found = found; // for tests
    const first = !Object.keys(specs).length;
    specs = explorable.panes(now, found, setup, hidden);
    for (const [name, spec] of Object.entries(specs)) {
      if (!canvases[name]) build(name, spec);
      canvases[name].setAttribute('aria-label', hidden ? spec.given || 'what is given' : spec.alt);
      canvases[name].style.cursor = spec.scrub && !hidden ? 'crosshair' : '';
      const pane = panes[name] = paneOf(canvases[name], colours, spec);
      if ((spec.equal || spec.lawn) && !spec.bare && spec.ghosts !== false && !hidden) {
        pane.ctx.globalAlpha = 0.3;
        (ghosts[name] || []).flat().forEach((path) => pane.line(path));
        pane.ctx.globalAlpha = 1;
      }
      pane.trail.length = 0;
    }
    if (first) {
      if (!root.querySelector('.live-main'))
        root.querySelector('.live-pane').classList.add('live-main');
      place();
    }
    if (gate) gate.draw(); // first, for names keep clear of a guess
    explorable.draw(panes, now, found, hidden, setup);
    Object.values(panes).forEach((pane) => pane.name());
    if (!gate) root.dataset.open = 'true';
  }
  // The sentence keeps the room that it takes anywhere on a knob's way, and that it once took.
  const sentence = find('.live-sentence'), SHARES = [0, 0.11, 0.23, 0.37, 0.5, 0.63, 0.77, 0.89, 1];
  let wide = 0, trying = 0;
  const heightOf = (it) => it.getBoundingClientRect().height, high = () => heightOf(sentence);
  const tryAll = () => {
    // what is being typed would be lost
    if (root.querySelector('.live-number:focus')) { trying = setTimeout(tryAll, 1000); return; }
    const heights = [high()];
    for (const { name, choices, stops } of setup.knobs) {
      for (const value of choices ? choices.map(([each]) => each)
          : SHARES.map((share) => stops[Math.round(share * (stops.length - 1))])) {
        const then = { ...values(), [name]: value };
        try {
          knobs.showResults(explorable.say(then, explorable.find(then, setup), setup));
        } catch (error) { if (!(error instanceof RangeError)) throw error; }
        knobs.show(then);
        heights.push(high());
      }
    }
    sentence.style.minHeight = `${Math.max(...heights)}px`;
    place();
    draw();
    root.dataset.settled = 'true'; // for tests
  };
  // The pictures have the room that all else leaves in the window, or on a slide.
  const host = find('.live-panes'), slide = root.closest('.page');
  function place() {
    const n = Object.keys(specs).length, width = sentence.clientWidth;
    if (!n || !width) return;
    const room = slide ? host.clientHeight
        : within(innerHeight - 130, 420, 720) - (heightOf(root) - heightOf(host));
    const [spec] = Object.values(specs), best = !slide && width < NARROW
        ? { columns: 1, width, height: Math.min(0.42 * innerHeight, 1.2 * width) }
        : fitted(n, slide ? host.clientWidth : width, Math.max(room, 180),
            n === 1 ? widestOf(spec) : undefined);
    for (const [name, value] of Object.entries(
      { columns: best.columns, wide: `${best.width}px`, high: `${best.height}px` }))
      host.style.setProperty(`--${name}`, value);
  }
  const room = new ResizeObserver((entries) => {
    for (const { target, contentRect: { width } } of entries) {
      if (target === host) { if (slide) place(); continue; }
      sentence.style.minHeight = width === wide ? `${high()}px` : '';
      place();
      if (width === wide) continue;
      wide = width;
      clearTimeout(trying);
      delete root.dataset.settled;
      if (width) trying = setTimeout(tryAll, 300);
    }
  });
  room.observe(sentence);
  room.observe(host);
  addEventListener('resize', place);
  const page = repainted(root, [root], (read) => { colours = read; schedule(); });
  model.on('change:state', schedule);
  return () => {
    knobs.stop();
    page.stop();
    room.disconnect();
    removeEventListener('resize', place);
    clearTimeout(trying);
    cancelAnimationFrame(frame);
    clearTimeout(spoken);
    model.off('change:state', schedule);
  };
});
