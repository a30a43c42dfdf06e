// Puts the parts together: reads the widget's traits, simulates, draws once a frame, and answers hands and keys.

const LASTS = 8; // s that playing a run takes at most
const RESTING = 0.3; // where on the run the cursor stands until somebody moves it

function scaffold(el) {
  const root = el.appendChild(document.createElement('div'));
  root.className = 'wmr';
  root.innerHTML = `
    <div class="wmr-bar">
      <button type="button" data-do="play">Play</button>
      <input type="range" class="wmr-time" min="0" max="1" step="any" aria-label="time cursor">
      <output class="wmr-clock"></output>
      <button type="button" data-do="pin">Pin this run</button>
      <button type="button" data-do="unpin" hidden>Unpin</button>
      <button type="button" data-do="reset">Reset</button>
    </div>
    <div class="wmr-status"></div>
    <div class="wmr-aside" role="status" aria-live="polite"></div>
    <div class="wmr-figures" role="list"></div>
    <div class="wmr-stage">
      <div><div class="wmr-polar"></div><div class="wmr-plane" style="position: relative"><canvas class="wmr-scene" role="img"></canvas></div></div>
      <div><div class="wmr-key"></div>
        <canvas class="wmr-charts" role="img"></canvas>
        <canvas class="wmr-map" role="img" tabindex="0" hidden></canvas></div>
    </div>`;
  return root;
}

