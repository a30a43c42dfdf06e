"""Numbers of other packages: taken with all that they say, or refused by the name of their type."""

import math
from datetime import date, timedelta
from decimal import Decimal
from enum import IntEnum
from fractions import Fraction

import astropy.units
import mpmath
import numpy as np
import pandas as pd
import pint
import pytest
import sympy as sp
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from sympy.physics.units import degree

import wmrlib as wmr
from wmrlib import checks

pint_units = pint.UnitRegistry()
TWO = IntEnum("TWO", {"TWO": 2})["TWO"]


class Quantity:
    """Of unxt: a dataclass with the fields value and unit, which numpy reads without its unit."""

    def __init__(self, value, unit):
        self.value, self.unit = value, unit

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.value, dtype)


class Breaks:
    """As a tensor of torch that has a gradient: its conversion raises an error of its own."""

    def __array__(self, dtype=None, copy=None):
        raise RuntimeError("call detach first")


def in_deg(value):
    """An xarray.DataArray that only notes its unit."""
    return xr.DataArray(value, attrs={"units": "deg"})


NUMBERS = [  # with the float that they are
    *(
        (3, 3.0),
        (2.5, 2.5),
        (10**30, 1e30),
        (TWO, 2.0),
        (np.float32(0.5), 0.5),
        (np.int8(-3), -3.0),
    ),
    *((Decimal("0.1"), 0.1), (Fraction(1, 3), 1 / 3), (mpmath.mpf("0.1"), 0.1)),
    *(
        (sp.pi, math.pi),
        (sp.sqrt(2), math.sqrt(2)),
        (sp.Rational(1, 3), 1 / 3),
        (sp.Float(2.5), 2.5),
    ),
    *((np.array(4), 4.0), (xr.DataArray(1.5), 1.5)),
]
NONE = [  # with what the sentence calls them
    *((pint_units.Quantity(90, "deg"), "a pint.Quantity"), (90 * astropy.units.deg, "an astropy.")),
    *((pint_units.Quantity(sp.Integer(90), "deg"), "a pint."), (Quantity(1.0, "deg"), "Quantity")),
    *((np.arange(2) * pint_units.deg, "a pint."), ([1, 2] * astropy.units.deg, "an astropy.")),
    *((in_deg(1.0), "an xarray.DataArray"), (in_deg([1.0]), "an xarray.DataArray with a unit")),
    (xr.DataArray([1.0] * pint_units.deg), "an xarray.DataArray with a unit"),
    *((pd.Series([1.0 * pint_units.deg]), "a pint."), (pd.Series([1, None], dtype=object), "None")),
    *((np.ma.array([1.0]), "a numpy.MaskedArray"), (np.ma.masked, "a numpy.MaskedConstant")),
    *((sp.I, "a sympy.Imag"), (sp.Symbol("x"), "a sympy.Symbol"), (90 * degree, "a sympy.Mul")),
    *((sp.true, "a sympy.Bool"), (mpmath.mpc(1, 0), "a mpmath.mpc"), (mpmath.iv.pi, "a mpmath.iv")),
    *((True, "a bool"), (np.True_, "a numpy.bool"), (np.array([True]), "an array of bool")),
    *(
        ("3", "a str"),
        (b"3", "a bytes"),
        (bytearray(b"3"), "a bytearray"),
        (pd.Series(["3"]), "a str"),
    ),
    *(
        (1j, "a complex"),
        (np.array([1j]), "an array of complex128"),
        (np.array(["3"]), "array of str"),
    ),
    *((date(2026, 3, 1), "a datetime.date"), (timedelta(1), "a datetime.timedelta")),
    *((np.timedelta64(1, "s"), "a numpy.timedelta64"), (pd.Timestamp(0), "a pandas.Timestamp")),
    (pd.Series([pd.Timestamp(0)]), "an array of datetime64"),
    *((None, "None"), (pd.NA, "a pandas.NAType"), ({}, "a dict"), (Breaks(), "a Breaks")),
]
NESTED = (lambda entry: [entry], lambda entry: (entry,), lambda entry: [[entry], [0]])
wraps = st.lists(st.sampled_from(NESTED), max_size=3)


@given(st.sampled_from(NUMBERS), st.lists(st.sampled_from(NESTED[:2]), max_size=3))
def test_a_number_of_any_kind_is_its_float(case, wrap):
    value, number = case
    for nest in wrap:
        value = nest(value)
    checked = checks.real("x", value)
    np.testing.assert_array_equal(checked, np.full((1,) * len(wrap), number))
    assert type(checked) is (np.ndarray if wrap else float)


@given(st.sampled_from(NONE), wraps, st.sampled_from([("goal.heading", "rad"), ("lat", "degrees")]))
def test_all_else_is_refused_by_its_type_and_with_the_unit_that_is_needed(case, wrap, argument):
    (value, kind), (name, unit) = case, argument
    for nest in wrap:
        value = nest(value)
    with pytest.raises(ValueError, match=f"^{name} = .* is not allowed: a finite") as error:
        checks.real(name, value)
    text = str(error.value)
    assert f"is needed, not {kind}" in text or (kind[0].isupper() or "array" in kind) * kind in text
    assert text.endswith(f": give the number in {unit}")


def test_tables_without_units_are_arrays():
    table = pd.DataFrame({"unit": [1.0, 2.0], "units": [3.0, 4.0]})  # names that mean nothing here
    for column in (table["unit"], table.unit.astype("Float64"), table.index + 1, [1, Decimal(2)]):
        assert checks.real("x", column).tolist() == [1.0, 2.0]
    assert checks.real("x", table).tolist() == [[1.0, 3.0], [2.0, 4.0]]
    assert checks.real("x", pd.Series([1.0], index=["unit"])).tolist() == [1.0]
    assert checks.real("x", xr.DataArray(table["unit"])).tolist() == [1.0, 2.0]
    with pytest.raises(ValueError, match="a finite number is needed"):
        checks.real("x", pd.Series([1, None], dtype="Float64"))


def test_what_has_no_unit_in_the_list_is_asked_for_in_the_documented_one():
    with pytest.raises(
        ValueError, match=r"not a str: give a plain number, in the documented unit$"
    ):
        wmr.LinearGains([["1", 2, 3], [4, 5, 6]])
