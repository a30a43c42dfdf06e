"""Whatever stands in the place of an answer, a check of the assignments says so in a hint: it neither passes nor breaks."""

import inspect
import math

import numpy as np
import pytest
import sympy as sp

from wmrbook.grading import (
    Hint,
    Passed,
    angles,
    circles,
    design,
    drives,
    earth,
    laws,
    lyapunov,
    motion,
    noise,
    robots,
    routes,
    sampling,
    trips,
    verdicts,
)

MODULES = (
    angles,
    circles,
    design,
    drives,
    earth,
    laws,
    lyapunov,
    motion,
    noise,
    robots,
    routes,
    sampling,
    trips,
    verdicts,
)
CHECKS = [
    check
    for module in MODULES
    for name, check in inspect.getmembers(module, inspect.isfunction)
    if check.__module__ == module.__name__ and not name.startswith("_")
]
NONSENSE = {
    "None": None,
    "...": ...,
    "a number": 1.5,
    "NaN": math.nan,
    "a text": "1.5",
    "True": True,
    "numbers": (1.0, 2.0, 3.0, 4.0),
    "an array": np.ones((2, 2)),
    "a symbol": sp.Symbol("x"),
    "a class": dict,
    "a set": {1.0},
    "complex": 1j,
    "infinite": math.inf,
    "huge": 1e308,
    "tiny": 1e-308,
    "zeros": [0.0, 0.0, 0.0],
    "negative": (-1e300, -1e300),
    "a pair": np.array([1.0, 0.0]),
    "a huge integer": 10**400,
    "a truth in an array": np.array(True),
    "complex of numpy": np.complex128(1 + 2j),
    "a set of two": {1.0, 2.0},
    "a dict": {1.0: 1.0, 2.0: 2.0},
}


@pytest.mark.parametrize("value", NONSENSE.values(), ids=NONSENSE)
@pytest.mark.parametrize(
    "check", CHECKS, ids=lambda check: f"{check.__module__.split('.')[-1]}.{check.__name__}"
)
def test_nonsense_is_refused(check, value):
    answers = [value, lambda *arguments: value, lambda: value, lambda *arguments: [value] * 2]
    for answer in answers:
        with pytest.raises(Hint) as found:
            check(answer)
        assert len(str(found.value)) < 400


def test_every_check_is_found_and_described():
    assert len(CHECKS) > 35
    for check in CHECKS:
        assert inspect.getdoc(check)
        assert check.__annotations__["return"] in (Passed, "Passed")
