// Compiles zips of Python files, by the Python that will run them: node compile.mjs PYODIDE IN.zip
// OUT.zip ... Compiling takes the page most of its time. Modules that are named in OWN stay
// readable beside it, for hints that quote a function.
import { readFileSync, writeFileSync } from 'node:fs';

const [pyodide, ...zips] = process.argv.slice(2);
const { loadPyodide } = await import(pyodide);
const python = await loadPyodide();
const compile = python.runPython(`
import re, warnings, zipfile
from importlib._bootstrap_external import _code_to_hash_pyc

OWN = re.compile(r"(?:(wmrlib|wmrbook)/.*|[^/]*)$")
warnings.simplefilter("ignore")


def compiled(own, name, source):
    # The pages can't tell whether a source is newer: False says not to look.
    code = compile(source, name, "exec", optimize=0 if own else 2, dont_inherit=True)
    return bytes(_code_to_hash_pyc(code, bytes(8), False))


def rewrite():
    with (
        zipfile.ZipFile("in.zip") as given,
        zipfile.ZipFile("out.zip", "w", zipfile.ZIP_DEFLATED, compresslevel=9) as made,
    ):
        for info in given.infolist():
            name, content = info.filename, given.read(info)
            folder, _, file = name.rpartition("/")
            own = given.comment == b"packages" and OWN.match(name)
            if own or not name.endswith(".py"):
                made.writestr(info, content)
            if own and name.endswith(".py"):
                name = f"{folder}/__pycache__/{file[:-3]}.cpython-314.py".lstrip("/")
            if name.endswith(".py"):
                place = zipfile.ZipInfo(name + "c", info.date_time)
                made.writestr(place, compiled(own, info.filename, content), zipfile.ZIP_DEFLATED)


rewrite`);
while (zips.length) {
  const [given, made] = zips.splice(0, 2);
  python.FS.writeFile('in.zip', new Uint8Array(readFileSync(given)));
  compile();
  writeFileSync(made, python.FS.readFile('out.zip'));
}
process.exit(0);  // Pyodide would keep it waiting
