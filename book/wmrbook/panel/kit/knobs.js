// The sentence and its numbers, a slider for each, and the buttons that play.

import { fromWords, placeOf, putSlider, stepped, stopsOf } from './controls.js';
import { held, made } from './hands.js';
import { inWords, isCalm } from './style.js';
import { putSymbol, roleOf } from './symbols.js';
import { within } from './numbers.js';

const DRAG = 5; // px of a number's drag a step
const GLIDE = 1500, PAUSE = 500; // ms: from one place to the next, and before and after

// A number among words: it can be dragged, typed over, and stepped with the arrow keys.
function putNumber(parent, knob, { get, set, refuse }) {
  const it = made(parent, 'input',
      { className: 'live-number', inputMode: 'decimal', autocomplete: 'off' },
      { 'aria-label': knob.says, role: 'spinbutton', 'aria-valuemin': knob.low,
      'aria-valuemax': knob.high });
  // of digits that are selected: the browser would take the pointer away
  it.addEventListener('dragstart', (event) => event.preventDefault());
  let from = null;
  held(it, {
    slack: DRAG,
    take({ clientX }) { from = { x: clientX, value: get() }; return true; },
    drag({ clientX }, first) {
      if (first) it.blur();
      set(stepped(knob.stops, from.value, Math.round((clientX - from.x) / DRAG)));
    },
  });
  it.addEventListener('keydown', (event) => {
    event.stopPropagation(); // a notebook would take the keys to change cells
    const by = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (event.key === 'Escape') it.value = it.dataset.shown;
    if (!by) return;
    event.preventDefault();
    set(stepped(knob.stops, get(), by));
  });
  it.addEventListener('input', () => refuse('')); // what was refused is no longer there
  it.addEventListener('change', () => {
    const value = fromWords(it.value);
    if (value >= knob.low && value <= knob.high) set(value);
    else refuse(
        `${it.value ? `${it.value} is not allowed: a` : 'A'} number from ` +
        `${inWords(knob.low)} to ${inWords(knob.high)} is needed.`);
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

export function putKnobs(root, setup, { get, set, refuse, changed }) {
  const sentence = root.querySelector('.live-sentence'), rows = root.querySelector('.live-rows'),
      results = {}, shows = [], timers = [], plays = [];
  const parts = Object.fromEntries(setup.knobs.map((knob) => [knob.name, knob]));
  for (const knob of setup.knobs)
    if (!knob.choices) knob.stops = stopsOf(knob.low, knob.high, knob.step);
  const put = (name) => (value) => set({ [name]: value });
  let into = sentence;
  // what can be changed, and the full stop or comma after it, on one line
  for (const piece of setup.sentence.split(/(\{[^}]+\}[.,;:]?|\*[a-z_]+\*|[[\]])/)) {
    // {name!}: without its symbol and unit, as in a formula
    const [, name, bare, stop] = piece.match(/^\{([^!}]+)(!?)\}(.*)$/) || [], knob = parts[name];
    if (piece === '[') into = made(sentence, 'span', { className: 'live-whole' });
    else if (piece === ']') into = sentence;
    else if (piece[0] === '*') putSymbol(into, piece.slice(1, -1));
    else if (knob && knob.choices) {
      const whole = made(into, 'span', { className: 'live-whole' }), select =
          made(whole, 'select', { className: 'live-choice' }, { 'aria-label': knob.says });
      whole.append(stop);
      select.replaceChildren(...knob.choices.map(([value, text]) => new Option(text, value)));
      select.addEventListener('change', () => put(name)(select.value));
      select.addEventListener('keydown', (event) => event.stopPropagation());
      shows.push((values) => { select.value = values[name]; });
    } else if (knob) {
      const whole = made(into, 'span', { className: 'live-whole' });
      if (knob.symbol && !bare) { putSymbol(whole, knob.symbol); whole.append(' = '); }
      const show = putNumber(whole, knob,
          { get: () => get()[name], set: put(name), refuse });
      if (knob.unit && !bare) whole.append(knob.unit === '°' ? knob.unit : ` ${knob.unit}`);
      whole.append(stop);
      shows.push((values) => show(values[name]));
    } else if (name) {
      (results[name] ||= []).push(made(into, 'b', { className: 'live-result' }));
      into.append(stop);
    } else into.append(into === sentence ? piece : piece.replaceAll('-', '−'));
  }
  for (const knob of setup.knobs.filter((each) => each.stops)) {
    const row = made(rows, knob.plays ? 'div' : 'label', { className: 'wmr-control live-row' }),
        { stops, name } = knob, own = made(row, 'span');
    row.dataset.control = name;
    if (knob.symbol) putSymbol(own, knob.symbol); else own.textContent = knob.label;
    const role = roleOf(knob.symbol);
    if (role) row.style.setProperty('--knob-colour', `var(--${role})`);
    const showSlider = putSlider(row, knob.says, stops, {
      get: () => get()[name], set: put(name),
    });
    let playing = 0;
    const call = (text) => {
      button.textContent = text;
      button.setAttribute('aria-label', `${text}: ${knob.says}`);
    };
    const stop = () => {
      if (!playing) return;
      cancelAnimationFrame(playing);
      playing = 0;
      call('Play');
      set({});
    };
    const play = () => {
      if (playing) { stop(); return; }
      halt();
      const from = get()[name] >= knob.high ? knob.low : get()[name], begin = performance.now();
      const go = (now) => {
        const value = Math.min(from
            + (knob.high - knob.low) * Math.max(now - begin, 0) / 1000 / knob.plays, knob.high);
        set({ [name]: Number(value.toPrecision(3)) }, true);
        if (value < knob.high) playing = requestAnimationFrame(go); else stop();
      };
      call('Stop');
      go(begin); // where it begins is shown at once: a hand may stop it before the next frame
    };
    const button = knob.plays
        ? made(row, 'button', { type: 'button', className: 'live-play', onclick: play }) : null;
    if (button) call('Play');
    timers.push(stop);
    // What happens in time is seen once more; a heading that turns stays where it was asked for.
    if (button && knob.value === knob.high)
      plays.push(() => { set({ [name]: knob.low }, true); play(); });
    if (knob.auto && !isCalm()) whenSeen(row, () => { if (!playing) play(); });
    shows.push((values) => {
      showSlider(values[name], `${inWords(values[name])} ${knob.unit}`.trim());
    });
  }
  // One place after another, each knob along its stops; a hand stops it, as it stops what plays.
  let gliding = 0;
  function halt() {
    const was = gliding;
    clearTimeout(gliding);
    cancelAnimationFrame(gliding);
    gliding = 0;
    delete root.dataset.moving;
    if (was) set({}); // a kernel hears where it ends
  }
  timers.push(halt);
  function glide(places, done) {
    root.dataset.moving = 'true';
    const [place, ...rest] = places;
    if (!place) {
      const last = plays.at(-1);
      halt();
      if (last) last(); else done();
      return;
    }
    const from = { ...get() }, begin = performance.now();
    const go = (now) => {
      const share = within((now - begin - PAUSE) / GLIDE, 0, 1), at = {};
      for (const [name, to] of Object.entries(place)) {
        const { stops } = parts[name], where = (value) => placeOf(stops, value);
        at[name] = share === 1 || !stops ? to : stops[Math.round(where(from[name])
            + share * (where(to) - where(from[name])))];
        if (!stops && share === 0) at[name] = from[name];
      }
      set(at, true);
      gliding = share < 1 ? requestAnimationFrame(go)
          : window.setTimeout(() => glide(rest, done), PAUSE);
    };
    go(begin);
  }
  const show = (values) => shows.forEach((each) => each(values));
  const showResults = (said) => {
    for (const [name, places] of Object.entries(results)) {
      const text = said ? String(said[name]) : '–'; // nothing follows from what is refused
      for (const place of places)
        if (place.textContent !== text) { place.textContent = text; changed(); }
    }
  };
  const moving = () => gliding || root.querySelector('.live-play[aria-label^="Stop"]');
  return { show, showResults, glide, moving, stop: () => timers.forEach((each) => each()) };
}

// Calls once, when an element comes into view.
function whenSeen(element, act) {
  const watch = new IntersectionObserver((entries) => {
    if (entries.some((each) => each.isIntersecting)) { watch.disconnect(); act(); }
  });
  watch.observe(element);
}
