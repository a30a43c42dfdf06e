"""Voila's settings: `python -m voila --Voila.config_file_paths=book/voila NOTEBOOK` serves a chapter as an app, its code hidden."""

import os
from pathlib import Path

c = get_config()  # noqa: F821  (Voila provides it)

# The template beside this file, which is Voila's own without what it loads from a CDN.
os.environ["JUPYTER_PATH"] = os.pathsep.join(
    filter(None, [str(Path(__file__).parent), os.environ.get("JUPYTER_PATH")])
)
c.VoilaConfiguration.template = "chapter"
c.VoilaConfiguration.allow_template_override = (
    "NO"  # a link must not choose another, which would ask the CDN again
)
# Of the environment's JupyterLab extensions only those that draw widgets: others, such as nbgrader's, look for a JupyterLab around them.
c.VoilaConfiguration.extension_allowlist = [
    "@jupyter-widgets/jupyterlab-manager",
    "@voila-dashboards/widgets-manager8",
    "anywidget",
]

# This machine only, and only for who has the link with its token, which Voila prints and opens: whoever reaches a kernel can run code.
c.Voila.ip = "127.0.0.1"
c.Voila.auto_token = True
c.Voila.port_retries = (
    0  # a port that is taken is an error, not another address than the one announced
)

# Each visitor has a kernel of their own. It ends with its page, and ten minutes after a connection was lost.
c.MappingKernelManager.cull_idle_timeout = 600
c.MappingKernelManager.cull_interval = 60
