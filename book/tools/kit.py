"""Print the modules of the panels' kit that follow from Python: its model and its contracts.

As a module, make the kit one script for pages from the disk.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from wmrbook import face, live, stages
from wmrbook.panel import Explorer, Front, MyRobot
from wmrbook.panel.kit import KIT, programs
from wmrlib import symbolic
from wmrrobot import printing

MODULES = Path(__file__).parents[1] / "node_modules"
# The kit is a function, which the worker of a map is made of too: a page from the disk may have no
# module as a worker. What it makes is where loader.js looks first.
BEGIN = "(function wmrKit() {"
END = "if (typeof document === 'object') globalThis.wmrPanels = kit.shown(); })();"
ENTRY = """{imports}
import css from './panel.css';
import {{ enliven }} from './player.js';
export function shown() {{
  document.head.append(Object.assign(document.createElement('style'), {{ textContent: css }}));
  enliven(document);
  return {{ {programs} }};
}}"""


def printed() -> dict[str, str]:
    """The texts of the modules that are printed, by name."""
    drawings = [getattr(live, name)() for name in sorted(set(live.__all__) - live.PARTS)]
    lawns = [getattr(stages, name)() for name in sorted(set(stages.__all__) - stages.PARTS)]
    panels = Explorer(), Front(), MyRobot(), *drawings, *lawns
    rows = "".join(f"  '{it.program}': '{it.contract}',\n" for it in panels)
    head = "// Printed by book/tools/kit.py: the contract of what is stored for each program.\n"
    contracts = f"{head}export const CONTRACTS = {{\n{rows}}};\n"
    return {
        "model.js": symbolic.javascript(),
        "drive.js": printing.javascript_drive(),
        "contracts.js": contracts,
        "face.js": face.javascript(),
    }


def bundle(script: Path) -> None:
    """Write the kit as one script."""
    names = {f"program{k}": name for k, name in enumerate(programs())}
    imports = "\n".join(f"import {it} from './{name}.js';" for it, name in names.items())
    table = ", ".join(f"'{name}': {it}" for it, name in names.items())
    entry = ENTRY.format(imports=imports, programs=table)
    options = ["--loader:.css=text", f"--banner:js={BEGIN}", f"--footer:js={END}"]
    bundled(entry, KIT, script, "kit", *options, '--define:import.meta.url=""')


def bundled(entry: str, folder: Path, script: Path, name: str, *options: str) -> None:
    """Write a module of a folder, and all that it imports, as one script that sets `name`."""
    esbuild = shutil.which("esbuild", path=MODULES / ".bin")
    always = ["--bundle", "--minify", "--format=iife", "--log-level=warning"]
    folders = [str(Path(sys.executable).parent), os.environ["PATH"]]  # of a node from PyPI
    subprocess.run(
        [esbuild, *always, *options, f"--global-name={name}", f"--outfile={script}"],
        input=entry.encode(),
        cwd=folder,
        env=os.environ | {"PATH": os.pathsep.join(folders)},
        check=True,
    )


if __name__ == "__main__":
    for name, text in printed().items():
        (KIT / name).write_bytes(text.encode())
