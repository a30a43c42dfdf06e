// A prediction before the result: one chooses an answer, turns an arrow or sketches a path; then
// the picture opens, with what was said in it, and moves from what was given to what was asked.

import * as memory from './memory.js';
import { DEGREES, inDegrees, written } from './style.js';
import { MOVES, held, made, onArrows, placeOn } from './hands.js';
import { putChip } from './box.js';
import { putWords } from './symbols.js';
import { within } from './numbers.js';
import { wrap } from './model.js';

const SKIPPED = 'skipped'; // a guess that is nobody's
export const TOLERANCE = 20 / DEGREES; // of an arrow that was turned rightly
const DIAL = 62; // px, the length of the arrow
const capital = (text) => text[0].toUpperCase() + text.slice(1);

/** Where an arrow points before anybody turns it: well beside the answer. @param {number} key */
export const begunAt = (key) => [0, Math.PI, Math.PI / 2, -Math.PI / 2]
    .find((angle) => Math.abs(wrap(angle - key)) > 3 * TOLERANCE);

/** A sentence for each answer, and for none. @returns {Record<string, string>} */
function verdictsOf({ kind, options, key, why, wrong }) {
  if (kind === 'turn')
    return { right: `Yes. ${why}`, wrong: `No: 180° off. ${why}`, skipped: why };
  if (kind === 'sketch')
    return { sketched: `Your path is 0.00 m from the robot's, on average. ${why}`, skipped: why };
  const verdict = (text, k) => (k === key ? `Yes, ${options[key]}. ${why}`
      : `No: ${options[key]}. ${wrong[k] || why}`);
  return { ...options.map(verdict), skipped: `${capital(options[key])}. ${why}` };
}

