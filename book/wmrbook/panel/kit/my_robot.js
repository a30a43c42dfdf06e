// My robot: two points and a data sheet go in; the numbers that it is told, where it will park, and
// the files for it come out.

import { DEGREES, written } from './style.js';
import { certified, filesOf, parkedRun, placeOf, sheetOf } from './sheet.js';
import { download } from './share.js';
import { keepKeys } from './controls.js';
import { made } from './hands.js';
import { paneOf } from './board.js';
import { pointsOf } from './nmea.js';
import { repainted } from './surface.js';
import { ahead, ring } from './numbers.js';
import { widget } from './widget.js';

const AT_ONCE = 30; // ms that the page may be busy
const OWN = 'my own';

// What the points of a log fill in, by the first field of the group that takes it.
const LOGS = {
  start_lat: ['from the log of a drive', (points) => {
    const [[start_lat, start_lon], [goal_lat, goal_lon]] = [points[0], points[points.length - 1]]
        .map((point) => point.map((degrees) => Number(degrees.toFixed(7))));
    return { start_lat, start_lon, goal_lat, goal_lon };
  }],
  sigma: ['from a log at rest', (points, { earth }) => {
    const near = scattered(points, earth),
        places = near.map((point) => placeOf(near[0], point, earth));
    const spread = (k) => {
      const mean = places.reduce((sum, place) => sum + place[k], 0) / places.length;
      return places.reduce((sum, place) => sum + (place[k] - mean) ** 2, 0) / places.length;
    };
    return { sigma: Number(Math.sqrt((spread(0) + spread(1)) / 2).toPrecision(4)) };
  }],
};

// The points that are not far outside the scatter of the others, as wmrlib's `strays` has it.
function scattered(points, earth) {
  const sorted = (values) => [...values].sort((a, b) => a - b),
      median = (values) => sorted(values)[values.length >> 1],
      [, east] = points[0], // so that the date line does not matter
      lon = median(points.map((point) => (point[1] - east + 540) % 360)) - 180 + east,
      middle = [median(points.map((point) => point[0])), lon],
      far = points.map((point) => Math.hypot(...placeOf(middle, point, earth))),
      most = sorted(far)[Math.floor(0.75 * (far.length - 1))];
  return points.filter((_, k) => far[k] <= Math.max(1, 10 * most));
}

// Rows of names and values.
function table(parent, title) {
  const box = made(parent, 'section');
  made(box, 'p', { className: 'my-title', textContent: title });
  const list = made(box, 'dl');
  return (rows) => {
    list.textContent = '';
    for (const [name, value] of rows) {
      made(list, 'dt', { textContent: name });
      made(list, 'dd', { textContent: value });
    }
  };
}

const told = (robot, { gains, turn, ...sheet }) => [
  ['distance', written(sheet.distance, 'm')],
  ['arrival radius', written(sheet.radius, 'm')],
  ['k_rho', written(gains.k_rho, '1/m')],
  ['k_alpha', written(gains.k_alpha, '1/s')],
  ['h', written(gains.h)],
  ['v_max', written(gains.v_max, 'm/s')],
  ['kappa, 2 to 1 + h', written(gains.k_alpha / (gains.k_rho * gains.v_max))],
  ['longest step', `${written(sheet.longest_step, 's')} (yours: ${written(robot.period, 's')})`],
  ['least speed', written(sheet.wheels.min_speed, 'm/s')],
  ['last turn, within', written(turn.tolerance * DEGREES, '°')],
  ['last turn, rates', `${written(turn.min_rate)} to ${written(turn.max_rate, 'rad/s')}`],
  ['oldest fix, patience',
    `${written(sheet.rules.oldest)} and ${written(sheet.rules.patience, 's')}`],
  ['largest error, jump of a fix',
    `${written(sheet.rules.largest_error)} and ${written(sheet.rules.jump, 'm')}`],
];

const bounded = (value, unit) => (value === Infinity ? 'no bound' : written(value, unit));

const expected = (found, runs) => [
  ['parked', `${found.parked} of ${runs}`],
  ['place, rms', bounded(found.place_rms, 'm')],
  ['place, 95 % of drives', bounded(found.place_bound, 'm')],
  ['heading, rms', bounded(found.heading_rms * DEGREES, '°')],
  ['heading, 95 % of drives', bounded(found.heading_bound * DEGREES, '°')],
  ['time, median', bounded(found.time, 's')],
];

