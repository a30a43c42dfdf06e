// sin(alpha)/alpha, at 0 too: a rod that turns by alpha from its middle to each end, and how far
// apart its ends are. The rod is 2 long.

import { DEGREES, written } from '../style.js';
import { live } from '../live.js';
import { sinc } from '../model.js';

const onRod = (alpha, s) =>
    [s * sinc(alpha * s), s * Math.sin(alpha * s / 2) * sinc(alpha * s / 2)];

export default live('small_angle', {
  find({ alpha }) {
    const bend = alpha / DEGREES;
    return { factor: sinc(bend),
        rod: Array.from({ length: 81 }, (_, k) => onRod(bend, k / 40 - 1)) };
  },
  panes: ({ alpha }, { factor }) => ({
    rod: { x: [-1.4, 1.4], y: [-1.2, 1.2], equal: true, bare: true, given: 'A bent rod.',
        alt: `A rod bent by ${written(alpha)} degrees to either side, its ends ` +
        `${written(factor)} of its length apart.` },
    factor: { x: [-190, 190, 'α [°]'], y: [-1.2, 1.2, 'sin α / α'],
        given: 'Room for the factor over alpha.',
        alt: `The factor over alpha, a smooth hill of height 1 at 0: ${written(factor)} at ` +
        `${written(alpha)} degrees.`,
        scrub: (x) => ({ alpha: Math.round(Math.min(Math.max(x, -180), 180)) }) },
  }),
  draw({ rod: picture, factor: chart }, { alpha }, { rod, factor }, hidden, { data: { bent } }) {
    const shown = hidden ? Array.from(rod, (_, k) => onRod(bent / DEGREES, k / 40 - 1)) : rod,
        end = shown.at(-1);
    if (!hidden) picture.line([shown[0], end], 'start', { dash: [6, 4] });
    picture.line(shown, 'path', { width: 4 });
    if (hidden) return;
    for (const turn of [0, alpha / DEGREES])
      picture.line([end, [end[0] + 0.35 * Math.cos(turn), end[1] + 0.35 * Math.sin(turn)]], 'ghost',
          { width: 1.5, dash: [3, 4] });
    if (Math.abs(alpha) > 5) picture.angle(...end, 0, alpha / DEGREES, 'α', 'alpha', 30);
    chart.curve((x) => sinc(x / DEGREES));
    chart.dot(alpha, factor);
  },
  handles: ({ alpha }, { rod }) => [{
    id: 'end', pane: 'rod', at: rod.at(-1),
        says: `the end of the rod, bent by ${written(alpha)} degrees`,
    move: (x, y) =>
        ({ alpha: Math.round(Math.min(Math.max(2 * Math.atan2(y, x) * DEGREES, -180), 180)) }),
  }],
  say: ({ alpha }, { factor }) =>
      ({ factor: written(factor),
      straight: alpha ? '' : ', all of it, where the fraction alone reads 0/0' }),
});
