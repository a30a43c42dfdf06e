"""The stage of each chapter: a lawn on which its question is asked, shown and answered.

A stage opens its chapter. The sections name the scene that they speak of in the metadata of their
heading's cell, `"stage": "near"`; a page shows it beside the text where there is room. A notebook
shows it again where a section needs it: `stages.first_drive("near")`.
"""

import lazy_loader

PARTS = {"Question", "Scene", "Stage"}
"""What the rest is made of."""

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "parts": sorted(PARTS),
        "first_drive": ["first_drive"],
        "gps_points": ["gps_points"],
        "two_wheels": ["two_wheels"],
        "three_numbers": ["three_numbers"],
        "downhill": ["downhill"],
        "two_drives": ["two_drives"],
        "two_numbers": ["two_numbers"],
        "moving_goal": ["moving_goal"],
        "late_looks": ["late_looks"],
        "noisy_fixes": ["noisy_fixes"],
        "as_printed": ["as_printed"],
        "crooked_compass": ["crooked_compass"],
        "standing_still": ["standing_still"],
        "race_of_laws": ["race_of_laws"],
        "course_from_gps": ["course_from_gps"],
        "seam": ["seam"],
    },
)
