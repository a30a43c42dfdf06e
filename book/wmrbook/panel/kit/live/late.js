// Two robots race: one sees its position late, the other its heading. Pale, where each believes it
// is.

import {
  DEGREES, ahead, heldRun, inDegrees, live, onStops, remembered, timeAlong, wrap, written,
} from '../drawing.js';

const RACERS = [{ name: 'position', role: 'path' }, { name: 'heading', role: 'alpha' }];
const NEAR = 4.5; // m round a robot

const turned = (pose, degrees) => [pose[0], pose[1], pose[2] + degrees / DEGREES];

const race = remembered(({ delay, lost, ...drive }) => RACERS.map(({ name }) => {
  const { dt } = drive, back = Math.round(delay / dt), past = [], seen = [];
  const { poses, arrived } = heldRun({ ...drive, steps: Math.round(lost / dt), sight(k, pose) {
    past.push(pose);
    const old = past[Math.max(k - back, 0)];
    seen.push(name === 'position' ? [old[0], old[1], pose[2]] : [pose[0], pose[1], old[2]]);
    return seen[k];
  } });
  return { poses, seen, time: arrived ? dt * (poses.length - 1) : Infinity };
}));

export default live('late', {
  find({ delay, time, set_off, face }, { data }) {
    const start = turned(data.start, set_off), goal = turned(data.goal, face),
        runs = race({ delay, ...data, start, goal }),
        longest = Math.max(...runs.map((it) => it.poses.length));
    const k = Math.round(time * (longest - 1));
    return { runs: runs.map((run) => {
      const now = Math.min(k, run.poses.length - 1);
      return { ...run, now, pose: run.poses[now], old: run.seen[now] || run.poses[now],
        off: wrap(run.poses.at(-1)[2] - goal[2]) };
    }), t: k * data.dt, start, goal };
  },
  panes(values, { runs, t, ...ends }, { data }, hidden) {
    const { start } = hidden ? data : ends;
    const near = ({ pose }, k) => {
      const [east, north] = (hidden ? start : pose).map((it) => [it - NEAR, it + NEAR]);
      return { x: east, y: north, lawn: 4, given: 'The robot at the start, from near.',
        alt: `The robot whose ${RACERS[k].name} is late, from near, and, pale, where it ` +
        `believes it is.` };
    };
    const [position, heading] = runs.map(near);
    return {
      whole: { x: [-14, 30], y: [-9, 68], lawn: true,
        given: 'The start and the goal, 58 m apart, each with its heading.',
        alt: `Two robots on a lawn after ${written(t, 's')}: the one whose position is late is ` +
        `${inWords(runs[0], start)}, the one whose heading is late ${inWords(runs[1], start)}.`,
        scrub: (x, y) => timeAlong(runs.map(({ poses }) => poses), x, y, 6) },
      position, heading,
    };
  },
  draw({ whole, ...near }, values, { runs, ...ends }, hidden, { data }) {
    const { start, goal } = hidden ? data : ends;
    whole.pose(start, 'start');
    whole.pose(goal, 'goal');
    RACERS.forEach(({ name, role }, k) => {
      const pane = near[name], { poses, now, pose, old } = runs[k], [x, y, heading] = pose;
      pane.pose(goal, 'goal');
      if (hidden) { pane.robot(start, 1, { size: 1.5, role }); return; }
      for (const each of [whole, pane]) each.line(poses.slice(0, now + 1), role);
      pane.line([old, pose], role, { width: 1.5, dash: [2, 5] });
      pane.robot(old, 0.4, { size: 1.5, role });
      for (const [along, share] of [[heading, 1], [old[2], 0.5]])
        pane.line([[x, y], ahead([x, y, along], 1.8)], role,
            { width: 1.5 + share, dash: share < 1 ? [4, 4] : [] });
      pane.robot(pose, 1, { size: 1.5, role });
      whole.robot(pose, 1, { role });
    });
    RACERS.forEach(({ name, role }) => near[name].text(`${name} late`,
        ...near[name].view.toWorld(10, 16), { role, weight: 600 }));
  },
  handles: (values, { start, goal }, setup) =>
      [['set_off', start, 'start'], ['face', goal, 'goal']].map(([id, pose, name]) => ({
        id, pane: 'whole', at: ahead(pose, 8), says: `the ${name}'s heading, ${inDegrees(pose[2])}`,
        move(x, y) {
          const turn = Math.atan2(y - pose[1], x - pose[0]) - setup.data[name][2];
          return onStops(setup, { [id]: wrap(turn) * DEGREES });
        },
      })),
  say: (values, { runs }) => Object.fromEntries(runs.map(({ time, off }, k) => [RACERS[k].name,
    Number.isFinite(time)
      ? `stops after ${written(time, 's')}, ${inDegrees(Math.abs(off), 0)} off`
      : 'does not arrive within a minute'])),
});

const inWords = ({ pose, poses, now }, start) => (now === poses.length - 1 ? 'at its end'
    : `${written(Math.hypot(pose[0] - start[0], pose[1] - start[1]), 'm')} from the start`);
