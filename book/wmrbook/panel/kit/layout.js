// How large the pictures of a figure are: as large as the room allows, none of them a strip.

const GAP = 8; // px between two of them
const LONGEST = 1.5; // the longer side of a picture over its shorter one
export const NARROW = 560; // px of a figure: less is a telephone's

/**
 * The number of columns, all of them full, and the size of a picture that make `n` pictures largest
 * within a width and a height.
 * @param {number} n @param {number} width @param {number} height
 * @param {number} widest its width over its height, at most
 */
export function fitted(n, width, height, widest = LONGEST) {
  let best = { columns: 1, width: 0, height: 0 };
  for (let columns = 1; columns <= n; columns += 1) {
    const rows = Math.ceil(n / columns), room = (width - GAP * (columns - 1)) / columns;
    const high = Math.min((height - GAP * (rows - 1)) / rows, LONGEST * room),
        wide = Math.min(room, widest * high);
    if (n % columns === 0 && wide * high > best.width * best.height)
      best = { columns, width: wide, height: high };
  }
  return best;
}

/** The shape of a picture on its own: a map's is that of what it shows. @param {Spec} spec */
export function widestOf({ x, y, equal, lawn }) {
  const shape = equal || lawn ? (x[1] - x[0]) / (y[1] - y[0]) : LONGEST;
  return Math.min(Math.max(shape, LONGEST), 2);
}
