"""The paper's proof, (18) to (26): each against V differentiated along the robot's motion."""

from __future__ import annotations

import math

import numpy as np
import sympy as sp

from wmrbook import equations
from wmrbook.audit.equations import polar_rates
from wmrbook.audit.row import (
    Row,
    Verdict,
    at,
    equation,
    equation_row,
    equivalent,
    finding,
    fits,
    latex,
    printed,
)
from wmrbook.published import PUBLISHED
from wmrlib import paper
from wmrlib.symbolic import L, alpha, h, k_alpha, k_rho, omega, rho, theta, v, v_max

_COSINE, _SINE, _STATE = sp.cos(alpha), sp.sin(alpha), (rho, alpha, theta)
_CLOSED = -rho / L * v_max * (1 - sp.exp(-k_rho * rho)) * _COSINE**2 - k_alpha * alpha**2
_MARGIN = 0.1  # rad/s above (23)


def steering() -> sp.Expr:
    """The omega that turns the second bracket of (21) into -k_alpha alpha^2, with (22)'s speed.

    It is solved for, not taken from (24).
    """
    _, turning, sweeping = polar_rates()
    # the bracket is this - alpha omega
    others = sp.factor((alpha * turning + h * theta * sweeping).subs(omega, 0))
    return k_alpha * alpha + (others / alpha).subs(v, printed(22))


def slope(turning: sp.Expr) -> sp.Expr:
    """V' = (18) differentiated along (7) to (9), with the speed of (22) and this omega."""
    V = rho**2 / (2 * L) + (alpha**2 + h * theta**2) / 2
    along = sum(V.diff(each) * rate for each, rate in zip(_STATE, polar_rates(), strict=True))
    return along.subs({omega: turning, v: printed(22)}, simultaneous=True)


def rising(expression: sp.Expr) -> tuple[float, float, float, float] | None:
    """The state (rho, alpha, theta), of 20 000 random ones, where V' is greatest, and V' there.

    None if it is positive in none.
    """
    low, high = (0.05, -3.1, -3.1), (1.0, 3.1, 3.1)
    states = np.random.default_rng(10).uniform(low, high, (20_000, 3)).round(2)
    states = states[states[:, 1] != 0.0]
    values = at(paper.OUTDOOR_GAINS) | {L: 1}
    slopes = sp.lambdify(_STATE, expression.subs(values), "numpy")(*states.T)
    worst = int(np.argmax(slopes))
    return (*states[worst].tolist(), float(slopes[worst])) if slopes[worst] > 1e-9 else None


def _place(state) -> str:
    return "$\\rho = {:.2f}$ m, $\\alpha = {:.2f}$, $\\theta = {:.2f}$ rad".format(*state[:3])


def circle_residual(turning: sp.Expr) -> float:
    """How far behind the paper's circle the robot of (22) and this omega stays, m.

    Euler's steps of 0.1 s, the last 10 s; infinite if it runs away.
    """
    dt, steps = paper.TIME_STEP, 400
    commands = [each.subs(at(paper.CIRCLE_GAINS)) for each in (printed(22), turning)]
    twist = sp.lambdify(_STATE, commands, "math")
    goal = paper.circle(dt * np.arange(steps + 1))
    x, y, heading = paper.CIRCLE_START
    behind = []
    for goal_x, goal_y, goal_heading in zip(*(part.tolist() for part in goal[:3]), strict=True):
        sight = math.atan2(goal_y - y, goal_x - x)
        distance = math.hypot(goal_x - x, goal_y - y)
        angles = (math.remainder(sight - each, math.tau) for each in (heading, goal_heading))
        try:
            forward, turn = twist(distance, *angles)
        except (OverflowError, ValueError):
            return math.inf
        x += dt * forward * math.cos(heading)
        y += dt * forward * math.sin(heading)
        heading += dt * turn
        behind.append(distance)
    return float(np.mean(behind[-100:]))


def energy_rows() -> list[Row]:
    """(18) to (23)."""
    dots = equations.rho_rate, equations.alpha_rate, equations.theta_rate
    chain = sum(printed(18).diff(each) * dot for each, dot in zip(_STATE, dots, strict=True))
    along = chain.subs(dict(zip(dots, polar_rates(), strict=True)))
    in_20, in_21 = equivalent(printed(20), along), equivalent(printed(21), along)
    stuck = slope(steering()).subs(alpha, sp.Symbol("a")).subs(rho, sp.Symbol("d"))
    flat = sp.limit(sp.limit(stuck, sp.Symbol("a"), 0), sp.Symbol("d"), 0)
    strict = (
        "The strict sign can't be met: at $\\rho = \\alpha = 0$ "
        f"it has $\\dot V = {sp.latex(flat)}$ for every $\\theta$."
    )
    sign = "(7) to (9) put into (19). It has the sign of (8), not that of (10)."
    return [
        _bowl_row(),
        equation_row(19, chain, {"(20)": in_20}, strict),
        equation_row(20, along, {"(21)": in_21}, sign),
        equation_row(21, along, {"(20)": in_20}, "(20) with its terms collected."),
        _speed_row(),
        _inequality_row(),
    ]


