"""The checks of the graded exercises: each tries a property of an answer, and where it fails gives a hint and not the answer.

A check takes what a student wrote (a function, a number, gains, an expression), returns a sentence to show if it is right, and raises
Hint if it is not. Where a usual mistake explains what is seen (latitude and longitude swapped, degrees in a sine), the hint says so. The
assignments are in book/course; one module here for each kind of thing that is asked for.
"""

from wmrlib.grading import circles, design, earth, noise, robots, routes, sampling, verdicts
from wmrlib.grading._hints import Hint, Passed

__all__ = ["Hint", "Passed", "circles", "design", "earth", "noise", "robots", "routes", "sampling", "verdicts"]
