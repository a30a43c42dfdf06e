// Where a flat map puts a point that is seen to the north-east, and how far from there it lies on
// the sphere.

import { DEGREES, written } from '../style.js';
import { live } from '../live.js';

const lengthText = (metres) => {
  const [size, unit] = metres >= 1e3 ? [1e-3, 'km'] : metres >= 0.999 ? [1, 'm'] : metres >= 0.00999
      ? [100, 'cm'] : metres >= 0.0000999 ? [1e3, 'mm'] : [1e6, 'µm'];
  return written(metres * size, unit);
};
const power = (value) =>
    (Number.isInteger(value)
    ? `10${[...String(value)].map((each) => '⁻⁰¹²³⁴⁵⁶'['-0123456'.indexOf(each)]).join('')}` : '');

// [east, north] by distance and bearing, and by the flat map, of the point `rho` metres to the
// north-east of latitude `lat`.
function bothMaps(rho, lat, radius) {
  const turn = rho / radius, from = lat / DEGREES, side = Math.SQRT1_2;
  const to = Math.asin(Math.sin(from) * Math.cos(turn) + Math.cos(from) * Math.sin(turn) * side);
  const lon = Math.atan2(side * Math.sin(turn) * Math.cos(from),
      Math.cos(turn) - Math.sin(from) * Math.sin(to));
  return [[rho * side, rho * side], [radius * lon * Math.cos(from), radius * (to - from)]];
}
/** @type {(maps: Point[]) => number} */
const between = ([[x, y], [x2, y2]]) => Math.hypot(x - x2, y - y2);

export default live('flat_map', {
  find({ km, lat }, { data: { radius } }) {
    const maps = bothMaps(1000 * km, lat, radius);
    return { maps, off: between(maps) };
  },
  panes: ({ km, lat }, { off }) => ({
    map: { x: [-0.12, 1.25], y: [-0.12, 1], equal: true, bare: true,
        given: 'A map, and a point to the north-east of where it begins.',
        alt: `At latitude ${written(lat)} degrees a point ${written(km, 'km')} to the ` +
        `north-east, and where the flat map puts it: ${lengthText(off)} away.` },
    size: {
      x: [1, 6, 'distance [m]', power], y: [-6, 6, 'error of the flat map [m]', power],
          given: 'Axes: distance from 10 m to 1000 km, error from a micrometre to 1000 km.',
      alt: `The flat map's error over the distance, a straight line on logarithmic scales: ` +
          `${lengthText(off)} at ${lengthText(1000 * km)}.`,
      scrub: (x) => ({ km: Number(Math.min(Math.max(10 ** (x - 3), 0.01), 1000).toPrecision(2)) }),
    },
  }),
  draw({ map, size }, { km, lat }, { maps, off }, hidden, { data: { radius } }) {
    const rho = 1000 * km, [true_, flat] = maps.map((each) => each.map((one) => one / rho));
    map.arrow(0, 0, 0, 0.95, 'ink', { width: 1.5 });
    map.text('north', 0, 0.95, { dx: 8 });
    map.arrow(0, 0, 0.95, 0, 'ink', { width: 1.5 });
    map.text('east', 0.95, 0, { dy: 12, align: 'center' });
    map.dot(0, 0, 'start');
    size.line([[1, -2], [6, -2]], 'ghost', { width: 1.5, dash: [2, 4] });
    size.text('1 cm', 6, -2, { role: 'ghost', dx: -6, dy: 9, align: 'right' });
    if (hidden) return;
    map.line([[0, 0], true_], 'rho');
    map.line(
        Array.from({ length: 41 },
        (_, k) => bothMaps(rho * (k || 1e-3) / 40, lat, radius)[1].map((one) => one / rho)),
        'ghost', { dash: [5, 5] });
    map.dot(...flat, 'ghost', { hollow: true });
    map.text('flat map', ...flat, { role: 'ghost', dx: 12, dy: -12 });
    map.dot(...true_, 'goal');
    map.text(lengthText(rho), 0.36, 0.36, { role: 'rho', dx: -10, dy: 10, align: 'right' });
    size.curve((x) => Math.log10(between(bothMaps(10 ** x, lat, radius)) || 1e-12));
    size.dot(Math.log10(rho), Math.log10(off || 1e-12), 'path');
  },
  say: (values, { off }) => ({ off: lengthText(off) }),
});