function render({ model, el }) {
  const root = scaffold(el), find = (selector) => root.querySelector(selector);
  const [scene, charts, mapCanvas] = ['.wmr-scene', '.wmr-charts', '.wmr-map'].map(find);
  const showFigures = buildFigures(find('.wmr-figures')), gainMap = buildGainMap();
  const state = { run: null, settings: null, figures: null, trouble: '', refused: '', ghost: null, time: null, playing: null, colours: null, view: null, held: false };
  let frame = 0, pressed = false, stale = true, writing = false, spoken = 0, shownKey = '';

  // Many traits at once count as one change: half a preset is no preset.
  function write(values) {
    writing = true;
    for (const [name, value] of Object.entries(values)) model.set(name, value);
    writing = false;
    follow();
    model.save_changes();
  }
  const schedule = () => { if (!frame) frame = requestAnimationFrame(draw); };
  const refresh = () => { stale = true; schedule(); };
  const poses = () => ({ start: model.get('start'), goal: model.get('scenario') === 1 ? null : model.get('goal') });
  const placeHandles = buildHandles(find('.wmr-plane'), {
    get: (name) => model.get(name), set: (name, pose) => write({ [name]: pose }), view: () => state.view,
    hold: (held) => { state.held = held; schedule(); },
  });

  function compute() {
    stale = false;
    const settings = settingsOf(model);
    let run;
    try { run = runOf(settings); } catch (error) { state.trouble = error.message; return; }
    const summary = summarise(run);
    Object.assign(state, { run, trouble: '', settings, figures: figuresOf(settings, run, summary), sentence: sentenceOf(settings, run, summary) });
  }

  function cursorOf(run) {
    const end = endOf(run), time = state.time === null ? RESTING * end : Math.min(Math.max(state.time, 0), end);
    return end > 0 ? Math.round(time / end * (run.n - 1)) : 0;
  }

  function draw(now) {
    frame = 0;
    if (stale) compute();
    advance(now);
    const { run, ghost, colours, trouble } = state, faded = trouble !== '';
    const cursor = run ? cursorOf(run) : 0, at = poses(), ghostRun = ghost && ghost.run;
    const safe = run ? at : { start: [0, 0, 0], goal: [1, 0, 0] };
    const drawn = faded && state.settings ? { start: state.settings.start, goal: state.settings.reference ? null : state.settings.goal } : safe;
    if (!state.held || !state.view) {
      state.view = viewOf([run, ghostRun].filter(Boolean), marksOf(drawn, run), drawn, sizeOf(scene));
    }
    drawScene(scene, colours, { view: state.view, run, ghost: ghostRun, poses: drawn, cursor, faded });
    placeHandles(drawn);
    if (model.get('view') === 1) drawLandscape(); else drawCharts(charts, colours, { run, ghost: ghostRun, cursor, faded });
    describe(run, cursor);
    root.dispatchEvent(new CustomEvent('drawn', { bubbles: true })); // for whoever measures
    if (state.playing) schedule();
  }

  function advance(now) {
    if (!state.playing || !state.run) return;
    const end = endOf(state.run), speed = Math.max(1, end / LASTS);
    const passed = Math.max(now - state.playing.since, 0) / 1000; // a frame's time is that of its beginning, before a click within it
    state.time = Math.min(state.playing.from + speed * passed, end);
    if (state.time >= end) state.playing = null;
  }

  function drawLandscape() {
    const note = !state.settings ? 'no run yet' : mapped(state.settings) ? '' : 'This law does not use these gains.';
    if (!note) gainMap.update(state.settings, model.get('axes'), model.get('metric'));
    if (!note && gainMap.step(pressed)) schedule();
    drawMap(mapCanvas, state.colours, { map: gainMap.map, gains: state.settings && state.settings.gains, note });
    mapCanvas.dataset.finished = String(gainMap.finished);
  }

  function describe(run, cursor) {
    const status = find('.wmr-status'), text = state.trouble || state.refused || state.sentence || '';
    status.classList.toggle('wmr-trouble', state.trouble !== '' || state.refused !== '');
    if (status.textContent !== text) { status.textContent = text; announce(text); }
    showKey();
    showFigures(state.trouble ? null : state.figures, state.ghost && state.ghost.figures);
    find('[data-do=play]').textContent = state.playing ? 'Pause' : 'Play';
    find('[data-do=unpin]').hidden = !state.ghost;
    if (!run) return;
    const t = run.t[cursor], end = endOf(run), slider = find('.wmr-time');
    Object.assign(slider, { max: end || 1, value: t });
    slider.setAttribute('aria-valuetext', `${written(t, 's')} of ${written(end, 's')}`);
    find('.wmr-clock').textContent = `${t.toFixed(1)} of ${end.toFixed(1)} s`;
    const { rho, alpha, theta, ink } = state.colours;
    find('.wmr-polar').innerHTML = [
      [rho, 'ρ', written(run.rho[cursor], 'm')], [alpha, 'α', hasSight(run, cursor) ? inDegrees(run.alpha[cursor]) : '–'], [theta, 'θ', hasSight(run, cursor) ? inDegrees(run.theta[cursor]) : '–'],
      [ink, 'v', written(run.v[cursor], 'm/s')], [ink, 'ω', written(run.omega[cursor], 'rad/s')],
    ].map(([colour, name, value]) => `<span style="color: ${colour}"><b>${name}</b> = ${value}</span>`).join('');
    scene.setAttribute('aria-label', `Path from start to goal. ${text}`);
    charts.setAttribute('aria-label', `Speed, turning rate, position errors and V over time. ${text}`);
    const { k_alpha, h, k_rho } = state.settings.gains;
    mapCanvas.setAttribute('aria-label', `Gain landscape; the gains are k_rho ${k_rho}, k_alpha ${k_alpha}, h ${h}; arrow keys change them. ${text}`);
  }

  // A screen reader hears where a drag ends, not each step of it.
  function announce(text) {
    clearTimeout(spoken);
    spoken = setTimeout(() => { find('.wmr-aside').textContent = text; nameControls(root); }, 700);
  }

  function showKey() {
    const mark = (name, text) => `<span><i data-mark="${name}"></i>${text}</span>`;
    const pinned = state.ghost ? mark('pinned', 'pinned run') : '';
    const text = model.get('view') === 1
      ? `<span>click on the map to set the gains</span>${mark('never', state.settings && state.settings.reference ? 'no value' : 'does not arrive')}`
      : `${mark('run', 'run')}${pinned}${mark('rising', 'V rises')}`;
    if (text !== shownKey) find('.wmr-key').innerHTML = shownKey = text;
  }

  function follow() {
    if (writing) return;
    const mapped = model.get('view') === 1;
    charts.hidden = mapped;
    mapCanvas.hidden = !mapped;
    const changed = Object.fromEntries(displaysOf(model).filter(([name, value]) => model.get(name) !== value));
    const preset = presetOf(model);
    if (preset !== model.get('preset')) changed.preset = preset;
    if (Object.keys(changed).length) { write(changed); return; }
    refresh();
  }

  const acts = {
    play() {
      if (state.playing) { state.playing = null; return; }
      const end = endOf(state.run), time = state.time === null || state.time >= end ? 0 : state.time;
      state.playing = { from: time, since: performance.now() };
    },
    pin() { if (state.run && !state.trouble) state.ghost = { run: state.run, figures: state.figures }; },
    unpin() { state.ghost = null; },
    reset() { Object.assign(state, { ghost: null, time: null, playing: null }); write(model.get('home')); },
  };
  root.addEventListener('click', (event) => {
    const act = event.target.closest('[data-do]');
    if (act) { acts[act.dataset.do](); schedule(); }
  });
  find('.wmr-time').addEventListener('input', (event) => { Object.assign(state, { time: Number(event.target.value), playing: null }); schedule(); });

  dragOver(charts, (x) => { Object.assign(state, { time: timeAxis(sizeOf(charts).width, state.run, state.ghost && state.ghost.run).toTime(x), playing: null }); schedule(); });
  dragOver(mapCanvas, (x, y) => { if (gainMap.map && mapped(state.settings)) write(gainsAt(gainMap.map, sizeOf(mapCanvas), x, y)); });
  mapCanvas.addEventListener('keydown', (event) => {
    const move = MOVES[event.key], { map } = gainMap;
    if (!move || !map) return;
    event.preventDefault();
    event.stopPropagation();
    const nudge = (name, by) => Math.min(Math.max(Math.round(model.get(name) * 20 + by) / 20, 0), RANGES[name]);
    write({ [map.kx]: nudge(map.kx, move[0]), [map.ky]: nudge(map.ky, move[1]) });
  });

  const choose = () => { const chosen = model.get('presets')[model.get('preset') - 1]; if (chosen && !writing) write(chosen); };
  model.on('change:preset', choose);
  model.on('change', follow);
  const forget = () => { state.refused = ''; };
  model.on('change', forget);
  const unwatch = watchTyping(root, (refused) => { state.refused = refused; schedule(); });
  const repaint = () => {
    nameControls(root);
    [scene, charts, mapCanvas].forEach(measure);
    state.colours = readColours(root);
    schedule();
  };
  const press = (event) => { pressed = event.type === 'pointerdown'; };
  const grips = ['pointerdown', 'pointerup', 'pointercancel'];
  grips.forEach((each) => window.addEventListener(each, press, true));
  const unfollow = followTheme(repaint), resized = new ResizeObserver(repaint);
  [root, scene, charts, mapCanvas].forEach((each) => resized.observe(each));
  repaint();
  follow();
  return () => {
    grips.forEach((each) => window.removeEventListener(each, press, true));
    unfollow();
    unwatch();
    resized.disconnect();
    cancelAnimationFrame(frame);
    clearTimeout(spoken);
    model.off('change', follow);
    model.off('change', forget);
    model.off('change:preset', choose);
  };
}

