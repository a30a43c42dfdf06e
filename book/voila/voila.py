"""Voila's settings: serve a chapter as an app, its code hidden.

`python -m voila --Voila.config_file_paths=book/voila NOTEBOOK`
"""

import os
from pathlib import Path

c = get_config()  # noqa: F821  (Voila provides it)

# The template beside this file, which is Voila's own without what it loads from a CDN.
os.environ["JUPYTER_PATH"] = os.pathsep.join(
    filter(None, [str(Path(__file__).parent), os.environ.get("JUPYTER_PATH")])
)
c.VoilaConfiguration.template = "chapter"
# A link must not choose another template, which would ask the CDN again.
c.VoilaConfiguration.allow_template_override = "NO"
# Only the JupyterLab extensions that draw widgets: others, such as nbgrader's, expect JupyterLab.
c.VoilaConfiguration.extension_allowlist = [
    "@jupyter-widgets/jupyterlab-manager",
    "@voila-dashboards/widgets-manager8",
    "anywidget",
]

# This machine only, and only with the token in the link that Voila prints and opens: whoever
# reaches a kernel can run code.
c.Voila.ip = "127.0.0.1"
c.Voila.auto_token = True
c.Voila.port_retries = 0  # a port in use is an error: the announced address must be the real one


def give_cookie(handler, **_):
    """Set the cookie with which a page, as it closes, may ask for the end of its kernel.

    The login page sets it; whoever comes by the link with the token has not seen that page.
    """
    handler.xsrf_token  # noqa: B018  (to read it is to set it)


c.VoilaConfiguration.prelaunch_hook = give_cookie
# Each visitor has a kernel of their own, which ends with its page, or ten minutes after the
# connection was lost.
c.MappingKernelManager.cull_idle_timeout = 600
c.MappingKernelManager.cull_interval = 60
