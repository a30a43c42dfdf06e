// Chapter 14: a robot with a receiver, and the headings that fit what it has received.

import {
  DEGREES, ahead, cornerOf, inDegrees, inWords, insetOf, insetSize, normals, poseAt, ring, stage,
  written,
} from '../drawing.js';

const LONG = 4, LENGTH = 40, ROOM = 0.5; // m of an arm of the cone; samples of the drive; m
const READING = 30 / DEGREES, RAY = 0.45; // rad; m ahead of a robot, by which it shows its heading
const MOST = 190, FLAT = 0.8; // px, and the corner's height to that
const FAR_OFF = 0.45; // rad, beyond which (14.1) says too little
const MANY = ['rest', 'straight', 'turn'];

// two fixes err across the way by sqrt(2) sigma, (14.1)
const openness = (sigma, far) => Math.atan2(Math.SQRT2 * sigma, far);
const joined = (one, other) => one * other / Math.hypot(one, other);
/** @returns {[number, number]} */
const outwards = (angle, length) => [length * Math.cos(angle), length * Math.sin(angle)];

// A drive from a place, straight on for `far` or round on the spot by `turn`.
function drive([x0, y0], heading, far, turn, role) {
  const t = Array.from({ length: LENGTH + 1 }, (_, k) => (far || turn || 1) * k / LENGTH);
  return { t, n: t.length, role, heading: t.map((s) => heading + (turn ? s : 0)),
    x: t.map((s) => x0 + (far ? s * Math.cos(heading) : 0)),
    y: t.map((s) => y0 + (far ? s * Math.sin(heading) : 0)) };
}

// The robots whose antennas share one spot: the first is the one that fixes are of.
const many = ({ scene, arm, far }, { heading, robots, turn }) =>
  Array.from({ length: robots }, (_, k) => heading + 2 * Math.PI * k / robots).map((own, k) =>
    drive(outwards(own, -arm), own, scene === 'straight' ? far : 0, scene === 'turn' ? turn : 0,
        k ? 'ghost' : 'path'));


/** @param {any} values */
function believed({ guess_deg: guess, reading_deg: reading }) {
  const [one, other] = [guess / DEGREES, reading / DEGREES];
  return { mean: READING * one ** 2 / (one ** 2 + other ** 2), both: joined(one, other) };
}
/** @param {any} values */
const crooked = ({ lean_deg: lean, dip_deg: dip }) =>
    Math.atan(Math.tan(dip / DEGREES) * Math.sin(lean / DEGREES));

function tracksOf(values, data) {
  const { scene, far } = values;
  if (MANY.includes(scene)) return many(values, data);
  if (scene === 'one') return [drive([0, 0], believed(values).mean, 0, 0, 'path')];
  if (scene === 'lean') return [drive([0, 0], Math.PI / 2, 0, 0, 'path')];
  return [drive([0, 0], data.heading, far, 0, 'path')];
}

// Aside and heading, one deviation round, where their covariance is [[a, b], [b, c]].
const ellipse = (a, b, c) => Array.from({ length: 61 }, (_, k) => {
  const [x, y] = outwards(2 * Math.PI * k / 60, 1);
  return [Math.sqrt(a) * x, b / Math.sqrt(a) * x + Math.sqrt(Math.max(c - b * b / a, 0)) * y];
});

/** @param {Pane} pane @param {any} values */
function drawPlan(pane, { sigma, far, guess_deg: guess }) {
  const c = (guess / DEGREES) ** 2, b = far * c, r = sigma ** 2, a = r + far * b, { width, height }
    = insetSize(pane, MOST), [wide, high] = [1.5 * Math.sqrt(a), 1.5 * Math.sqrt(c)];
  const inset = insetOf(pane, 'left', { width, height: FLAT * height }, [-wide, wide],
    [-high, high]), left = r / (a + r); // of the covariance
  inset.within(() => {
    for (const ends of [[[-wide, 0], [wide, 0]], [[0, -high], [0, high]]])
      pane.line(ends.map(inset.at), 'line', { width: 1 });
    pane.line(ellipse(a, b, c).map(inset.at), 'ghost', { width: 2 });
    pane.line(ellipse(left * a, left * b, c - b * b / (a + r)).map(inset.at), 'path',
        { width: 2.5 });
  });
  pane.text('aside', ...inset.at([wide, 0]),
      { role: 'soft', dx: -4, dy: -9, align: 'right', fixed: true });
  pane.text('heading', ...inset.at([0, high]),
      { role: 'soft', dx: 5, dy: -10, fixed: true });
}