def _bowl_row() -> Row:
    energy, state = printed(18), sp.Matrix([_STATE])
    hessian = sp.hessian(energy, _STATE)
    quadratic = (state * hessian * state.T)[0] / 2
    is_bowl = (
        energy.subs(dict.fromkeys(_STATE, 0)) == 0
        and equivalent(energy, quadratic)
        and all(value.is_positive for value in hessian.eigenvals())
    )
    if is_bowl:
        bowl = "Zero at the goal, positive elsewhere: a sum of squares with positive weights."
        return finding(18, Verdict.HOLDS, bowl, "all second derivatives' eigenvalues are positive")
    why = "an eigenvalue of the second derivatives is not positive"
    return finding(18, Verdict.WRONG, "Not positive definite.", why)


def _speed_row() -> Row:
    first = sp.simplify(-rho / L * printed(22) * _COSINE)
    push = sp.simplify(-first * L / (rho * _COSINE**2))
    far = sp.Symbol("d", positive=True)
    falls = push.subs(rho, 0) == 0 and bool(push.diff(rho).is_positive)
    if falls and sp.limit(push.subs(rho, far), far, sp.oo) == v_max:
        text = (
            "The first bracket of (21) is then never positive, "
            "and the speed never above $v_{\\max}$."
        )
        why = f"${latex(push)}$ is 0 at 0 and grows to $v_{{\\max}}$"
        return finding(22, Verdict.HOLDS, text, why)
    why = "the factor of $-\\rho\\cos^2\\alpha/L$ is not positive"
    return finding(22, Verdict.WRONG, "The first bracket of (21) can be positive.", why)


def _inequality_row() -> Row:
    """(23) is to make the second bracket of (21) negative: look for a state where it does not."""
    low, high = equation(23).lts, equation(23).gts
    obeying = (high if low == omega else low) + _MARGIN
    second = alpha * (-omega) + printed(22) * _SINE / rho * (h * theta + alpha)
    found = rising(second.subs(omega, obeying))
    if found:
        text = (
            f"At {_place(found)} an $\\omega$ {_MARGIN} rad/s above it "
            f"leaves the bracket at {found[3]:+.1f}."
        )
        why = "a counterexample: (23) does not follow from (21)"
        return finding(23, Verdict.WRONG, text, why)
    text = "No counterexample among 20 000 states."
    return finding(23, Verdict.HOLDS, text, "the bracket is negative wherever (23) is obeyed")


def law_rows() -> list[Row]:
    """(24) to (26)."""
    law = steering()
    derived, as_printed = circle_residual(law), circle_residual(printed(24))
    wanted = PUBLISHED["circle_residual"]
    needed = {
        "the proof": equivalent(slope(law), _CLOSED),
        "Fig. 5": fits(derived, wanted) and not fits(as_printed, wanted),
    }
    text = f"The circle then ends {derived:.3f} m behind; as printed, {as_printed:.3f} m."
    return [equation_row(24, law, needed, text), _substitution_row(), _last_row()]


def _substitution_row() -> Row:
    ours, theirs = slope(steering()), slope(printed(24))
    if equivalent(printed(25), ours):
        return finding(25, Verdict.HOLDS, "(22) and (24) put into (21).", "the difference is 0")
    up = rising(printed(25))
    where = f"It is not below 0: at {_place(up)} it is {up[3]:+.1f}. " if up else ""
    text = f"{where}With the factor of (24) removed it is ${latex(_CLOSED)}$, never positive."
    if equivalent(printed(25), theirs) and equivalent(ours, _CLOSED):
        why = "it follows from (21), (22) and (24) as printed, and so repeats the typo of (24)"
        return finding(25, Verdict.TYPO, text, why)
    why = "it is what neither (24) as printed nor the derived law gives"
    return finding(25, Verdict.WRONG, text, why)


def _last_row() -> Row:
    last = printed(26).subs(sp.Abs(rho), rho)  # rho is a distance
    if equivalent(last, _CLOSED):
        left = "What the derived law leaves of (25)."
        return finding(26, Verdict.HOLDS, left, "the difference is 0")
    state = {rho: 1, alpha: -0.5, theta: 1, L: 1} | at(paper.OUTDOOR_GAINS)
    numbers = [float(each.subs(state)) for each in (last, printed(25), _CLOSED)]
    text = (
        "At $\\rho = 1$ m, $\\alpha = -0.5$, $\\theta = 1$ rad (26) says {:.2f}, (25) {:.2f}, "
        "and the derived law {:.2f}."
    ).format(*numbers)
    up = rising(last)
    if up:
        text += f" (26) is not below 0 either: at {_place(up)} it is {up[3]:+.1f}."
    if equivalent(last, printed(25)):
        why = "it follows from (25), and so repeats the typo of (24)"
        return finding(26, Verdict.TYPO, text, why)
    why = "the difference from (25) is not 0, with (24) as printed and with the derived law"
    return finding(26, Verdict.WRONG, text, why)


def rows() -> list[Row]:
    """The nine rows, in order."""
    return [*energy_rows(), *law_rows()]
