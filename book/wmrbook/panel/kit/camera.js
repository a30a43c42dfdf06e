// A body that a hand turns, seen from where `yaw` and `tilt` say, in degrees.

import { DEGREES } from './style.js';
import { within } from './numbers.js';
import { wrap } from './model.js';

/**
 * How far to the right, up and towards whoever looks a place of the body is.
 * @returns {(...place: number[]) => number[]}
 */
export function camera(yaw, tilt) {
  const [c, s, up, down] = [yaw, tilt].map((angle) => angle / DEGREES)
      .flatMap((angle) => [Math.cos(angle), Math.sin(angle)]);
  return (x, y, z) => {
    const across = x * c - y * s, away = x * s + y * c;
    return [across, away * down + z * up, z * down - away * up];
  };
}

// What a hand on it changes, for `scrub`.
export const turnedBy = (x, y, moved, now) => moved
    && { yaw: wrap((now.yaw + moved[0] / 2) / DEGREES) * DEGREES,
    tilt: within(now.tilt + moved[1] / 2, 5, 85) };
