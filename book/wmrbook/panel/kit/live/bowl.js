// The angles' part of V as a bowl to be turned by hand, and its level sets; in both the state rolls
// along one run, and the robot drives it.

import {
  DEGREES, LAWS, camera, driven, inDegrees, live, ring, timeNear, turnedBy, written,
} from '../drawing.js';

// rad that are one unit of the picture; rings; m round the goal
const REACH = 3, RINGS = 8, NEAR = 0.75;
const LIGHT = [-0.45, 0.3, 0.84]; // from the left, from behind and from above

const levelSet = (level, h) =>
    ring(0, 0, Math.sqrt(2 * level)).map(([alpha, theta]) => [alpha, theta / Math.sqrt(h)]);

// The facets between rings, those behind first: corners, whether its inside is seen, how light it
// is and how high. `rim` is V at the edge.
function facets(rings, rim, h, yaw, tilt) {
  const seen = camera(yaw, tilt), fromAbove = camera(yaw, 90), found = [];
  rings.forEach((outer, i) => {
    const inner = i ? rings[i - 1] : outer.map(() => [0, 0]);
    for (let k = 0; k < outer.length - 1; k += 1) {
      const corners = [inner[k], outer[k], outer[k + 1], inner[k + 1]],
          [alpha, theta] = [0, 1].map((it) => corners.reduce((sum, at) => sum + at[it] / 4, 0)),
          normal = [-alpha * REACH / rim, -h * theta * REACH / rim, 1],
          inside = seen(...normal)[2] > 0, height = ((i + 0.5) / RINGS) ** 2;
      const light = fromAbove(...normal).reduce((sum, each, it) => sum + each * LIGHT[it], 0)
          / Math.hypot(...normal) * (inside ? 1 : -1);
      found.push({ corners, inside, light, height,
        near: seen(alpha / REACH, theta / REACH, height)[2] });
    }
  });
  return found.sort((a, b) => a.near - b.near);
}

