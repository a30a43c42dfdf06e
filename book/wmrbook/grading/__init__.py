"""The checks of the graded exercises: each tries a property of an answer, and where it fails gives a hint and not the answer.

A check takes what a student wrote (a function, a number, gains, an expression), returns a sentence to show if it is right, and raises
Hint if it is not. Where a usual mistake explains what is seen (latitude and longitude swapped, degrees in a sine), the hint says so. The
assignments are in book/course; one module here for each kind of thing that is asked for.
"""

import lazy_loader

# An assignment uses one or two of them, and only some need sympy: each is imported when it is first named.
__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=[
        "angles",
        "circles",
        "design",
        "drives",
        "earth",
        "laws",
        "lyapunov",
        "motion",
        "noise",
        "robots",
        "routes",
        "sampling",
        "trips",
        "verdicts",
    ],
    submod_attrs={"_hints": ["Hint", "Passed"]},
)
