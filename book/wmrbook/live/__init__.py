"""Small things to move, a module a chapter; each is imported when one of them is named.

Each stands at the sentence that it explains, with one or two numbers to drag or to type, and some
ask for a prediction first. They live in a page without a kernel, as the Explorer does.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "parts": ["Ask", "Choice", "Knob", "Live"],
        "first_drive": ["last_metres", "stopping"],
        "earth": ["bearing", "flat_map"],
        "robot": ["commutator", "one_step", "turning_centre"],
        "angles": ["half_turn", "polar_angles"],
        "lyapunov": [],
        "pose_to_pose": [],
        "circle": [],
        "design": ["poles"],
        "sampling": [],
        "noise": [],
        "audit": [],
        "real_robot": [],
        "routes": [],
    },
)
