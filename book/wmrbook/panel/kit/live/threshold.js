// Is it parked? The heading that is left over where a robot stops, and two lines that we draw: each
// halved, as it is, and doubled.

import { between, live, onStops, written } from '../drawing.js';

const SCALES = [0.5, 1, 2];

const offs = (stops) => stops.flat().map(([, off]) => off.toFixed(1)).join(', ');

export default live('threshold', {
  find({ radius, most, gains }, { data: { step, curves } }) {
    const at = (curve, r) => between(curve, Math.min(r / step - 1, curve.length - 1));
    const stops = curves[gains].map((curve) =>
        SCALES.map((scale) => [scale * radius, at(curve, scale * radius)]));
    const yes = stops.flat().flatMap(([, off]) => SCALES.map((scale) => off < scale * most))
        .filter(Boolean).length;
    return { stops, yes, verdict: yes === 18 ? 'always' : yes ? 'depends' : 'never' };
  },
  panes: (values, { stops, verdict }) => ({ plane: {
    x: [0, 42, 'where the robot stops, before the goal [cm]'], y: [0, 65, 'heading error [°]'],
        tall: true, given: 'The heading error over the place where the robot stops: nothing yet.',
    alt: `The heading error over the place where the robot stops, for both readings of the ` +
        `axes. At the three radii: ${offs(stops)} degrees. Parked: ${verdict}.`,
  } }),
  draw({ plane }, { radius, most, gains }, { stops }, hidden, { data: { step, curves } }) {
    if (hidden) return;
    plane.rect(radius / 2, 0, 2 * radius, most / 2, 'start', 0.3);
    plane.rect(radius / 2, most / 2, 2 * radius, 2 * most, 'theta', 0.2);
    for (const scale of SCALES) {
      plane.line([[radius / 2, scale * most], [2 * radius, scale * most]], 'theta',
          { width: 1.5, dash: [5, 4] });
      plane.line([[scale * radius, 0], [scale * radius, 2 * most]], 'theta',
          { width: 1.5, dash: [5, 4] });
    }
    curves[gains].forEach((curve, k) => {
      plane.line(curve.map((off, i) => [step * (i + 1), off]), k ? 'goal' : 'path',
          { dash: k ? [8, 5] : [] });
      stops[k].forEach(([r, off]) =>
          plane.dot(r, off, k ? 'goal' : 'path', { size: 4, hollow: off >= most }));
      plane.text(k ? 'x north' : 'x east', 35, curve[Math.round(35 / step) - 1],
          { role: k ? 'goal' : 'path', dy: 12 });
    });
  },
  handles: ({ radius, most }, found, setup) => [{
    id: 'line', pane: 'plane', at: [radius, most],
        says: `where the lines cross, ${written(radius, 'cm')} and ${written(most, '°')}`,
    move: (x, y) => onStops(setup, { radius: x, most: y }),
  }],
  say: (values, { yes, verdict }) =>
      ({ yes: `in ${yes} of 18`,
      verdict: { always: 'is "holds"', never: 'is "wrong"',
      depends: 'depends on the line, and nothing is decided' }[verdict] }),
});
