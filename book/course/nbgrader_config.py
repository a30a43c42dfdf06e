"""The course's settings: run nbgrader in this folder."""

import sys
from pathlib import Path

from nbgrader.preprocessors import GetGrades

sys.path.insert(0, str(Path(__file__).resolve().parent))
import feedback
import policy

c = get_config()  # noqa: F821  (nbgrader provides it)

c.CourseDirectory.course_id = "wmr"
# What students get in the place of an answer; an untouched cell fails by it.
c.ClearSolutions.code_stub = {"python": 'raise NotImplementedError("write your answer here")'}
# Due dates, extensions and what it costs to be late: term.toml.
c.AssignLatePenalties.plugin_class = policy.Late
c.Late.folder = str(Path(__file__).resolve().parent)
c.ExecutePreprocessor.timeout = 120  # s for a cell: an endless loop ends

# Its own commands write the pages that grade.py writes: nothing in them acts.
c.GenerateFeedback.exporter_class = feedback.Page
c.GenerateFeedback.preprocessors = [GetGrades]
