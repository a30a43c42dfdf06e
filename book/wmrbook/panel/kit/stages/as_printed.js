// Chapter 10: two robots race, by the law as printed and by the law as derived.

import { endOf, freshRun, stage } from '../drawing.js';

const ROLES = { blue: 'path', pink: 'alpha' };

export default stage('as_printed', {
  find({ start, goal, h }, { data: { gains, laws } }) {
    const tracks = Object.entries(laws).map(([robot, law]) => ({ robot, role: ROLES[robot],
      ...freshRun({ start, goal, law, gains: { ...gains, h } }) }));
    return { tracks };
  },
  say: ({ goal }, { tracks }) => Object.fromEntries(tracks.map((track) =>
    [track.robot, endOf(track, goal)])),
});
