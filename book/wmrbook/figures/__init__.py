"""The figures of the chapters, each with its alternative text; a module is imported when one of its figures is first named."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submod_attrs={
        "angles": ["angles_over_time", "polar_angles", "third_angle", "ways"],
        "comparison": [
            "chase",
            "heading_shares",
            "residual_curve",
            "snapshots",
            "together",
            "tradeoff",
        ],
        "design": ["front", "phase_portrait", "root_locus"],
        "diagram": ["block_diagram"],
        "earth": ["local_map", "rounding_errors", "sphere_error_map", "spherical_triangle"],
        "noise": ["arrival_radii", "end_poses", "near_goal", "rise_map", "rising", "scatter"],
        "robot": ["approach", "commutator", "coordinate_system", "steps", "turning_centre"],
        "routes": ["challenge_paths", "route", "route_signals"],
        "sampling": ["driven", "inner_loops", "orders", "responses", "time_steps"],
        "state": ["heading_errors", "level_sets", "lyapunov_runs", "rate_sign"],
        "verdicts": ["verdicts"],
    },
)
