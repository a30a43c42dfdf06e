"""The chapters' figures, a module a chapter; each is imported when one of its figures is named."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "style": ["COLOURS", "LINES", "Picture"],
        "paths": ["path"],
        "facing": ["beliefs"],
        "first_drive": ["twist"],
        "earth": [
            "chord",
            "curvature_radii",
            "sphere_error_map",
            "spherical_triangle",
        ],
        "robot": ["coordinate_system", "robot_loops"],
        "angles": ["angles_over_time", "path_choices", "third_angle", "velocity_split"],
        "pose_to_pose": [
            "block_diagram",
            "endpoints",
            "figures_8_to_12",
            "heading_to_go",
            "snapshots",
        ],
        "design": ["root_locus"],
        "sampling": ["inner_loops", "three_steps", "time_steps"],
        "noise": ["memories"],
        "audit": ["verdicts"],
        "routes": ["challenge_paths", "route"],
    },
)
