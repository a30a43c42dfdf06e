// A small thing to move: pictures, a sentence with numbers that can be dragged or typed, a slider for each, and, before it opens, a prediction.

// An explorable is, in a file of its own,
//   panes(values, found, setup): the panes by name, see board.js, with `alt`, what it shows in words, and `scrub(x, y, moved, values, found)`: what a
//     pointer on it changes, or nothing; `moved` is [dx, dy] since the last call while it is held, or null while it passes over;
//   find(values, setup): what follows from the knobs; throws RangeError, in words, where nothing does;
//   draw(panes, values, found, hidden, setup): `hidden` before the prediction, when only what is given may be drawn;
//   say(values, found, setup): the results in the sentence, by name;
//   handles(values, found, setup): [{ id, pane, at: [x, y], says, move(x, y): what changes; throws RangeError, in words, where nothing can }].
const DRAG = 5; // px of a number's drag a step
const SYMBOLS = { rho: 'ρ', alpha: 'α', theta: 'θ', omega: 'ω', beta: 'β', gamma: 'γ', lambda: 'λ', zeta: 'ζ', sigma: 'σ', tau: 'τ', phi: 'φ', delta: 'δ' };
const made = (parent, tag, properties = {}, attributes = {}) => {
  const it = Object.assign(parent.appendChild(document.createElement(tag)), properties);
  for (const [name, value] of Object.entries(attributes)) it.setAttribute(name, value);
  return it;
};
const inWords = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(6))).replace('-', '−') : String(value));
// A comma is a decimal one: 1,000 could be either, and is neither.
const fromWords = (text) => (/^[-+−]?(?![1-9]\d{0,2},\d{3}$)(\d+[.,]?\d*|[.,]\d+)(e[-+]?\d+)?$/i.test(text.trim()) ? Number(text.trim().replace(',', '.').replace('−', '-')) : NaN);

// A function of what JSON can say that keeps its last answer: a run need not be driven anew while only the time moves.
function remembered(f) {
  let key, last;
  return (asked) => {
    const text = JSON.stringify(asked);
    if (text !== key) [key, last] = [text, f(asked)];
    return last;
  };
}

// A run of the law that acts all the time, sample by sample; `start`, `goal` and `gains` as for `simulate`.
const driven = remembered((options) => simulate({ reference: null, law: 'corrected', method: 'continuous', dt: 0.05, duration: 60, arrivalRadius: 0.05, ...options }));
const sampleAt = (run, t) => Math.min(Math.max(Math.floor(t / run.t[1] + 1e-9), 0), run.n - 1);
const poseAt = (run, k) => [run.x[k], run.y[k], run.heading[k]];

// The time, as a share, at which a path comes nearest to a point, or nothing if that is farther than `reach`: for `scrub`.
function timeNear(xs, ys, x, y, reach) {
  let best = 0;
  const far = (k) => Math.hypot(xs[k] - x, ys[k] - y);
  for (let k = 1; k < xs.length; k += 1) if (far(k) < far(best)) best = k;
  return far(best) < reach ? { time: best / (xs.length - 1) } : null;
}

// A symbol such as k_alpha, as in the formulas: Greek, with its index, and in its colour.
function putSymbol(parent, name) {
  const [stem, ...index] = name.split('_'), role = ROLES.includes(stem) ? stem : ROLES.includes(index[0]) ? index[0] : '';
  const it = made(parent, 'i', { className: 'live-symbol', textContent: SYMBOLS[stem] || stem });
  if (role) it.style.color = `var(--${role})`;
  if (index.length) made(it, 'sub', { textContent: SYMBOLS[index[0]] || index.join(' ') });
}

// A number among words: it can be dragged, typed over, and stepped with the arrow keys.
function putNumber(parent, knob, { get, step, set, refuse }) {
  const it = made(parent, 'input', { className: 'live-number', inputMode: 'decimal', autocomplete: 'off' }, { 'aria-label': knob.says, role: 'spinbutton', 'aria-valuemin': knob.low, 'aria-valuemax': knob.high });
  let grip = null;
  it.addEventListener('pointerdown', (event) => { grip = { x: event.clientX, from: get(), moved: false }; });
  it.addEventListener('pointermove', (event) => {
    if (!grip || (!grip.moved && Math.abs(event.clientX - grip.x) < DRAG)) return;
    if (!grip.moved) { grip.moved = true; it.setPointerCapture(event.pointerId); it.blur(); }
    set(step(grip.from, Math.round((event.clientX - grip.x) / DRAG)));
  });
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) it.addEventListener(end, () => { grip = null; });
  it.addEventListener('keydown', (event) => {
    event.stopPropagation(); // a notebook would take the keys to change cells
    const by = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!by) return;
    event.preventDefault();
    set(step(get(), by));
  });
  it.addEventListener('change', () => {
    const value = fromWords(it.value);
    if (value >= knob.low && value <= knob.high) set(value);
    else refuse(`${it.value || 'Nothing'} is not allowed: a number from ${inWords(knob.low)} to ${inWords(knob.high)} is needed.`);
    it.value = it.dataset.shown;
  });
  return (value) => {
    const text = inWords(value);
    it.style.width = `${text.length + 1.2}ch`;
    it.setAttribute('aria-valuenow', value);
    it.setAttribute('aria-valuetext', `${text} ${knob.unit}`.trim());
    if (it.dataset.shown !== text) it.value = it.dataset.shown = text;
  };
}

