// A map that zooms from a lawn to a country: where a flat map puts a point that is seen to the
// north-east, how far from there it lies on the sphere, and which way north is there.

import {
  DEGREES, disc, inReach, inside, lengthText, live, ring, roundBelow, within, written,
} from '../drawing.js';

const power = (value) =>
    (Number.isInteger(value)
    ? `10${[...String(value)].map((each) => '⁻⁰¹²³⁴⁵⁶'['-0123456'.indexOf(each)]).join('')}` : '');
const LENS = 62, RINGS = [10, 100, 1e3, 1e4, 1e5, 1e6], SIDE = Math.SQRT1_2; // px, m
const LAWN = 100; // m, its side

// [east, north] by distance and bearing, and by the flat map, of the point `rho` metres to the
// north-east of latitude `lat`.
function bothMaps(rho, lat, radius) {
  const turn = rho / radius, from = lat / DEGREES;
  const to = Math.asin(Math.sin(from) * Math.cos(turn) + Math.cos(from) * Math.sin(turn) * SIDE);
  const lon = Math.atan2(SIDE * Math.sin(turn) * Math.cos(from),
      Math.cos(turn) - Math.sin(from) * Math.sin(to));
  return [[rho * SIDE, rho * SIDE], [radius * lon * Math.cos(from), radius * (to - from)]];
}
/** @type {(maps: Point[]) => number} */
const between = ([[x, y], [x2, y2]]) => Math.hypot(x - x2, y - y2);

// By distance and bearing again: the point that the flat map has at `east` and `north`.
function onSphere(east, north, lat, radius) {
  const from = lat / DEGREES, to = from + north / radius, lon = east / radius / Math.cos(from);
  const [x, y] = [Math.sin(lon) * Math.cos(to), Math.cos(from) * Math.sin(to)
    - Math.sin(from) * Math.cos(to) * Math.cos(lon)];
  const far = Math.atan2(Math.hypot(x, y),
      Math.sin(from) * Math.sin(to) + Math.cos(from) * Math.cos(to) * Math.cos(lon));
  const size = radius * (Math.hypot(x, y) ? far / Math.hypot(x, y) : 1);
  return [x * size, y * size];
}

