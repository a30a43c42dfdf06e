"""JupyterLab for a reader; README's first command uses it, and it opens the first chapter."""

import logging
import os
from importlib.util import find_spec
from pathlib import Path

import nbformat
import zmq
from nbformat.sign import NotebookNotary

ROOT = Path(__file__).resolve().parents[2]
c = get_config()  # noqa: F821  (JupyterLab provides it)

# The link that is printed leads to the chapter, and is the last line unless something goes wrong.
c.LabApp.default_url = "/lab/tree/notebooks/00_from_gps_to_a_parked_robot.ipynb"
c.ServerApp.log_level = c.LabApp.log_level = "WARN"
# Kernels warn of plain TCP: encrypt it, which works on Windows too.
c.KernelManager.transport_encryption = "auto" if zmq.has("curve") else "disabled"
# Jupyter gives tornado milliseconds for seconds; on one machine no ping is needed.
c.ServerApp.tornado_settings = {"ws_ping_interval": 0}
# This machine only, and nothing is asked of any other: no news, no updates, no list of extensions.
c.ServerApp.ip = "127.0.0.1"
c.LabApp.news_url = None
c.LabApp.check_for_updates_class = "jupyterlab.NeverCheckForUpdate"
c.LabApp.extension_manager = "readonly"

# A reader grades nothing: what nbgrader and others add to the server stays out.
c.ServerApp.jpserver_extensions = {
    name: False
    for name in (
        "nbgrader.server_extensions.assignment_list",
        "nbgrader.server_extensions.course_list",
        "nbgrader.server_extensions.formgrader",
        "nbgrader.server_extensions.validate_assignment",
        "notebook",
        "notebook_shim",
    )
    if find_spec(name.partition(".")[0])
}
# The panels' program, by an address that labconfig, beside this file, tells the page: a notebook
# that is opened shows its panels before its kernel runs anything.
c.ServerApp.extra_static_paths = [str(ROOT / "book" / "wmrbook" / "panel")]
# Their buttons stay out by labconfig, beside this file.
os.environ["JUPYTER_CONFIG_PATH"] = os.pathsep.join(
    filter(None, [str(Path(__file__).parent), os.environ.get("JUPYTER_CONFIG_PATH")])
)

# As `jupyter trust` does: JupyterLab shows the panels of a trusted notebook before anything is run.
notary = NotebookNotary()
for chapter in (ROOT / "notebooks").glob("*.ipynb"):
    notary.sign(nbformat.read(chapter, as_version=4))

# While a notebook is saved its folder holds a file that a listing may just miss: no news.
logging.getLogger("ServerApp").addFilter(lambda record: "/.~" not in record.getMessage())
