// Elements, and the hands that move them: all that is dragged or stepped by arrow keys is so here.

import { sizeOf } from './surface.js';

export const MOVES =
    { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/**
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Element} parent @param {Tag} tag @param {Record<string, any>} properties
 * @param {Record<string, any>} attributes
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function made(parent, tag, properties = {}, attributes = {}) {
  const it = Object.assign(parent.appendChild(document.createElement(tag)), properties);
  for (const [name, value] of Object.entries(attributes)) it.setAttribute(name, value);
  return it;
}

/**
 * `drag(event, first)` is told while an element is held by a hand that it may `take`, from `slack`
 * pixels to the side on; `drop` when it is let go.
 * @param {HTMLElement} element
 * @param {{ take?(event: PointerEvent): unknown, drag(event: PointerEvent, first: boolean): void,
 *   drop?(): void, slack?: number }} hand
 */
export function held(element, { take = () => true, drag, drop = () => {}, slack = 0 }) {
  let from = null, dragged = false;
  const move = (event) => {
    if (from === null || !event.isPrimary) return;
    if (!dragged && Math.abs(event.clientX - from) < slack) return;
    if (!dragged) element.setPointerCapture(event.pointerId);
    drag(event, !dragged);
    dragged = true;
  };
  element.addEventListener('pointerdown', (event) => {
    if (event.button || !event.isPrimary || !take(event)) return;
    [from, dragged] = [event.clientX, false];
    move(event);
  });
  element.addEventListener('pointermove', move);
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'])
    element.addEventListener(end, () => {
      if (from !== null) drop();
      from = null;
    });
}

/**
 * Where a pointer is on a canvas, in the canvas's own units.
 * @param {HTMLCanvasElement} canvas @param {MouseEvent} event @returns {[number, number]}
 */
export function placeOn(canvas, { clientX, clientY }) {
  const { left, top } = canvas.getBoundingClientRect(), { zoom } = sizeOf(canvas);
  return [(clientX - left) / zoom, (clientY - top) / zoom];
}

/**
 * `act` is told which way an arrow key points. A notebook does not change cells by it then, nor do
 * slides turn the page, unless it returns false.
 * @param {HTMLElement} element @param {(move: Point, event: KeyboardEvent) => unknown} act
 */
export function onArrows(element, act) {
  element.addEventListener('keydown', (event) => {
    const move = MOVES[event.key];
    if (!move || act(move, event) === false) return;
    event.preventDefault();
    event.stopPropagation();
  });
}

/**
 * A button over a canvas that is held where it was taken: `view` is the picture's, `move` is told
 * places in its plane, `nudge` the arrow keys. Returns the button and what puts it to a place on
 * the screen, or to the rim if that is out of the picture.
 * @param {HTMLElement} host
 * @param {{ view(): View, move(...place: number[]): void, hold?(holds: boolean): void,
 *   nudge(move: Point, event: KeyboardEvent): unknown }} hand
 */
export function putHandle(host, { view, move, nudge, hold = () => {} }) {
  const button = made(host, 'button', { type: 'button', className: 'wmr-handle' });
  let grip = null;
  held(button, {
    drag(event, first) {
      if (first) {
        // as it lies now: a longer sentence moves it under the hand
        const box = button.getBoundingClientRect(), whole = host.getBoundingClientRect();
        grip = [event.clientX - box.left - box.width / 2 + whole.left,
            event.clientY - box.top - box.height / 2 + whole.top];
        hold(true);
        return;
      }
      const { zoom, toWorld } = view();
      move(...toWorld((event.clientX - grip[0]) / zoom, (event.clientY - grip[1]) / zoom));
    },
    drop: () => hold(false),
  });
  onArrows(button, nudge);
  const show = ([x, y]) => {
    const { box, zoom } = view();
    const left = Math.min(Math.max(x, box.left), box.left + box.width),
        top = Math.min(Math.max(y, box.top), box.top + box.height);
    Object.assign(button.style, { left: `${zoom * left}px`, top: `${zoom * top}px` });
    return left === x && top === y;
  };
  return { button, show };
}
