// A small picture in an upper corner of another one, in units of its own.

import { ahead } from './numbers.js';
import { inside } from './surface.js';
import { sizeAt } from './scene.js';

const GAP = 10; // px, to the edge

/**
 * Draws the frame; `at` gives the place in the large picture for one in the small one, and
 * `within(draw)` keeps a drawing inside.
 * @param {Pane} pane @param {'left' | 'right'} side @param {{ width: number, height: number }} size
 * @param {number[]} xs @param {number[]} ys
 */
export function insetOf(pane, side, { width, height }, [x0, x1], [y0, y1]) {
  const { ctx, box, view } = pane, top = box.top + GAP,
      left = box.left + (side === 'left' ? GAP : box.width - width - GAP);
  ctx.fillStyle = pane.ink('paper');
  ctx.fillRect(left, top, width, height);
  ctx.strokeStyle = pane.ink('soft');
  ctx.lineWidth = 1.5;
  ctx.strokeRect(left, top, width, height);
  return {
    /** @type {(place: Point) => Point} */
    at: ([x, y]) => view.toWorld(left + (x - x0) / (x1 - x0) * width,
        top + (y1 - y) / (y1 - y0) * height),
    within: (draw) => inside(ctx, { left, top, width, height }, draw),
  };
}

/** As large as there is room. @param {{ box: any }} pane @param {number} most px */
export const insetSize = ({ box }, most) =>
    ({ width: Math.min(0.34 * box.width, most), height: Math.min(0.42 * box.height, most) });

/** What an inset takes of a stage, with room around it. @param {any} size @param {number} most */
export const cornerOf = (size, most, share = 1) => {
  const { width, height } = insetSize({ box: size }, most);
  return { width: width + 2 * GAP, height: share * height + 2 * GAP };
};

/**
 * A goal from near, and the robots there, each [pose, role, share]; `reach` metres to the
 * edge, and `most` pixels wide.
 * @param {Pane} pane @param {Pose} goal @param {any[]} robots
 */
export function goalFromNear(pane, goal, robots, reach, most) {
  const { width, height } = insetSize(pane, most), side = Math.min(width, height), [x, y] = goal;
  const inset = insetOf(pane, 'left', { width: side, height: side }, [x - reach, x + reach],
    [y - reach, y + reach]), size = sizeAt(side / 2 / reach);
  inset.within(() => {
    for (const [pose, role, share] of robots)
      pane.robot([...inset.at(pose), pose[2]], share, { size, role });
    pane.dot(...inset.at(goal), 'goal', { hollow: true });
    pane.arrow(...inset.at(goal), ...inset.at(ahead(goal, 0.8 * reach)), 'goal');
  });
  return inset;
}