function render({ model, el }) {
  const root = made(el, 'div', { className: 'wmr my-robot' }),
      { groups, receivers, qualities, rules, files: templates } = model.get('setup');
  root.dataset.lmSuppressShortcuts = 'true';
  keepKeys(root);
  const form = made(root, 'div', { className: 'my-fields' }), inputs = {};
  const heard = made(root, 'output', { className: 'my-heard' }),
      trouble = made(root, 'p', { className: 'live-trouble' }, { role: 'alert' });
  const results = made(root, 'div', { className: 'my-results' }),
      showTold = table(results, 'What it is told'),
      showExpected = table(results, 'Where it will park'),
      canvas = made(results, 'canvas', {}, { role: 'img', 'aria-label': 'not yet driven' });
  const sentence = made(root, 'p', {}, { role: 'status' }),
      bar = made(root, 'div', { className: 'wmr-bar' });
  let colours, turn = 0, ends = [], sheet = null, waiting = 0;

  const robot = () => model.get('state');
  const presumed = () => qualities[robot().quality - 1];
  function change(values) {
    model.set('state', { ...robot(), ...values });
    model.save_changes();
  }
  let kinds = null;
  for (const [title, fields] of groups) {
    const group = made(form, 'fieldset');
    made(group, 'legend', { textContent: title });
    if (fields.some(([name]) => name === 'sigma')) {
      const row = made(group, 'label', { className: 'my-row' });
      made(row, 'span', { textContent: 'kind of fix' });
      const menu = kinds = made(row, 'select');
      for (const name of [...receivers.map(([each]) => each), OWN])
        made(menu, 'option', { textContent: name, value: name });
      menu.onchange = () => change(Object.fromEntries(receivers)[menu.value] || {});
    }
    const [words, filled] = LOGS[fields[0][0]] || [];
    if (filled) {
      const row = made(group, 'label', { className: 'my-row' });
      made(row, 'span', { textContent: words });
      made(row, 'input', { type: 'file', onchange: async ({ target: { files: [file] } }) => {
        const points = file ? pointsOf(await file.text()) : [];
        if (points.length) change(filled(points, rules));
        if (file) heard.textContent = `${file.name}: ` + (points.length
          ? `${points.length} fixes` : 'no NMEA sentence with a fix and its checksum');
      } });
    }
    for (const [name, label] of fields) {
      const row = made(group, 'label', { className: 'my-row' });
      made(row, 'span', { textContent: label });
      inputs[name] = made(row, 'input', { type: 'number', step: 'any', className: 'wmr-typed',
        onchange: ({ target }) => change({ [name]: target.valueAsNumber }) }, { name });
      made(row, 'span', { textContent: rules.bounds[name][2].replace('degrees', '°') });
    }
  }
  for (const name of Object.keys(templates))
    made(bar, 'button', { type: 'button', textContent: `Save ${name}`,
      onclick: () => download(name, new Blob([filesOf(robot(), sheet, rules, templates)[name]])) });

  function draw() {
    const far = ends.reduce((most, { place }) => Math.max(most, place < Infinity ? place : 0),
        sheet.radius), half = 1.15 * far;
    const pane = paneOf(canvas, colours, { equal: true, alt: '',
      x: [-half, half, 'east of the goal [m]'], y: [-half, half, 'north [m]'] });
    for (const { at } of ends.filter((end) => end.at))
      pane.arrow(at[0], at[1], ...ahead(at, far / 12), 'path', { width: 1 });
    pane.line(ring(0, 0, sheet.radius), 'goal', { width: 1.5, dash: [4, 4] });
    pane.pose([0, 0, sheet.heading], 'goal');
    pane.name();
  }

  // The runs, a few at a time, until something changes.
  function go(mine) {
    if (mine !== turn) return;
    const until = performance.now() + AT_ONCE;
    while (ends.length < rules.runs && performance.now() < until)
      ends.push(parkedRun(robot(), sheet, rules, ends.length));
    const done = ends.length === rules.runs;
    if (!done) {
      sentence.textContent = `Driving: ${ends.length} of ${rules.runs} …`;
      waiting = setTimeout(go, 0, mine);
      return;
    }
    const found = certified(ends, rules);
    showExpected(expected(found, rules.runs));
    sentence.textContent = found.place_bound === Infinity
      ? `${rules.runs - found.parked} of ${rules.runs} drives did not park in time, or their ` +
        'checks stopped them: nothing is certain of the others. Try a shorter delay, slower or ' +
        'stronger wheels, or a better compass.'
      : `With 95 % confidence, 95 of 100 drives end within ${written(found.place_bound, 'm')} of ` +
        `the goal, and as many within ${written(found.heading_bound * DEGREES, '°')} of its ` +
        `heading, if robot and receiver are as you say, and while every fix is ${presumed()}. ` +
        'With another fix the robot waits.';
    canvas.setAttribute('aria-label', `The robot about its goal after ${found.parked} drives: ` +
      `${written(found.place_rms, 'm')} off, root mean square.`);
    Object.assign(root, { found: { sheet, ends, ...found,
      files: filesOf(robot(), sheet, rules, templates) } });
    root.dataset.done = 'true';
    draw();
  }

  function compute() {
    const now = robot();
    turn += 1;
    clearTimeout(waiting);
    root.dataset.done = 'false';
    for (const [name, input] of Object.entries(inputs))
      if (document.activeElement !== input || input.valueAsNumber !== now[name])
        input.value = Number.isFinite(now[name]) ? String(now[name]) : '';
    kinds.value = receivers.find(([, each]) =>
      Object.entries(each).every(([name, value]) => now[name] === value))?.[0] || OWN;
    let said = '';
    try { sheet = sheetOf(now, rules); } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      said = error.message;
    }
    for (const [name, input] of Object.entries(inputs))
      input.setAttribute('aria-invalid', String(said.startsWith(`${name} `)));
    // what is below stays where it is
    if (!said || !results.hidden) root.style.minHeight = said ? `${root.offsetHeight}px` : '';
    trouble.textContent = said;
    results.hidden = sentence.hidden = bar.hidden = said !== '';
    if (said) { root.dataset.done = 'true'; return; }
    showTold(told(now, sheet));
    ends = [];
    go(turn);
  }

  const page = repainted(root, [root], (read) => {
    colours = read;
    if (root.dataset.done === 'true' && !results.hidden) draw();
  });
  model.on('change:state', compute);
  compute();
  return () => {
    turn += 1;
    clearTimeout(waiting);
    page.stop();
    model.off('change:state', compute);
  };
}

export default widget('my_robot', render);
