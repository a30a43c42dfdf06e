// The handles that move and turn the start and the goal: buttons over the picture, for mouse, touch
// and keyboard.

import { inDegrees, written } from './style.js';
import { knobOf } from './scene.js';
import { roundStep } from './surface.js';

export const MOVES =
    { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
export const turned = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
// 0.1 mm, 0.006 deg: what a hand can't aim at
const tidy = (value) => Math.round(value * 1e4) / 1e4;

// `host` stands over the canvas; `get(name)` gives a pose, `set(name, pose)` changes it; `view()`
// gives the picture's view; `hold(bool)` is told when a drag begins and ends, for the picture must
// not zoom under the hand.
export function buildHandles(host, { get, set, view, hold }) {
  const handles = [];
  for (const name of ['goal', 'start']) {
    for (const part of ['move', 'turn']) {
      const button = host.appendChild(document.createElement('button'));
      button.type = 'button';
      button.className = 'wmr-handle';
      Object.assign(button.dataset, { pose: name, part });
      handles.push(button);
      let grip = null;
      button.addEventListener('pointerdown', (event) => {
        const box = host.getBoundingClientRect();
        const pose = get(name),
            at = part === 'move' ? view().toScreen(pose[0], pose[1]) : knobOf(view(), pose, name);
        grip = [event.clientX - box.left - view().zoom * at[0],
            event.clientY - box.top - view().zoom * at[1]];
        button.setPointerCapture(event.pointerId);
        hold(true);
      });
      button.addEventListener('pointermove', (event) => {
        if (!grip) return;
        const box = host.getBoundingClientRect();
        const { zoom } = view();
        const [x, y] = view()
            .toWorld((event.clientX - box.left - grip[0]) / zoom,
            (event.clientY - box.top - grip[1]) / zoom);
        const pose = get(name);
        set(name,
            part === 'move' ? [tidy(x), tidy(y), pose[2]]
            : [pose[0], pose[1], tidy(Math.atan2(y - pose[1], x - pose[0]))]);
      });
      const release = () => { if (grip) { grip = null; hold(false); } };
      button.addEventListener('lostpointercapture', release);
      button.addEventListener('pointerup', release);
      button.addEventListener('keydown', (event) => {
        const move = MOVES[event.key];
        if (!move) return;
        event.preventDefault();
        // a notebook would take the arrows to change cells, and slides to turn the page
        event.stopPropagation();
        set(name,
            nudged(get(name), move, part === 'turn' || event.shiftKey,
            roundStep(view().box.width / view().scale, 60)));
      });
    }
  }
  return (poses) => {
    for (const button of handles) {
      const { pose: name, part } = button.dataset, pose = poses[name];
      button.hidden = !pose;
      if (!pose) continue;
      const [x, y] = part === 'move' ? view().toScreen(pose[0], pose[1])
          : knobOf(view(), pose, name);
      const { box, zoom } = view();
      const [left, top] = [Math.min(Math.max(x, box.left), box.left + box.width),
          Math.min(Math.max(y, box.top), box.top + box.height)];
      // out of view, for keys only
      Object.assign(button.style,
          { left: `${zoom * left}px`, top: `${zoom * top}px`,
          pointerEvents: left === x && top === y ? '' : 'none' });
      const place =
          `x ${written(pose[0], 'm')}, y ${written(pose[1], 'm')}, heading ${inDegrees(pose[2])}`;
      const keys = part === 'move' ? 'arrow keys move it, Shift and the arrow keys turn it'
          : 'arrow keys turn it';
      button.setAttribute('aria-label', `${part} the ${name}: ${place}; ${keys}`);
      button.title = `${part === 'move' ? 'drag' : 'turn'} the ${name}`;
    }
  };
}

function nudged([x, y, heading], [across, up], turn, step) {
  // 5 deg; left and up are counter-clockwise
  if (turn) return [x, y, tidy(turned(heading + (up - across) * Math.PI / 36))];
  return [tidy(x + across * step), tidy(y + up * step), heading];
}
