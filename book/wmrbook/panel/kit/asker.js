// A button that asks Python: the page's own, which runs its cells, or else the notebook's kernel.

import { made } from './hands.js';

const SLOW = 4000; // ms within which a kernel that is there answers, as a rule

// `asks` is { button, function, knobs }: a function of wmrbook, and the knobs that it takes by
// name. What it returns becomes the state's `answer`, { of: those knobs' values, is }.
/** @param {HTMLElement} root @param {Values} asks @param {Values} figure */
export function buildAsker(root, asks, { model, get, set }) {
  const bar = made(root, 'div', { className: 'wmr-bar' }),
      button = made(bar, 'button',
      { type: 'button', className: 'live-commit', textContent: asks.button, onclick: press }),
      status = made(bar, 'span', {}, { role: 'status' }),
      clock = made(bar, 'span', {}, { 'aria-hidden': 'true' });
  /** @type {(() => void) | null} */
  let leave = null;
  let shown = '', turn = 0;
  const say = (text) => { status.textContent = text; };

  async function press() {
    if (leave) { leave(); return; }
    const mine = turn += 1, gone = () => mine !== turn || !leave;
    const tell = (text) => { if (!gone()) say(text); }; // who was left says no more
    const of = Object.fromEntries(asks.knobs.map((name) => [name, get()[name]])),
        left = new Promise((done) => { leave = () => done(null); }), begin = performance.now();
    const ticking = setInterval(() => {
      clock.textContent = `${Math.round((performance.now() - begin) / 1000)} s`;
    }, 1000);
    button.textContent = 'Stop';
    try {
      const page = globalThis.wmrPython, asked = (page ? ofPage : ofKernel)(of, tell, gone);
      const found = await Promise.race([left, asked]);
      const moved = asks.knobs.some((name) => get()[name] !== of[name]);
      say(!found ? 'Stopped.' : moved ? 'The question has changed: ask again.' : '');
      shown = '';
      if (found) set({ answer: { of, is: found.is } });
      else if (page) { asked.catch(() => {}); page.stop(); }
    } catch (error) { say(`No answer: ${error.message}`); } finally {
      clearInterval(ticking);
      clock.textContent = '';
      button.textContent = asks.button;
      leave = null;
    }
  }
  async function ofPage(of, tell, gone) {
    const [, module, name] = asks.function.match(/(.*)\.(.*)/), given = JSON.stringify(of);
    const code = `import json\nfrom ${module} import ${name}\n`
        + `print(json.dumps({"is": ${name}(**json.loads('${given}'))}))`;
    return JSON.parse(await globalThis.wmrPython.answer(code, tell, gone));
  }
  function ofKernel(of, tell) {
    tell('Asking the kernel …');
    const waiting =
        setTimeout(() => tell('Asking the kernel … If none is running, run this cell.'), SLOW);
    return new Promise((resolve, reject) => {
      const hear = (content) => {
        if (JSON.stringify(content.of) !== JSON.stringify(of)) return;
        clearTimeout(waiting);
        model.off('msg:custom', hear);
        if (content.error) reject(Error(content.error)); else resolve(content);
      };
      model.on('msg:custom', hear);
      model.send({ of });
    });
  }
  return {
    show(verdict) {
      bar.hidden = typeof wmrKit !== 'undefined' && !globalThis.wmrPython; // in a deck
      if (leave || verdict === shown) return;
      shown = verdict;
      say(verdict);
    },
    stop() { if (leave) leave(); },
  };
}
