// Chapter 15: how soon a robot arrives, which way it turns where theta jumps, alone and with noise,
// and a start beside the goal.

import {
  DEGREES, ahead, cornerOf, endOf, freshRun, heldRun, inDegrees, insetOf, insetSize, normals,
  remembered, ring, stage, trackOf, wrap, written,
} from '../drawing.js';

const QUARTER = Math.PI / 2, MOST = 210, FLAT = 0.72; // px, of the corner's picture, and its height
/** @type {[string, string, number][]} */
const ROBOTS = [['blue', 'path', 1], ['pink', 'alpha', -1]];
const NOISY = ['noise', 'hysteresis']; // scenes with many robots
const CORNERS = ['soon', 'level', 'cusp'];
const own = remembered(freshRun), straight = remembered(freshRun);

// What is random is drawn once.
const drawn = remembered(({ robots, seed, steps }) =>
  Array.from({ length: robots }, (_, robot) =>
    Array.from({ length: steps }, (__, k) => normals(robot, k, seed, 1)[0])));

// The drive of each of the robots that see their goal through noise, and how far off it ends.
const swarm = remembered(({ robots, seed, noise, distance, ...asked }) =>
  drawn({ robots, seed, steps: asked.steps }).map((errors) => {
    const [goalX, goalY] = asked.goal, sight = (k, [x, y, heading]) => {
      const turn = noise * errors[k], c = Math.cos(turn), s = Math.sin(turn);
      const [east, north] = [x - goalX, y - goalY];
      return [goalX + c * east - s * north, goalY + s * east + c * north, heading];
    };
    const run = heldRun({ ...asked, start: [goalX + distance, goalY, Math.PI], sight });
    return { run, off: wrap(run.poses.at(-1)[2] - asked.goal[2]) };
  }));

/** @param {any} values @param {any} data */
function noisyDrives({ noise, hysteresis, goal }, { gains, swarm: asked }) {
  const drives = swarm({ ...asked, goal, gains: gains.paper, noise: noise / DEGREES, hysteresis });
  const tracks = drives.map(({ run, off }) =>
    trackOf(run, asked.dt, Math.abs(off) > QUARTER ? 'rising' : 'path'));
  return { tracks, offs: drives.map(({ off }) => off) };
}

// Two robots wrap theta in each sample, as real ones do; a run in continuous time would not.
/** @param {any} values @param {any} data */
function twoSides({ side, facing, goal }, { gains, away, hair }) {
  const tracks = ROBOTS.map(([robot, role, sign]) => {
    const angle = (side + sign * hair) / DEGREES,
        start = [goal[0] + away * Math.cos(angle), goal[1] + away * Math.sin(angle),
          facing / DEGREES];
    return { robot, role,
      ...freshRun({ start, goal, gains: gains.gentle, method: 'arc', dt: 0.02 }) };
  });
  return { tracks };
}

/** @param {any} values @param {any} data */
function aboutOne({ scene, facing, goal, gains: chosen, apart }, { gains, away, beside }) {
  const options = { gains: gains[chosen], goal }, [x, y, heading] = goal;
  if (scene === 'beside') {
    const far = beside[apart], run = own({ ...options, start: [x, y - far, heading],
      arrivalRadius: far / 100, dt: 0.02 });
    return { run, tracks: [{ ...run, role: 'path' }] };
  }
  const radius = { soon: 0.01, level: 1e-4, cusp: 0.01 }[scene];
  const run = own({ ...options, start: [x + away, y, facing / DEGREES], arrivalRadius: radius,
    dt: 0.02 }), tracks = [{ ...run, role: 'path' }];
  if (scene !== 'soon') return { run, tracks };
  const grey = straight({ ...options, start: [x + away, y, Math.PI], goal: [x, y, Math.PI],
    arrivalRadius: radius, dt: 0.02 });
  return { run, grey, tracks: [...tracks, { ...grey, role: 'ghost' }] };
}

// The samples after which a column of a run changes its sign.
const changes = (column, n) => Array.from({ length: n - 1 }, (_, k) => k).filter((k) =>
  Math.abs(column[k]) > 1e-9 && column[k] * column[k + 1] < 0);
const cosines = ({ alpha }) => alpha.map(Math.cos);
// A run is wrapped, but where its theta and alpha are compared they are not.
const swingOf = ({ heading, n }, goal) => {
  let turned = wrap(heading[0] - goal[2]), most = Math.abs(turned);
  for (let k = 1; k < n; k += 1) {
    turned += wrap(heading[k] - heading[k - 1]);
    most = Math.max(most, Math.abs(turned));
  }
  return most;
};

// The curve in the corner: its height in each sample, what it is called, its role, its dots.
function curveOf(scene, run) {
  if (scene === 'soon')
    return { of: ({ rho }) => rho.map(Math.log10), low: -2.4, high: 1, name: 'log ρ', role: 'rho' };
  if (scene === 'level') {
    const of = ({ V, rho }) => V.map((height, k) => 2 * height - rho[k] ** 2),
        high = Math.max(...of(run));
    return { of, low: -0.2 * high, high: 1.08 * high, name: 'W', role: 'V',
      dots: changes(run.alpha, run.n) };
  }
  return { of: ({ alpha }) => alpha.map((angle) => Math.abs(angle) * DEGREES), low: -30, high: 190,
    name: '|α|', role: 'alpha', dots: changes(cosines(run), run.n), level: 90 };
}

