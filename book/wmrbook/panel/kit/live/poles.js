// The poles of the angles near the goal and the gains that put them there, each from the other; and
// the robot that has them.

import {
  DEGREES, LAWS, complex, driven, inDegrees, live, modes, polesOf, poseAt, wrap, written,
} from '../drawing.js';

const CLEAR = 0.12; // 1/s: nearer the axis than this a hand means the axis

function gainsOf([first, second], pace) {
  const a = -(first[0] + second[0]), b = first[0] * second[0] - first[1] * second[1];
  if (a < 0)
    throw new RangeError(
        `k_alpha would be ${written(a, '1/s')}: it is minus the sum of the poles, and no robot ` +
        `needs one below 0.`);
  if (b <= 0)
    throw new RangeError(
        `h would be ${written(b / pace ** 2)}: it is the product of the poles over (k_rho ` +
        `v_max)², and V needs it above 0.`);
  return { k_alpha: Number(a.toPrecision(3)), h: Number((b / pace ** 2).toPrecision(3)) };
}

export default live('poles', {
  find({ k_alpha, h }, { data: { k_rho, v_max, start, goal } }) {
    const gains = { k_rho, k_alpha, h, v_max }, [pace, a, b] = LAWS.corrected.modes(gains),
        run = driven({ start, goal, gains, duration: 30, dt: 0.02 });
    return { poles: polesOf(a, b), pace, run, off: wrap(run.heading[run.n - 1] - goal[2]),
        ...modes(gains) };
  },
  panes: (values, { poles, pace, off }) => ({
    plane: { x: [-9, 1, 'real part [1/s]'], y: [-5, 5, 'imaginary part [1/s]'], equal: true,
        given: 'The poles of the angles and of the distance with the gains at first.',
        alt: `The poles at ${poles.map(complex).join(' and ')} per second; the distance's at ` +
        `${written(-pace)}.` },
    robot: { x: [-2.2, 1.2, 'x [m]'], y: [-1.4, 1.4, 'y [m]'], equal: true,
        main: true,
        given: 'The way of about two metres to the goal, with the gains at first.',
        alt: `The robot's last two metres: it stops ` +
        `${Math.abs(off * DEGREES).toFixed(0)} degrees off.` },
  }),
  draw({ plane, robot }, values, { poles, pace, run }, hidden, { data: { goal } }) {
    plane.rect(0, -99, 99, 99, 'rising', 0.12);
    robot.pose(goal, 'goal');
    plane.dot(-pace, 0, 'rho', { hollow: true });
    for (const [re, im] of poles) plane.cross(re, im, 'alpha', 8);
    plane.text('distance', -pace, 0, { role: 'rho', dx: -11, align: 'right' });
    robot.path(run.x, run.y);
    robot.robot(poseAt(run, run.n - 1));
  },
  handles: (values, { poles, pace }) => poles.map((pole, k) => ({
    id: `pole-${k}`, pane: 'plane', at: pole,
        says: `a pole at ${written(pole[0])} and ${written(pole[1])} i per second`,
    move(x, y, exact) {
      const clear = exact ? 0.01 : CLEAR, up = k ? -y : y;
      if (up > clear) return gainsOf([[x, y], [x, -y]], pace);
      if (up < -clear && exact)
        throw new RangeError(
            `Of a pair each pole is the other's mirror image: this one stays ` +
            `${k ? 'below' : 'above'} the axis.`);
      // of a pair that meets the axis both go on together, and one that meets the other takes it
      // along
      const [re, im] = poles[1 - k];
      return gainsOf([[x, 0], [Math.abs(im) > clear || (k ? x > re : x < re) ? x : re, 0]], pace);
    },
  })),
  say: (values, { damping, naturalFrequency, run, off }) => ({
    damping: written(damping), frequency: written(naturalFrequency, 'rad/s'),
        end: run.outcome === 'ARRIVED'
        ? `stops after ${written(run.t[run.n - 1], 's')}, ${inDegrees(Math.abs(off))} off`
        : 'is still on its way after 30 s',
  }),
});
