// The handles that move and turn the start and the goal: buttons over the picture, for mouse, touch
// and keyboard.

import { inDegrees, written } from './style.js';
import { knobOf } from './scene.js';
import { putHandle } from './hands.js';
import { roundStep } from './surface.js';
import { wrap } from './model.js';

// 0.1 mm, 0.006 deg: what a hand can't aim at
const tidy = (value) => Math.round(value * 1e4) / 1e4;

// `host` stands over the canvas; `get(name)` gives a pose, `set(name, pose)` changes it; `view()`
// gives the picture's view; `hold(bool)` is told when a drag begins and ends, for the picture must
// not zoom under the hand.
export function buildHandles(host, { get, set, view, hold }) {
  const handles = [];
  const placeOf = (name, part, pose) =>
      (part === 'move' ? view().toScreen(pose[0], pose[1]) : knobOf(view(), pose, name));
  for (const name of ['goal', 'start']) {
    for (const part of ['move', 'turn']) {
      const handle = putHandle(host, {
        view, hold,
        move(x, y) {
          const pose = get(name), turn = Math.atan2(y - pose[1], x - pose[0]);
          const to = part === 'move' ? [x, y, pose[2]] : [pose[0], pose[1], turn];
          set(name, to.map((value, k) => (value === pose[k] ? value : tidy(value))));
        },
        nudge(move, { shiftKey }) {
          const step = roundStep(view().box.width / view().scale, 60);
          set(name, nudged(get(name), move, part === 'turn' || shiftKey, step));
        },
      });
      Object.assign(handle.button.dataset, { pose: name, part });
      handle.button.title = `${part === 'move' ? 'drag' : 'turn'} the ${name}`;
      handles.push({ ...handle, name, part });
    }
  }
  return (poses) => {
    for (const { button, show, name, part } of handles) {
      const pose = poses[name];
      button.hidden = !pose;
      if (!pose) continue;
      // out of the picture nobody would see what has the focus
      const seen = show(placeOf(name, part, pose));
      button.style.pointerEvents = seen ? '' : 'none';
      button.tabIndex = seen ? 0 : -1;
      const place =
          `x ${written(pose[0], 'm')}, y ${written(pose[1], 'm')}, heading ${inDegrees(pose[2])}`;
      const keys = part === 'move' ? 'arrow keys move it, Shift and the arrow keys turn it'
          : 'arrow keys turn it';
      button.setAttribute('aria-label', `${part} the ${name}: ${place}; ${keys}`);
    }
  };
}

/** @param {Pose} pose @param {Point} move @param {boolean} turn @param {number} step */
function nudged([x, y, heading], [across, up], turn, step) {
  // 5 deg; left and up are counter-clockwise
  if (turn) return [x, y, tidy(wrap(heading + (up - across) * Math.PI / 36))];
  return [tidy(x + across * step), tidy(y + up * step), heading];
}
