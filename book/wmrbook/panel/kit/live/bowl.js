// The angles' part of V as a bowl to be turned by hand, and its level sets; in both the state rolls
// along one run.

import { DEGREES, inDegrees, written } from '../style.js';
import { LAWS, wrap } from '../model.js';
import { driven, timeNear } from '../runs.js';
import { live } from '../live.js';

// rad that are one unit of the picture; rings; points of a ring
const REACH = 3, RINGS = 8, AROUND = 64;

const ring = (level, h) =>
    Array.from({ length: AROUND + 1 }, (_, k) => 2 * Math.PI * k / AROUND)
    .map((turn) =>
    [Math.sqrt(2 * level) * Math.cos(turn), Math.sqrt(2 * level / h) * Math.sin(turn)]);

// alpha and theta, in radians, and the height to two numbers on the screen
function projected(yaw, tilt) {
  const [c, s, up, down] = [Math.cos(yaw / DEGREES), Math.sin(yaw / DEGREES),
      Math.cos(tilt / DEGREES), Math.sin(tilt / DEGREES)];
  return (alpha, theta, height) =>
      [(alpha * c - theta * s) / REACH, (alpha * s + theta * c) / REACH * down + height * up];
}

export default live('bowl', {
  find({ choice, time }, { data: { start, goal, gains } }) {
    const run =
        driven({ start, goal, gains: gains[choice], arrivalRadius: 0, duration: 12, dt: 0.02 }),
        value = (k) => LAWS.corrected.value(0, run.alpha[k], run.theta[k], gains[choice]);
    const k = Math.round(time * (run.n - 1));
    return { run, k, h: gains[choice].h, height: value(k), top: value(0), value };
  },
  panes: ({ yaw }, { run, k, height }) => ({
    bowl: {
      x: [-1.25, 1.25], y: [-0.85, 1.75], equal: true, bare: true,
          given: 'The bowl over the two angles, with a ball on its rim.',
          alt: `The bowl, turned by ${written(yaw)} degrees; the ball is ${written(height)} high.`,
      scrub: (x, y, moved, now) => moved
          && { yaw: wrap((now.yaw - moved[0] / 2) / DEGREES) * DEGREES,
          tilt: Math.min(Math.max(now.tilt + moved[1] / 2, 5), 85) },
    },
    levels: {
      x: [-180, 180, 'α [°]'], y: [-160, 160, 'θ [°]'], equal: true,
          given: 'The level sets from above, with the state at the start.',
      alt: `The level sets from above, and the state's way over them; it is at alpha ` +
          `${inDegrees(run.alpha[k])} and theta ${inDegrees(run.theta[k])}.`,
      scrub: (x, y) => timeNear(run.alpha, run.theta, x / DEGREES, y / DEGREES, 0.2),
    },
  }),
  draw({ bowl, levels }, { yaw, tilt }, { run, k, h, top, value }, hidden,
      { data: { look, gains } }) {
    const at = hidden ? projected(...look) : projected(yaw, tilt),
        weight = hidden ? gains.gentle.h : h, now = hidden ? 0 : k;
    const rim = hidden ? LAWS.corrected.value(0, run.alpha[0], run.theta[0], gains.gentle) : top,
        high = (alpha, theta) => LAWS.corrected.value(0, alpha, theta, { h: weight }) / rim;
    const rings =
        Array.from({ length: RINGS }, (_, i) => ring(rim * ((i + 1) / RINGS) ** 2, weight));
    for (const each of rings) {
      bowl.line(each.map((point) => at(...point, high(...point))), 'ghost', { width: 1 });
      levels.line(each.map(([alpha, theta]) => [alpha * DEGREES, theta * DEGREES]), 'ghost',
          { width: 1 });
    }
    for (let i = 0; i < AROUND; i += 4)
      bowl.line(
          [[0, 0], ...rings.map((each) => each[i])].map((point) => at(...point, high(...point))),
          'line', { width: 1 });
    for (const { axis, role, end } of [{ axis: 'α', role: 'alpha', end: [REACH, 0, 0] },
        { axis: 'θ', role: 'theta', end: [0, REACH, 0] }]) {
      bowl.arrow(...at(0, 0, 0), ...at(...end), role, { width: 1.5 });
      bowl.text(axis, ...at(...end), { role, dx: 5, dy: 8, size: 16 });
    }
    if (!hidden) {
      bowl.line(
          Array.from({ length: k + 1 }, (_, i) => at(run.alpha[i], run.theta[i], value(i) / top)),
          'path');
      levels.path(run.alpha.map((each) => each * DEGREES), run.theta.map((each) => each * DEGREES),
          'path', { to: k + 1 });
    }
    bowl.dot(...at(run.alpha[now], run.theta[now], high(run.alpha[now], run.theta[now])), 'path',
        { size: 7 });
    levels.dot(run.alpha[now] * DEGREES, run.theta[now] * DEGREES, 'path', { size: 7 });
  },
  say: (values, { run, k, height, top }) =>
      ({ seconds: written(run.t[k], 's'), height: written(height), top: written(top) }),
});
