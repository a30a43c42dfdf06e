// Chapter 2: the arc that two wheel speeds make, its centre and its chord, and a way to the side in
// four moves.

import { ahead, arcStep, inDegrees, ring, stage, twistOf, written } from '../drawing.js';

const DT = 0.05; // s
const START = [0, 0, Math.PI / 2];
const SLANTED = [0, 0, Math.PI / 6]; // 30 degrees from east, to split a velocity
const LONGER = 3.5; // m of an arrow for each m/s
const FAR = 50; // m to the turning centre, beyond which it is not drawn
const COLUMNS = ['t', 'x', 'y', 'heading'];

// The poses of some moves, each of a twist and a time, from a start.
function along(start, moves) {
  const run = { t: [], x: [], y: [], heading: [] };
  let pose = start, time = 0;
  const keep = () => [time, ...pose].forEach((value, i) => run[COLUMNS[i]].push(value));
  keep();
  for (const { v, omega, seconds } of moves)
    for (let k = 0; k < Math.round(seconds / DT); k += 1) {
      pose = arcStep(...pose, v, omega, DT);
      time += DT;
      keep();
    }
  return { ...run, n: run.t.length, pose };
}

// Where the wheels have been, the left one first.
const tracksOf = ({ x, y, heading }, width) => [1, -1].map((side) => x.map((_, k) =>
  ahead([x[k], y[k], heading[k] + side * Math.PI / 2], width / 2)));

// Drive forward, turn left, drive back, turn right: a move of the twist's parts at a time.
const fourMoves = (v, omega, seconds) => [[v, 0], [0, omega], [-v, 0], [0, -omega]]
    .map(([drive, turn]) => ({ v: drive, omega: turn, seconds }));

// What the moves are called, for two wheel speeds of any sign, and where they lead.
function namesOf(v, omega) {
  const drives = v > 0 ? ['forward', 'back'] : v ? ['back', 'forward'] : [],
      turns = omega > 0 ? ['left', 'right'] : omega ? ['right', 'left'] : [];
  const names = [0, 1].flatMap((i) => [drives[i], turns[i]]).filter(Boolean).join(', ');
  return names ? names[0].toUpperCase() + names.slice(1) : 'No move';
}
function shiftedTo([x, y]) {
  const parts = [[x, 'to its right', 'to its left'], [y, 'ahead', 'back']]
      .filter(([by]) => Math.abs(by) >= 0.0005)
      .map(([by, more, less]) => `${written(Math.abs(by), 'm')} ${by > 0 ? more : less}`);
  return parts.length ? parts.join(' and ') : 'where it began';
}

// About which point it turns, in words.
function movesOf(v, omega) {
  if (!omega) return v > 0 ? 'drives straight on' : v ? 'drives straight back' : 'stands still';
  if (!v) return 'turns on the spot';
  return `turns about a point ${written(Math.abs(v / omega), 'm')} to its ${
    v / omega > 0 ? 'left' : 'right'}`;
}

const sidewaysFrom = (pose, side, far) =>
    ahead([pose[0], pose[1], pose[2] + side * Math.PI / 2], far);

