// Cells that run in the page. Python itself, 16 MB beside this file, is loaded when the first one
// is run, into a worker that can be stopped, and z3 for the first one that asks it; the editor,
// when a cell to write in is near. Before a cell the ones above it run, as far as they have not, or
// not since something above them changed.
(function () {
  const FOLDER = new URL('vendor/python/', document.currentScript.src).href;
  const PARTS = ['worker', 'asm', 'wasm', 'stdlib', 'packages'];
  const ZIPPED = new Set(['worker', 'asm', 'wasm']);
  const ASKS_Z3 = /\bimport z3\b|\bwmrbook\.chapters(\.| import .*)strict\b/;
  const cells = [];
  let parts, solver, editor, worker, running;

  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };

  // Python and its worker

  function load(name) {
    return new Promise((resolve, reject) => {
      const onerror = () => reject(Error(`${name}.js is not beside this page`));
      document.head.append(
          make('script', { src: `${FOLDER}${name}.js`, onload: resolve, onerror }));
    });
  }

  async function unpacked(name) {
    const bytes = Uint8Array.from(atob(window.PYTHON_PARTS[name]), (it) => it.charCodeAt(0));
    delete window.PYTHON_PARTS[name];
    if (!ZIPPED.has(name)) return bytes.buffer;
    return new Response(new Blob([bytes]).stream()
        .pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
  }

  async function allParts() {
    await Promise.all(PARTS.map(load));
    const found = await Promise.all(PARTS.map(unpacked));
    return Object.fromEntries(PARTS.map((name, i) => [name, found[i]]));
  }

  // of z3
  function loadedSolver() {
    solver ??= load('z3').then(() => unpacked('z3'));
    solver.catch(() => { solver = undefined; });
    return solver;
  }

  function started() {
    parts ??= allParts();
    parts.catch(() => { parts = undefined; });
    return parts.then(({ worker: script, ...rest }) => new Promise((resolve, reject) => {
      const python =
          new Worker(URL.createObjectURL(new Blob([script], { type: 'text/javascript' })));
      let finish, stopped = false, solves = false;
      python.onmessage = ({ data }) => {
        if (data.failed) reject(Error(data.failed));
        else if (data.ready) resolve({ run, stop });
        else finish(data);
      };
      const run = async (cell) => {
        const { number, before } = cell, text = source(cell);
        const more = !solves && ASKS_Z3.test(`${before}\n${text}`) && await loadedSolver();
        solves ||= Boolean(more);
        return new Promise((done) => {
          finish = done;
          if (stopped) done({ stopped });
          else python.postMessage({ number, before, source: text, more });
        });
      };
      const stop = () => {
        stopped = true;
        python.terminate();
        finish?.({ stopped });
      };
      python.postMessage(rest);
    }));
  }

  // Cells

  const source = (cell) => cell.editor?.value ?? cell.source;
  const say = (cell, text) => { cell.status.textContent = text; };

  async function run(cell) {
    if (running) return running === cell || say(cell, 'Another cell is running.');
    running = cell;
    document.documentElement.classList.add('python-busy');
    cell.stop.hidden = false;
    try {
      say(cell, worker ? 'Running …' : 'Loading Python …');
      const python = await (worker ??= started());
      for (const each of cells.slice(0, cell.number)) {
        if (each !== cell && each.ran === source(each)) continue;
        say(cell, each === cell ? 'Running …' : `Running cell ${each.number} …`);
        const start = performance.now();
        const ran = source(each);
        const { shown, error, died, stopped } = await python.run(each);
        if (stopped) {
          each.output.replaceChildren();  // of an earlier run
          return say(cell, 'Stopped. All variables are gone.');
        }
        if (ran !== each.ran) forget(cells.slice(each.number));
        each.ran = error ? undefined : ran;
        if (died) stop();
        await show(each, shown, error);
        if (error)
          return say(cell, each === cell ? 'An error.' : `An error, in cell ${each.number} above.`);
        say(each, `Done in ${((performance.now() - start) / 1000).toFixed(1)} s.`);
      }
    } catch (error) {
      worker = undefined;
      say(cell, `Python does not start here: ${error.message}`);
    } finally {
      running = undefined;
      document.documentElement.classList.remove('python-busy');
      if (document.activeElement === cell.stop) cell.run.focus();
      cell.stop.hidden = true;
    }
  }

  const forget = (some) => some.forEach((each) => { each.ran = undefined; });

  function stop() {
    worker?.then((python) => python.stop());
    worker = undefined;
    forget(cells);
  }

  async function show(cell, shown, error) {
    // so that what is long scrolls by keyboard
    const lines = (text, kind) =>
        make('div', { className: `output highlight ${kind}` },
        make('pre', { textContent: text, tabIndex: text.length > 2000 ? 0 : -1 }));
    const formula = (text) =>
        make('div',
        { className: 'output text_latex math notranslate nohighlight',
        textContent: `\\[${text}\\]` });
    const parts = shown.map(([kind, text]) =>
        (kind === 'latex' ? formula(text.replace(/^\$+|\$+$/g, '')) : lines(text, 'stream')));
    if (error) parts.push(lines(error, 'python-error'));
    cell.stored.forEach((it) => { it.hidden = true; });
    cell.output.replaceChildren(...parts);
    await MathJax.startup.promise;
    MathJax.typesetClear([cell.output]);
    await MathJax.typesetPromise([cell.output]);
    // a formula that is too wide is reached by the keyboard, see mathjax.js
    window.dispatchEvent(new Event('resize'));
  }

  const near = new IntersectionObserver((seen) => {
    for (const { target } of seen.filter((it) => it.isIntersecting)) {
      near.unobserve(target);
      editor ??= load('../editor');
      editor.then(() => window.wmrEditor.dress(target), () => {});  // else the textarea does
    }
  }, { rootMargin: '100%' });

  function edit(cell) {
    const area = cell.editor = make('textarea',
        { className: 'python-editor', value: cell.source,
        rows: cell.source.split('\n').length + 1, spellcheck: false, autocapitalize: 'off' });
    area.setAttribute('aria-label', `Code of cell ${cell.number}`);
    area.setAttribute('aria-describedby', 'python-keys');
    cell.code.hidden = true;
    cell.written.replaceChildren(area);
    near.observe(area);
    cell.edit.hidden = true;
    cell.reset.hidden = false;
    area.focus();
  }

  function reset(cell) {
    cell.output.replaceChildren();
    cell.stored.forEach((it) => { it.hidden = false; });
    say(cell, '');
    cell.written.replaceChildren();
    cell.editor = undefined;
    cell.code.hidden = false;
    cell.reset.hidden = true;
    cell.edit.hidden = false;
    cell.edit.focus();
  }

  const keys = (cell) => (event) => {
    if (event.key !== 'Enter' || !(event.ctrlKey || event.shiftKey || event.metaKey)) return;
    event.preventDefault();
    event.stopPropagation();  // the editor has another use for them
    run(cell);
  };

  function enliven(script) {
    const cell = JSON.parse(script.textContent);
    cell.element = script.closest('.cell');
    cell.number = cells.length + 1;
    const button = (text, does, hidden) => {
      const made = make('button',
          { type: 'button', textContent: text, hidden, onclick: () => does(cell) });
      made.setAttribute('aria-label', `${text}, cell ${cell.number}`);
      return made;
    };
    cell.run = button('Run', run, false);
    cell.edit = button('Edit', edit, false);
    cell.reset = button('Reset', reset, true);
    cell.stop = button('Stop', stop, true);
    cell.status = make('span', { className: 'python-status' });
    cell.status.setAttribute('role', 'status');
    cell.tools = make('div', { className: 'python-tools' }, cell.run, cell.edit, cell.reset,
        cell.stop, cell.status);
    if (cell.left_out) {
      const lines = cell.left_out === 1 ? 'One line needs' : `${cell.left_out} lines need`;
      const notebook = document.querySelector('.run-it a')?.cloneNode() ?? make('span');
      notebook.textContent = 'the notebook';
      cell.tools.append(
          make('span', { className: 'python-left-out' }, `${lines} numpy: in `, notebook, '.'));
    }
    cell.stored = [...cell.element.querySelectorAll('.cell_output')];
    cell.output = make('div', { className: 'cell_output python-output' });
    const input = cell.element.querySelector('.cell_input');
    cell.code = input.firstElementChild;
    cell.written = make('div');
    cell.written.addEventListener('keydown', keys(cell), true);
    cell.code.after(cell.written);
    const folded = input.closest('details');
    input.after(cell.tools);  // which fold with it
    folded?.querySelector('summary .collapsed')?.append(', runs here');
    (folded && cell.element.contains(folded) ? folded : cell.tools).after(cell.output);
    cells.push(cell);
  }

  document.addEventListener('DOMContentLoaded', () => {
    document.querySelectorAll('script.python-cell').forEach(enliven);
    const about =
        ' Code that “runs here” runs in this page too; the rest needs numpy or compiled code.';
    document.querySelector('.run-it')?.append(about);
    const keys = 'Ctrl+Enter runs it. Tab indents; Esc and then Tab leaves.';
    document.body.append(make('p', { id: 'python-keys', hidden: true, textContent: keys }));
  });
})();
