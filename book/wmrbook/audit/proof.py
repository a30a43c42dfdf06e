"""The paper's proof, equations (18) to (26): each against V differentiated along the robot's motion."""

from __future__ import annotations

import math

import numpy as np
import sympy as sp

from wmrbook import equations
from wmrbook.audit.equations import polar_rates
from wmrbook.audit.rows import Row, Verdict, equation_row, finding, fits, latex, printed, same
from wmrlib import paper
from wmrlib.symbolic import L, alpha, h, k_alpha, k_rho, omega, rho, theta, v, v_max

_COSINE, _SINE, _STATE = sp.cos(alpha), sp.sin(alpha), (rho, alpha, theta)


def steering() -> sp.Expr:
    """The omega that turns the second bracket of (21) into -k_alpha alpha^2, with the speed of (22): solved for, not taken from (24)."""
    _, turning, sweeping = polar_rates()
    others = sp.factor(
        (alpha * turning + h * theta * sweeping).subs(omega, 0)
    )  # the bracket is this - alpha omega
    return k_alpha * alpha + (others / alpha).subs(v, printed(22))


def slope(turning: sp.Expr) -> sp.Expr:
    """V' = (18) differentiated along (7) to (9), with the speed of (22) and this omega."""
    V = rho**2 / (2 * L) + (alpha**2 + h * theta**2) / 2
    along = sum(V.diff(each) * rate for each, rate in zip(_STATE, polar_rates(), strict=True))
    return along.subs({omega: turning, v: printed(22)}, simultaneous=True)


def rising(expression: sp.Expr) -> tuple[float, float, float, float] | None:
    """A state (rho, alpha, theta), and V' there, at which V' is the most positive among 20 000 random ones; None if there is none."""
    states = (
        np.random.default_rng(10).uniform((0.05, -3.1, -3.1), (1.0, 3.1, 3.1), (20_000, 3)).round(2)
    )
    states = states[states[:, 1] != 0.0]
    gains = paper.OUTDOOR_GAINS
    values = {k_rho: gains.k_rho, k_alpha: gains.k_alpha, h: gains.h, v_max: gains.v_max, L: 1}
    slopes = sp.lambdify(_STATE, expression.subs(values), "numpy")(*states.T)
    worst = int(np.argmax(slopes))
    return (*states[worst].tolist(), float(slopes[worst])) if slopes[worst] > 1e-9 else None


def _at(state) -> str:
    return "$\\rho = {:.2f}$ m, $\\alpha = {:.2f}$, $\\theta = {:.2f}$ rad".format(*state[:3])


def circle_residual(turning: sp.Expr) -> float:
    """How far behind the paper's circle the robot of (22) and this omega stays, m (inf if it runs away): Euler, 0.1 s, last 10 s."""
    gains, dt, steps = paper.CIRCLE_GAINS, paper.TIME_STEP, 400
    values = {k_rho: gains.k_rho, k_alpha: gains.k_alpha, h: gains.h, v_max: gains.v_max}
    twist = sp.lambdify(_STATE, [each.subs(values) for each in (printed(22), turning)], "math")
    goal = paper.circle(dt * np.arange(steps + 1))
    (x, y, heading), behind = paper.CIRCLE_START, []
    for goal_x, goal_y, goal_heading in zip(*(part.tolist() for part in goal[:3]), strict=True):
        east, north = goal_x - x, goal_y - y
        sight, distance = math.atan2(north, east), math.hypot(east, north)
        try:
            forward, turn = twist(
                distance,
                math.remainder(sight - heading, math.tau),
                math.remainder(sight - goal_heading, math.tau),
            )
        except (OverflowError, ValueError):
            return math.inf
        x, y, heading = (
            x + dt * forward * math.cos(heading),
            y + dt * forward * math.sin(heading),
            heading + dt * turn,
        )
        behind.append(distance)
    return float(np.mean(behind[-100:]))


def _energy_rows() -> list[Row]:
    energy, rates, zero = printed(18), polar_rates(), dict.fromkeys(_STATE, 0)
    hessian = sp.hessian(energy, _STATE)
    is_bowl = energy.subs(zero) == 0 and same(
        energy, (sp.Matrix([_STATE]) * hessian * sp.Matrix(_STATE))[0] / 2
    )
    is_bowl = is_bowl and all(value.is_positive for value in hessian.eigenvals())
    bowl = "Zero at the goal, positive elsewhere: a sum of squares with positive weights."
    dots = equations.rho_rate, equations.alpha_rate, equations.theta_rate
    chain = sum(energy.diff(each) * dot for each, dot in zip(_STATE, dots, strict=True))
    along = chain.subs(dict(zip(dots, rates, strict=True)))
    in_20, in_21 = same(printed(20), along), same(printed(21), along)
    stuck = slope(steering()).subs(alpha, sp.Symbol("a")).subs({rho: sp.Symbol("d")})
    flat = sp.limit(sp.limit(stuck, sp.Symbol("a"), 0), sp.Symbol("d"), 0)
    strict = f"The strict sign can't be met: at $\\rho = \\alpha = 0$ it has $\\dot V = {sp.latex(flat)}$ for every $\\theta$."
    return [
        finding(18, Verdict.HOLDS, bowl, "all second derivatives' eigenvalues are positive")
        if is_bowl
        else finding(
            18,
            Verdict.WRONG,
            "Not positive definite.",
            "an eigenvalue of the second derivatives is not positive",
        ),
        equation_row(19, chain, {"(20)": in_20}, strict),
        equation_row(
            20,
            along,
            {"(21)": in_21},
            "(7) to (9) put into (19). It has the sign of (8), not that of (10).",
        ),
        equation_row(21, along, {"(20)": in_20}, "(20) with its terms collected."),
        _speed_row(),
        _inequality_row(),
    ]


