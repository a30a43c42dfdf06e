// Chapter 1: the goal as its digits have it, on the lattice of all places that they can name.

import {
  DEGREES, driven, insetOf, insetSize, lengthText, roundBelow, stage, within, written,
} from '../drawing.js';

const MARGIN = 5, BELOW = 10; // m
const [DENSE, WIDE] = [14, 200]; // px from one place that the digits can name to the next one

// Latitude and longitude of a place on the lawn, and back.
/** @type {(place: Point, data: any) => Point} */
const degreesOf = ([x, y], { origin, metres }) =>
    [origin[0] + y / metres[0], origin[1] + x / metres[1]];
/** @type {(degrees: Point, data: any) => Point} */
const placeOf = ([lat, lon], { origin, metres }) =>
    [(lon - origin[1]) * metres[1], (lat - origin[0]) * metres[0]];

// The place of the same degrees on the ellipsoid, where both have other lengths.
/** @type {(place: Point, data: any) => Point} */
const onEllipsoid = ([x, y], { curved }) => [x * curved[0], y * curved[1]];
const dist = ([x, y], [toX, toY]) => Math.hypot(toX - x, toY - y);

// Where they are neither too close for the lawn nor too far apart; else a corner shows them.
const showsLattice = (pane, step) => within(step / pane.pixel, DENSE, WIDE) === step / pane.pixel;
/**
 * @param {Pane} pane @param {Point} place @param {Point} steps @param {any} range
 * @param {(place: Point) => Point} at
 */
function lattice(pane, [x, y], [east, north], [left, right, bottom, top], at) {
  for (let i = Math.ceil((left - x) / east); x + i * east < right; i += 1)
    for (let j = Math.ceil((bottom - y) / north); y + j * north < top; j += 1)
      pane.dot(...at([x + i * east, y + j * north]), 'soft', { size: 2.5 });
}

const bearingOf = (east, north) => (Math.hypot(east, north) < 1e-3 ? 'any angle'
    : `${((Math.atan2(east, north) * DEGREES + 360) % 360).toFixed(1)}°`);

const comparedFrom = (metres) =>
  `${lengthText(Math.abs(metres))} ${metres < 0 ? 'farther from' : 'nearer to'}`;

export default stage('gps_points', {
  find({ start, goal, digits }, { data }) {
    const count = Math.round(digits), shown = (place) =>
      degreesOf(place, data).map((value) => value.toFixed(count));
    const [began, told] = [start, goal].map((place) => placeOf(shown(place).map(Number), data)),
        { gains } = data;
    const apart = shown(goal).map((value, row) =>
      `${(Number(value) - Number(shown(start)[row])).toFixed(count).replace('-', '−')}°`);
    const run = driven({ start, goal: [...told, goal[2]], gains, arrivalRadius: 0.002 });
    return { count, began, told, apart, labels: [shown(start), shown(goal)],
      steps: data.metres.map((metres) => metres * 10 ** -count),
      miss: Math.hypot(told[0] - goal[0], told[1] - goal[1]), tracks: [{ ...run, role: 'path' }] };
  },
  look({ start, goal }, { began, told }) {
    const [xs, ys] = [0, 1].map((i) => [start, goal, began, told].map((place) => place[i]));
    return [Math.min(...xs) - MARGIN, Math.min(...ys) - BELOW, Math.max(...xs) + MARGIN,
      Math.max(...ys) + MARGIN];
  },
  say: ({ start, goal }, { count, miss, began, told, apart: [dlat, dlon] }, { data }) => ({
    digits: count, miss: lengthText(miss), dlat, dlon,
    east: written(told[0] - began[0], 'm'), north: written(told[1] - began[1], 'm'),
    rho: written(dist(began, told), 'm', 4),
    course: bearingOf(told[0] - began[0], told[1] - began[1]),
    gap: lengthText(dist(goal, onEllipsoid(goal, data))),
    nearer: comparedFrom(dist(start, goal) - dist(start, onEllipsoid(goal, data))),
    distance: written(dist(start, goal), 'm'),
    bearing: bearingOf(goal[0] - start[0], goal[1] - start[1]),
  }),
  draw(pane, values, { began, told, steps: [north, east], count, apart: [dlat, dlon] },
      { shows }) {
    const corner = [told[0], began[1]];
    if (shows.includes('legs')) {
      pane.line([began, corner, told], 'ink', { width: 1.5, dash: [6, 4] });
      for (const place of [began, told]) pane.dot(...place, 'ink', { size: 4 });
      pane.text(dlon, (began[0] + corner[0]) / 2, began[1], { dy: -30, align: 'center' });
      pane.text(dlat, told[0], (began[1] + told[1]) / 2, { dx: 10 });
    }
    if (shows.includes('line')) {
      pane.line([began, [began[0], told[1]]], 'soft', { width: 1.5, dash: [6, 4] });
      pane.text('north', began[0], told[1], { role: 'soft', dy: 10, align: 'center' });
      pane.line([began, told], 'rho', { width: 2.5 });
      pane.text('ρ', (began[0] + told[0]) / 2, (began[1] + told[1]) / 2,
          { role: 'rho', dx: 12, size: 18 });
    }
    if (shows.length || !showsLattice(pane, north)) return;
    lattice(pane, told, [east, north], pane.range, (place) => place);
    pane.text(`what ${count} digits can name`, ...pane.view.toWorld(14, 18),
        { role: 'soft', size: 13, fixed: true });
  },
  above(pane, { start, goal }, { told, labels, steps: [north, east] }, { size, shows }, { data }) {
    if (shows.includes('ellipsoid')) {
      const place = onEllipsoid(goal, data);
      pane.line([goal, place], 'rising', { width: 3 });
      pane.dot(...place, 'rising', { size: 5 });
      pane.text('on the ellipsoid', ...place, { role: 'rising', dy: -44, align: 'center' });
    }
    const beside = 24 + 10 * size + within((told[0] - goal[0]) / pane.pixel, 0, 120); // px
    for (const row of [0, 1]) {
      const [first, last] = labels.map((label) => `${label[row]}° ${row ? 'E' : 'N'}`),
          dy = 8 - 18 * row;
      pane.text(first, start[0], start[1], { role: 'start', dx: -24, dy, align: 'right' });
      pane.text(last, goal[0], goal[1], { role: 'goal', dx: beside, dy });
    }
    if (shows.length || showsLattice(pane, north)) return;
    const { width, height } = insetSize(pane, 190), side = goal[0] < start[0] ? 'right' : 'left',
        wide = roundBelow(4.6 * north), tall = wide * height / width;
    const range = [goal[0] - wide / 2, goal[0] + wide / 2, goal[1] - tall / 2, goal[1] + tall / 2],
        inset = insetOf(pane, side, { width, height }, range.slice(0, 2), range.slice(2));
    inset.within(() => {
      lattice(pane, told, [east, north], range, inset.at);
      pane.line([goal, told].map(inset.at), 'rising', { width: 3 });
      pane.dot(...inset.at(goal), 'goal', { hollow: true });
      pane.dot(...inset.at(told), 'path', { size: 5 });
    });
    pane.text(`${lengthText(wide, 1)} wide`, ...inset.at([goal[0], range[2]]),
        { role: 'soft', dy: 12, align: 'center', size: 13, fixed: true });
  },
});
