// Chapter 2: the arc that two wheel speeds make, and a way to the side in three moves.

import { DEGREES, ahead, arcStep, stage, twistOf, written } from '../drawing.js';

const DT = 0.05; // s
const START = [0, 0, Math.PI / 2];
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

export default stage('two_wheels', {
  find({ scene, left, right }, { scenes, data: { track_width: width, seconds } }) {
    const { shows } = scenes.find(({ name }) => name === scene);
    const { v, omega } = twistOf(left, right, width);
    const moves = [{ v, omega, seconds }, { v, omega: -omega, seconds }];
    const there = along(START, moves), back = { v: -there.pose[1] / seconds, omega: 0, seconds };
    const run = along(START, shows.includes('moves') ? [...moves, back] : moves.slice(0, 1));
    return { v, omega, wheels: tracksOf(run, width), tracks: [{ ...run, role: 'path' }],
      aside: Math.abs(there.pose[0]) };
  },
  look(values, { tracks: [{ x, y }] }) {
    const reach = 0.4 + Math.max(1.3, ...x.map(Math.abs), ...y.map(Math.abs));
    return [-reach, -reach, reach, reach];
  },
  say: (values, { v, omega, aside }) => ({
    speed: written(v, 'm/s'), turning: written(omega * DEGREES, '°/s'),
    does: v && omega ? 'drives an arc' : v ? 'drives straight on' : omega ? 'turns on the spot'
        : 'stands still',
    aside: aside < 0.0005 ? 'nothing' : written(aside, 'm'),
  }),
  draw(pane, { left, right }, { wheels }, { pose, k, size, shows }, { data }) {
    pane.robot(START, 0.2, { size });
    for (const [i, speed] of [left, right].entries()) {
      const away = pose[2] + (i ? -1 : 1) * Math.PI / 2;
      const [x, y] = ahead([pose[0], pose[1], away], data.track_width / 2);
      pane.line(wheels[i].slice(0, k + 1), 'ink', { width: 1.5, dash: [2, 5] });
      if (speed && !shows.includes('moves'))
        pane.arrow(x, y, ...ahead([x, y, pose[2]], speed), 'rho');
    }
  },
});
