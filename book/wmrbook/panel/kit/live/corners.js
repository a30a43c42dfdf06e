// A route with one corner: the heading that shares its bend between two legs, and the way that
// follows.

import {
  DEGREES, ahead, alongRoute, inDegrees, live, onStops, poseAt, wrap, written,
} from '../drawing.js';

const HAIRPIN = Math.PI - 1e-9; // a turn of 180 degrees but for rounding goes to the left

/** @type {(from: Point, to: Point) => number | null} */
const courseOf = ([x, y], [toX, toY]) =>
    (x === toX && y === toY ? null : Math.atan2(toY - y, toX - x));

function sharedHeading(first, corner, last) {
  const come = courseOf(first, corner) ?? courseOf(corner, last),
      leave = courseOf(corner, last) ?? come, turn = wrap(leave - come);
  return { come, leave, heading: wrap(come + (Math.abs(turn) > HAIRPIN ? Math.PI : turn) / 2) };
}

export default live('corners', {
  find({ x, y, stop }, { data: { first, last, gains, ...radii } }) {
    const bend = sharedHeading(first, [x, y], last);
    const goals = [[x, y, bend.heading], [...last, bend.leave]], start = [...first, bend.come];
    return { ...bend, run: alongRoute({ start, goals, radii: [radii[stop], radii.stop], gains }) };
  },
  panes: ({ x, y }, { heading, run }) => ({ plane: {
    x: [-34, 38, 'east [m]'], y: [-32, 42, 'north [m]'], equal: true,
        given: 'A start, a corner and a goal, joined by two legs.',
    alt: `A route by way of a corner at ${written(x)} and ${written(y)} metres, where the robot ` +
        `looks to ${(heading * DEGREES).toFixed(0)} degrees; ` +
        `${run.arrived ? `${written(run.t[run.n - 1], 's')} long` : 'it does not arrive'}.`,
  } }),
  draw({ plane }, { x, y }, { come, heading, leave, run }, hidden, { data: { first, last }, ask }) {
    const corner = hidden ? ask.at : [x, y];
    plane.line([first, corner, last], 'ghost', { width: 1.5, dash: [4, 5] });
    plane.dot(...corner, 'ink', { hollow: true });
    if (hidden) {
      plane.text('start', ...first, { role: 'start', dy: -18, align: 'center' });
      plane.text('goal', ...last, { role: 'goal', dy: 18, align: 'center' });
      plane.dot(...first, 'start', { hollow: true });
      plane.dot(...last, 'goal', { hollow: true });
      return;
    }
    plane.path(run.x, run.y);
    plane.pose([...first, come], 'start');
    plane.pose([...last, leave], 'goal');
    plane.arrow(x, y, ...ahead([x, y, heading], 7), 'theta');
    plane.robot(poseAt(run, run.n - 1));
  },
  handles: ({ x, y }, found, setup) => [{
    id: 'corner', pane: 'plane', at: [x, y],
        says: `the corner, ${written(x)} m east and ${written(y)} m north`,
    move: (toX, toY) => onStops(setup, { x: toX, y: toY }),
  }],
  say: (values, { heading, run }) =>
      ({ heading: inDegrees(heading), omega: written(run.peakOmega, 'rad/s'),
      seconds: run.arrived ? written(run.t[run.n - 1], 's') : 'more than four minutes' }),
});
