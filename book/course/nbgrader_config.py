"""The course's settings: run nbgrader in this folder."""

import sys
from pathlib import Path

import nbgrader

import wmrbook

c = get_config()  # noqa: F821  (nbgrader provides it)

c.CourseDirectory.course_id = "wmr"
# What students get in the place of an answer; an untouched cell fails by it.
c.ClearSolutions.code_stub = {"python": 'raise NotImplementedError("write your answer here")'}
sys.path.append(str(Path(__file__).parent))
from policy import Late  # noqa: E402  (it reads term.toml)

c.AssignLatePenalties.plugin_class, c.Late.folder = Late, str(Path(__file__).parent)
c.ExecutePreprocessor.timeout = 120  # s for a cell: an endless loop ends


def javascript(name):
    """Return a file of the book's JavaScript as it stands in a page, or nothing without npm's."""
    path = Path(wmrbook.__file__).parents[1] / name
    return path.read_text(encoding="utf-8") if path.exists() else ""


# The feedback opens without a network: the template beside this file comes first.
c.HTMLExporter.filters = {"javascript": javascript}
c.HTMLExporter.template_name = "offline"
c.HTMLExporter.extra_template_basedirs = [
    str(Path(__file__).parent / "templates"),
    str(Path(nbgrader.__file__).parent / "server_extensions" / "formgrader" / "templates"),
]
