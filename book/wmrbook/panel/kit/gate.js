// A prediction before the result: one chooses, turns an arrow or sketches a path, and commits; then
// the picture opens, with what was said in it, and moves from what was given to what was asked.

import * as memory from './memory.js';
import { DEGREES, inDegrees, written } from './style.js';
import { MOVES, held, made, placeOn } from './hands.js';
import { putSlider, stopsOf } from './controls.js';
import { putWords } from './symbols.js';
import { within } from './numbers.js';
import { wrap } from './model.js';

// `ask` is { name, kind, question, key, why } and, by its kind: `options` to choose from, with what
// is `wrong` about each; `pane` and `at` of an arrow to turn; `pane` and `at`, the start, of a path
// to sketch. `key` is the number of the option or the arrow's angle in radians; of a path there is
// none, but `way()` is the true one. `open(moving)` shows what was asked, and `close()` what was
// given. A guess of SKIPPED is nobody's.
const SKIPPED = 'skipped';
export function buildGate(root, ask, { get, set, panes, host, way, reveal, close }) {
  const open = () => get().guess !== null && get().guess !== undefined;
  /** @type {any} */
  let draft = ask.kind === 'sketch' ? [] : null;
  let listening = false, shown = null, answered = false, renewed = false, grip = null;
  const form = made(root, 'form', { className: 'live-gate' });
  putWords(made(form, 'p', { className: 'live-question' }), ask.question);
  const options = made(form, 'div', { className: 'live-options' },
      { role: 'radiogroup', 'aria-label': ask.question });
  (ask.options || []).forEach((text, k) => {
    const row = made(options, 'label');
    made(row, 'input', { type: 'radio', name: `gate-${ask.name}`, value: k, onchange: () => {
      draft = k;
      show();
    } });
    putWords(made(row, 'span'), text);
  });
  const showTurn = ask.kind === 'turn' ? putSlider(options,
      'the angle of the arrow, degrees counter-clockwise from the right', stopsOf(-180, 180, 5),
      { get: () => draft * DEGREES, set(angle) { draft = angle / DEGREES; set(); } }) : null;
  form.addEventListener('keydown', (event) => event.stopPropagation());
  const bar = made(form, 'div', { className: 'wmr-bar' }),
      commit = made(bar, 'button', { className: 'live-commit', textContent: 'Commit' });
  const button = (textContent, onclick) =>
      made(bar, 'button', { type: 'button', textContent, onclick, hidden: true });
  const skip = button('Just show me', () => { commitTo(SKIPPED); }),
      again = button('Try again', () => { memory.forget(ask.name); tryAgain(); }),
      never = button('Never ask me', () => { memory.ask(true); show(true); }),
      clear = button('Forget all my answers', () => { memory.forgetAll(); tryAgain(); });
  const verdict = made(form, 'p', { className: 'live-verdict', tabIndex: -1 }, { role: 'status' });
  function tryAgain() {
    draft = ask.kind === 'sketch' ? [] : null;
    renewed = true;
    set({ guess: null });
    close();
  }
  function commitTo(guess) {
    set({ guess });
    answered = true;
    if (guess !== SKIPPED) memory.remember(ask.name, guess);
    reveal(true);
  }
  form.addEventListener('submit', (event) => {
    event.preventDefault();
    if (ready()) commitTo(draft);
  });
  const before = memory.recall(ask.name) ?? (memory.neverAsk() ? SKIPPED : null);
  if (before !== null && !open()) { set({ guess: before }); reveal(false); }
  const ready = () => (ask.kind === 'sketch' ? draft.length > 3 : draft !== null);
  const right = (guess) =>
      (ask.kind === 'choose' ? guess === ask.key : Math.abs(wrap(guess - ask.key)) < Math.PI / 9);

  function listen() { // to a hand that turns the arrow or draws the path
    if (listening || !ask.pane || !panes()[ask.pane]) return;
    listening = true;
    const canvas = host(ask.pane).querySelector('canvas');
    grip = made(host(ask.pane), 'div', { className: 'live-grip' });
    for (const each of [canvas, grip]) held(each, {
      take: () => !open(),
      drag(event, first) {
        const [x, y] = panes()[ask.pane].view.toWorld(...placeOn(canvas, event));
        if (first && ask.kind === 'sketch') draft = [ask.at];
        if (ask.kind === 'sketch') draft.push([x, y]);
        else {
          const angle = Math.atan2(y - ask.at[1], x - ask.at[0]);
          draft = 5 * Math.round(angle * DEGREES / 5) / DEGREES;
        }
        set();
      },
      drop: show,
    });
    canvas.addEventListener('keydown', (event) => {
      const move = MOVES[event.key], { range: [x0, x1] } = panes()[ask.pane], step = (x1 - x0) / 40;
      if (open() || ask.kind !== 'sketch' || !(move || (event.key === 'Backspace' && draft.length)))
        return;
      event.preventDefault();
      event.stopPropagation();
      const [x, y] = draft.length ? draft.at(-1) : ask.at, [, , y0, y1] = panes()[ask.pane].range;
      draft = move
          ? [...(draft.length ? draft : [ask.at]),
          [within(x + move[0] * step, x0, x1), within(y + move[1] * step, y0, y1)]]
          : draft.slice(0, -1);
      set();
    });
  }
  // The picture takes keys for as long as it asks, and a finger that begins where the arrow or the
  // path ends: elsewhere a finger scrolls.
  function teach(canvas) {
    const sketches = !open() && ask.kind === 'sketch', pane = panes()[ask.pane];
    grip.hidden = open();
    if (pane && !grip.hidden) {
      const [x, y] = pane.at(...(sketches ? draft.at(-1) || ask.at : ask.at)), { zoom } = pane.view;
      const [dx, dy] = sketches ? [0, 0] : [Math.cos(draft || 0), -Math.sin(draft || 0)];
      grip.style.left = `${zoom * (x + 62 * dx)}px`;
      grip.style.top = `${zoom * (y + 62 * dy)}px`;
    }
    canvas.tabIndex = sketches ? 0 : -1;
    canvas.setAttribute('role', sketches ? 'application' : 'img');
    if (sketches)
      canvas.setAttribute('aria-label',
          `${canvas.getAttribute('aria-label')} The arrow keys sketch, Backspace takes back: ` +
          `${Math.max(draft.length - 1, 0)} strokes.`);
  }
  // What was said, and what is wrong about it: of a path how far it is from the true one.
  function judged(guess) {
    if (guess === SKIPPED) return '';
    if (ask.kind === 'sketch') {
      const { x, y } = way(), far = guess.map(([px, py]) =>
        Math.min(...Array.from(x, (each, k) => Math.hypot(each - px, y[k] - py))));
      const mean = far.reduce((sum, each) => sum + each, 0) / far.length;
      return `Your path is ${written(mean, 'm', 2)} from the robot's, on average. `;
    }
    if (right(guess)) return 'As you said. ';
    return `Not so. ${ask.wrong?.[guess] ? `${ask.wrong[guess]} ` : ''}`;
  }
  function show(anew = false) {
    showTurn?.(draft * DEGREES, `${inDegrees(draft || 0)} from the right`);
    const guess = get().guess, done = open(), key = JSON.stringify([guess, done, ready()]);
    if (key === shown && !anew) return;
    shown = key;
    const guesses = done && guess !== SKIPPED;
    skip.hidden = commit.hidden = done;
    again.hidden = !done;
    never.hidden = guess !== SKIPPED || memory.neverAsk() || !memory.keepsAnswers();
    clear.hidden = !done || !memory.keepsAnswers() || (guesses && ask.kind === 'sketch');
    commit.disabled = !ready();
    options.hidden = done && ask.kind !== 'choose';
    form.querySelectorAll('input').forEach((each) => {
      each.disabled = done;
      if (ask.kind === 'choose') each.checked = Number(each.value) === (done ? guess : draft);
    });
    form.classList.toggle('live-answered', done);
    if (ask.kind === 'choose')
      options.querySelectorAll('label').forEach((each, k) => {
        each.classList.toggle('live-key', done && k === ask.key);
        each.hidden = done && k !== ask.key && k !== guess;
      });
    putWords(verdict, done ? judged(guess) + ask.why : '');
    root.closest('.live').dataset.open = String(done);
    if (renewed && !done) { renewed = false; form.querySelector('input')?.focus(); }
    if (answered) { answered = false; verdict.focus(); } // where a keyboard and a voice go on
  }
  function draw() {
    show();
    listen();
    if (listening) teach(host(ask.pane).querySelector('canvas'));
    const pane = panes()[ask.pane],
        said = open() ? get().guess : ask.kind === 'turn' ? draft || 0 : draft;
    if (!pane || said === null || said === SKIPPED) return;
    if (ask.kind === 'turn') {
      const [x, y] = pane.at(...ask.at), along = Math.cos(said), up = Math.sin(said),
          side = along < 0 ? -1 : 1;
      pane.arrow(...ask.at, ...pane.view.toWorld(x + 62 * along, y - 62 * up), 'ghost',
          { dash: [5, 5] });
      // beside the shaft, and beyond the ring that turns it
      pane.text('your guess', ...ask.at, { dx: side * Math.max(98 * Math.abs(along), 14),
        dy: 98 * up + (up < 0 ? -14 : 14), role: 'ghost', align: side < 0 ? 'right' : 'left',
        fixed: true });
    }
    if (ask.kind === 'sketch' && said.length) pane.line(said, 'ghost', { width: 3, dash: [3, 6] });
  }
  return { open, draw };
}
