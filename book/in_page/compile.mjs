// Compiles zips of Python files, by the Python that will run them: node compile.mjs PYODIDE IN.zip
// OUT.zip ... Compiling takes the page most of its time. What comes out is not compressed, which
// WebAssembly would take long for.
import { readFileSync, writeFileSync } from 'node:fs';

const [pyodide, ...zips] = process.argv.slice(2);
const { loadPyodide } = await import(pyodide);
const python = await loadPyodide();
const compile = python.runPython(`
import warnings, zipfile
from importlib._bootstrap_external import _code_to_hash_pyc

warnings.simplefilter("ignore")


def compiled(name, source):
    code = compile(source, name, "exec", optimize=2, dont_inherit=True)
    # The pages can't tell whether a source is newer: False says not to look.
    return bytes(_code_to_hash_pyc(code, bytes(8), False))


def rewrite():
    with zipfile.ZipFile("in.zip") as given, zipfile.ZipFile("out.zip", "w") as made:
        for info in given.infolist():
            content = given.read(info)
            if info.filename.endswith(".py"):
                content = compiled(info.filename, content)
                info = zipfile.ZipInfo(info.filename + "c")
            made.writestr(info, content, zipfile.ZIP_STORED)


rewrite`);
while (zips.length) {
  const [given, made] = zips.splice(0, 2);
  python.FS.writeFile('in.zip', new Uint8Array(readFileSync(given)));
  compile();
  writeFileSync(made, python.FS.readFile('out.zip'));
}
process.exit(0);  // Pyodide would keep it waiting