// `ask` is { name, kind, question, key, why } and, by its kind: `options` to choose from, with what
// is `wrong` about each; `pane` and `at` of an arrow to turn; `pane` and `at`, the start, of a path
// to sketch. `key` is the number of the option or the arrow's angle in radians; of a path there is
// none, but `way()` is the true one. `reveal(moving)` shows what was asked, and `close()` what was
// given. Of the rows of chips `after` is the one for when it is open.
export function buildGate(root, box, after, ask,
    { get, set, panes, host, way, reveal, close, announce }) {
  const guessed = () => get().guess, open = () => guessed() !== null && guessed() !== undefined;
  const begun = ask.kind === 'turn' ? begunAt(ask.key) : 0;
  /** @type {any} */
  let draft = null;
  let listening = false, shown = null, answered = false, renewed = false, grip = null;
  const question = box.line('live-question', ask.question),
      answers = box.row('live-answers', ask.question);
  const verdicts = Object.fromEntries(Object.entries(verdictsOf(ask)).map(
      ([name, text]) => [name, box.line('live-verdict', text)]));
  (ask.options || []).forEach((text, k) => putChip(answers, text, () => answer(k)));
  const done = ask.kind === 'choose' ? null
      : putChip(answers, 'That\'s it', () => { if (ready()) answer(draft); });
  putChip(answers, 'Just show me', () => answer(SKIPPED), 'live-quiet live-skip');
  putChip(after, 'Try again', () => { memory.forget(ask.name); tryAgain(); },
      'live-quiet live-again');
  if (memory.keepsAnswers()) {
    const menu = made(root, 'details', { className: 'live-menu' });
    made(menu, 'summary', { textContent: '⋯' }, { 'aria-label': 'more about predictions' });
    const list = made(menu, 'div'), item = (text, act) =>
      putChip(list, text, () => { menu.open = false; act(); }, 'live-quiet');
    item('Never ask me', () => { memory.ask(true); if (!open()) answer(SKIPPED); });
    item('Forget all my answers', () => { memory.forgetAll(); tryAgain(); });
  }

  function tryAgain() {
    draft = null;
    renewed = true;
    set({ guess: null });
    close();
  }
  function answer(guess) {
    set({ guess });
    answered = true;
    if (guess !== SKIPPED) memory.remember(ask.name, guess);
    reveal(true);
  }
  const before = memory.recall(ask.name) ?? (memory.neverAsk() ? SKIPPED : null);
  if (before !== null && !open()) { set({ guess: before }); reveal(false); }
  const ready = () => (ask.kind === 'sketch' ? draft?.length > 3 : draft !== null);

  // The line that judges a guess: of a path by how far it is from the true one.
  function judged(guess) {
    if (guess === SKIPPED || ask.kind === 'choose') return verdicts[guess];
    if (ask.kind === 'sketch') {
      const { x, y } = way(), far = guess.map(([px, py]) =>
        Math.min(...Array.from(x, (each, k) => Math.hypot(each - px, y[k] - py))));
      const mean = far.reduce((sum, each) => sum + each, 0) / far.length;
      putWords(verdicts.sketched, `Your path is ${written(mean, 'm', 2)} from the robot's, on ` +
          `average. ${ask.why}`);
      return verdicts.sketched;
    }
    const off = Math.abs(wrap(guess - ask.key));
    if (off < TOLERANCE) return verdicts.right;
    putWords(verdicts.wrong, `No: ${inDegrees(off, 0)} off. ${ask.why}`);
    return verdicts.wrong;
  }

  function turned(angle) {
    draft = 5 * Math.round(wrap(angle) * DEGREES / 5) / DEGREES;
    set();
  }
  function listen() { // to a hand that turns the arrow or draws the path
    if (listening || !ask.pane || !panes()[ask.pane]) return;
    listening = true;
    const canvas = host(ask.pane).querySelector('canvas'), turns = ask.kind === 'turn';
    grip = made(host(ask.pane), 'div', { className: 'live-grip' }, turns ? { role: 'slider',
      tabindex: '0', 'aria-valuemin': -180, 'aria-valuemax': 180,
      'aria-label': 'the angle of the arrow, degrees counter-clockwise from the right' } : {});
    for (const each of [canvas, grip]) held(each, {
      take: () => !open(),
      drag(event, first) {
        const [x, y] = panes()[ask.pane].view.toWorld(...placeOn(canvas, event));
        if (turns) { turned(Math.atan2(y - ask.at[1], x - ask.at[0])); return; }
        draft = first ? [ask.at, [x, y]] : [...draft, [x, y]];
        set();
      },
      drop: show,
    });
    if (turns)
      onArrows(grip, ([across, up]) => turned((draft ?? begun) + (across + up) * 5 / DEGREES));
    canvas.addEventListener('keydown', (event) => {
      const move = MOVES[event.key], { range: [x0, x1] } = panes()[ask.pane], step = (x1 - x0) / 40;
      if (open() || turns || !(move || (event.key === 'Backspace' && draft))) return;
      event.preventDefault();
      event.stopPropagation();
      const [x, y] = draft ? draft.at(-1) : ask.at, [, , y0, y1] = panes()[ask.pane].range;
      const longer = move && [...(draft || [ask.at]),
        [within(x + move[0] * step, x0, x1), within(y + move[1] * step, y0, y1)]];
      draft = longer || (draft.length > 2 ? draft.slice(0, -1) : null);
      set();
    });
  }
  // The picture takes keys for as long as it asks, and a finger that begins where the arrow or the
  // path ends: elsewhere a finger scrolls.
  function teach(canvas) {
    const sketches = !open() && ask.kind === 'sketch', pane = panes()[ask.pane];
    grip.hidden = open();
    if (pane && !grip.hidden) {
      const [x, y] = pane.at(...(sketches && draft ? draft.at(-1) : ask.at)), { zoom } = pane.view;
      const angle = draft ?? begun, [dx, dy] = sketches ? [0, 0]
          : [Math.cos(angle), -Math.sin(angle)];
      grip.style.left = `${zoom * (x + DIAL * dx)}px`;
      grip.style.top = `${zoom * (y + DIAL * dy)}px`;
      if (!sketches) {
        grip.setAttribute('aria-valuenow', String(Math.round(angle * DEGREES)));
        grip.setAttribute('aria-valuetext', `${inDegrees(angle, 0)} from the right`);
      }
    }
    canvas.tabIndex = sketches ? 0 : -1;
    canvas.setAttribute('role', sketches ? 'application' : 'img');
    if (sketches)
      canvas.setAttribute('aria-label',
          `${canvas.getAttribute('aria-label')} The arrow keys sketch, Backspace takes back: ` +
          `${draft ? draft.length - 1 : 0} strokes.`);
  }
  function show() {
    if (done) done.disabled = !ready();
    const guess = guessed(), key = JSON.stringify(guess ?? null);
    if (key === shown) return;
    shown = key;
    const line = open() ? judged(guess) : question;
    box.show(line, open() ? after : answers);
    root.closest('.live').dataset.open = String(open());
    if (renewed && !open()) (grip || answers.querySelector('button')).focus();
    if (answered) { // where a keyboard and a voice go on
      line.focus({ preventScroll: true });
      announce(line.textContent);
    }
    renewed = answered = false;
  }
  function draw() {
    show();
    listen();
    if (listening) teach(host(ask.pane).querySelector('canvas'));
    const pane = panes()[ask.pane],
        guess = open() ? guessed() : ask.kind === 'turn' ? draft ?? begun : draft;
    if (!pane || guess === null || guess === SKIPPED) return;
    if (ask.kind === 'turn') {
      const [x, y] = pane.at(...ask.at), along = Math.cos(guess), up = Math.sin(guess),
          side = along < 0 ? -1 : 1;
      pane.arrow(...ask.at, ...pane.view.toWorld(x + DIAL * along, y - DIAL * up), 'ghost',
          { dash: [5, 5] });
      // beside the shaft, and beyond the ring that turns it
      pane.text('your guess', ...ask.at, { dx: side * Math.max(98 * Math.abs(along), 14),
        dy: 98 * up + (up < 0 ? -14 : 14), role: 'ghost', align: side < 0 ? 'right' : 'left',
        fixed: true });
    }
    if (ask.kind === 'sketch') pane.line(guess, 'ghost', { width: 3, dash: [3, 6] });
  }
  return { open, draw };
}