// The notebook's sliders and menus show their names, but don't tell them to screen readers.
function nameControls(root) {
  const card = root.closest('.wmr-explorer');
  for (const each of card ? card.querySelectorAll('.noUi-handle:not([aria-label]), .widget-dropdown select:not([aria-label])') : []) {
    const name = each.closest('.jupyter-widgets').querySelector('.widget-label');
    if (name) each.setAttribute('aria-label', [name.textContent, name.title].filter(Boolean).join(', '));
  }
}

// A slider puts its old value back when what is typed beside it is no number. Calls back with a sentence that says so.
function watchTyping(root, onTyped) {
  const look = (event) => {
    const typed = event.target, card = root.closest('.wmr-explorer');
    if (!card || !card.contains(typed) || !typed.matches('.widget-readout') || (event.type === 'keydown' && event.key !== 'Enter')) return;
    const name = typed.closest('.jupyter-widgets').querySelector('.widget-label').textContent, text = typed.textContent.trim();
    if (!Number.isFinite(parseFloat(text))) onTyped(`${name} = ${text} is not allowed: a number is needed. The value stays as it was.`);
  };
  const events = ['keydown', 'focusout']; // heard on their way down, before the slider mends its text
  events.forEach((each) => window.addEventListener(each, look, true));
  return () => events.forEach((each) => window.removeEventListener(each, look, true));
}

// Calls back with the place in the canvas's own units while a pointer is held down on the canvas.
function dragOver(canvas, onPlace) {
  let down = false;
  const tell = (event) => {
    const box = canvas.getBoundingClientRect(), { zoom } = sizeOf(canvas);
    onPlace((event.clientX - box.left) / zoom, (event.clientY - box.top) / zoom);
  };
  canvas.addEventListener('pointerdown', (event) => { down = true; canvas.setPointerCapture(event.pointerId); tell(event); });
  canvas.addEventListener('pointermove', (event) => { if (down) tell(event); });
  canvas.addEventListener('lostpointercapture', () => { down = false; });
}

export default { render };
