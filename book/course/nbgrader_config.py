"""The course's settings: run nbgrader in this folder."""

c = get_config()  # noqa: F821  (nbgrader provides it)

c.CourseDirectory.course_id = "wmr"
# What stands in the place of an answer in what students get: a cell that is left as it is fails by this, and its checks with it.
c.ClearSolutions.code_stub = {"python": 'raise NotImplementedError("write your answer here")'}
c.ExecutePreprocessor.timeout = 120  # s for a cell: an endless loop ends
