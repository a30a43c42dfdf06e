// V' as a sum of two bars, for the distance and for the angles, at a state to be dragged, with the
// robot in that state, while the law is put in piece by piece.

import {
  DEGREES, correctedLaw, live, onStops, printedLaw, ratesOfV, remembered, within, written,
} from '../drawing.js';

const MARKS = 19; // marks a side of the plane

const LAWS_SO_FAR = {
  nothing: (rho) => [1 / rho, 0], // v/rho of 1 m/s, and rad/s
  speed: (...state) => [correctedLaw(...state)[0], 0],
  corrected: correctedLaw,
  printed: printedLaw,
};

const falls = (law, rho, alpha, theta, gains) => // with L = 1 m^2
    ratesOfV(LAWS_SO_FAR[law](rho, alpha, theta, gains), rho, alpha, theta, gains.h);

const rising = remembered(([law, rho, gains]) => {
  const side = Array.from({ length: MARKS }, (_, i) => (2 * (i + 0.5) / MARKS - 1) * Math.PI);
  return side.flatMap((alpha) => side.map((theta) => [alpha, theta]))
      .filter((state) => falls(law, rho, ...state, gains).reduce((sum, each) => sum + each) > 0);
});
const way = (rate) => (Math.abs(rate) < 1e-9 ? 'stays level' : rate < 0 ? 'falls' : 'rises');

export default live('two_bars', {
  find: ({ law, alpha, theta }, { data: { rho, gains } }) =>
      ({ bars: falls(law, rho, alpha / DEGREES, theta / DEGREES, gains),
      marks: rising([law, rho, gains]) }),
  panes: ({ alpha, theta }, { bars, marks }, { data: { rho } }) => ({
    plane: { x: [-180, 180, 'α [°]'], y: [-180, 180, 'θ [°]'],
        given: 'The plane of the two angles, with the state.',
        alt: `The plane of the angles, the state at ${written(alpha)} and ` +
        `${written(theta)} degrees; V rises at ${marks.length} of ${MARKS ** 2} states, each ` +
        `with a cross.` },
    robot: { x: [-1.3 * rho, 1.3 * rho], y: [-1.3 * rho, 1.3 * rho], lawn: true,
        given: 'The robot in that state, on a lawn.',
        alt: `The robot in that state, ${written(rho, 'm')} from its goal, with both angles.` },
    bars: { x: [0.4, 3.6, '', () => ''], y: [-11, 7, 'rate of V [1/s]'], main: true,
        given: 'Room for two bars and their sum.',
        alt: `Two bars, ${written(bars[0])} for the distance and ${written(bars[1])} for the ` +
        `angles, and their sum, ${written(bars[0] + bars[1])}.` },
  }),
  draw({ plane, robot, bars: chart }, values, { bars, marks }, hidden, { data: { asked, rho } }) {
    const sum = bars[0] + bars[1], [alpha, theta] = hidden ? asked : [values.alpha, values.theta];
    robot.state(rho, alpha / DEGREES, theta / DEGREES);
    if (!hidden)
      for (const mark of marks) plane.cross(mark[0] * DEGREES, mark[1] * DEGREES, 'rising', 2.5);
    plane.dot(alpha, theta, 'path', { size: 8, hollow: true });
    chart.line([[0.4, 0], [3.6, 0]], 'ink', { width: 1 });
    const lower = chart.box.width < 210 ? 16 : 0; // px: in a narrow picture not side by side
    [['distance', 'rho', bars[0]], ['angles', 'alpha', bars[1]],
        ['sum', 'ink', sum]].forEach(([name, role, rate], k) => {
      chart.text(name, k + 1, 7, { role, dy: -12 - (k % 2) * lower, align: 'center', fixed: true });
      if (hidden) {
        chart.text('?', k + 1, 0, { role, dy: 14, size: 20, align: 'center' });
        return;
      }
      chart.rect(k + 0.7, 0, k + 1.3, within(rate, -10.2, 5.4), role);
      chart.text(way(rate), k + 1, rate < 0 ? 0 : Math.min(rate, 5.4),
          { role, dy: 12, align: 'center', weight: 400 });
    });
  },
  handles: ({ alpha, theta }, found, setup) => [{
    id: 'state', pane: 'plane', at: [alpha, theta],
        says: `the state, alpha ${written(alpha)} and theta ${written(theta)} degrees`,
    move: (x, y) => onStops(setup, { alpha: x, theta: y }),
  }],
  say: (values, { bars, marks }) =>
      ({ distance: way(bars[0]), angles: way(bars[1]),
      share: marks.length
      ? `rises at ${Math.round(100 * marks.length / MARKS ** 2)} % of the states, those with a ` +
      `cross` : 'rises nowhere' }),
});
