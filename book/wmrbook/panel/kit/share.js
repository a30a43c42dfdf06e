// A run to take along: as a link, as Python, as CSV and as a picture.

import { FONT } from './style.js';
import { LAWS } from './model.js';
import { RUN_COLUMNS } from './simulate.js';
import { checkKinds, differences, runOf, settingsOf } from './settings.js';
import { made } from './hands.js';

export function pythonOf(settings) {
  const { start, goal, law, gains, feedback, method, dt, duration, wheels } = settings,
      moving = settings.reference !== null;
  const named = (values) => Object.entries(values).map(([name, value]) => `${name}=${value}`),
      call = (name, values) => `wmr.${name}(${values.join(', ')})`;
  const ends = (moving ? [start] : [start, goal]).map((pose) => call('Pose', pose)),
      tuning = LAWS[law].gains.includes('k_x') ? call('KanayamaGains', named(feedback))
      : call('Gains', named(gains));
  const how = named({ law: `"${law}"`, method: `"${method}"`, dt, duration,
    ...(wheels && { wheels: call('Wheels', named(wheels)) }),
    ...(!moving && { arrival_radius: settings.arrivalRadius }) });
  const rows = [...(moving ? ['paper.circle'] : []), ...ends, tuning, ...how]
      .map((row) => `    ${row},\n`).join('');
  return `import wmrlib as wmr\n${moving ? 'from wmrlib import paper\n' : ''}\n`
    + `run = wmr.${moving ? 'track' : 'simulate'}(\n${rows})\nprint(wmr.arrival(run))\n`;
}

// As a table, its columns named as the fields of a Trajectory.
export function csvOf(run) {
  const lines = [RUN_COLUMNS.join(',')];
  for (let k = 0; k < run.n; k += 1) lines.push(RUN_COLUMNS.map((name) => run[name][k]).join(','));
  return `${lines.join('\n')}\n`;
}

// The canvases that are shown, side by side, below the sentence on the run.
export function pictureOf(canvases, sentence, colours) {
  const image = document.createElement('canvas'), ctx = image.getContext('2d'),
      head = Math.round(canvases[0].height / 14);
  image.width = canvases.reduce((sum, each) => sum + each.width, 0);
  image.height = head + Math.max(...canvases.map((each) => each.height));
  ctx.fillStyle = colours.paper;
  ctx.fillRect(0, 0, image.width, image.height);
  ctx.fillStyle = colours.ink;
  ctx.font = `600 ${0.55 * head}px ${FONT}`;
  ctx.fillText(sentence, 0.4 * head, 0.7 * head, image.width - 0.8 * head);
  let x = 0;
  for (const each of canvases) { ctx.drawImage(each, x, head); x += each.width; }
  return new Promise((done) => { image.toBlob(done); });
}

export function download(name, blob) {
  const link = Object.assign(document.createElement('a'),
      { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

// Whether a text is in the clipboard: the old way, which needs no permission and works in a page
// from the disk too. Where it does not, the text stands there to be copied by hand.
export function copied(root, text) {
  root.querySelectorAll('.wmr-text').forEach((each) => each.remove());
  const before = /** @type {HTMLElement} */ (document.activeElement);
  const box = made(root, 'textarea', { className: 'wmr-text', value: text, readOnly: true },
      { 'aria-label': 'to copy' });
  box.select();
  if (!document.execCommand('copy')) return false;
  box.remove();
  before.focus();
  return true;
}

// Where a page is an application with a kernel, a link leads to another kernel, whose Python would
// not know what the panel shows.
export const canLink = () => document.getElementById('jupyter-config-data') === null;

// What a panel is called in a link: a page may have several, which differ in the state that they
// were made with.
function nameOf(home) {
  let hash = 7;
  for (const each of JSON.stringify(Object.entries(home).sort()))
    hash = (31 * hash + each.codePointAt(0)) % 2 ** 32;
  return hash.toString(36);
}

// What comes before the question mark of a fragment is a slide's number.
export function linkOf(home, state) {
  const values = new URLSearchParams({ panel: nameOf(home) });
  for (const [name, value] of Object.entries(differences(state, home)))
    values.set(name, JSON.stringify(value));
  return `${location.href.split('#')[0]}#${location.hash.slice(1).split('?')[0]}?${values}`;
}

// What the page's address changes of this panel's state, or null where it is no link to this panel.
// Throws RangeError, which names a value that the panel can't have: it takes all of a link, or
// none.
export function stateInLink(setup) {
  const { home } = setup;
  // slides rewrite their address
  const opened = performance.getEntriesByType('navigation')[0]?.name || '';
  const address = location.hash.includes('?') ? location.hash : opened.slice(opened.indexOf('#'));
  const asked = new URLSearchParams(address.split('?')[1] || '');
  if (asked.get('panel') !== nameOf(home) || !canLink()) return null;
  const values = {};
  for (const [name, text] of asked) {
    if (!Object.hasOwn(home, name)) continue;
    try { values[name] = JSON.parse(text); } catch { values[name] = text; }
  }
  const state = { ...home, ...values };
  checkKinds(state, setup);
  runOf(settingsOf(state)); // whatever else is not allowed
  return values;
}
