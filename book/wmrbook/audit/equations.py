"""The paper's equations (1) to (17), each against a derivation that does not use it."""

from __future__ import annotations

from functools import cache

import sympy as sp

from wmrbook import equations
from wmrbook.audit.rows import Row, Verdict, equation_row, finding, fits, printed, same
from wmrbook.equations import V_l, V_r
from wmrlib import paper, symbolic
from wmrlib.geodesy import haversine_distance, local_position
from wmrlib.symbolic import L, alpha, b, h, lat1, lat2, omega, rho, theta, v

_RIGHT_TURN = sp.Matrix([[0, 1], [-1, 0]])


# The robot, (1) to (6): rigid body and rolling wheels -----------------------------------------------------------------


def wheels() -> tuple[sp.Expr, sp.Expr]:
    """(v, omega) from the speeds of two wheels b apart: each rolls along the heading at the speed of the axle's end that carries it."""
    nose = sp.Matrix([sp.cos(theta), sp.sin(theta)])
    ends = [
        side * b / 2 * _RIGHT_TURN * nose for side in (1, -1)
    ]  # right, left, from the middle of the axle
    speeds = [sp.trigsimp((v * nose + end.diff(theta) * omega).dot(nose)) for end in ends]
    found = sp.solve([speeds[0] - V_r, speeds[1] - V_l], [v, omega])
    return found[v], found[omega]


def rolling() -> sp.Matrix:
    """(x', y', heading'): no slip sideways, the speed v forwards, and a nose that turns by omega."""
    x, y = sp.symbols("x y")
    nose = sp.Matrix([sp.cos(theta), sp.sin(theta)])
    sideways = -_RIGHT_TURN * nose
    velocity = sp.Matrix([x, y])
    found = sp.solve([velocity.dot(nose) - v, velocity.dot(sideways)], [x, y])
    spin = omega / nose.diff(theta).dot(sideways)  # nose' = spin times its own left
    return sp.trigsimp(sp.Matrix([found[x], found[y], spin]))


def _robot_rows() -> list[Row]:
    speed, turning = wheels()
    by_spin = turning.subs(
        {V_r: equations.right_wheel * equations.r, V_l: equations.left_wheel * equations.r}
    )
    rates = rolling()
    fits_6 = [same(printed(6)[i], rates[i]) for i in range(3)]
    rows = [
        equation_row(1, speed, {}, "The mean of the two wheels' speeds, from a rigid axle."),
        equation_row(2, by_spin, {}, "With $V = w\\,r$ for each wheel it agrees with (1)."),
    ]
    rows += [
        equation_row(3 + i, rates[i], {"(6)": fits_6[i]}, "Rolling without side slip.")
        for i in range(3)
    ]
    by_lines = all(same(printed(3 + i), rates[i]) for i in range(3))
    return [
        *rows,
        equation_row(
            6, rates, {"(3) to (5)": by_lines}, "(3) to (5) in one matrix, multiplied out here."
        ),
    ]


# The polar error, (7) to (10): differentiate distance and line of sight -----------------------------------------------


@cache
def polar_rates() -> sp.ImmutableMatrix:
    """(rho', alpha', theta') of a robot at (x, y) that looks along `heading`, for a goal at rest, by the chain rule."""
    x, y, goal_x, goal_y, heading, goal_heading = sp.symbols(
        "x y goal_x goal_y heading goal_heading", real=True
    )
    sight = sp.atan2(goal_y - y, goal_x - x)
    error = sp.Matrix(
        [sp.sqrt((goal_x - x) ** 2 + (goal_y - y) ** 2), sight - heading, sight - goal_heading]
    )
    rates = error.jacobian([x, y, heading]) * sp.Matrix(
        [v * sp.cos(heading), v * sp.sin(heading), omega]
    )
    size = sp.Symbol("size", positive=True)
    there = {x: goal_x - size * sp.cos(alpha + heading), y: goal_y - size * sp.sin(alpha + heading)}
    return sp.ImmutableMatrix(sp.simplify(rates.subs(there)).subs(size, rho))


