"""The paper's equations (1) to (17), each against a derivation that does not use it."""

from __future__ import annotations

from functools import cache

import sympy as sp

from wmrbook import equations as symbols
from wmrbook.audit.published import PUBLISHED
from wmrbook.audit.row import Row, Verdict, equivalent, finding, fits, latex, printed
from wmrbook.audit.slips import SAME, equation_row
from wmrlib import paper, symbolic
from wmrlib.geodesy import haversine_distance, local_position
from wmrlib.symbolic import L, alpha, b, h, lat1, lat2, omega, rho, theta, v

_RIGHT_TURN = sp.Matrix([[0, 1], [-1, 0]])
_NOSE = sp.Matrix([sp.cos(theta), sp.sin(theta)])


# The robot, (1) to (6): rigid body and rolling wheels -------------------------------------------


def wheels() -> tuple[sp.Expr, sp.Expr]:
    """(v, omega) from the speeds of two wheels b apart, each as fast as its end of the axle."""
    right, left = (
        (v * _NOSE + side * b / 2 * (_RIGHT_TURN * _NOSE).diff(theta) * omega).dot(_NOSE)
        for side in (1, -1)
    )
    solution = sp.solve(
        [sp.trigsimp(right) - symbols.V_r, sp.trigsimp(left) - symbols.V_l], [v, omega]
    )
    return solution[v], solution[omega]


def rolling(ahead: sp.Expr | int = 0) -> sp.Matrix:
    """(x', y', heading'): no slip sideways, speed v forwards, and a nose that turns by omega.

    (x, y) is in the middle of the axle, or some metres ahead of it.
    """
    x, y = sp.symbols("x y")
    sideways = -_RIGHT_TURN * _NOSE
    velocity = sp.Matrix([x, y])
    solution = sp.solve([velocity.dot(_NOSE) - v, velocity.dot(sideways)], [x, y])
    spin = omega / _NOSE.diff(theta).dot(sideways)  # nose' = spin times its own left
    middle = sp.Matrix([solution[x], solution[y], spin])
    swing = ahead * spin * _NOSE.diff(theta)
    return sp.trigsimp(middle + sp.Matrix([*swing, 0]))


def robot_rows() -> list[Row]:
    """(1) to (6)."""
    speed, turning = wheels()
    spins = {
        symbols.V_r: symbols.right_wheel * symbols.r,
        symbols.V_l: symbols.left_wheel * symbols.r,
    }
    rates = rolling()
    by_5 = {symbols.theta_rate: printed(5)}
    in_6 = [equivalent(printed(6)[i], rates[i]) for i in range(2)]
    by_lines = all(equivalent(printed(3 + i), rates[i]) for i in range(3))
    rigid = "The mean of the two wheels' speeds, from a rigid axle."
    as_1 = "With $V = w\\,r$ for each wheel it agrees with (1)."
    matrix = "(3) to (5) in one matrix, multiplied out here. Its input is $[v, \\dot\\theta]$, "
    matrix += "so its third row says $\\dot\\theta = \\dot\\theta$ until (5) puts $\\omega$ there."
    d = sp.Symbol("d")
    swing = rolling(d) - rates
    middle = "Rolling without side slip, the point $a$ being the middle of the axle. "
    middle += "With a point $d$ ahead of it ${}$ would be added."
    heading = "$\\omega$ is the heading's rate; (2) gives it from the wheels."
    return [
        equation_row(1, speed, {}, rigid),
        equation_row(2, turning.subs(spins), {}, as_1),
        *(
            equation_row(3 + i, rates[i], {"(6)": in_6[i]}, middle.format(latex(swing[i])))
            for i in range(2)
        ),
        equation_row(5, rates[2], {}, heading),
        equation_row(6, rates, {"(3) to (5)": by_lines}, matrix, known=by_5),
    ]


# The polar error, (7) to (10): differentiate distance and line of sight -------------------------


@cache
def polar_rates() -> sp.ImmutableMatrix:
    """(rho', alpha', theta') of a robot at (x, y), for a goal at rest, by the chain rule."""
    x, y, goal_x, goal_y, heading, goal_heading = sp.symbols(
        "x y goal_x goal_y heading goal_heading", real=True
    )
    sight = sp.atan2(goal_y - y, goal_x - x)
    distance = sp.sqrt((goal_x - x) ** 2 + (goal_y - y) ** 2)
    error = sp.Matrix([distance, sight - heading, sight - goal_heading])
    motion = sp.Matrix([v * sp.cos(heading), v * sp.sin(heading), omega])
    rates = error.jacobian([x, y, heading]) * motion
    size = sp.Symbol("size", positive=True)
    there = {x: goal_x - size * sp.cos(alpha + heading), y: goal_y - size * sp.sin(alpha + heading)}
    return sp.ImmutableMatrix(sp.simplify(rates.subs(there)).subs(size, rho))