def _speed_row() -> Row:
    first = sp.simplify(-rho / L * printed(22) * _COSINE)
    push = sp.simplify(-first * L / (rho * _COSINE**2))
    falls = push.subs(rho, 0) == 0 and bool(push.diff(rho).is_positive)
    bounded = (
        sp.limit(
            push.subs(rho, sp.Symbol("d", positive=True)), sp.Symbol("d", positive=True), sp.oo
        )
        == v_max
    )
    if falls and bounded:
        text = "The first bracket of (21) is then never positive, and the speed never above $v_{\\max}$."
        return finding(
            22, Verdict.HOLDS, text, f"${latex(push)}$ is 0 at 0 and grows to $v_{{\\max}}$"
        )
    return finding(
        22,
        Verdict.WRONG,
        "The first bracket of (21) can be positive.",
        "the factor of $-\\rho\\cos^2\\alpha/L$ is not positive",
    )


def _inequality_row() -> Row:
    """(23) is to make the second bracket of (21) negative: look for a state and an omega that obey (23) and do not."""
    gains, margin = paper.OUTDOOR_GAINS, 0.1
    values = {k_rho: gains.k_rho, k_alpha: gains.k_alpha, h: gains.h, v_max: gains.v_max, L: 1}
    equation = equations.EQUATIONS[23]
    obeying = (
        equation.gts + margin
        if equation.lts == omega
        else equation.lts + margin
        if equation.gts == omega
        else None
    )
    second = alpha * (-omega) + printed(22) * _SINE / rho * (h * theta + alpha)
    found = rising(second.subs(omega, obeying).subs(values))
    if found:
        text = f"At {_at(found)} an $\\omega$ {margin} rad/s above it leaves the bracket at {found[3]:+.1f}."
        return finding(23, Verdict.WRONG, text, "a counterexample: (23) does not follow from (21)")
    return finding(
        23,
        Verdict.HOLDS,
        "No counterexample among 20 000 states.",
        "the bracket is negative wherever (23) is obeyed",
    )


def _law_rows() -> list[Row]:
    law, as_printed = steering(), printed(24)
    closed = -rho / L * v_max * (1 - sp.exp(-k_rho * rho)) * _COSINE**2 - k_alpha * alpha**2
    closes = same(slope(law), closed)
    behind = {
        name: circle_residual(turning)
        for name, turning in (("derived", law), ("printed", as_printed))
    }
    wanted = paper.PUBLISHED["circle_residual"]
    fig_5 = fits(behind["derived"], wanted) and not fits(behind["printed"], wanted)
    text = f"The circle then ends {behind['derived']:.3f} m behind; as printed, {behind['printed']:.3f} m."
    row_24 = equation_row(24, law, {"the proof": closes, "Fig. 5": fig_5}, text)
    return [row_24, _substitution_row(as_printed, closed), _last_row(closed)]


def _substitution_row(as_printed: sp.Expr, closed: sp.Expr) -> Row:
    ours, theirs = slope(steering()), slope(as_printed)
    if same(printed(25), ours):
        return finding(25, Verdict.HOLDS, "(22) and (24) put into (21).", "the difference is 0")
    up = rising(printed(25))
    where = f"It is not below 0: at {_at(up)} it is {up[3]:+.1f}. " if up else ""
    text = f"{where}With the factor of (24) removed it is ${latex(closed)}$, never positive."
    if same(printed(25), theirs) and same(ours, closed):
        return finding(
            25,
            Verdict.TYPO,
            text,
            "it follows from (21), (22) and (24) as printed, and so repeats the typo of (24)",
        )
    return finding(
        25, Verdict.WRONG, text, "it is what neither (24) as printed nor the derived law gives"
    )


def _last_row(closed: sp.Expr) -> Row:
    size = {sp.Abs(rho): rho}  # rho is a distance
    last = printed(26).subs(size)
    if same(last, closed):
        return finding(
            26, Verdict.HOLDS, "What the derived law leaves of (25).", "the difference is 0"
        )
    state = {
        rho: 1,
        alpha: sp.Rational(-1, 2),
        theta: 1,
        k_rho: 2,
        k_alpha: 1,
        h: sp.Rational(3, 10),
        v_max: 4,
        L: 1,
    }
    numbers = [float(each.subs(state)) for each in (last, printed(25), closed)]
    text = "At $\\rho = 1$ m, $\\alpha = -0.5$, $\\theta = 1$ rad (26) says {:.2f}, (25) {:.2f}, and the derived law {:.2f}.".format(
        *numbers
    )
    up = rising(last)
    if up:
        text += f" (26) is not below 0 either: at {_at(up)} it is {up[3]:+.1f}."
    if same(last, printed(25)):
        return finding(
            26, Verdict.TYPO, text, "it follows from (25), and so repeats the typo of (24)"
        )
    return finding(
        26,
        Verdict.WRONG,
        text,
        "the difference from (25) is not 0, with (24) as printed and with the derived law",
    )


def rows() -> list[Row]:
    """The nine rows, in order."""
    return [*_energy_rows(), *_law_rows()]
