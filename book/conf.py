"""Sphinx's configuration of the book, which `python book/tools/build.py` uses."""

from pathlib import Path

import kernels
from docutils import nodes
from sphinx.util import logging

import wmrlib

project = "From two GPS points to a parked robot"
author = "the wmrlib authors"
copyright = "the wmrlib authors. Prose: CC BY 4.0; code: BSD-3-Clause"
version = release = wmrlib.__version__
language = "en"

exclude_patterns = ["course"]  # the graded exercises: only a table of them is shown
extensions = ["crossref", "myst_nb", "sphinx_copybutton", "sphinx_design", "sphinxcontrib.bibtex"]
extensions += ["pages", "python_cells", "reference"]
myst_enable_extensions = ["amsmath", "attrs_block", "attrs_inline", "colon_fence", "deflist"]
myst_enable_extensions += ["dollarmath", "substitution"]
edition = f"Version {version}, November 2026"
myst_substitutions = {"author": author, "edition": edition}
myst_heading_anchors = 3
bibtex_bibfiles = [str(Path(__file__).parent / "references.bib")]
bibtex_cite_id = "cite-{key}"

# The chapters show what they store, which the tests compare; the book's own pages are executed.
kernels.use_files()
kernels.share()
nb_execution_mode = "force"
nb_execution_excludepatterns = ["notebooks/*.ipynb"]
nb_execution_timeout = 120
nb_execution_raise_on_error = True
nb_kernel_rgx_aliases = {".*": "python3"}
nb_merge_streams = True
nb_code_prompt_show, nb_code_prompt_hide = "Code", "Hide the code"
# A table that a cell prints may have formulas and links to chapters.
nb_render_markdown_format = "myst"
nb_output_stderr = "remove-warn"  # and a warning fails the build

html_theme = "sphinx_book_theme"
html_title = project
html_static_path = ["_static"]
html_favicon = "icon.svg"  # else a browser asks a server for one that is not there
html_css_files = ["vendor/face.css", "book.css", ("print.css", {"media": "print"})]
html_show_sphinx = False
html_domain_indices = False
# Light or dark as the reader's system is; the button overrides it.
html_context = {"default_mode": "auto"}
html_sidebars = {  # the front page is a picture and three doors
    "index": [],
    "**": ["navbar-logo.html", "search-button-field.html", "sbt-sidebar-nav.html"],
}
html_theme_options = {
    "navbar_persistent": [],  # the search field is in the side bar already
    "show_toc_level": 2,
    "use_download_button": True,
    "use_fullscreen_button": True,
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
copybutton_exclude = ".linenos, .gp"

# The API reference. A parameter's type is text, such as "float or array, m".
autodoc_typehints = "none"
napoleon_google_docstring = False
napoleon_use_param = napoleon_use_rtype = napoleon_attr_annotations = False
napoleon_custom_sections = [("Attributes", "params_style")]
add_module_names = toc_object_entries = False

# MathJax 3 as one file; mathjax.js holds its settings, so MyST must not write any.
mathjax_path = "vendor/mathjax/tex-svg.js"
mathjax_config_path = "mathjax.js"
myst_update_mathjax = False

# The live widgets: anywidgets all of them, which a page needs no widget manager of 4 MB for.
html_js_files = [("widgets.js", {"data-start": "whole page"}), "figures.js", "reading.js"]
html_js_files += ["docking.js", ("vendor/panels.js", {"defer": ""})]
nb_ipywidgets_js = {}


def look_for_words(app, doctree):
    """An image without alternative text is an error."""
    for image in doctree.findall(nodes.image):
        if not image.get("alt"):
            logging.getLogger(__name__).warning(
                "no alternative text for %s", image["uri"], location=image
            )


def setup(app):
    app.connect("doctree-read", look_for_words)
