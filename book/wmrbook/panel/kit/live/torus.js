// Robots that start on the seam of theta and see their goal through noise: their ways over the two
// angles, on a torus and laid flat, and in the plane.

import {
  DEGREES, LAWS, ahead, camera, heldRun, inDegrees, live, normals, polarClosingRate,
  polarFromPose, remembered, turnedBy, wrap,
} from '../drawing.js';

const TUBE = 0.45, AROUND = 48, QUARTER = Math.PI / 2;

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

// A point of the torus on the screen, alpha = 0 on top, and whether it is on the side that is seen.
function turned(yaw, tilt) {
  const seen = camera(yaw, tilt);
  return ([alpha, theta]) => {
    const [out, up, ct, st] = [Math.sin(alpha), Math.cos(alpha), Math.cos(theta), Math.sin(theta)];
    const [x, y] = seen((1 + TUBE * out) * ct, (1 + TUBE * out) * st, TUBE * up);
    return { at: [x, y], front: seen(out * ct, out * st, up)[2] > 0 };
  };
}

// A line over the torus: what is behind is thin and pale.
function over(pane, view, points, role, width) {
  let piece = [], side = null;
  const end = () => {
    if (piece.length > 1)
      pane.line(piece, side ? role : 'line', { width: side ? width : 1 });
  };
  for (const { at, front } of points.map(view)) {
    if (side !== null && front !== side) { end(); piece = piece.slice(-1); }
    side = front;
    piece.push(at);
  }
  end();
}

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

const circle = (point) =>
    Array.from({ length: AROUND + 1 }, (_, k) => point(2 * Math.PI * k / AROUND));

export default live('torus', {
  find({ noise, hysteresis, distance }, { data }) {
    const runs = swarm({ ...data, noise: noise / DEGREES, hysteresis, distance }),
        lost = runs.filter(({ off }) => Math.abs(off) > QUARTER).length;
    return { runs, lost };
  },
  panes: (values, { runs, lost }) => ({
    torus: {
      x: [-1.55, 1.55], y: [-1.5, 1.5], equal: true, bare: true,
      given: 'A torus of the two angles, with the seam as a ring about its tube.',
      alt: `On the torus ${runs.length} ways begin on the seam; ${lost} leave it, but too late.`,
      scrub: turnedBy,
    },
    square: { x: [-190, 190, 'α [°]'], y: [-190, 190, 'θ [°]', named], equal: true,
        given: 'The torus laid flat, the seam across its middle, and which way the law drives.',
        alt: 'The same ways over the square of alpha and theta.' },
    plane: { x: [-0.2, 0.95, 'x [m]'], y: [-0.4, 0.4, 'y [m]'], equal: true,
        given: 'The goal, and the robot that looks at it from the front.',
        alt: `The ways in the plane: ${lost} of ${runs.length} robots park over 90 degrees off.` },
  }),
  draw({ torus, square, plane }, values, { runs }, hidden, { data }) {
    const { yaw, tilt, distance } = hidden ? data.asked : values, view = turned(yaw, tilt);
    for (let k = 0; k < 12; k += 1) {
      over(torus, view, circle((alpha) => [alpha, Math.PI * k / 6]), 'ghost', 0.8);
      over(torus, view, circle((theta) => [Math.PI * k / 6, theta]), 'ghost', 0.8);
    }
    over(torus, view, circle((alpha) => [alpha, Math.PI]), 'rising', 3);
    square.line([[-180, 0], [180, 0]], 'rising', { width: 3 });
    square.text('seam', -175, 0, { role: 'rising', dy: 10, size: 13 });
    for (const theta of [-150, -90, 90, 150])
      for (let alpha = -150; alpha <= 150; alpha += 60)
        field(square, alpha / DEGREES, theta / DEGREES, distance, data.gains);
    for (const { poses, angles, off } of hidden ? [] : runs) {
      const role = Math.abs(off) > QUARTER ? 'rising' : 'path', last = view(angles.at(-1));
      over(torus, view, angles, role, 1.5);
      if (last.front) torus.dot(...last.at, role, { size: 3 });
      flat(square, angles, role, 1.5);
      square.dot(...unrolled(angles.at(-1)), role, { size: 3 });
      const end = poses.at(-1);
      plane.line(poses, role, { width: 1.5 });
      plane.arrow(end[0], end[1], ...ahead(end, 0.06), role, { width: 1.5 });
    }
    const goal = view([0, 0]), start = view([0, Math.PI]);
    if (goal.front) torus.dot(...goal.at, 'goal');
    if (start.front) torus.dot(...start.at, 'start', { size: 4 });
    torus.text('seam', ...view([QUARTER, Math.PI]).at, { role: 'rising', dx: 8, size: 13 });
    for (const edge of [-180, 180]) square.dot(0, edge, 'goal');
    plane.pose([distance, 0, Math.PI], 'start');
    plane.pose(data.goal, 'goal');
  },
  say: (values, { runs, lost }) => ({ lost: `${lost} of ${runs.length}`,
      worst: inDegrees(Math.max(...runs.map(({ off }) => Math.abs(off)))) }),
});
