"""The course's settings: run nbgrader's commands in this folder."""

c = get_config()  # noqa: F821  (nbgrader provides it)

c.CourseDirectory.course_id = "wmr"
# Students get this line in place of an answer; a cell that still has it fails.
c.ClearSolutions.code_stub = {"python": 'raise NotImplementedError("write your answer here")'}
# The mark scheme of an explanation stands in the locked cell with its question, which has no
# points of its own. Students get that cell without the scheme; the formgrader shows it whole.
c.ClearMarkScheme.enforce_metadata = False
c.ExecutePreprocessor.timeout = 120  # seconds for a cell; a longer one is interrupted

# The names that Moodle and Canvas give to hand-ins, here of `01_gps_to_metres.ipynb`:
#   Moodle, with and without folders: Ada Lovelace_1234_assignsubmission_file_/NAME
#                                     Ada Lovelace_1234_assignsubmission_file_NAME
#   Canvas, also late:                lovelaceada_4711_98765_NAME
#                                     lovelaceada_LATE_4711_98765_NAME
# A second upload is called NAME-1 or NAME (1).
c.FileNameCollectorPlugin.named_regexp = (
    r".*[/\\](?P<student_id>[^/\\_]+)(?:_LATE)?_\d+_(?:assignsubmission_file_[/\\]?|\d+_)"
    r"(?P<file_id>\d\d_\w+)(?:-\d+| ?\(\d+\))?\.ipynb"
)
