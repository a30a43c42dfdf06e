// Runs cells in a thread of its own, which the page can stop. LOCK and loadPyodide stand before it.
const ready = new Promise((resolve, reject) => {
  self.onmessage = ({ data }) => {
    self.onmessage = ({ data }) => ready.then((run) => self.postMessage(run(data)));
    start(data).then(resolve, reject);
  };
});
ready.then(() => self.postMessage({ ready: true }),
    (error) => self.postMessage({ failed: String(error) }));

async function start({ asm, wasm, stdlib, packages }) {
  const url = (part, type) => URL.createObjectURL(new Blob([part], { type }));
  // Pyodide would fetch its own file.
  self.fetch = ((fetch) => (what, ...rest) => (String(what).endsWith('pyodide.asm.wasm')
    ? Promise.resolve(new Response(wasm, { headers: { 'content-type': 'application/wasm' } }))
    : fetch(what, ...rest)))(self.fetch);
  const { default: createPyodideModule } = await import(url(asm, 'text/javascript'));
  const pyodide = await loadPyodide({
    indexURL: 'https://none.invalid/', lockFileContents: LOCK,
        stdLibURL: url(stdlib, 'application/zip'), createPyodideModule,
  });
  pyodide.unpackArchive(packages, 'zip', { extractDir: '/packages' });
  const run = pyodide.runPython(
      'import sys; sys.path.insert(0, "/packages"); from run_cell import run; run');
  return ({ number, before, source, more }) => {
    try {
      if (more) pyodide.unpackArchive(more, 'zip', { extractDir: '/packages' });
      return JSON.parse(run(number, before, source));
    } catch (error) {  // Python itself broke, as by too deep a recursion
      return { shown: [], error: String(error), died: true };
    }
  };
}
