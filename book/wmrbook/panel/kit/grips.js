// What is held in a picture.

import { MOVES } from './handles.js';
import { made } from './knobs.js';

// Handles over a pane: buttons, for mouse, touch and the arrow keys.
export function showHandles(host, handles, pane, give) {
  const known =
      new Map([...host.querySelectorAll('.wmr-handle')].map((each) => [each.dataset.handle, each]));
  for (const handle of handles) {
    let button = known.get(handle.id);
    if (!button) {
      button = made(host, 'button', { type: 'button', className: 'wmr-handle' });
      button.dataset.handle = handle.id;
      let grip = null;
      button.addEventListener('pointerdown', (event) => {
        // as it lies now: a longer sentence moves it under the hand
        const box = button.getBoundingClientRect(), whole = host.getBoundingClientRect();
        grip = [event.clientX - box.left - box.width / 2 + whole.left,
            event.clientY - box.top - box.height / 2 + whole.top];
        button.setPointerCapture(event.pointerId);
      });
      button.addEventListener('pointermove', (event) => {
        if (!grip) return;
        const { view } = button.pane;
        give(() =>
            button.handle.move(
            ...view.toWorld((event.clientX - grip[0]) / view.zoom,
            (event.clientY - grip[1]) / view.zoom)));
      });
      for (const end of ['pointerup', 'lostpointercapture'])
        button.addEventListener(end, () => { grip = null; });
      button.addEventListener('keydown', (event) => {
        const move = MOVES[event.key];
        if (!move) return;
        event.preventDefault();
        event.stopPropagation();
        const { range: [x0, x1, y0, y1] } = button.pane, step = event.shiftKey ? 200 : 40;
        const [x, y] = button.handle.at,
            by = [move[0] * (x1 - x0) / step, move[1] * (y1 - y0) / step];
        // as far as it takes, where places are rounded
        for (let far = 1; far <= 64 && String(button.handle.at) === String([x, y]); far *= 2) {
          if (!give(() => button.handle.move(x + far * by[0], y + far * by[1], true), true)) return;
        }
      });
    }
    known.delete(handle.id);
    Object.assign(button, { handle, pane });
    const { box, zoom } = pane.view, [x, y] = pane.at(...handle.at);
    const [left, top] = [Math.min(Math.max(x, box.left), box.left + box.width),
        Math.min(Math.max(y, box.top), box.top + box.height)];
    Object.assign(button.style, { left: `${zoom * left}px`, top: `${zoom * top}px` });
    button.setAttribute('aria-label', `${handle.says}; the arrow keys move it`);
  }
  known.forEach((each) => each.remove());
}
