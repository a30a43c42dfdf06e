// Chapter 12: fixes of a receiver that stands still come in: their means over some time, their
// scatter in it, and the courses from fix to fix if the receiver were carried to the east.

import { inDegrees, inSize, remembered, ring, stage, written } from '../drawing.js';

const ROOM = 0.6, ROSE = 2.5; // m round the fixes, and the length of a course's line
const farthest = (points) => Math.max(...points.map(([x, y]) => Math.hypot(x, y)));
const mean = (numbers) => numbers.reduce((sum, it) => sum + it, 0) / numbers.length;

// The fixes come as a text, one line of a notebook.
const logged = remembered(({ fixes }) => JSON.parse(fixes));

// The mean of the last n fixes, and their scatter about it (rms); of all so far while there are
// fewer.
const means = remembered(({ data, n }) => {
  const fixes = logged(data), sum = [0, 0, 0];
  return fixes.map((fix, k) => {
    const [old, size] = [fixes[k - n] || [0, 0], Math.min(n, k + 1)];
    [0, 1].forEach((i) => {
      sum[i] += fix[i] - old[i];
      sum[2] += fix[i] ** 2 - old[i] ** 2;
    });
    const [x, y, square] = sum.map((it) => it / size);
    return [x, y, Math.sqrt(Math.max(square - x ** 2 - y ** 2, 0))];
  });
});

const steps = (fixes) => fixes.slice(1).map(([x, y], k) => [x - fixes[k][0], y - fixes[k][1]]);

export default stage('standing_still', {
  find({ seconds, speed, scene }, { data }) {
    const { every } = data, n = Math.round(seconds / every), places = means({ data, n });
    const drawn = ['whole', 'minute', 'ask'].includes(scene); // the other scenes show no mean
    const [x, y] = [0, 1].map((i) => places.map((place) => (drawn ? place[i] : 0))),
        t = x.map((_, k) => k * every);
    const courses = steps(logged(data)).map(([dx, dy]) => Math.atan2(dy, dx + speed * every));
    return { n, places, courses,
      tracks: [{ t, x, y, heading: x.map(() => 0), n: x.length, role: 'path' }] };
  },
  say({ speed }, { n, places, courses }, { data }) {
    const { every } = data, fixes = logged(data), full = places.slice(n - 1);
    return {
      seconds: `${n * every} s`, lasts: written(every * fixes.length / 60, 'minutes', 2),
      far: inSize(farthest(fixes)), left: inSize(farthest(full)),
      spread: inSize(mean(full.map((place) => place[2]))), speed: written(speed, 'm/s', 2),
      walk: written(steps(fixes).reduce((sum, step) => sum + Math.hypot(...step), 0), 'm', 2),
      turned: inDegrees(Math.max(...courses.map(Math.abs)), 0),
    };
  },
  look(values, run, { data }) {
    const [xs, ys] = [0, 1].map((i) => logged(data).map((fix) => fix[i]));
    return [Math.min(...xs) - ROOM, Math.min(...ys) - ROOM, Math.max(...xs) + ROOM,
      Math.max(...ys) + ROOM];
  },
  draw(pane, values, { n, places, courses }, { k, size, shows }, { data }) {
    const fixes = logged(data);
    if (shows.includes('course')) {
      for (const course of courses.slice(0, k))
        pane.line([[0, 0], [ROSE * Math.cos(course), ROSE * Math.sin(course)]], 'alpha',
            { width: 1 });
      pane.robot([0, 0, 0], 0.5, { size });
      return;
    }
    pane.robot([0, 0, 0], 0.5, { size });
    if (shows.includes('path')) pane.line(fixes.slice(0, k + 1), 'rho', { width: 1.5 });
    const recent = (i) => shows.includes('scatter') && i > k - n;
    fixes.slice(0, k + 1).forEach(([x, y], i) =>
      pane.dot(x, y, 'rho', { size: i === k ? 5 : recent(i) ? 3.5 : 2 }));
    if (shows.includes('path')) return;
    const [x, y, scatter] = places[k];
    if (shows.includes('scatter')) pane.line(ring(x, y, scatter), 'path', { width: 2 });
    pane.dot(x, y, 'path', { size: 8, hollow: true });
    pane.cross(x, y, 'path', 5);
  },
});
