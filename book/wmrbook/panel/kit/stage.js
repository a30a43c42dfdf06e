// The stage of a chapter: a lawn, robots that drive on it, the few handles that the chapter is
// about, and scenes that its sections name. A page docks it beside the text where there is room,
// see book/_static/docking.js.

import { DEGREES, inDegrees, inWords, isCalm } from './style.js';
import { buildHandles } from './handles.js';
import { keepKeys } from './controls.js';
import { made } from './hands.js';
import { paneOf } from './board.js';
import { putGains } from './gains.js';
import { putSymbol } from './symbols.js';
import { repainted, sizeOf } from './surface.js';
import { sizeAt } from './scene.js';
import { widget } from './widget.js';
import { within } from './numbers.js';
import { wrap } from './model.js';

const DRIVE = 4000, FLIGHT = 1100; // ms: a drive, and the camera's way from one scene to the next
const FOOT = 40; // px below, for the buttons and the scale
const NEAR = 1.25, MARGIN = 5; // m round the goal seen from near, and round all of a drive
const PARKED = 2 / DEGREES; // rad off, which nobody sees
const ease = (share) => share * share * (3 - 2 * share);

/**
 * A chapter gives, in a file of its own,
 *   find(values, setup): what follows from the knobs: { tracks, ... }, each track { t, x, y,
 *     heading, n, role, share }, the robot's samples in time, in seconds, metres and radians, its
 *     colour, and how opaque it is if less than wholly; throws RangeError, in words, where nothing
 *     follows;
 *   say(values, found, setup): the results in the sentences, by name;
 *   look(values, found, setup, how): what the camera shows, [left, bottom, right, top] in metres,
 *     where that is neither all of the way ("whole") nor the goal ("near");
 *   corner(values, found, size, scene): the { width, height } in pixels of a small picture that it
 *     draws into the upper left corner, or nothing; the camera keeps out of it;
 *   draw(pane, values, found, now, setup): what is on the lawn beside paths and robots; `now` has
 *     the time, the scene, what it `shows`, the first robot's `pose` and its sample
 *     `k`, and the `poses` of all;
 *   above(the same): what is above the robots.
 * @param {string} name @param {Play} play
 */
