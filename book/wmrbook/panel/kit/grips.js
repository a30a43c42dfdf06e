// What is held in a picture: handles over a pane, for mouse, touch and the arrow keys.

import { putHandle } from './hands.js';

export function showHandles(host, handles, pane, give) {
  const known = host.grips ||= new Map(), wanted = new Set(handles.map(({ id }) => id));
  for (const [id, { button }] of known) {
    if (wanted.has(id)) continue;
    button.remove();
    known.delete(id);
  }
  for (const handle of handles) {
    if (!known.has(handle.id)) known.set(handle.id, putGrip(host, handle.id, give));
    const grip = Object.assign(known.get(handle.id), { handle, pane });
    grip.show(pane.at(...handle.at));
    grip.button.setAttribute('aria-label', `${handle.says}; the arrow keys move it`);
  }
}

function putGrip(host, id, give) {
  const grip = putHandle(host, {
    view: () => grip.pane.view,
    move: (x, y) => give(() => grip.handle.move(x, y)),
    nudge([across, up], { shiftKey }) {
      const { range: [x0, x1, y0, y1] } = grip.pane, step = shiftKey ? 200 : 40;
      const [x, y] = grip.handle.at, by = [across * (x1 - x0) / step, up * (y1 - y0) / step];
      // as far as it takes, where places are rounded
      for (let far = 1; far <= 64 && String(grip.handle.at) === String([x, y]); far *= 2) {
        if (!give(() => grip.handle.move(x + far * by[0], y + far * by[1], true), true)) return;
      }
    },
  });
  grip.button.dataset.handle = id;
  return grip;
}
