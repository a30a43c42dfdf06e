// The rover's body in MuJoCo, as book/robot/rover.py has it, and how a page loads MuJoCo.

import { DEGREES } from './style.js';
import { made } from './hands.js';

let engine;

async function load() {
  const kit = document.querySelector('script[src*="vendor/panels.js"]');
  if (!(kit instanceof HTMLScriptElement))
    throw new Error('the rover drives in the book’s pages alone');
  await new Promise((onload, reject) => {
    const onerror = () => reject(new Error('mujoco.js is not beside this page'));
    made(document.head, 'script', { src: new URL('mujoco.js', kit.src).href, onload, onerror });
  });
  const { start, wasm } = globalThis.wmrMujoco, { buffer } =
      Uint8Array.from(atob(wasm), (it) => it.charCodeAt(0));
  const plain = new Blob([buffer]).stream().pipeThrough(new DecompressionStream('gzip'));
  globalThis.wmrMujoco = undefined; // its text is not needed again
  const wasmBinary = await new Response(plain).arrayBuffer();
  return start({ wasmBinary, locateFile: (name) => name }); // else it asks where this file is
}

/** MuJoCo, once: 3.5 MB beside the page, of which nothing is loaded before it is asked for. */
export function loadedEngine() {
  engine ??= load();
  engine.catch(() => { engine = undefined; });
  return engine;
}

/**
 * A rover at rest at a pose; numbers by name as in wmrbook.rover_model.
 * @param {any} mujoco @param {{ text: string, start: Pose, [name: string]: any }} rules
 * @param {Values} rover
 */
export function bodyAt(mujoco, { text, start, gravity, radius, track, period }, rover) {
  const slope = rover.slope_deg / DEGREES, downhill = rover.downhill_deg / DEGREES,
      flat = Math.sin(slope);
  const down = [flat * Math.cos(downhill), flat * Math.sin(downhill), -Math.cos(slope)]
      .map((share) => gravity * share).join(' ');
  const model = mujoco.MjModel.from_xml_string(
      text.replace(/\{(\w+)\}/g, (_, name) => (name === 'down' ? down : rover[name])));
  const data = new mujoco.MjData(model), half = start[2] / 2;
  const step = () => mujoco.mj_step(model, data), steps = Math.round(period / rover.timestep);
  data.qpos.set([start[0], start[1], radius, Math.cos(half), 0, 0, Math.sin(half)]);
  for (let k = 0; k < steps; k += 1) step(); // it comes to stand on its springs
  return {
    step,
    steps, // a period
    // of the middle of the axle, from above
    pose() {
      const [x, y, , a, b, c, d] = data.qpos;
      return [x, y, Math.atan2(2 * (a * d + b * c), 1 - 2 * (c * c + d * d))];
    },
    // its height, and how far it leans to the right and, nose down, ahead
    lean() {
      const [, , z, a, b, c, d] = data.qpos;
      return [z, Math.asin(2 * (c * d + a * b)), Math.asin(2 * (a * c - b * d))];
    },
    // its speeds ahead and to the left
    speeds() {
      const [east, north] = data.qvel, heading = this.pose()[2];
      const [sine, cosine] = [Math.sin(heading), Math.cos(heading)];
      return [cosine * east + sine * north, cosine * north - sine * east];
    },
    loads: () => Array.from(data.sensordata), // N, left, right, castor
    tell(v, omega) {
      data.ctrl.set([-1, 1].map((side) => (v + side * omega * track / 2) / radius));
    },
    free() { data.delete(); model.delete(); },
  };
}
