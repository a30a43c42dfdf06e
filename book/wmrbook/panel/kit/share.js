// A run to take along: as a link, as Python, as CSV and as a picture.

import { FONT } from './style.js';
import { LAWS } from './model.js';
import { RUN_COLUMNS } from './simulate.js';
import { differences } from './settings.js';

const COLUMNS = RUN_COLUMNS; // of the CSV file, named as the fields of a Trajectory

export function pythonOf(settings) {
  const { start, goal, law, gains, feedback, method, dt, duration, arrivalRadius, reference,
    wheels } = settings;
  const pose = (values) => `wmr.Pose(${values.join(', ')})`,
      named = (values) =>
      Object.entries(values).map(([name, value]) => `${name}=${value}`).join(', ');
  const tuning = LAWS[law].gains.includes('k_x') ? `wmr.KanayamaGains(${named(feedback)})`
      : `wmr.Gains(${named(gains)})`;
  const how = `law="${law}",\n    method="${method}",\n    dt=${dt},\n    duration=${duration},\n`;
  const moving = reference !== null, first = moving ? 'paper.circle' : pose(start),
      second = pose(moving ? start : goal);
  return `import wmrlib as wmr\n${moving ? 'from wmrlib import paper\n' : ''}\nrun = ` +
      `wmr.${moving ? 'track' : 'simulate'}(\n    ${first},\n    ${second},\n    ${tuning},\n   ` +
      ` ${how}`
    + `${wheels ? `    wheels=wmr.Wheels(${named(wheels)}),\n` : ''}`
    + `${moving ? '' : `    arrival_radius=${arrivalRadius},\n`})\nprint(wmr.arrival(run))\n`;
}

export function csvOf(run) {
  const lines = [COLUMNS.join(',')];
  for (let k = 0; k < run.n; k += 1) lines.push(COLUMNS.map((name) => run[name][k]).join(','));
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

// The state in the page's address, if it is this panel's. What is wrong with its values the
// simulation says.
export function stateInLink(home) {
  // slides rewrite their address
  const opened = performance.getEntriesByType('navigation')[0]?.name || '';
  const address = location.hash.includes('?') ? location.hash : opened.slice(opened.indexOf('#'));
  const asked = new URLSearchParams(address.split('?')[1] || '');
  if (asked.get('panel') !== nameOf(home) || !canLink()) return {};
  const values = {};
  for (const [name, text] of asked) {
    if (!Object.hasOwn(home, name)) continue;
    try { values[name] = JSON.parse(text); } catch { values[name] = text; }
  }
  return values;
}