function putKnobs(root, setup, { get, set, refuse, changed }) {
  const sentence = root.querySelector('.live-sentence'), rows = root.querySelector('.live-rows'), results = {}, shows = [], timers = [];
  const parts = Object.fromEntries(setup.knobs.map((knob) => [knob.name, knob]));
  for (const knob of setup.knobs) if (!knob.choices) knob.stops = stopsOf(knob.low, knob.high, knob.step);
  const stepFrom = ({ stops }) => (value, by) => {
    const place = placeOf(stops, value), next = by > 0 ? Math.floor(place + by + 1e-9) : by < 0 ? Math.ceil(place + by - 1e-9) : place;
    return by ? stops[Math.min(Math.max(next, 0), stops.length - 1)] : value;
  };
  const put = (name) => (value) => set({ [name]: value });
  for (const piece of setup.sentence.split(/(\{[^}]+\}|\*[a-z_]+\*)/)) {
    const bare = piece.endsWith('!}'), name = piece.slice(1, bare ? -2 : -1), knob = piece[0] === '{' && parts[name]; // {name!}: without its symbol and unit, as in a formula
    if (piece[0] === '*') putSymbol(sentence, name);
    else if (knob && knob.choices) {
      const select = made(sentence, 'select', { className: 'live-choice' }, { 'aria-label': knob.says });
      select.replaceChildren(...knob.choices.map(([value, text]) => new Option(text, value)));
      select.addEventListener('change', () => put(name)(select.value));
      select.addEventListener('keydown', (event) => event.stopPropagation());
      shows.push((values) => { select.value = values[name]; });
    } else if (knob) {
      const whole = made(sentence, 'span', { className: 'live-whole' });
      if (knob.symbol && !bare) { putSymbol(whole, knob.symbol); whole.append(' = '); }
      const show = putNumber(whole, knob, { get: () => get()[name], step: stepFrom(knob), set: put(name), refuse });
      if (knob.unit && !bare) whole.append(knob.unit === '°' ? knob.unit : ` ${knob.unit}`);
      shows.push((values) => show(values[name]));
    } else if (piece[0] === '{') (results[name] ||= []).push(made(sentence, 'b', { className: 'live-result' }));
    else sentence.append(piece);
  }
  for (const knob of setup.knobs.filter((each) => each.stops)) {
    const row = made(rows, knob.plays ? 'div' : 'label', { className: 'wmr-control live-row' }), { stops, name } = knob, own = made(row, 'span');
    row.dataset.control = name;
    if (knob.symbol) putSymbol(own, knob.symbol); else own.textContent = knob.label;
    const slider = made(row, 'input', { type: 'range', className: 'wmr-slider', min: 0, max: stops.length - 1, step: 'any' }, { 'aria-label': knob.says });
    slider.addEventListener('input', () => { stop(); put(name)(stops[Math.round(slider.value)]); });
    slider.addEventListener('keydown', (event) => {
      const by = STEP_KEYS[event.key];
      if (!by) return;
      event.preventDefault();
      event.stopPropagation();
      stop();
      put(name)(stepFrom(knob)(get()[name], by));
    });
    let playing = 0;
    const call = (text) => { button.textContent = text; button.setAttribute('aria-label', `${text}: ${knob.says}`); };
    const stop = () => {
      if (!playing) return;
      cancelAnimationFrame(playing);
      playing = 0;
      call('Play');
      set({});
    };
    const play = () => {
      if (playing) { stop(); return; }
      const from = get()[name] >= knob.high ? knob.low : get()[name], begin = performance.now();
      const go = (now) => {
        const value = Math.min(from + (knob.high - knob.low) * (now - begin) / 1000 / knob.plays, knob.high);
        set({ [name]: Number(value.toPrecision(3)) }, true);
        if (value < knob.high) playing = requestAnimationFrame(go); else stop();
      };
      call('Stop');
      playing = requestAnimationFrame(go);
    };
    const button = knob.plays ? made(row, 'button', { type: 'button', className: 'live-play', textContent: 'Play', onclick: play }, { 'aria-label': `play: ${knob.says}` }) : null;
    timers.push(stop);
    if (knob.auto && !matchMedia('(prefers-reduced-motion: reduce)').matches) whenSeen(row, () => { if (!playing) play(); });
    shows.push((values) => {
      slider.value = placeOf(stops, values[name]);
      slider.setAttribute('aria-valuetext', `${inWords(values[name])} ${knob.unit}`.trim());
    });
  }
  const show = (values) => shows.forEach((each) => each(values));
  const showResults = (said) => {
    for (const [name, places] of Object.entries(results)) {
      const text = said ? String(said[name]) : '–'; // nothing follows from what is refused
      for (const place of places) if (place.textContent !== text) { place.textContent = text; changed(); }
    }
  };
  return { show, showResults, stop: () => timers.forEach((each) => each()) };
}

