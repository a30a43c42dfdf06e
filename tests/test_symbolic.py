"""The expressions against wmrlib's compiled formulas, and what is printed of them."""

from __future__ import annotations

import inspect
import math
import runpy
import sys
from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from oracle import commanded

import wmrlib as wmr
from wmrlib import body, laws, motion, paper, symbolic
from wmrlib.laws import LAWS, pose_value
from wmrlib.symbolic import (
    L,
    alpha,
    decay,
    h,
    k_alpha,
    k_heading,
    k_rho,
    k_x,
    k_y,
    omega_ref,
    rho,
    textbook,
    theta,
    v_max,
    v_ref,
)

POSE_LAWS = tuple(laws.POSE_LAWS)
ARGUMENTS = (rho, alpha, theta, k_rho, k_alpha, h, v_max, L)
EXACT = {"rtol": 1e-12, "atol": 1e-12}
TRACKING = {
    "kanayama": (wmr.KanayamaGains(1.3, 2.1, 0.7), (k_x, k_y, k_heading)),
    "linear": (
        wmr.LinearGains([[1.0, 0.2, 0.3], [-0.4, 2.0, 1.5]]),
        sp.symbols("v_x v_y v_heading omega_x omega_y omega_heading", real=True),
    ),
}


small = st.sampled_from([0.0, 1e-300, 1e-12, 9.9e-9, 1.1e-8, 1e-4])
distances = st.floats(0.0, 100.0, allow_subnormal=False) | small
angles = st.floats(-math.pi, math.pi, allow_subnormal=False) | small
angles |= st.sampled_from([-1e-12, -1.1e-8, math.pi / 2.0, math.pi])
gain = st.floats(0.01, 5.0)


def same(a, b):
    return sp.expand(textbook(a) - textbook(b)) == 0


@pytest.fixture(scope="module", params=POSE_LAWS)
def pose(request):
    """(name, the law's expressions as functions of numbers)."""
    name = request.param
    parts = symbolic.law(name), symbolic.closed_loop_rates(name)
    parts += (symbolic.lyapunov(name),), (symbolic.lyapunov_rate(name),)
    return name, [sp.lambdify(ARGUMENTS, part, "numpy") for part in parts]


@given(polar=st.tuples(distances, angles, angles), gains=st.tuples(gain, gain, gain, gain), L=gain)
def test_laws_rates_and_lyapunov_functions_equal_wmrlib(pose, polar, gains, L):
    name, functions = pose
    law, rates, value, slope = (function(*polar, *gains, L) for function in functions)
    tuned = wmr.Gains(*gains)
    twist = wmr.control_law(*polar, tuned, law=name)
    np.testing.assert_allclose(law, twist, **EXACT)
    if polar[0] > 1e-200:
        np.testing.assert_allclose(rates, wmr.polar_rate(*polar[:2], *twist), **EXACT)
    if LAWS[name].value is pose_value:
        np.testing.assert_allclose(value[0], wmr.lyapunov(*polar, gains[2], L), **EXACT)
        np.testing.assert_allclose(slope[0], wmr.lyapunov_rate(*polar, tuned, name, L), **EXACT)
    else:
        np.testing.assert_allclose(value[0], LAWS[name].value(*polar, tuned), **EXACT)


@pytest.mark.parametrize("name", TRACKING)
def test_tracking_laws_equal_wmrlib(name):
    gains, symbols = TRACKING[name]
    arguments = rho, alpha, theta, v_ref, omega_ref, *symbols
    function = sp.lambdify(arguments, symbolic.law(name), "numpy")
    random = np.random.default_rng(3)
    state = random.uniform((0, -3, -3, -2, -2), (9, 3, 3, 2, 2), (500, 5)).T
    expected = commanded(*state, gains, name)
    np.testing.assert_allclose(function(*state, *gains), expected, **EXACT)