const arrow = (pane, pose, length, role) =>
    pane.arrow(pose[0], pose[1], ...ahead(pose, length), role, { width: 1.5 });

export default stage('seam', {
  find(values, { data }) {
    if (NOISY.includes(values.scene)) return noisyDrives(values, data);
    if (['whole', 'ask'].includes(values.scene)) return twoSides(values, data);
    return aboutOne(values, data);
  },
  say(values, { tracks, offs, run, grey }) {
    const { goal, scene } = values;
    if (offs)
      return { noise: `${values.noise.toFixed(1)}°`,
        hysteresis: `${values.hysteresis.toFixed(2)} rad`,
        lost: `${offs.filter((off) => Math.abs(off) > QUARTER).length} of ${offs.length}` };
    if (run) {
      const [first] = run.alpha, last = run.n - 1, times = changes(cosines(run), run.n).length;
      return { seconds: written(run.t[last], 's'), apart: values.apart,
        straight: scene === 'soon' ? written(grey.t[grey.n - 1], 's') : '',
        alpha: inDegrees(Math.abs(first), 0), swing: inDegrees(swingOf(run, goal), 0),
        cusps: times ? `reverses ${times === 1 ? 'once' : `${times} times`}` : 'never reverses' };
    }
    const [one, other] = tracks.map(({ theta }) => Math.sign(theta.reduce((sum, it) => sum + it)));
    return { ways: one === other ? 'the same side' : 'different sides',
      ...Object.fromEntries(tracks.flatMap((track) => [[track.robot, endOf(track, goal)],
        [`${track.robot}_value`, written(track.V[0])]])) };
  },
  look({ goal: [x, y], scene, apart }, { run, offs }, { data: { away, beside, swarm: asked } }) {
    if (offs) return [x - 0.2, y - 0.3, x + asked.distance + 0.1, y + 0.3];
    if (scene === 'beside') {
      const far = beside[apart];
      return [x - 1.5 * far, y - 1.5 * far, x + 1.5 * far, y + 0.8 * far];
    }
    const high = run ? Math.max(3, ...run.y.map((it) => Math.abs(it - y) + 1)) : 4.5,
        right = run ? Math.max(...run.x, x + away) + 1.5 : x + away + 3;
    return [x - 3, y - high, right, y + high];
  },
  corner: ({ scene }, found, size) =>
      (CORNERS.includes(scene) ? cornerOf(size, MOST, FLAT) : null),
  draw(pane, { goal: [x, y], scene, apart }, found, { k: now, done, poses }, { data }) {
    const { run, offs, tracks } = found, { away, beside } = data;
    if (scene === 'beside') // a robot would cover it all
      for (let k = 0; k <= now; k += 20) arrow(pane, [run.x[k], run.y[k], run.heading[k]],
        0.25 * beside[apart], 'path');
    if (offs && done) tracks.forEach(({ role }, k) => arrow(pane, poses[k], 0.06, role));
    if (scene === 'cusp')
      for (const k of changes(cosines(run), run.n))
        pane.dot(run.x[k], run.y[k], 'rising', { size: 6 });
    if (run) return;
    pane.line([[x, y], [x + 2 * away, y]], 'rising', { width: 1.5, dash: [6, 5] });
    if (offs) return;
    pane.text('seam', x + away + 0.6, y, { role: 'rising', dy: 12 });
    pane.line(ring(x, y, away, -0.2, 0.2), 'ink', { width: 1, dash: [2, 4] });
  },
  above(pane, { scene }, { run, grey }, { time }) {
    if (!CORNERS.includes(scene)) return;
    const { of, low, high, name, role, dots = [], level } = curveOf(scene, run),
        { width, height } = insetSize(pane, MOST), end = run.t[run.n - 1];
    const inset = insetOf(pane, 'left', { width, height: FLAT * height },
      [-0.06 * end, 1.03 * end], [low, high]);
    const curve = (one, ink, wide) => {
      const heights = of(one), later = one.t.findIndex((second) => second > time),
          to = later < 0 ? one.n : later;
      const points = Array.from({ length: to }, (_, k) => inset.at([one.t[k], heights[k]]));
      if (to) pane.line(points, ink, { width: wide });
      for (const k of one === run ? dots : [])
        if (k < to) pane.dot(...inset.at([one.t[k], heights[k]]), 'rising', { size: 4 });
    };
    inset.within(() => {
      if (level) pane.line([[0, level], [end, level]].map(inset.at), 'soft', { dash: [4, 4] });
      if (grey) curve(grey, 'ghost', 2);
      curve(run, role, 3);
    });
    pane.text('time', ...inset.at([end, low]),
        { role: 'soft', dx: -4, dy: 9, align: 'right', fixed: true });
    pane.text(name, ...inset.at([0.6 * end, low + 0.85 * (high - low)]),
        { role, size: 15, weight: 600, fixed: true });
  },
});
