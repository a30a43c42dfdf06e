"""The checks of the exercises at the chapters' ends, of those that a few numbers or lines answer.

They return what the checks of the course raise: a sentence if an answer is right, else a hint. So a
chapter runs while they wait for an answer.
"""

import lazy_loader

_DESIGNS = "aicardi brake braking kanayama longest_step one_centimetre pendulum short_fence"
_PLACES = "back_to_the_pose campus odometry third_formula three_readings walk"
__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "_designs": [*_DESIGNS.split(), "announced_too_low"],
        "_places": _PLACES.split(),
    },
)
