// Chapter 10: two robots race, by the law as printed and by the law as derived; and what a referee
// tries on the paper's other lines.

import {
  arcStep, cornerOf, endOf, freshRun, inDegrees, insetOf, insetSize, lengthText, poseOfError, ring,
  stage, summarise, trackOf, wrap, written,
} from '../drawing.js';

const ROLES = { blue: 'path', pink: 'alpha' };
const CORNER = 170; // px, of the picture of V
const MARGIN = 1.2; // m, round the circle
const AWAY = 40; // m, of the circle from the other drive's start

const raced = ({ laws }, options) => ({ tracks: Object.entries(laws).map(([robot, law]) =>
  ({ robot, role: ROLES[robot], ...freshRun({ law, ...options }) })) });

// A robot that gets the same command all the time, whatever it sees.
function blind({ error, twist, seconds }, goal) {
  const steps = Math.round(seconds / 0.1), poses = [poseOfError(...error, ...goal)];
  while (poses.length <= steps) poses.push(arcStep(...poses.at(-1), ...twist, 0.1));
  return { tracks: [trackOf({ poses, twists: poses.map(() => twist) }, 0.1)] };
}

const sightOf = (pose, goal) => Math.atan2(goal[1] - pose[1], goal[0] - pose[0]);

const FINDS = {
  rises({ goal, h }, { gains, laws, nearGoal: { error, seconds } }) {
    const { tracks } = raced({ laws }, { start: poseOfError(...error, ...goal), goal,
      gains: { ...gains, h }, dt: 0.02, duration: seconds, arrivalRadius: 0 });
    const curves = tracks.map(({ V }) => Array.from(V, (value) => value / V[0]));
    return { tracks, curves, most: Math.max(...curves.flat()) };
  },
  circle({ h }, { laws, circle: { gains, start, seconds } }) {
    const { tracks } = raced({ laws }, { start, reference: 'circle', gains: { ...gains, h },
      dt: 0.1, duration: seconds });
    const aside = (xs) => xs.map((x) => x + AWAY);
    return { tracks: tracks.map((track) =>
      ({ ...track, x: aside(track.x), goalX: aside(track.goalX) })) };
  },
};

export default stage('as_printed', {
  find(values, { data }) {
    const { scene, start, goal, h } = values;
    if (scene in data.blind) return blind(data.blind[scene], goal);
    if (scene in FINDS) return FINDS[scene](values, data);
    return raced(data, { start, goal, gains: { ...data.gains, h } });
  },
  look({ scene, goal: [x, y] }, { tracks }, { data: { blind: asked, circle: { radius } } }) {
    if (scene === 'circle')
      return [AWAY - 2 * radius - MARGIN, -radius - MARGIN, AWAY + 2 * MARGIN, radius + MARGIN];
    const reach = scene === 'rises' ? 0.5 : 1.5;
    if (scene !== 'rises' && !(scene in asked)) return null;
    const xs = tracks.flatMap((track) => [...track.x, x]),
        ys = tracks.flatMap((track) => [...track.y, y]);
    // below them the goal's arrow has to clear the buttons
    return [Math.min(...xs) - reach, Math.min(...ys) - (scene in asked ? 2 : 1) * reach,
      Math.max(...xs) + reach, Math.max(...ys) + reach];
  },
  corner: ({ scene }, found, size) => (scene === 'rises' ? cornerOf(size, CORNER) : null),
  say({ scene, goal }, { tracks, most }, { data: { blind: asked } }) {
    if (scene in asked) {
      const [{ x, y, heading, n }] = tracks, poses = [0, n - 1].map((k) => [x[k], y[k]]),
          [first, last] = poses.map((pose) => sightOf(pose, goal));
      return { turned: inDegrees(wrap(last - first), 0),
        alpha: inDegrees(wrap(last - heading[n - 1]), 0) };
    }
    if (scene === 'rises') return { most: written(most, '', 2) };
    if (scene === 'circle')
      return Object.fromEntries(tracks.map((track) =>
        [`${track.robot}_gap`, lengthText(summarise(track).residual, 2)]));
    return Object.fromEntries(tracks.map((track) => [track.robot, endOf(track, goal)]));
  },
  draw(pane, { scene, goal }, { tracks }, { pose }, { data: { blind: asked, circle } }) {
    if (scene === 'circle')
      pane.line(ring(AWAY - circle.radius, 0, circle.radius), 'goal', { width: 1.5, dash: [8, 5] });
    if (!(scene in asked)) return;
    const [{ x, y }] = tracks;
    pane.line([[x[0], y[0]], goal], 'ghost', { width: 1.5, dash: [6, 5] });
    pane.line([pose, goal], 'rho', { width: 2 });
  },
  above(pane, { scene }, { tracks, curves, most }, { k, time }) {
    if (scene === 'circle') {
      const [{ goalX, goalY, goalHeading }] = tracks;
      pane.pose([goalX[k], goalY[k], goalHeading[k]], 'goal');
    }
    if (scene !== 'rises') return;
    const [{ t }] = tracks, last = t[t.length - 1];
    const inset = insetOf(pane, 'left', insetSize(pane, CORNER), [-0.05 * last, 1.05 * last],
      [-0.1 * most, 1.25 * most]);
    inset.within(() => {
      pane.line([[0, 1], [last, 1]].map(inset.at), 'soft', { width: 1, dash: [4, 4] });
      curves.forEach((curve, i) => {
        const to = curve.findIndex((_, j) => t[j] > time);
        pane.line(curve.slice(0, to < 0 ? undefined : Math.max(to, 2))
          .map((value, j) => inset.at([t[j], value])), tracks[i].role, { width: 2.5 });
      });
    });
    pane.text('V', ...inset.at([0.08 * last, 1.1 * most]),
      { role: 'ink', size: 15, weight: 600, align: 'center', fixed: true });
  },
});
