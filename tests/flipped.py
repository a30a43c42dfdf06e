"""Flip a sign in a formula behind each concept question, and tell what becomes of its key.

Run without compiling (NUMBA_DISABLE_JIT=1), where a formula is a plain function whose code can be
changed in place, wherever it is used. Prints {question: the text of its right option, with the sign
flipped} as JSON; a question that refuses to be asked has null.
"""

from __future__ import annotations

import gc
import inspect
import json
import re
import textwrap
from types import FunctionType

from wmrbook.chapters import routes
from wmrbook.questions import MAKERS, Refusal
from wmrlib import geodesy, kinematics, laws, motion, tuning
from wmrrobot import kalman

HEADING = (laws.corrected_law, "+ gains.h * theta", "- gains.h * theta")
SPEED = (laws.corrected_law, "gains.v_max * decay", "-gains.v_max * decay")
FLIPS = {  # the question: a formula behind it, what stands there, and what to make of it
    "arrived-parked": HEADING,
    "swapped-points": (geodesy.great_circle_angle, "e = sin", "e = -sin"),
    "bearing-and-heading": (geodesy.destination_point, "np.sin(bearing)", "-np.sin(bearing)"),
    "turning-centre": (kinematics.wheels_to_twist, "right - left", "left - right"),
    "four-moves": (motion.arc_step, "y + chord", "y - chord"),
    "two-angles": (motion.polar_from_pose, "sight - heading", "sight + heading"),
    "beta-or-theta": (motion.polar_from_pose, "sight - goal_heading", "goal_heading - sight"),
    "level-spot": HEADING,
    "millimetre-beside": SPEED,
    "tenth-of-a-second": SPEED,
    "mirror": (laws.corrected_law, "(alpha + ", "(abs(alpha) + "),
    "how-far-behind": SPEED,
    "nearer": SPEED,
    "damping": (tuning.modes, "damping=plain(k_alpha", "damping=plain(-k_alpha"),
    "more-steering": (tuning._settling, "half * half - stiffness", "half * half + stiffness"),
    "twice-as-fast": (tuning.longest_step, "turn = k_alpha + rate", "turn = k_alpha - rate"),
    "one-factor": (laws.fastest_wheel, "abs(v) + ", "abs(v) - "),
    "constant-offset": (motion.arc_step, "x + chord", "x - chord"),
    "crooked-compass": HEADING,
    "as-printed": (motion.polar_closing_rate, "turning - omega", "turning + omega"),
    "is-it-parked": HEADING,
    "swapped-cables": (motion.wheel_speeds, "v - omega", "v + omega"),
    "bearing-for-heading": (motion.polar_from_pose, "sight - heading", "sight + heading"),
    "course-from-fixes": (geodesy.bearing_angle, "direction(cos", "direction(-cos"),
    "at-the-corner": (routes.headings_along, "+ 0.5 * turn", "- 0.5 * turn"),
    "along-a-route": HEADING,
    "in-the-dock": (kalman.see_heading, "heading - state[2]", "state[2] - heading"),
}


def key(name: str) -> str | None:
    """The text of the right option, or None if the question is refused."""
    try:
        made = MAKERS[name]()
    except (Refusal, ValueError, IndexError):  # a library that refuses its own results, too
        return None
    return next(option.text for option in made.options if not option.mistake)


def flipped(function, right: str, wrong: str):
    """The code of the function with one place changed."""
    text = textwrap.dedent(inspect.getsource(function))
    text = re.sub(r"\A(@.*\n)*", "", text)
    assert text.count(right) == 1, (function, right)
    home = dict(function.__globals__)
    exec("from __future__ import annotations\n" + text.replace(right, wrong), home)
    return home[function.__name__].__code__


def main() -> None:
    answers = {}
    for name, (function, right, wrong) in FLIPS.items():
        function = inspect.unwrap(function)
        code = function.__code__
        # what `wmrlib` has rebuilt of it, to be vectorised, too
        every = [
            it for it in gc.get_objects() if isinstance(it, FunctionType) and it.__code__ is code
        ]
        new = flipped(function, right, wrong)
        for copy in every:
            copy.__code__ = new
        answers[name] = key(name)
        for copy in every:
            copy.__code__ = code
    print(json.dumps(answers))


if __name__ == "__main__":
    main()
