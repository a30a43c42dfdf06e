// Plays a drive over the picture that shows it: robots and a goal go along their paths, at a button
// or under a slider. `Picture.motion` in wmrbook.figures says where they are.

import { DEGREES } from './style.js';
import { between, within } from './numbers.js';
import { putSlider, stopsOf } from './controls.js';
import { drawPose, drawRobot } from './scene.js';
import { inside, repainted } from './surface.js';
import { made } from './hands.js';

const PARTS = 10000; // of the picture's width and height
const LONGEST = 8000; // ms: a longer drive is played faster
const STOPS = stopsOf(0, 1, 0.002);

/**
 * @param {HTMLElement} box what holds the pictures for light and dark, of which one is seen
 * @param {{ seconds: number, robots: { box: number[], x: number[], y: number[], heading: number[],
 *   role: string }[] }} motion
 */
function player(box, { seconds, robots: told }) {
  const summed = (changes) => { // they are stored as changes, which are shorter
    let sum = 0;
    return changes.map((change) => (sum += change));
  };
  const robots = told.map((it) => ({ ...it, x: summed(it.x), y: summed(it.y),
    heading: summed(it.heading) }));
  const images = [...box.querySelectorAll('img')];
  const canvas = made(box, 'canvas', { className: 'player-robots' }, { 'aria-hidden': 'true' });
  const root = document.createElement('div'), row = made(root, 'div', { className: 'wmr-control' });
  root.className = 'wmr player';
  box.after(root);
  const button = made(row, 'button', { type: 'button', textContent: 'Play' });
  const show = putSlider(row, 'time of the drive', STOPS,
      { get: () => share, set(value) { share = value; begin = 0; draw(); } });
  const clock = made(row, 'output');
  let share = 0, begin = 0, colours, shown = false;
  button.addEventListener('click', () => {
    begin = begin ? 0 : performance.now() - (share < 1 ? share : 0) * lasts;
    if (begin) requestAnimationFrame(step);
    draw();
  });
  const lasts = Math.min(1000 * seconds, LONGEST);

  function step(now) {
    if (!begin) return;
    share = within((now - begin) / lasts, 0, 1);
    if (share === 1) begin = 0; else requestAnimationFrame(step);
    draw();
  }
  function draw() {
    const image = images.find((it) => it.offsetWidth);
    shown ||= share > 0 || begin > 0; // until then the picture speaks for itself
    button.textContent = begin ? 'Pause' : 'Play';
    clock.textContent = `${(share * seconds).toFixed(1)} s`;
    show(share, clock.textContent);
    if (!image) return;
    const { offsetWidth: width, offsetHeight: height } = image, ratio = devicePixelRatio || 1;
    Object.assign(canvas.style, { left: `${image.offsetLeft}px`, top: `${image.offsetTop}px`,
      width: `${width}px`, height: `${height}px` });
    [canvas.width, canvas.height] = [Math.round(ratio * width), Math.round(ratio * height)];
    const ctx = canvas.getContext('2d');
    ctx.scale(ratio, ratio);
    const size = Math.min(Math.max(width / 640, 0.5), 1.2) * (robots.length > 4 ? 0.4 : 1);
    const last = ({ role }) => Number(role === 'goal'); // on the robot that stands on it
    for (const { box: [left, top, right, bottom], x, y, heading, role }
      of shown ? [...robots].sort((a, b) => last(a) - last(b)) : []) {
      const at = (values) => between(values, share * (values.length - 1));
      const frame = { left: left * width / PARTS, top: top * height / PARTS,
        width: (right - left) * width / PARTS, height: (bottom - top) * height / PARTS };
      const place = [at(x) * width / PARTS, at(y) * height / PARTS],
          turned = at(heading) / DEGREES;
      inside(ctx, frame, () => {
        if (role !== 'goal') {
          drawRobot(ctx, place, turned, { ...colours, path: colours[role] || colours.path }, size);
          return;
        }
        ctx.translate(place[0], place[1]);
        ctx.scale(size, size);
        drawPose(ctx, { toScreen: (east, down) => [east, down] }, [0, 0, turned], role, colours);
      });
    }
  }
  repainted(root, images, (read) => { colours = read; draw(); });
}

export function enliven(page) {
  for (const told of page.querySelectorAll('.figure-box > script[type="application/json"]'))
    player(told.parentElement, JSON.parse(told.text));
}
