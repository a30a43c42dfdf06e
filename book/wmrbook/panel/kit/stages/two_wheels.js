// Chapter 2: the arc that two wheel speeds make, its chord, and a way to the side in four moves.

import { DEGREES, ahead, arcStep, inDegrees, stage, twistOf, written } from '../drawing.js';

const DT = 0.05; // s
const START = [0, 0, Math.PI / 2];
const SLANTED = [0, 0, Math.PI / 6]; // 30 degrees from east, to split a velocity
const LONGER = 3.5; // m of an arrow for each m/s
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

const sidewaysFrom = (pose, side, far) =>
    ahead([pose[0], pose[1], pose[2] + side * Math.PI / 2], far);

export default stage('two_wheels', {
  find({ scene, left, right }, { scenes, data: { track_width: width, seconds } }) {
    const { shows } = scenes.find(({ name }) => name === scene);
    const { v, omega } = twistOf(left, right, width);
    const start = shows.includes('velocity') ? SLANTED : START;
    const run = along(start, shows.includes('moves') ? fourMoves(v, omega, seconds)
        : [{ v, omega, seconds }]);
    const straight = ahead(start, v * seconds);
    return { v, omega, start, straight, wheels: tracksOf(run, width),
      tracks: [{ ...run, role: 'path' }], end: run.pose, close: shows.length > 0,
      miss: Math.hypot(run.pose[0] - straight[0], run.pose[1] - straight[1]) };
  },
  look(values, { tracks: [{ x, y }], close }) {
    const reach = 0.4 + Math.max(close ? 0.8 : 1.3, ...x.map(Math.abs), ...y.map(Math.abs));
    return [-reach, close ? Math.min(-0.5, Math.min(...y) - 0.4) : -reach, reach, reach];
  },
  say: ({ left, right }, { v, omega, start, end, miss }, { data: { seconds } }) => ({
    speed: written(v, 'm/s'), turning: written(omega * DEGREES, '°/s'),
    does: v && omega ? 'drives an arc' : v ? 'drives straight on' : omega ? 'turns on the spot'
        : 'stands still',
    left_way: written(left * seconds, 'm'), right_way: written(right * seconds, 'm'),
    turned: inDegrees(omega * seconds), half: inDegrees(omega * seconds / 2),
    arc: written(Math.abs(v) * seconds, 'm'),
    chord: written(Math.hypot(end[0] - start[0], end[1] - start[1]), 'm'),
    miss: written(miss, 'm'), heading: inDegrees(start[2], 0),
    east: written(v * Math.cos(start[2]), 'm/s'), north: written(v * Math.sin(start[2]), 'm/s'),
    aside: Math.abs(end[0]) < 0.0005 ? 'nothing' : written(Math.abs(end[0]), 'm'),
    ahead: Math.abs(end[1]) < 0.0005 ? 'nothing' : written(Math.abs(end[1]), 'm'),
  }),
  draw(pane, { left, right }, { v, omega, start, straight, wheels, end }, { pose, k, size, shows },
      { data: { track_width: width, seconds } }) {
    pane.robot(start, 0.2, { size });
    for (const [i, speed] of [left, right].entries()) {
      const [x, y] = sidewaysFrom(pose, i ? -1 : 1, width / 2);
      pane.line(wheels[i].slice(0, k + 1), 'ink', { width: 1.5, dash: [2, 5] });
      if (speed && !shows.length) pane.arrow(x, y, ...ahead([x, y, pose[2]], speed), 'rho');
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
});
