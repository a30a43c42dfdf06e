// The ground that robots drive on, from above, and a bar that says how large it is.

import { label, line } from './surface.js';

// Stripes, as a mower leaves them, as wide as one can tell, or `wide` metres.
export function drawLawn(ctx, view, colours, wide = 0) {
  const { box, scale } = view, stripe = wide || 2 ** Math.round(Math.log2(60 / scale));
  ctx.fillStyle = colours.lawn;
  ctx.fillRect(box.left, box.top, box.width, box.height);
  ctx.fillStyle = colours.mown;
  const [left] = view.toWorld(0, 0), [right] = view.toWorld(box.width, 0);
  for (let k = 2 * Math.floor(left / stripe / 2); k * stripe < right; k += 2)
    ctx.fillRect(view.toScreen(k * stripe, 0)[0], box.top, stripe * scale, box.height);
}

// 1, 2 or 5 times a power of ten, and at most `most`.
export function roundBelow(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return power * [5, 2, 1].find((each) => each * power <= most * (1 + 1e-9));
}

// A bar of a round number of metres in the corner, a quarter of the picture at most.
export function drawScale(ctx, { box, scale }, colours, called) {
  const metres = roundBelow(box.width / 4 / scale), y = box.top + box.height - 10,
      x = box.left + 12, to = x + metres * scale;
  line(ctx, [[x, y - 5], [x, y], [to, y], [to, y - 5]], colours.ink, 1.5);
  label(ctx, called(metres), (x + to) / 2, y - 13, colours, { align: 'center' });
}