// A chain of goals, sampled, each left behind within its own of the `radii`: columns as of a run, and `leg`. As wmrlib's `drive_route`.
const alongRoute = remembered(({ start, goals, radii, gains }) => {
  const joined = { t: [], x: [], y: [], heading: [], v: [], V: [], leg: [] };
  let pose = start, begin = 0, peakOmega = 0, arrived = true;
  for (let leg = 0; arrived && leg < goals.length; leg += 1) {
    const run = simulate({ start: pose, goal: goals[leg], gains, reference: null, law: 'corrected', method: 'arc', dt: 0.1, duration: 120, arrivalRadius: radii[leg] }), last = run.n - 1;
    arrived = run.outcome === 'ARRIVED';
    const kept = arrived && leg < goals.length - 1 ? last : run.n; // where a leg ends stands the next one's first sample
    for (let k = 0; k < kept; k += 1) for (const [name, column] of Object.entries(joined)) column.push(name === 't' ? begin + run.t[k] : name === 'leg' ? leg : run[name][k]);
    peakOmega = Math.max(peakOmega, summarise(run).peakOmega);
    [pose, begin] = [poseAt(run, last), begin + run.t[last]];
  }
  return { ...joined, n: joined.t.length, arrived, peakOmega };
});

// Handles over a pane: buttons, for mouse, touch and the arrow keys.
function showHandles(host, handles, pane, give) {
  const known = new Map([...host.querySelectorAll('.wmr-handle')].map((each) => [each.dataset.handle, each]));
  for (const handle of handles) {
    let button = known.get(handle.id);
    if (!button) {
      button = made(host, 'button', { type: 'button', className: 'wmr-handle' });
      button.dataset.handle = handle.id;
      let grip = null;
      button.addEventListener('pointerdown', (event) => {
        const box = button.getBoundingClientRect();
        grip = [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
        button.setPointerCapture(event.pointerId);
      });
      button.addEventListener('pointermove', (event) => {
        if (!grip) return;
        const box = host.getBoundingClientRect(), { view } = button.pane;
        give(() => button.handle.move(...view.toWorld((event.clientX - grip[0] - box.left) / view.zoom, (event.clientY - grip[1] - box.top) / view.zoom)));
      });
      for (const end of ['pointerup', 'lostpointercapture']) button.addEventListener(end, () => { grip = null; });
      button.addEventListener('keydown', (event) => {
        const move = MOVES[event.key];
        if (!move) return;
        event.preventDefault();
        event.stopPropagation();
        const { range: [x0, x1, y0, y1] } = button.pane, step = event.shiftKey ? 200 : 40;
        give(() => button.handle.move(button.handle.at[0] + move[0] * (x1 - x0) / step, button.handle.at[1] + move[1] * (y1 - y0) / step), true);
      });
    }
    known.delete(handle.id);
    Object.assign(button, { handle, pane });
    const { box, zoom } = pane.view, [x, y] = pane.at(...handle.at);
    const [left, top] = [Math.min(Math.max(x, box.left), box.left + box.width), Math.min(Math.max(y, box.top), box.top + box.height)];
    Object.assign(button.style, { left: `${zoom * left}px`, top: `${zoom * top}px` });
    button.setAttribute('aria-label', `${handle.says}; the arrow keys move it`);
  }
  known.forEach((each) => each.remove());
}

// Calls once, when an element comes into view.
function whenSeen(element, act) {
  const watch = new IntersectionObserver((entries) => { if (entries.some((each) => each.isIntersecting)) { watch.disconnect(); act(); } });
  watch.observe(element);
}

const live = (explorable) => ({ render({ model, el }) {
  const setup = structuredClone(model.get('setup')), root = made(el, 'div', { className: 'wmr live' }, { 'data-lm-suppress-shortcuts': 'true' }); // keys are ours, not JupyterLab's
  root.innerHTML = '<div class="live-ask"></div><p class="live-sentence"></p><div class="live-panes"></div><div class="live-rows" role="group" aria-label="controls"></div>'
    + '<p class="live-trouble" role="alert"></p><div class="wmr-aside" role="status" aria-live="polite"></div>';
  const find = (selector) => root.querySelector(selector), canvases = {}, values = () => model.get('state');
  let frame = 0, spoken = 0, colours = null, found = null, refused = '', panes = {}, specs = {};
  const schedule = () => { if (!frame) frame = requestAnimationFrame(draw); };
  const set = (changes, playing = false) => { // a hand stops what plays; a kernel hears where it ends
    refused = '';
    if (!playing) knobs.stop();
    if (changes) model.set('state', { ...values(), ...changes });
    if (changes && !playing) model.save_changes();
    schedule();
  };
  const refuse = (sentence) => { refused = sentence; schedule(); };
  const give = (change, atOnce = false) => {
    try {
      const changes = change() || {};
      for (const { name, low, high, says } of setup.knobs) {
        if (low !== undefined && name in changes && !(changes[name] >= low && changes[name] <= high)) throw new RangeError(`${inWords(changes[name])} is not allowed as ${says}: ${inWords(low)} to ${inWords(high)} is.`);
      }
      set(changes);
    } catch (error) { if (!(error instanceof RangeError)) throw error; refuse(error.message); }
    if (atOnce) { cancelAnimationFrame(frame); draw(); } // the next key goes on from here
  };
  const say = () => {
    clearTimeout(spoken);
    spoken = setTimeout(() => { find('.wmr-aside').textContent = find('.live-sentence').textContent ? [...root.querySelectorAll('.live-result')].map((each) => each.textContent).join(', ') : ''; }, 700);
  };
  const knobs = putKnobs(root, setup, { get: values, set, refuse, changed: say });
  const gate = setup.ask ? buildGate(find('.live-ask'), setup.ask, { get: values, set, panes: () => panes, host: (name) => canvases[name].parentElement }) : null;

  function build(name, spec) {
    const host = made(find('.live-panes'), 'div', { className: `live-pane${spec.tall ? ' live-tall' : ''}` }), canvas = canvases[name] = made(host, 'canvas', {}, { role: 'img' });
    let last = null;
    const place = (event) => {
      const box = canvas.getBoundingClientRect(), { zoom } = sizeOf(canvas), { scrub } = specs[name];
      if (!scrub || !panes[name] || !found || (gate && !gate.open())) return;
      const [x, y] = panes[name].view.toWorld((event.clientX - box.left) / zoom, (event.clientY - box.top) / zoom), moved = last && [event.clientX - last[0], event.clientY - last[1]];
      if (last) last = [event.clientX, event.clientY];
      const changes = scrub(x, y, moved, values(), found);
      if (changes && (last || Object.keys(changes).every((each) => each === 'time'))) set(changes); // what passes over a picture only moves the robot
    };
    canvas.addEventListener('pointerdown', (event) => { last = [event.clientX, event.clientY]; if (specs[name].scrub) canvas.setPointerCapture(event.pointerId); place(event); });
    canvas.addEventListener('pointermove', place);
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) canvas.addEventListener(end, () => { last = null; });
    resized.observe(canvas);
  }
  function draw() {
    frame = 0;
    if (!colours) return;
    const now = values(), hidden = Boolean(gate && !gate.open());
    let trouble = refused, sound = true;
    try { found = explorable.find(now, setup); } catch (error) { if (!(error instanceof RangeError)) throw error; [trouble, sound] = [error.message, false]; }
    find('.live-trouble').textContent = hidden ? '' : trouble;
    knobs.show(now);
    for (const part of ['.live-sentence', '.live-rows']) find(part).hidden = hidden;
    if (!found) return;
    root.found = found; // for tests
    specs = explorable.panes(now, found, setup);
    for (const [name, spec] of Object.entries(specs)) {
      if (!canvases[name]) build(name, spec);
      canvases[name].setAttribute('aria-label', hidden ? spec.given || 'what is given' : spec.alt);
      panes[name] = paneOf(canvases[name], colours, spec);
    }
    explorable.draw(panes, now, found, hidden, setup);
    if (gate) gate.draw();
    else root.dataset.open = 'true';
    const handles = hidden ? [] : explorable.handles ? explorable.handles(now, found, setup) : [];
    for (const name of Object.keys(specs)) showHandles(canvases[name].parentElement, handles.filter((each) => each.pane === name), panes[name], give);
    if (!hidden) knobs.showResults(sound ? explorable.say(now, found, setup) : null);
  }
  const repaint = () => { Object.values(canvases).forEach(measure); colours = readColours(root); schedule(); };
  const unfollow = followTheme(repaint), resized = new ResizeObserver(repaint);
  resized.observe(root);
  model.on('change:state', schedule);
  repaint();
  return () => { unfollow(); resized.disconnect(); cancelAnimationFrame(frame); clearTimeout(spoken); knobs.stop(); model.off('change:state', schedule); };
} });
