// Robots that start on the seam of theta and see their goal through noise: their ways over the two
// angles, and in the plane.

import {
  DEGREES, LAWS, ahead, heldRun, inDegrees, live, normals, polarClosingRate, polarFromPose,
  remembered, wrap,
} from '../drawing.js';

const QUARTER = Math.PI / 2;

// What is random is drawn once.
const drawn = remembered(({ robots, seed, steps }) =>
  Array.from({ length: robots }, (_, robot) =>
    Array.from({ length: steps }, (__, k) => normals(robot, k, seed, 1)[0])));

// Where each of the robots ends, and its angles on the way, wrapped.
const swarm = remembered(({ robots, seed, noise, distance, ...drive }) =>
  drawn({ robots, seed, steps: drive.steps }).map((errors) => {
    const [goalX, goalY] = drive.goal, sight = (k, [x, y, heading]) => {
      const turn = noise * errors[k], c = Math.cos(turn), s = Math.sin(turn);
      const [east, north] = [x - goalX, y - goalY];
      return [goalX + c * east - s * north, goalY + s * east + c * north, heading];
    };
    const { poses } = heldRun({ ...drive, start: [distance, 0, Math.PI], sight });
    const angles = poses.map((pose) => polarFromPose(...pose, ...drive.goal).slice(1));
    return { poses, angles, off: wrap(poses.at(-1)[2] - drive.goal[2]) };
  }));

// In degrees, over a square with the seam in its middle.
const unrolled = ([alpha, theta]) =>
    [alpha * DEGREES, theta * DEGREES + (theta < 0 ? 180 : -180)];

// A way over that square, cut where it leaves it.
function flat(pane, angles, role, width) {
  let piece = [];
  for (const point of angles.map(unrolled)) {
    if (piece.length && Math.abs(point[1] - piece.at(-1)[1]) > 180) {
      pane.line(piece, role, { width });
      piece = [];
    }
    piece.push(point);
  }
  pane.line(piece, role, { width });
}

// Which way the law takes the angles, as a short arrow.
function field(pane, alpha, theta, rho, gains) {
  const commanded = LAWS.corrected.formula(rho, alpha, theta, gains);
  const [, alphaRate, thetaRate] = polarClosingRate(rho, alpha, ...commanded);
  const size = 16 / Math.max(Math.hypot(alphaRate, thetaRate), 1e-9);
  const [x, y] = unrolled([alpha, theta]);
  pane.arrow(x, y, x + size * alphaRate, y + size * thetaRate, 'ink', { width: 1.2 });
}

const named = (y) => (y > 0 ? y - 180 : y + 180).toFixed(0).replace('-', '−');

export default live('seam', {
  find({ noise, hysteresis }, { data }) {
    const runs = swarm({ ...data, noise: noise / DEGREES, hysteresis }),
        lost = runs.filter(({ off }) => Math.abs(off) > QUARTER).length;
    return { runs, lost };
  },
  panes: (values, { runs, lost }) => ({
    square: { x: [-190, 190, 'α [°]'], y: [-190, 190, 'θ [°]', named], equal: true,
        given: 'The two angles, the seam across the middle, and which way the law drives.',
        alt: `Over the two angles ${runs.length} ways begin on the seam; ${lost} leave it, but ` +
        `too late.` },
    plane: { x: [-0.2, 0.95, 'x [m]'], y: [-0.4, 0.4, 'y [m]'], equal: true,
        given: 'The goal, and the robot that looks at it from the front.',
        alt: `The ways in the plane: ${lost} of ${runs.length} robots park over 90 degrees off.` },
  }),
  draw({ square, plane }, values, { runs }, hidden, { data }) {
    square.line([[-180, 0], [180, 0]], 'rising', { width: 3 });
    square.text('seam', -175, 0, { role: 'rising', dy: 10, size: 13 });
    for (const theta of [-150, -90, 90, 150])
      for (let alpha = -150; alpha <= 150; alpha += 60)
        field(square, alpha / DEGREES, theta / DEGREES, data.distance, data.gains);
    for (const { poses, angles, off } of hidden ? [] : runs) {
      const role = Math.abs(off) > QUARTER ? 'rising' : 'path';
      flat(square, angles, role, 1.5);
      square.dot(...unrolled(angles.at(-1)), role, { size: 3 });
      const end = poses.at(-1);
      plane.line(poses, role, { width: 1.5 });
      plane.arrow(end[0], end[1], ...ahead(end, 0.06), role, { width: 1.5 });
    }
    for (const edge of [-180, 180]) square.dot(0, edge, 'goal');
    plane.pose([data.distance, 0, Math.PI], 'start');
    plane.pose(data.goal, 'goal');
  },
  say: (values, { runs, lost }) => ({ lost: `${lost} of ${runs.length}`,
      worst: inDegrees(Math.max(...runs.map(({ off }) => Math.abs(off)))) }),
});
