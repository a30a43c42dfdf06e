"""The course's settings: run nbgrader in this folder."""

from pathlib import Path

import nbgrader

c = get_config()  # noqa: F821  (nbgrader provides it)

c.CourseDirectory.course_id = "wmr"
# What students get in the place of an answer; an untouched cell fails by it.
c.ClearSolutions.code_stub = {
    "python": 'raise NotImplementedError("write your answer here")'
}
c.ExecutePreprocessor.timeout = 120  # s for a cell: an endless loop ends

# The feedback opens without a network: the template beside this file comes first.
c.HTMLExporter.template_name = "offline"
c.HTMLExporter.extra_template_basedirs = [
    str(Path(__file__).parent / "templates"),
    str(Path(nbgrader.__file__).parent / "server_extensions" / "formgrader" / "templates"),
]