def test_decay_is_finite_and_smooth_at_the_goal():
    assert decay(0, k_rho) == k_rho
    for order in (0, 1):
        derivative = decay(rho, k_rho).diff(rho, order) if order else decay(rho, k_rho)
        written = ((1 - sp.exp(-k_rho * rho)) / rho).diff(rho, order)
        assert sp.simplify(derivative.subs(rho, 0) - sp.limit(written, rho, 0)) == 0
        point = {rho: 0.7, k_rho: 2}
        assert derivative.subs(point).evalf() == pytest.approx(float(written.subs(point)))
    assert decay(rho, k_rho).diff(k_rho) == sp.exp(-k_rho * rho)
    tiny = sp.Float("1e-30", 40)  # 1 - exp(-2e-30) has lost all digits
    assert abs(decay(tiny, sp.Integer(2)).evalf(40) - 2 * (1 - tiny)) < 1e-38


def test_near_the_goal_the_poles_are_those_of_tuning():
    s, rate = sp.Symbol("s"), v_max * k_rho
    state = sp.Matrix([rho, alpha, theta])
    expected = {
        "corrected": (s + rate) * (s**2 + k_alpha * s + h * rate**2),
        "aicardi": (s + k_rho) * (s**2 + k_alpha * s + h * k_rho**2),
        "printed": (s + rate) * s * (s + k_alpha - rate),
    }
    for name, polynomial in expected.items():
        matrix = (
            sp.Matrix(symbolic.closed_loop_rates(name)).jacobian(state).subs({rho: 0, theta: 0})
        )
        matrix = matrix.applyfunc(lambda entry: sp.limit(textbook(entry), alpha, 0))
        assert sp.expand(matrix.charpoly(s).as_expr() - polynomial) == 0
        near, a, b = symbolic.panel_formulas()[f"{name}_modes"].expanded()
        assert sp.expand((s + near) * (s**2 + a * s + b) - polynomial) == 0


# Printing


def test_the_committed_header_is_what_is_printed(tmp_path, monkeypatch, capsys):
    header = symbolic.c_header()
    assert symbolic.C_HEADER.read_text(encoding="utf-8") == header, "run python -m wmrlib.symbolic"

    def command(*words):
        monkeypatch.setattr(sys, "argv", ["symbolic", *words])
        runpy.run_module("wmrlib.symbolic", run_name="__main__")
        files = {file.name: file.read_text(encoding="utf-8") for file in tmp_path.iterdir()}
        return files, capsys.readouterr().out

    monkeypatch.setattr(symbolic, "C_HEADER", tmp_path / "law.h")
    assert command("--c", "-") == ({}, header)
    assert command("--c", str(tmp_path / "own.h")) == ({"own.h": header}, "")
    assert command() == ({"own.h": header, "law.h": header}, "")


def rolled(v, omega, left, right, left_rest, right_rest, width, easing, lag, dead, step, dt):
    """`body.roll` of numbers one by one, as it is printed."""
    wheels = wmr.Wheels(width, acceleration=easing, lag=lag, dead_band=dead, encoder_step=step)
    state = left, right, left_rest, right_rest
    v, omega, after = body.roll(v, omega, state, wheels, dt)
    return v, omega, *after


PRINTED_APART = {"roll": rolled, "saturation_scale": lambda most, fast: min(most / fast, 1.0)}


def test_a_printed_function_does_what_the_one_of_that_name_does_in_python():
    random, compared = np.random.default_rng(3), 0
    within = [{"turned_back": lambda angle: math.remainder(angle, 2.0 * math.pi)}, "math"]
    for name, formula in symbolic.panel_formulas().items():
        homes = SimpleNamespace(**PRINTED_APART), paper, motion, laws, body
        ours = next((getattr(it, name) for it in homes if hasattr(it, name)), None)
        if ours is None:
            continue
        ours, size = getattr(ours, "py_func", ours), len(formula.arguments)
        names = (*formula.arguments, *formula.gains)
        low = 0.1 if name in PRINTED_APART else -3.0
        given = dict(zip(map(str, names), random.uniform(low, 3.0, len(names)), strict=True))
        gains = [SimpleNamespace(**given)] * ("gains" in inspect.signature(ours).parameters)
        expected = np.ravel(ours(*list(given.values())[:size], *gains))
        printed = sp.lambdify(names, formula.expanded(), within)(**given)
        np.testing.assert_allclose(printed, expected, **EXACT, err_msg=name)
        compared += 1
    assert compared >= 17
