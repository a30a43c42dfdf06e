"""The checks of the graded exercises: where an answer fails, they give a hint, not the answer.

A check takes what a student wrote (a function, a number, gains, an expression) and tries properties
of it. It returns a sentence if they hold, and raises Hint if not; where a usual mistake explains
what comes out (latitude and longitude swapped, degrees in a sine), the hint says so. The
assignments are in book/course; there is one module here for each kind of task.
"""

from pathlib import Path

import lazy_loader

# An assignment uses one or two of them, and only some need sympy: each is imported when first used.
__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=[path.stem for path in Path(__file__).parent.glob("[a-z]*")],
    submod_attrs={"_hints": ["Hint"]},
)
