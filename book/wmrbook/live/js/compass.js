// A compass on a robot with magnets and steel: the field that it feels, and the heading that it makes of it.

// The field in the robot's frame, [ahead, left], and the heading that follows from it; the robot's heading in radians from magnetic east.
function felt(heading, { iron, soft }, field) {
  const s = soft / 100, at = [(1 + s) * field * Math.sin(heading) + iron, (1 - s) * field * Math.cos(heading)];
  return { at, read: wrap(Math.PI / 2 - Math.atan2(at[1], at[0])) };
}

const explorable = {
  find(values, { data: { field } }) {
    const turn = Array.from({ length: 181 }, (_, k) => 2 * k - 180), all = turn.map((each) => felt(each / DEGREES, values, field));
    const errors = all.map(({ read }, k) => wrap(read - turn[k] / DEGREES) * DEGREES), heading = values.heading / DEGREES;
    return { turn, errors, circle: all.map(({ at }) => at), worst: Math.max(...errors.map(Math.abs)), ...felt(heading, values, field), true: heading };
  },
  panes: (values, { read, worst, at }) => ({
    above: { x: [-2, 2, ''], y: [-1.6, 1.6, ''], equal: true, bare: true, given: 'A robot from above that looks east, and an arrow to the north.', alt: `The robot from above: it looks to ${values.heading} degrees and believes to look to ${(read * DEGREES).toFixed(0)} degrees.` },
    field: { x: [-60, 60, 'field ahead [µT]'], y: [-60, 60, 'field to the left [µT]'], equal: true, given: 'The plane of the readings: nothing yet.', alt: `The readings of a full turn as a ring, this one ${at.map((each) => each.toFixed(0)).join(' and ')} microtesla.` },
    error: { x: [-180, 180, 'heading [°]'], y: [-90, 90, 'error [°]'], tall: true, given: 'The error over the heading: nothing yet.', alt: `The heading's error in a full turn, up to ${worst.toFixed(0)} degrees.`, scrub: (x) => ({ heading: Math.min(Math.max(2 * Math.round(x / 2), -180), 180) }) },
  }),
  draw({ above, field, error }, { heading: degrees, iron }, { turn, errors, circle, at, read, true: heading }, hidden) {
    above.arrow(-1.5, 0.4, -1.5, 1.3, 'ghost');
    above.text('north', -1.5, 0.4, { role: 'ghost', dy: -12, align: 'center' });
    above.robot([0, 0, hidden ? 0 : heading]);
    if (hidden) return;
    above.arrow(0, 0, 1.2 * Math.cos(heading), 1.2 * Math.sin(heading), 'path');
    above.arrow(0, 0, 1.2 * Math.cos(read), 1.2 * Math.sin(read), 'rising', { dash: [6, 4] });
    above.text('believed', 1.35 * Math.cos(read), 1.35 * Math.sin(read), { role: 'rising', align: Math.cos(read) < 0 ? 'right' : 'left' });
    field.line(circle, 'path', { width: 2 });
    field.cross(iron, 0, 'goal');
    field.arrow(0, 0, ...at, 'rising', { dash: [6, 4] });
    error.path(turn, errors, 'rising');
    const off = wrap(read - heading) * DEGREES;
    error.line([[degrees, 0], [degrees, off]], 'ghost', { width: 1.5 });
    error.dot(degrees, off, 'rising', { hollow: true });
  },
  say: (values, { read, worst }) => ({ read: inDegrees(read), worst: `${worst.toFixed(0)}°` }),
};
