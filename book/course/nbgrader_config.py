"""The course's settings: run nbgrader in this folder."""

import sys
from pathlib import Path

from nbgrader.preprocessors import ClearMarkScheme, GetGrades

sys.path.insert(0, str(Path(__file__).resolve().parent))
import feedback

c = get_config()  # noqa: F821  (nbgrader provides it)

c.CourseDirectory.course_id = "wmr"
# What students get in the place of an answer; an untouched cell fails by it.
c.ClearSolutions.code_stub = {"python": 'raise NotImplementedError("write your answer here")'}
# What an assistant marks by stands in the locked cell before an explanation. Students get that cell
# without it; the formgrader shows it whole, as it restores locked cells.
c.ClearMarkScheme.enforce_metadata = False  # such a cell needs no points of its own
c.ExecutePreprocessor.timeout = 120  # s for a cell: an endless loop ends

# Its own commands write the pages that grade.py writes: nothing in them acts.
c.GenerateFeedback.exporter_class = feedback.Page
c.GenerateFeedback.preprocessors = [ClearMarkScheme, GetGrades]
