// Small sums that pictures and hands share.

/** @param {number} value @param {number} low @param {number} high */
export const within = (value, low, high) => Math.min(Math.max(value, low), high);

// What a table has at a place between two of its rows.
export function between(table, place) {
  const k = Math.min(Math.floor(place), table.length - 2);
  return table[k] + (place - k) * (table[k + 1] - table[k]);
}

export function median(values) {
  const sorted = Float64Array.from(values).sort(), half = (sorted.length - 1) / 2;
  return (sorted[Math.floor(half)] + sorted[Math.ceil(half)]) / 2;
}

// The number of the nearest of `n` things, of those from `from` on, or null if none is within
// `reach`.
export function nearest(n, far, reach, from = 0) {
  let best = null, least = reach;
  for (let k = from; k < n; k += 1) if (far(k) < least) [best, least] = [k, far(k)];
  return best;
}

// The place so far ahead of a pose.
/** @param {Pose} pose @param {number} far @returns {[number, number]} */
export const ahead = ([x, y, heading], far) =>
    [x + far * Math.cos(heading), y + far * Math.sin(heading)];

// Points of a circle about a place, or of its arc from one angle to another one.
export function ring(x, y, radius, from = 0, to = 2 * Math.PI) {
  return Array.from({ length: 81 }, (_, k) => from + (to - from) * k / 80)
      .map((angle) => [x + radius * Math.cos(angle), y + radius * Math.sin(angle)]);
}