def _polar_rows() -> list[Row]:
    radial, turning, sweeping = rates = polar_rates()
    in_10 = [same(printed(10)[i], rates[i]) for i in range(3)]
    slopes = dict(
        zip((equations.rho_rate, equations.alpha_rate, equations.theta_rate), rates, strict=True)
    )
    in_20 = same(
        printed(20),
        (
            rho * equations.rho_rate / L
            + alpha * equations.alpha_rate
            + h * theta * equations.theta_rate
        ).subs(slopes),
    )
    by_lines = {
        f"({7 + i})": same(printed(number), rates[row])
        for i, (number, row) in enumerate(((7, 0), (8, 2), (9, 1)))
        if not in_10[row]
    }
    return [
        equation_row(
            7, radial, {"(10)": in_10[0], "(20)": in_20}, "The chain rule on the distance."
        ),
        equation_row(
            8, sweeping, {"(10)": in_10[2], "(20)": in_20}, "The chain rule on the line of sight."
        ),
        equation_row(
            9,
            turning,
            {"(10)": in_10[1], "(20)": in_20},
            "The chain rule on the line of sight less the heading.",
        ),
        equation_row(
            10,
            rates,
            by_lines | {"(20)": in_20},
            "The row of $\\dot\\theta$ has the opposite sign of (8).",
        ),
    ]


# The Earth, (11) to (17): unit vectors --------------------------------------------------------------------------------


def _earth_rows() -> list[Row]:
    lon1, s = sp.symbols("lon1 s", real=True)
    lon2 = lon1 + symbolic.dlong
    here, there = (
        sp.Matrix([sp.cos(a) * sp.cos(o), sp.cos(a) * sp.sin(o), sp.sin(a)])
        for a, o in ((lat1, lon1), (lat2, lon2))
    )
    to_east, to_north = here.diff(lon1) / sp.cos(lat1), here.diff(lat1)
    arc = sp.Matrix([symbolic.R * sp.cos(s), symbolic.R * sp.sin(s)]).diff(s)
    length = sp.integrate(
        sp.sqrt(sp.simplify(arc.dot(arc))).subs(sp.Abs(symbolic.R), symbolic.R), (s, 0, equations.c)
    )
    quarter_chord = (there - here).dot(there - here) / 4
    haversine = printed(13).subs(symbolic.dlat, lat2 - lat1)
    pair = paper.GPS_POINT_1, paper.GPS_POINT_2
    distance = {
        "the distance of 58.07 m": fits(haversine_distance(*pair), paper.PUBLISHED["distance"])
    }
    far_north = {
        "the error of 57 m at the start": fits(
            local_position(*pair)[1], paper.PUBLISHED["x_error_at_start"]
        )
    }
    rows = [
        equation_row(11, length, distance, "The length of an arc of the angle $c$."),
        equation_row(
            12,
            2 * sp.asin(sp.sqrt(equations.epsilon)),
            distance,
            "Half the chord is $\\sin(c/2) = \\sqrt\\epsilon$.",
        ),
    ]
    if same(haversine, quarter_chord):
        rows.append(
            finding(
                13,
                Verdict.HOLDS,
                "A quarter of the squared chord between two unit vectors.",
                "the difference is 0",
            )
        )
    else:
        ours = (
            sp.sin(symbolic.dlat / 2) ** 2
            + sp.cos(lat1) * sp.cos(lat2) * sp.sin(symbolic.dlong / 2) ** 2
        )
        rows.append(equation_row(13, ours, distance))
    north = sp.simplify(to_north.dot(there))
    return [
        *rows,
        _compass_row(far_north),
        _bearing_row(equations.zeta_x, equations.zeta_y, far_north),
        equation_row(
            16,
            sp.simplify(to_east.dot(there)),
            far_north,
            "The part of the goal's unit vector along east.",
        ),
        equation_row(17, north, far_north, "The part of the goal's unit vector along north."),
    ]


def _compass_row(wanted_by) -> Row:
    """(14): the angle from east of the direction with the parts (sin br, cos br) along east and north."""
    if same(sp.cos(printed(14)), sp.sin(equations.br)) and same(
        sp.sin(printed(14)), sp.cos(equations.br)
    ):
        return finding(
            14,
            Verdict.HOLDS,
            "From east, counter-clockwise, against from north, clockwise.",
            "both differences are 0",
        )
    return equation_row(14, sp.pi / 2 - equations.br, wanted_by)


def _bearing_row(east, north, wanted_by) -> Row:
    """(15): the angle whose sine and cosine are in the ratio of the parts along east and north."""
    size = sp.sqrt(east**2 + north**2)
    if same(sp.sin(printed(15)) * size, east) and same(sp.cos(printed(15)) * size, north):
        return finding(
            15,
            Verdict.HOLDS,
            "Its sine goes with east and its cosine with north.",
            "both differences are 0",
        )
    return equation_row(15, sp.atan2(east, north), wanted_by)


def rows() -> list[Row]:
    """The 17 rows, in order."""
    return [*_robot_rows(), *_polar_rows(), *_earth_rows()]
