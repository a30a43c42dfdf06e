"""The course's settings: run nbgrader in this folder."""

from pathlib import Path

import nbgrader

c = get_config()  # noqa: F821  (nbgrader provides it)

c.CourseDirectory.course_id = "wmr"
# What stands in the place of an answer in what students get: a cell that is left as it is fails by this, and its checks with it.
c.ClearSolutions.code_stub = {
    "python": 'raise NotImplementedError("write your answer here")'
}
c.ExecutePreprocessor.timeout = 120  # s for a cell: an endless loop ends

# The feedback is a page that opens without a network: nbgrader's, but with the template beside this file in front of it.
c.HTMLExporter.template_name = "offline"
c.HTMLExporter.extra_template_basedirs = [
    str(Path(__file__).parent / "templates"),
    str(Path(nbgrader.__file__).parent / "server_extensions" / "formgrader" / "templates"),
]
