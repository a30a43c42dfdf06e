"""Small things to move, a module a chapter; each is imported when one of them is named.

Each stands at the sentence that it explains, with one or two numbers to drag or to type, and some
ask for a prediction first. They live in a page without a kernel, as the Explorer does.
"""

import lazy_loader

PARTS = {"Ask", "Choice", "Knob", "Live"}
"""What the rest is made of."""

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "parts": sorted(PARTS),
        "first_drive": ["stopping"],
        "earth": ["bearing", "flat_map"],
        "robot": ["one_step"],
        "angles": ["half_turn", "polar_angles"],
        "lyapunov": ["bowl", "two_bars"],
        "design": ["window"],
        "real_robot": ["silence"],
        "routes": ["corners"],
    },
)