export default live('flat_map', {
  find({ km, lat }, { data: { radius } }) {
    const maps = bothMaps(1000 * km, lat, radius), [, [east, north]] = maps,
        [x, y] = onSphere(east, north + km, lat, radius); // a thousandth to the north
    return { maps, off: between(maps), leans: Math.atan2(maps[0][0] - x, y - maps[0][1]) };
  },
  panes: ({ km, lat }, { off, leans }, setup, hidden) => {
    const rho = 1000 * (hidden ? setup.data.asked.km : km);
    return {
      map: { x: [-0.2 * rho, 1.05 * rho], y: [-0.2 * rho, 1.05 * rho], equal: true, bare: true,
          given: 'A lawn, and a point to the north-east of where the map begins.',
          alt: `At latitude ${written(lat)} degrees a point ${written(km, 'km')} to the ` +
          `north-east, and, in a lens, where the flat map puts it: ${lengthText(off)} away. ` +
          `North leans ${leaning(leans)} there.` },
      size: {
        x: [1, 6, 'distance [m]', power], y: [-6, 6, 'error of the flat map [m]', power],
            given: 'The error of the flat map over the distance: one dot, at 100 m.',
        alt: `The flat map's error over the distance, a straight line on logarithmic scales: ` +
            `${lengthText(off)} at ${lengthText(1000 * km)}.`,
        scrub: (x) => inReach(setup, { km: 10 ** (x - 3) }),
      },
    };
  },
  draw({ map, size }, values, { maps, off, leans }, hidden, { data: { radius, asked } }) {
    const { km, lat } = hidden ? asked : values, rho = 1000 * km, { ctx } = map;
    map.rect(0, 0, LAWN, LAWN, 'lawn', 1);
    for (let left = 0; left < LAWN; left += 20) map.rect(left, 0, left + 10, LAWN, 'mown', 1);
    for (const far of RINGS.filter((each) => each > 0.02 * rho && each < 2 * rho)) {
      map.line(ring(0, 0, far), 'line', { width: 1.5 });
      const [x, y, dy] = far < 0.18 * rho ? [-far, 0, 0] : [0, far, -9]; // where less is drawn
      map.text(lengthText(far, 1), x, y,
          { role: 'soft', dx: -6, dy, size: 13, align: 'right', fixed: true });
    }
    size.line([[1, -2], [6, -2]], 'ghost', { width: 1.5, dash: [2, 4] });
    size.text('1 cm', 6, -2, { role: 'ghost', dx: -6, dy: 9, align: 'right' });
    size.dot(Math.log10(rho), Math.log10(between(bothMaps(rho, lat, radius)) || 1e-12), 'path');
    map.dot(0, 0, 'start');
    const there = [rho * SIDE, rho * SIDE], north = 0.25 * rho;
    map.line([[0, 0], there], 'rho');
    map.text(lengthText(rho), 0.5 * there[0], 0.5 * there[1],
        { role: 'rho', dx: -10, dy: 10, align: 'right' });
    if (rho < 20 * LAWN) map.robot([0, 0, Math.PI / 4]);
    if (hidden) { map.dot(...there, 'goal'); return; }
    // meridians, and the north of the map at the point
    for (let k = -2; k <= 8; k += 1)
      map.line(Array.from({ length: 41 }, (_, i) => onSphere(k * maps[1][0] / 4,
        (i - 10) / 20 * rho, lat, radius)), 'soft', { width: 1, dash: [1, 5] });
    map.line([there, [there[0], there[1] + north]], 'ghost', { width: 2, dash: [5, 5] });
    map.arrow(...there, there[0] - north * Math.sin(leans), there[1] + north * Math.cos(leans),
        'ink', { width: 2 });
    map.text(`north leans ${leaning(leans)}`, ...there, { dx: -10, dy: 34, align: 'right' });
    map.dot(...there, 'goal');
    // a lens, whose width is a round number
    const centre = map.view.toWorld(map.box.left + map.box.width - LENS - 6,
        map.box.top + map.box.height - LENS - 6), wide = roundBelow(8 * off || 8e-9);
    const scale = 2 * LENS * map.pixel / wide, [x, y] = map.at(centre[0], centre[1]);
    const spot = maps[1].map((each, k) => centre[k] + (each - maps[0][k]) * scale);
    map.line([there, centre], 'soft', { width: 1 });
    disc(ctx, [x, y], LENS, map.ink('raised'), map.ink('soft'), 2);
    inside(ctx, { left: x - LENS, top: y - LENS, width: 2 * LENS, height: 2 * LENS }, () => {
      map.line([centre, spot], 'rising', { width: 3 });
      map.dot(...spot, 'ghost', { hollow: true, size: 5 });
      map.dot(...centre, 'goal', { size: 5 });
    });
    map.text('flat map', within(spot[0], centre[0] - 0.5 * LENS * map.pixel,
      centre[0] + 0.5 * LENS * map.pixel), spot[1],
    { role: 'ghost', dy: -14, align: 'center', size: 13 });
    map.text(`${lengthText(wide, 1)} wide`, ...centre, { role: 'soft', dy: LENS - 14,
      align: 'center', size: 13 });
    size.curve((each) => Math.log10(between(bothMaps(10 ** each, lat, radius)) || 1e-12));
  },
  handles: ({ km }, { off }, setup) => [{
    id: 'distance', pane: 'size', says: `the distance, ${km} km`,
    at: [Math.log10(1000 * km), Math.log10(off || 1e-12)],
    move: (x) => inReach(setup, { km: 10 ** (x - 3) }),
  }],
  say: (values, { off, leans }) => ({ off: lengthText(off), leans: leaning(leans) }),
});

const leaning = (angle) => (Math.abs(angle * DEGREES) < 0.001 ? 'less than 0.001°'
    : written(Math.abs(angle * DEGREES), '°'));