export default stage('two_wheels', {
  find({ scene, left, right, answer }, { scenes, data: { track_width: width, seconds } }) {
    const { shows, ask } = scenes.find(({ name }) => name === scene);
    const [v, omega] = Object.values(twistOf(left, right, width))
        .map((value) => (Math.abs(value) < 1e-9 ? 0 : value)); // of sliders that add up to nothing
    const start = shows.includes('velocity') ? SLANTED : START;
    const run = along(start, shows.includes('moves') ? fourMoves(v, omega, seconds)
        : [{ v, omega, seconds }]);
    const straight = ahead(start, v * seconds);
    const asks = Boolean(ask) && shows.includes('centre') && answer === null; // would tell
    return { v, omega, start, straight, wheels: tracksOf(run, width),
      tracks: [{ ...(asks ? along(start, []) : run), role: 'path' }], end: run.pose, run, asks,
      close: shows.length > 0 && !shows.includes('centre'),
      miss: Math.hypot(run.pose[0] - straight[0], run.pose[1] - straight[1]) };
  },
  look(values, { run: { x, y }, close }) {
    const reach = 0.4 + Math.max(close ? 0.8 : 1.3, ...x.map(Math.abs), ...y.map(Math.abs));
    return [-reach, close ? Math.min(-0.5, Math.min(...y) - 0.4) : -reach, reach, reach];
  },
  say: ({ left, right }, { v, omega, start, end, miss }, { data: { seconds } }) => ({
    speed: written(v, 'm/s'), turning: written(omega, 'rad/s'), does: movesOf(v, omega),
    left_way: written(left * seconds, 'm'), right_way: written(right * seconds, 'm'),
    turned: inDegrees(omega * seconds), half: inDegrees(omega * seconds / 2),
    arc: written(Math.abs(v) * seconds, 'm'),
    chord: written(Math.hypot(end[0] - start[0], end[1] - start[1]), 'm'),
    miss: written(miss, 'm'), heading: inDegrees(start[2], 0),
    east: written(v * Math.cos(start[2]), 'm/s'), north: written(v * Math.sin(start[2]), 'm/s'),
    moves: namesOf(v, omega), shifted: shiftedTo(end),
  }),
  draw(pane, { left, right }, { v, omega, start, straight, wheels, end, asks },
      { pose, k, size, shows }, { data: { track_width: width, seconds } }) {
    pane.robot(start, 0.2, { size });
    for (const [i, speed] of [left, right].entries()) {
      const [x, y] = sidewaysFrom(pose, i ? -1 : 1, width / 2);
      pane.line(wheels[i].slice(0, k + 1), 'ink', { width: 1.5, dash: [2, 5] });
      if (speed && (!shows.length || shows.includes('centre')))
        pane.arrow(x, y, ...ahead([x, y, pose[2]], speed), 'rho');
    }
    if (shows.includes('centre') && !asks && omega && Math.abs(v / omega) < FAR) {
      const place = sidewaysFrom(pose, 1, v / omega),
          [tip, other] = [left, right].map((speed, i) =>
            ahead([...sidewaysFrom(pose, i ? -1 : 1, width / 2), pose[2]], speed));
      if (v) pane.line(ring(...place, Math.abs(v / omega)), 'ghost', { width: 1.5, dash: [4, 4] });
      pane.line([tip, place, other], 'rho', { width: 1.5, dash: [2, 4] });
      pane.line([pose, place], 'theta', { width: 1.5, dash: [6, 4] });
    }
    if (shows.includes('turn')) {
      if (omega && Math.abs(v / omega) < 5)
        for (const at of [start, pose])
          pane.line([sidewaysFrom(at, 1, v / omega), sidewaysFrom(at, -Math.sign(v / omega || 1),
              width / 2)], 'theta', { width: 1.5, dash: [6, 4] });
      for (const [i, speed] of [left, right].entries())
        pane.text(written(speed * seconds, 'm'), ...wheels[i][Math.floor(wheels[i].length / 2)],
            { role: 'rho', dx: i ? 12 : -8, dy: i ? 10 : -12, align: i ? 'left' : 'right' });
    }
    if (shows.includes('chord')) {
      pane.line([start, straight], 'ghost', { dash: [6, 4] });
      pane.text('straight step', ...straight, { role: 'ghost', dx: 14 });
      pane.line([start, end], 'rho');
      pane.text('chord', (start[0] + end[0]) / 2, (start[1] + end[1]) / 2,
          { role: 'rho', dx: -14, dy: -8, align: 'right' });
    }
    if (shows.includes('velocity') && v) {
      const tip = ahead(start, LONGER * v), corner = [tip[0], start[1]];
      pane.line([start, corner], 'rho', { width: 3 });
      pane.line([corner, tip], 'theta', { width: 3 });
      pane.arrow(start[0], start[1], ...tip, 'path');
      pane.text('v', tip[0] / 2, tip[1] / 2, { role: 'path', dx: -10, dy: 18, size: 18 });
      pane.text('v cos θ', corner[0], corner[1], { dy: -18, align: 'right' });
      pane.text('v sin θ', corner[0], tip[1] / 2, { dx: 10 });
    }
  },
  above(pane, values, { v, omega, asks }, { pose, shows }) {
    if (!shows.includes('centre') || asks || !omega || Math.abs(v / omega) > FAR) return;
    const place = sidewaysFrom(pose, 1, v / omega);
    pane.cross(...place, 'goal'); // over the robot that it may lie under
    const left = place[0] < pose[0] - 0.1; // the text keeps off the robot
    pane.text('turning centre', ...place,
        { role: 'goal', dx: left ? -12 : 12, align: left ? 'right' : 'left' });
  },
});