export default stage('course_from_gps', {
  find(values, { data }) {
    const tracks = tracksOf(values, data), { arm, sigma } = values,
        ends = tracks.map((it) => ahead(poseAt(it, LENGTH), arm)), [[x, y]] = ends;
    return { tracks,
      fits: ends.filter((it) => Math.hypot(it[0] - x, it[1] - y) <= data.fit * sigma).length };
  },
  say(values, { fits }, { data: { robots } }) {
    const { sigma, far, guess_deg: guess, reading_deg: reading, lean_deg: lean, dip_deg: dip,
      scene } = values;
    const { mean, both } = believed(values), open = openness(sigma, far);
    return { sigma: `${inWords(sigma)} m`, far: `${inWords(far)} m`, off: inDegrees(open),
      tell: open > FAR_OFF ? 'tell little of its heading'
        : `tell its heading within about ${inDegrees(open)}`,
      fits, robots, lean: `${inWords(lean)}°`, dip: `${inWords(dip)}°`,
      guess: `${inWords(guess)}°`, reading: `${inWords(reading)}°`, mean: inDegrees(mean),
      both: inDegrees(scene === 'two' ? joined(guess / DEGREES, Math.SQRT2 * sigma / far) : both),
      crooked: written(crooked(values) * DEGREES, '°', 2) };
  },
  look({ scene, far, arm }) {
    if (scene === 'one') return [-1, -1.5, LONG, 3];
    if (scene === 'lean') return [-1.2, -0.7, 1.2, 1.5];
    const reach = 2 * arm + ROOM + (scene === 'straight' ? far : 0);
    if (MANY.includes(scene)) return [-reach, -reach, reach, reach];
    const most = Math.max(far, 5) + LONG;
    return [-3, -3, most, 0.6 * most + 1];
  },
  corner: (values, found, size) =>
      (values.scene === 'two' ? cornerOf(size, MOST, FLAT) : null),
  draw(pane, values, { tracks }, { pose: [x, y], time, k, scene }, { data }) {
    const { sigma, arm, guess_deg: guess, reading_deg: reading } = values;
    const cone = (mean, open, length, role, share) =>
        pane.area([[0, 0], ...ring(0, 0, length, mean - open, mean + open)], role, share);
    if (scene === 'one') {
      const { mean, both } = believed(values);
      cone(0, guess / DEGREES, LONG, 'ghost', 0.3);
      cone(READING, reading / DEGREES, LONG, 'rho', 0.3);
      cone(mean, both, LONG, 'path', 0.4);
      return;
    }
    if (MANY.includes(scene)) {
      for (const it of tracks.slice(1))
        pane.line(Array.from({ length: k + 1 }, (_, i) => ahead(poseAt(it, i), arm)), 'ghost',
            { width: 1.5, dash: [3, 4] });
      for (const [i, it] of scene === 'turn' ? tracks.entries() : [])
        pane.line([0, RAY].map((far) => ahead(poseAt(it, k), far)), i ? 'ghost' : 'path',
            { width: 2 });
      return;
    }
    if (scene === 'lean') {
      pane.arrow(0, 0, 0, 1.3, 'ink', { dash: [5, 4] });
      pane.text('north', 0, 1.3, { dx: 8, fixed: true });
      return;
    }
    const { pairs, seed, heading } = data, long = Math.max(LONG, time), two = scene === 'two';
    const open = two ? joined(guess / DEGREES, Math.SQRT2 * sigma / Math.max(time, 1e-6))
        : openness(sigma, time);
    if (two) cone(heading, guess / DEGREES, long + time, 'ghost', 0.3);
    cone(heading, open, long + time, 'path', 0.25);
    for (const [atX, atY] of [[0, 0], [x, y]]) {
      pane.line(ring(atX, atY, sigma), 'rho', { width: 1.5, dash: [4, 4] });
      pane.dot(atX, atY, 'rho', { size: 4 });
    }
    for (let run = 0; run < pairs; run += 1)
      [[0, 0], [x, y]].forEach(([atX, atY], i) => {
        const [dx, dy] = normals(run, i, seed);
        pane.dot(atX + sigma * dx, atY + sigma * dy, 'rho', { size: 2 });
      });
  },
  above(pane, values, found, { poses, scene }) {
    if (scene === 'two') drawPlan(pane, values);
    if (scene === 'lean') {
      const angle = crooked(values);
      pane.arrow(0, 0, ...outwards(Math.PI / 2 + angle, 1.3), 'rising');
      pane.angle(0, 0, Math.PI / 2, angle, '', 'rising', 60);
    }
    if (!MANY.includes(scene)) return;
    for (const [i, pose] of [...poses.entries()].reverse())
      pane.dot(...ahead(pose, values.arm), i ? 'ghost' : 'rho', { size: i ? 3.5 : 6 });
  },
});