export const stage = (name, play) => widget(`stages/${name}`, ({ model, el }) => {
  const setup = structuredClone(model.get('setup')),
      root = made(el, 'div', { className: 'wmr stage' });
  keepKeys(root);
  const say = made(root, 'div', { className: 'stage-say' }, { 'aria-live': 'polite' }),
      host = made(root, 'div', { className: 'stage-view' }),
      canvas = made(host, 'canvas', {}, { role: 'img' }),
      trouble = made(host, 'p', { className: 'stage-trouble' }, { role: 'alert' }),
      tools = made(host, 'div', { className: 'wmr-bar stage-tools' }),
      rows = made(root, 'div', { className: 'stage-rows' },
          { role: 'group', 'aria-label': 'what you can change' });
  const values = () => model.get('state'), still = isCalm();
  const home = { ...setup.poses,
    ...Object.fromEntries(setup.knobs.map(({ name: knob, value }) => [knob, value])) };
  let colours, found, ghost = null, view, frame = 0, holds = false;
  let at = 0, from = 0, began = 0; // the time shown, and where and when the film began
  let wide = 0, fitted = false; // the width for which the words have their room
  let touched = false; // by a hand, since the scene began
  const answers = {}; // what was answered, by scene
  let close = false, camera = null, flight = null; // what is seen, and from where the camera comes

  const scene = () => setup.scenes.find((it) => it.name === values().scene);
  const write = (changes) => model.set('state', { ...values(), ...changes });
  const whole = () => Math.max(...found.tracks.map(({ t, n }) => t[n - 1])),
      end = () => scene().until * whole(); // where the film of this scene ends

  const words = setup.scenes.map((it) => putWordsOf(it));
  const again = made(tools, 'button', { type: 'button', textContent: 'Drive again' });
  const nearer = made(tools, 'button', { type: 'button' });
  again.addEventListener('click', () => { from = 0; film(); });
  nearer.addEventListener('click', () => { fly(!close); });
  nearer.hidden = setup.far;
  const numbers = setup.knobs.filter(({ choices }) => !choices);
  const showRows = setup.knobs.filter(({ choices }) => choices).map(putChoice);
  if (numbers.length)
    showRows.push(putGains(rows, numbers, {
      get: (knob) => values()[knob],
      set(knob, value) {
        const { low, high } = numbers.find((it) => it.name === knob);
        if (value < low || value > high) {
          refuse(`${knob} = ${inWords(value)} is not allowed: from ${inWords(low)} to `
              + `${inWords(high)}.`);
          return;
        }
        moved({ [knob]: value });
        model.save_changes();
      },
      refuse,
    }));
  const handles = buildHandles(host, {
    get: (pose) => values()[pose],
    set(pose, place) { moved({ [pose]: place }); },
    view: () => view,
    hold(on) {
      holds = on;
      if (on) ghost = found.tracks[0]; else { model.save_changes(); film(); }
    },
  });

  // Sentences and questions lie on one another, so that the box is as high as the longest.
  function putWordsOf({ name: of, says, moved: then, ask }) {
    const results = [];
    const putText = (it, text) => {
      for (const piece of text.split(/(\{[a-z_]+\}|\*[A-Za-z_]+\*)/)) {
        if (piece[0] === '{')
          results.push([piece.slice(1, -1), made(it, 'b', { className: 'live-result' }), it]);
        else if (piece[0] === '*') putSymbol(it, piece.slice(1, -1));
        else it.append(piece);
      }
    };
    const put = (text, kind) => {
      const it = made(say, 'p', { className: 'stage-words' });
      putText(it, text);
      it.dataset.kind = kind;
      return it;
    };
    const asked = ask && put(`${ask.question} `, 'ask');
    const verdicts = (ask ? ask.answers : []).map(([answer, verdict], k) => {
      const chip = made(asked, 'button', { type: 'button', className: 'stage-chip' });
      putText(chip, answer);
      chip.addEventListener('click', () => {
        ghost = found.tracks[0];
        answerWith(k);
        model.save_changes();
        again.focus({ preventScroll: true }); // the chip has gone
      });
      return put(`${k === ask.key ? 'Yes: ' : 'No: '}${verdict}`, 'verdict');
    });
    const plain = put(says, 'says');
    return { of, plain, after: then ? put(then, 'says') : plain, asked, verdicts, results };
  }
  // A choice among a few is a row of chips.
  function putChoice({ name: knob, choices, says, label }) {
    const row = made(rows, 'div', { className: 'stage-row' });
    row.dataset.control = knob;
    made(row, 'span', { textContent: label });
    const box = made(row, 'div', {}, { role: 'group', 'aria-label': says });
    const chips = choices.map(([value, text]) => {
      const chip = made(box, 'button',
          { type: 'button', className: 'stage-chip', textContent: text });
      chip.addEventListener('click', () => {
        ghost = found.tracks[0];
        moved({ [knob]: value });
        model.save_changes();
        film();
      });
      return [value, chip];
    });
    return (now) => {
      row.hidden = !(knob in now);
      chips.forEach(([value, chip]) =>
        chip.setAttribute('aria-pressed', String(now[knob] === value)));
    };
  }

  // A verdict is of what was asked: the handles go where the question put them, and from there.
  function answerWith(k) {
    const { name: of, to, ask } = scene();
    answers[of] = k;
    touched = true;
    write({ ...home, ...to, ...ask.then, answer: k });
    refresh();
    from = close ? Math.max(0, nearTime()) : 0;
    film();
  }
  // A hand has moved something: the whole way is seen at once, and a verdict goes.
  function moved(changes) {
    const { answer } = values();
    touched = true;
    write({ ...changes, answer: answer === null ? null : -1 });
    began = 0;
    refresh();
    at = end();
    schedule();
  }
  function refuse(sentence) { trouble.textContent = sentence; }
  function refresh() {
    refuse('');
    try { found = play.find(values(), setup); } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      refuse(error.message); // and the picture stays as it was
    }
  }
  function nearTime() {
    const [track] = found.tracks, { goal } = values();
    if (!goal) return 0;
    const k = track.x.findIndex((x, i) => Math.hypot(x - goal[0], track.y[i] - goal[1]) < 2 * NEAR);
    return k < 0 ? 0 : track.t[k];
  }
  function film() {
    if (still) { at = end(); began = 0; } else { at = from; began = performance.now(); }
    schedule();
  }
  function fly(toClose) {
    if (close === toClose) return;
    flight = still || !camera ? null : { since: performance.now(), from: { ...camera } };
    close = toClose;
    schedule();
  }
  // A section of the text, or the reader, asks for a scene.
  function show(of, first = false) {
    const next = setup.scenes.find((it) => it.name === of);
    if (!next) return;
    ghost = null;
    touched = false;
    write({ ...home, ...next.to, scene: of, answer: null });
    refresh();
    if (first) close = next.look === 'near'; else fly(next.look === 'near');
    if (next.look === 'other') fly(false);
    from = next.look === 'near' ? nearTime() : 0;
    if (of in answers) answerWith(answers[of]);
    else if (next.still) { began = 0; at = next.ask ? end() : 0; schedule(); } else film();
  }

  function schedule() { if (!frame) frame = requestAnimationFrame(draw); }
  function boxNow() {
    const own = play.look && play.look(values(), found, setup, scene().look);
    const { start, goal } = values();
    if (close && goal) return [goal[0] - NEAR, goal[1] - NEAR, goal[0] + NEAR, goal[1] + NEAR];
    if (own) return own;
    const xs = [start[0], goal[0]], ys = [start[1], goal[1]];
    return [Math.min(...xs) - MARGIN, Math.min(...ys) - MARGIN, Math.max(...xs) + MARGIN,
        Math.max(...ys) + MARGIN];
  }
  // Where the camera is: its middle and how many pixels a metre has.
  function aimed(size) {
    const { width, height } = size, [left, bottom, right, top] = boxNow(),
        corner = !close && play.corner && play.corner(values(), found, size, scene());
    // beside a small picture in the upper left corner, or below it, where there is more room
    const rooms = corner ? [[corner.width, 0], [0, corner.height]] : [[0, 0]];
    const [scale, aside, down] = rooms.map(([x, y]) => [Math.min((width - x) / (right - left),
        (height - FOOT - y) / (top - bottom)), x, y]).sort(([one], [other]) => other - one)[0];
    return { x: (left + right - aside / scale) / 2, y: (bottom + top + (down - FOOT) / scale) / 2,
      scale };
  }
  function seen(now, size) {
    const to = aimed(size);
    if (!flight) return to;
    const passed = ease(within((now - flight.since) / FLIGHT, 0, 1)), { from: old } = flight;
    if (passed === 1) { flight = null; return to; }
    const scale = old.scale * (to.scale / old.scale) ** passed;
    // straight towards what the eye looks at, while the scale grows
    const gone = Math.abs(Math.log(to.scale / old.scale)) < 0.1 ? passed
        : 1 - (1 / scale - 1 / to.scale) / (1 / old.scale - 1 / to.scale);
    return { x: old.x + gone * (to.x - old.x), y: old.y + gone * (to.y - old.y), scale };
  }

  function draw(stamp) {
    frame = 0;
    if (!colours || !found) return;
    const now = stamp || performance.now(), last = end();
    if (began) {
      const passed = within((now - began) / DRIVE, 0, 1);
      at = from + (last - from) * (1 - (1 - passed) ** 1.8); // slower towards its end
      if (passed === 1) began = 0;
    }
    at = within(at, 0, last);
    const size = sizeOf(canvas);
    if (size.width < 2) return;
    if (!holds || !camera) camera = seen(now, size);
    paint(size, at >= whole() && !began);
    if (began || flight) schedule();
  }
  function paint({ width, height }, done) {
    const { x, y, scale } = camera, across = width / 2 / scale, up = height / 2 / scale;
    const pane = paneOf(canvas, colours, { x: [x - across, x + across], y: [y - up, y + up],
      lawn: true, alt: '' });
    view = pane.view;
    const state = values(), { start, goal } = state, it = scene();
    const size = Math.max(sizeAt(scale), 1);
    const sampled = found.tracks.map((track) => sampleAt(track, at));
    const now = { time: at, done, scene: it.name, shows: it.shows, k: sampled[0].k,
      pose: sampled[0].pose, poses: sampled.map(({ pose }) => pose), size };
    if (ghost)
      pane.path(ghost.x, ghost.y, 'ghost', { width: 1.5, dash: [2, 5], to: ghost.n });
    found.tracks.forEach(({ x: xs, y: ys, role }, k) =>
      pane.path(xs, ys, role, { width: 3, to: sampled[k].k + 1 }));
    if (goal && close) pane.robot(goal, 0.3, { size }); // where it should stand
    if (start) pane.pose(start, 'start');
    if (play.draw) play.draw(pane, state, found, now, setup);
    if (!it.empty)
      for (const [k, { role, share = 1 }] of [...found.tracks.entries()].reverse())
        pane.robot(sampled[k].pose, share, { size, role }); // the first one above the others
    if (play.above) play.above(pane, state, found, now, setup);
    if (goal) pane.pose(goal, 'goal');
    const off = goal ? wrap(now.pose[2] - goal[2]) : 0;
    if (close && done && Math.abs(off) > PARKED && !it.empty)
      pane.angle(goal[0], goal[1], goal[2], off, inDegrees(Math.abs(off), 0), 'rising', 84);
    pane.name();
    handles(Object.fromEntries(['start', 'goal'].map((pose) =>
      [pose, setup.hands.includes(pose) && inside(view, state[pose]) ? state[pose] : null])));
    tell();
  }
  function tell() {
    const state = values(), results = play.say(state, found, setup);
    for (const { of, plain, after, asked, verdicts, results: places } of words) {
      const now = of === state.scene, verdict = verdicts[state.answer];
      const chosen = verdict || (asked && state.answer === null ? asked : touched ? after : plain);
      for (const it of new Set([plain, after, asked, ...verdicts].filter(Boolean))) {
        const on = now && it === chosen;
        if (on === (it.dataset.on === 'true')) continue;
        it.dataset.on = String(on);
        it.inert = !on;
        it.setAttribute('aria-hidden', String(!on));
      }
      for (const [result, place, it] of places) {
        if (!now && !(result in results)) continue; // another scene computes it
        if (touched && asked && asked.contains(it)) continue; // it asks what it asked
        const text = String(results[result]).replace(/(\d) /g, '$1\u00a0'); // a number, its unit
        if (place.textContent !== text) place.textContent = text;
      }
    }
    const { handles: shown = setup.knobs.map((it) => it.name) } = scene();
    const places = Object.fromEntries(shown.map((it) => [it, state[it]]));
    showRows.forEach((showRow) => showRow(places));
    nearer.textContent = close ? 'The whole way' : 'The last metre';
    canvas.setAttribute('aria-label', `A lawn from above. ${
      say.querySelector('[data-on="true"]').textContent}`);
    root.dataset.done = String(!began && !flight);
    root.dataset.scene = state.scene;
    if (!fitted) fit();
  }
  // The words keep the room that the longest takes as it opens: a longer result lies on the lawn.
  function fit() {
    fitted = true;
    say.style.height = '';
    say.style.height = `${say.getBoundingClientRect().height}px`;
  }

  // It drives when it comes into view, unless a hand has moved something.
  const replay = () => { if (!touched && !scene().still) film(); };
  root.stage = { show, play: replay, opening: values().scene };
  root.found = () => found; // for tests
  show(values().scene, true);
  const eye = new IntersectionObserver(([{ isIntersecting }]) => {
    if (isIntersecting) root.stage.play();
  }, { threshold: 0.3 });
  eye.observe(host);
  const unfit = () => { fitted = false; schedule(); };
  const width = new ResizeObserver(([{ contentRect }]) => {
    if (contentRect.width !== wide) { wide = contentRect.width; unfit(); }
  });
  width.observe(root);
  document.fonts.ready.then(unfit);
  const page = repainted(root, [canvas], (read) => { colours = read; schedule(); });
  const heard = () => { refresh(); schedule(); };
  model.on('change:state', heard);
  return () => {
    page.stop();
    eye.disconnect();
    width.disconnect();
    cancelAnimationFrame(frame);
    model.off('change:state', heard);
  };
});

const inside = ({ box, toScreen }, pose) => {
  if (!pose) return false;
  const [x, y] = toScreen(pose[0], pose[1]);
  return x > 0 && x < box.width && y > 0 && y < box.height;
};

// The sample of a track that is reached at a time, and the pose between it and the next.
function sampleAt({ t, x, y, heading, n }, time) {
  let [low, high] = [0, n - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle; else high = middle;
  }
  if (time >= t[n - 1]) return { k: n - 1, pose: [x[n - 1], y[n - 1], heading[n - 1]] };
  const share = within((time - t[low]) / (t[high] - t[low] || 1), 0, 1);
  const mid = (column) => column[low] + share * (column[high] - column[low]);
  const turned = heading[low] + share * wrap(heading[high] - heading[low]);
  return { k: low, pose: [mid(x), mid(y), turned] };
}