// alpha and theta, in radians, and the height to two numbers on the screen
function projected(yaw, tilt) {
  const seen = camera(yaw, tilt);
  return (alpha, theta, height) => seen(alpha / REACH, theta / REACH, height).slice(0, 2);
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
      scrub: turnedBy,
    },
    levels: {
      x: [-180, 180, 'α [°]'], y: [-160, 160, 'θ [°]'], equal: true,
          given: 'The level sets from above, with the state at the start.',
      alt: `The level sets from above, the steepest way, dashed, and the state's; it is at alpha ` +
          `${inDegrees(run.alpha[k])} and theta ${inDegrees(run.theta[k])}.`,
      scrub: (x, y) => timeNear(run.alpha, run.theta, x / DEGREES, y / DEGREES, 0.2),
    },
    robot: { x: [-NEAR, NEAR], y: [-NEAR, NEAR], lawn: true,
        given: 'The robot in that state, on a lawn.',
        alt: `The robot in that state, ${written(run.rho[k], 'm')} from its goal.` },
  }),
  draw({ bowl, levels, robot }, values, { run, k, h, top, value }, hidden,
      { data: { look, gains } }) {
    const [yaw, tilt] = hidden ? look : [values.yaw, values.tilt], at = projected(yaw, tilt),
        weight = hidden ? gains.gentle.h : h, now = hidden ? 0 : k;
    const rim = hidden ? LAWS.corrected.value(0, run.alpha[0], run.theta[0], gains.gentle) : top,
        high = (alpha, theta) => LAWS.corrected.value(0, alpha, theta, { h: weight }) / rim;
    const rings =
        Array.from({ length: RINGS }, (_, i) => levelSet(rim * ((i + 1) / RINGS) ** 2, weight));
    for (const each of rings)
      levels.line(each.map(([alpha, theta]) => [alpha * DEGREES, theta * DEGREES]), 'ghost',
          { width: 1 });
    const sides = facets(rings, rim, weight, yaw, tilt), { ctx } = bowl;
    const fill = ({ corners, light, height }, share) => {
      const dark = Math.round(24 + 30 * height + 40 * (1 - light) / 2);
      ctx.fillStyle = ctx.strokeStyle =
          `color-mix(in srgb, ${bowl.ink('V')} ${dark}%, ${bowl.ink('paper')})`;
      ctx.globalAlpha = share;
      ctx.lineWidth = 1;
      ctx.beginPath();
      for (const [alpha, theta] of corners) {
        const [x, y] = at(alpha, theta, high(alpha, theta)), [px, py] = bowl.at(x, y);
        ctx.lineTo(px, py);
      }
      ctx.closePath();
      ctx.fill();
      if (share === 1) ctx.stroke(); // no seams
      ctx.globalAlpha = 1;
    };
    sides.filter(({ inside }) => inside).forEach((each) => fill(each, 1));
    for (const each of rings)
      bowl.line(each.map((point) => at(...point, high(...point))), 'paper', { width: 0.6 });
    for (const { axis, role, end } of [{ axis: 'α', role: 'alpha', end: [REACH, 0, 0] },
        { axis: 'θ', role: 'theta', end: [0, REACH, 0] }]) {
      bowl.arrow(...at(0, 0, 0), ...at(...end), role, { width: 1.5 });
      bowl.text(axis, ...at(...end), { role, dx: 5, dy: 8, size: 16 });
    }
    if (!hidden) {
      // down the gradient (alpha, h theta)
      const by = Math.log(0.01) / 40 / Math.min(1, h), dashed = { dash: [5, 4] },
          steepest = Array.from({ length: 41 }, (_, i) =>
          [run.alpha[0] * Math.exp(by * i), run.theta[0] * Math.exp(h * by * i)]);
      bowl.line(steepest.map((point) => at(...point, high(...point))), 'ink', dashed);
      levels.line(steepest.map((point) => point.map((each) => each * DEGREES)), 'ink', dashed);
      bowl.line(
          Array.from({ length: k + 1 }, (_, i) => at(run.alpha[i], run.theta[i], value(i) / top)),
          'path');
      levels.path(run.alpha.map((each) => each * DEGREES), run.theta.map((each) => each * DEGREES),
          'path', { to: k + 1 });
      robot.path(run.x, run.y, 'path', { to: k + 1 });
    }
    const ball = at(run.alpha[now], run.theta[now], high(run.alpha[now], run.theta[now]));
    bowl.dot(...ball, 'path', { size: 8 });
    bowl.dot(ball[0] - 2.5 * bowl.pixel, ball[1] + 3 * bowl.pixel, 'paper', { size: 1 });
    sides.filter(({ inside }) => !inside).forEach((each) => fill(each, 0.45));
    const still = yaw === look[0] && tilt === look[1];
    if (still && !hidden && !matchMedia('print').matches) {
      const arc = ring(0, 0, 0.95, 205 / DEGREES, 335 / DEGREES)
          .map(([x, y]) => [x, 0.32 / 0.95 * y - 0.35]);
      bowl.line(arc, 'focus');
      bowl.arrow(...arc.at(-11), ...arc.at(-1), 'focus');
      bowl.text('turn me', 0, -0.8, { role: 'focus', align: 'center', weight: 600 });
    }
    levels.dot(run.alpha[now] * DEGREES, run.theta[now] * DEGREES, 'path', { size: 7 });
    robot.state(run.rho[now], run.alpha[now], run.theta[now]);
  },
  handles({ yaw, tilt }) {
    const at = projected(yaw, tilt), down = Math.sin(tilt / DEGREES);
    return [{ id: 'turn', pane: 'bowl', at: at(REACH, 0, 0),
      says: `the bowl, turned by ${written(yaw)} degrees`,
      move: (x, y) => ({ yaw: Math.round(Math.atan2(y / down, x) * DEGREES) }) }];
  },
  say: (values, { run, k, height, top }) =>
      ({ seconds: written(run.t[k], 's'), height: written(height), top: written(top) }),
});
