"""What every check stands on: an answer is asked for its numbers, and its code for what it uses of wmrlib."""

import decimal
import fractions
import math

import numpy as np
import pytest
import sympy as sp

import wmrlib
import wmrlib as wmr
import wmrlib.kinematics
from wmrbook.grading import Hint, _hints
from wmrlib import control_law, polar_error
from wmrlib import control_law as polar_error_of_mine
from wmrlib import polar_error as seen_from

GAINS = wmr.Gains(1.0, 2.0, 3.0)
START = wmr.Pose(0.0, 0.0, 0.0)
ALLOWED = ("Pose", "polar_error")


NUMBERS = [
    1.5,
    np.float32(1.5),
    np.longdouble(1.5),
    np.array(1.5),
    np.array([1.5]),
    np.array(1.5, dtype=object),
]


@pytest.mark.parametrize(
    "value",
    [*NUMBERS, sp.Rational(3, 2), fractions.Fraction(3, 2), decimal.Decimal("1.5")],
    ids=repr,
)
def test_a_number_may_have_many_forms(value):
    assert _hints.number("it", value) == 1.5


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        (10**400, "far too large"),
        (-(10**5000), "far too large"),
        (np.complex128(1 + 2j), "one number is needed"),
        (np.array(1 + 0j), "one number is needed"),
        (np.True_, "one number is needed"),
        (np.array(True), "one number is needed"),
        (np.array(True, dtype=object), "one number is needed"),
        (np.array("3.5"), "one number is needed"),
        (np.array(b"3.5"), "one number is needed"),
        (np.array([1.0, 2.0]), "one number is needed"),
        (np.array([]), "one number is needed"),
        (np.array(math.nan), "not a finite number"),
        ([10**5000], "something of the type list"),
    ],
    ids=lambda each: str(type(each)),
)
@pytest.mark.filterwarnings("error")
def test_what_is_no_number(value, hint):
    with pytest.raises(Hint, match=hint):
        _hints.number("it", value)


@pytest.mark.parametrize(
    "answer",
    [
        {1.0, 2.0},
        frozenset({1.0, 2.0}),
        {1.0: 3.0, 2.0: 4.0},
        "12",
        1.0,
        [1.0],
        (1.0, 2.0, 3.0),
        None,
    ],
)
def test_numbers_need_an_order(answer):
    with pytest.raises(Hint, match="2 numbers, separated by commas, are needed"):
        _hints.ask_numbers(lambda: answer, 2)


@pytest.mark.parametrize(
    "answer",
    [(1, 2), [1, 2], np.array([1, 2]), sp.Matrix([1, 2]), {"v": 1, "omega": 2}.values()],
    ids=repr,
)
def test_ordered_numbers(answer):
    assert _hints.ask_numbers(lambda: answer, 2) == (1.0, 2.0)


def by_name(pose, goal):
    return polar_error(pose, goal)


def by_module(pose, goal):
    return wmr.polar_error(wmr.Pose(*pose), goal)


def by_submodule(pose, goal):
    return wmrlib.kinematics.polar_error(pose, goal)


def by_another_name(pose, goal):
    return seen_from(pose, goal)


def by_an_import_inside(pose, goal):
    import wmrlib.kinematics as k
    from wmrlib import Pose

    return (lambda: k.polar_error(Pose(*pose), goal))()


def and_a_helper(pose, goal):
    return by_module(pose, goal)


@pytest.mark.parametrize(
    "function",
    [by_name, by_module, by_submodule, by_another_name, by_an_import_inside, and_a_helper],
)
def test_what_is_allowed_may_be_used_in_any_way(function):
    assert function(START, wmr.Pose(1.0, 0.0, 0.0)) == (1.0, 0.0, 0.0)
    _hints.own_work(function, *ALLOWED)
    with pytest.raises(Hint, match="of wmrlib; this task asks for your own formula"):
        _hints.own_work(function)


def law_by_name(*polar):
    return control_law(*polar, GAINS)


def law_by_module(*polar):
    return wmr.control_law(*polar, GAINS)


def law_by_submodule(*polar):
    return wmrlib.control.control_law(*polar, GAINS)


def law_by_another_name(*polar):
    return polar_error_of_mine(*polar, GAINS)


def law_by_an_import_inside(*polar):
    import wmrlib.control as c

    return c.control_law(*polar, GAINS)


def law_by_a_name_imported_inside(*polar):
    from wmrlib.control import control_law as mine

    return (lambda: mine(*polar, GAINS))()


def law_by_a_helper(*polar):
    return law_by_an_import_inside(*polar)


LAWS = [law_by_name, law_by_module, law_by_submodule, law_by_another_name]
LAWS += [law_by_an_import_inside, law_by_a_name_imported_inside, law_by_a_helper]


@pytest.mark.parametrize("function", LAWS)
def test_what_is_not_allowed_is_found_in_any_way(function):
    assert function(1.0, 0.5, 0.2) == control_law(1.0, 0.5, 0.2, GAINS)
    with pytest.raises(
        Hint, match=r"control_law` of wmrlib; of it only `Pose`, `polar_error` may be used here"
    ):
        _hints.own_work(function, *ALLOWED)
    with pytest.raises(
        Hint, match="of wmrlib; this task asks for your own formula, with `math` or `numpy`"
    ):
        _hints.own_work(function)


def control(x):
    return x


def with_data(x):
    return GAINS.k_rho * x + START.x


def with_names_that_wmrlib_has_too(x):
    return wmr.polar_error(START, START).rho + control(x)


def with_a_module_that_does_not_exist(x):
    import wmrlib.nowhere as nowhere

    return nowhere.law(x)


def test_data_and_names_of_ones_own_are_no_matter():
    assert with_data(2.0) == 2.0
    _hints.own_work(with_data)
    _hints.own_work(with_names_that_wmrlib_has_too, *ALLOWED)
    for allowed in ((), ALLOWED):
        _hints.own_work(with_a_module_that_does_not_exist, *allowed)
    with pytest.raises(Hint, match=r"stops.* with ModuleNotFoundError"):
        _hints.ask(with_a_module_that_does_not_exist, 1.0)