def polar_rows() -> list[Row]:
    """(7) to (10)."""
    rates = polar_rates()
    in_10 = [equivalent(printed(10)[i], rates[i]) for i in range(3)]
    dots = symbols.rho_rate, symbols.alpha_rate, symbols.theta_rate
    chain = rho * dots[0] / L + alpha * dots[1] + h * theta * dots[2]
    in_20 = equivalent(printed(20), chain.subs(dict(zip(dots, rates, strict=True))))
    lines = (
        (7, 0, "The chain rule on the distance."),
        (8, 2, "The chain rule on the line of sight."),
        (9, 1, "The chain rule on the line of sight less the heading."),
    )
    by_lines = {
        f"({number})": equivalent(printed(number), rates[i])
        for number, i, _ in lines
        if not in_10[i]
    }
    return [
        *(
            equation_row(number, rates[i], {"(10)": in_10[i], "(20)": in_20}, note)
            for number, i, note in lines
        ),
        equation_row(
            10,
            rates,
            by_lines | {"(20)": in_20},
            "The row of $\\dot\\theta$ has the opposite sign of (8).",
        ),
    ]


# The Earth, (11) to (17): unit vectors ----------------------------------------------------------


def earth_rows() -> list[Row]:
    """(11) to (17)."""
    lon1, s = sp.symbols("lon1 s", real=True)
    here, there = (
        sp.Matrix([sp.cos(lat) * sp.cos(lon), sp.cos(lat) * sp.sin(lon), sp.sin(lat)])
        for lat, lon in ((lat1, lon1), (lat2, lon1 + symbolic.dlong))
    )
    to_east, to_north = here.diff(lon1) / sp.cos(lat1), here.diff(lat1)
    arc = sp.Matrix([symbolic.R * sp.cos(s), symbolic.R * sp.sin(s)]).diff(s)
    speed = sp.sqrt(sp.simplify(arc.dot(arc))).subs(sp.Abs(symbolic.R), symbolic.R)
    length = sp.integrate(speed, (s, 0, symbols.c))
    angle = 2 * sp.asin(sp.sqrt(symbols.epsilon))
    quarter_chord = (there - here).dot(there - here) / 4
    half_sine = sp.sin(symbolic.dlong / 2) ** 2
    haversine = sp.sin(symbolic.dlat / 2) ** 2 + sp.cos(lat1) * sp.cos(lat2) * half_sine
    as_13 = equivalent(printed(13).subs(symbolic.dlat, lat2 - lat1), quarter_chord)
    # (14) turns (sin br, cos br), the parts along east and north, into an angle from east
    br = symbols.br
    as_14 = equivalent(sp.cos(printed(14)), sp.sin(br)) and equivalent(
        sp.sin(printed(14)), sp.cos(br)
    )
    east, north = symbols.zeta_x, symbols.zeta_y
    size = sp.sqrt(east**2 + north**2)
    as_15 = equivalent(sp.sin(printed(15)) * size, east) and equivalent(
        sp.cos(printed(15)) * size, north
    )
    pair = paper.GPS_POINT_1, paper.GPS_POINT_2
    distance = {"the distance of 58.07 m": fits(haversine_distance(*pair), PUBLISHED["distance"])}
    start_error = fits(local_position(*pair)[1], PUBLISHED["x_error_at_start"])
    far_north = {"the error of 57 m at the start": start_error}
    half_chord = "Half the chord is $\\sin(c/2) = \\sqrt\\epsilon$."
    chord = "A quarter of the squared chord between two unit vectors."
    compass = "With the 90 in degrees and the rest in radians: "
    compass += "from east, counter-clockwise, against from north, clockwise."
    ratio = "Its sine goes with east and its cosine with north."
    along_east = "The part of the goal's unit vector along east."
    along_north = "The part of the goal's unit vector along north."
    return [
        equation_row(11, length, distance, "The length of an arc of the angle $c$."),
        equation_row(12, angle, distance, half_chord),
        _row(13, as_13, chord, haversine, distance, SAME),
        _row(14, as_14, compass, sp.pi / 2 - br, far_north),
        _row(15, as_15, ratio, sp.atan2(east, north), far_north),
        equation_row(16, sp.simplify(to_east.dot(there)), far_north, along_east),
        equation_row(17, sp.simplify(to_north.dot(there)), far_north, along_north),
    ]


def _row(number, agrees, note, derived, wanted_by, why="Its sine and its cosine are ours.") -> Row:
    """The row of an equation that holds by a property of the derived form."""
    if agrees:
        return finding(number, Verdict.HOLDS, note, why)
    return equation_row(number, derived, wanted_by)


def rows() -> list[Row]:
    """The 17 rows, in order."""
    return [*robot_rows(), *polar_rows(), *earth_rows()]
