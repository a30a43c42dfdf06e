"""The page's stand-in for numpy, against numpy: the same values, shapes and refusals."""

import importlib
import math
import sys

import numpy as np
import pytest
from build import ROOT
from hypothesis import given
from hypothesis import strategies as st

STAND_INS = ROOT / "book" / "in_page" / "stand_ins"


def imported():
    """The stand-in, imported beside numpy."""
    real = {name: it for name, it in sys.modules.items() if name.split(".")[0] == "numpy"}
    for name in real:
        del sys.modules[name]
    sys.path.insert(0, str(STAND_INS))
    try:
        return importlib.import_module("numpy")
    finally:
        sys.path.remove(str(STAND_INS))
        for name in [it for it in sys.modules if it.split(".")[0] == "numpy"]:
            del sys.modules[name]
        sys.modules.update(real)


page = imported()
NUMBERS = st.floats(-1e3, 1e3).map(lambda x: round(x, 3))
ROWS = st.lists(NUMBERS, min_size=2, max_size=6)
TABLES = st.integers(1, 4).flatmap(
    lambda n: st.lists(st.lists(NUMBERS, min_size=n, max_size=n), min_size=2, max_size=4)
)
ALIKE = st.integers(2, 5).flatmap(
    lambda n: st.tuples(*[st.lists(NUMBERS, min_size=n, max_size=n)] * 2)
)
OF_ONE = """
np.sin(x) np.arctan(x) np.exp(x/99) np.sqrt(x) np.log(x) np.abs(x) -x x**2 x//3 x%7 1/x x/0
np.radians(x) np.sign(x) np.floor(x) np.sinc(x/9) np.square(x) np.isfinite(1/x) np.round(x,1)
~(x>0) np.arcsin(x) np.clip(x,-1,2) np.where(x>0,x,-1) np.expm1(x/99) np.ceil(x)
np.logical_not(x) x.sum() x.mean() x.std() x.var(ddof=1) np.std(x,ddof=1) x.max() x.min()
x.argmax() x.argmin() x.ravel() np.all(x>0) np.any(x>0) np.linalg.norm(x) x.T x.shape len(x)
x.tolist() x.size x.ndim x.reshape(-1) x[0] x[-1] x[1:] x[::-1] x[x>0] x[[0,-1]] x[None]
np.append(x,3) np.repeat(x,2) np.diff(x) np.concatenate([x,x]) x.cumsum() np.allclose(x,x+1e-9)
np.isclose(x,x+1) np.prod(x/99) x.sum(axis=0) x.mean(axis=0) x.max(axis=0) x.min(0)
x.std(axis=0) x@x.T 2*x+x[0] (x>0)*(x<6) (x>0)+(x<-2) x[(x>0)*(x<6)] x//0 x**(1/3) x**-1 x**0.5
np.log10(x) np.log1p(x) np.sign(0*x/0) np.floor(x/0) np.ceil(x)/2 x**401 np.vectorize(abs)(x)
np.power(x,-2) np.log10(x-x[0]) np.column_stack([x,x]) ~(x>0)*1
"""
OF_HOLES = "x.max() x.min() x.argmax() x.argmin() np.sort(x) x.sum() np.max([x,x],axis=1)"
OF_ROWS = """
np.unwrap(x) np.insert(x,0,5) np.sort(x) np.interp([0.5,-9e3,7],np.sort(x)+np.arange(x.size),x)
np.linspace(x[0],x[1],5) np.arange(x.size) np.dot(x,x) x[x.argmax():]
"""
OF_TABLES = """
x[:,0] x[1,0] x[:,None] x[0] x[:,[0]] x.sum(axis=1) x.mean(axis=-1) np.transpose(x)
x-x.mean(axis=0) x[0]-x np.linalg.norm(x,axis=1) np.concatenate([x,x],axis=1)
np.column_stack(list(x)) x*x[:,:1] np.sort(x)
"""
OF_TWO = """
x+y x-y x*y x/y x**2+y x<y x==y x!=y (x>0)&(y>0) (x>0)|(y>0) np.hypot(x,y) np.arctan2(x,y)
np.maximum(x,y) np.minimum(x,y) np.fmod(x,y) np.mod(x,y) x@y np.subtract(x,y) np.where(x>y,x,y)
x[:,None]*y np.power(2.0,x/99) np.logical_and(x>0,y>0) np.column_stack([x,y]) np.append(x,y)
np.add(x,y) np.divide(x,y) np.multiply(x,y)
"""


def same(text, *values):
    names = dict(zip("xy", values, strict=False))
    with np.errstate(all="ignore"):
        wanted = eval(text, {"np": np} | {it: np.array(v) for it, v in names.items()})
    found = eval(text, {"np": page} | {it: page.array(v) for it, v in names.items()})
    shape = getattr(found, "shape", ())
    if not isinstance(wanted, tuple | list | int):
        assert shape == np.shape(wanted), text
    listed = found.tolist() if shape else found
    np.testing.assert_allclose(listed, wanted, rtol=1e-9, atol=1e-9, err_msg=text)


@given(st.one_of(ROWS, TABLES))
def test_arrays_of_one_and_two_dimensions_are_as_numpys(x):
    for text in OF_ONE.split():
        same(text, x)


@given(ROWS)
def test_what_is_not_a_number_is_found_as_in_numpy(x):
    x = [*x[:1], math.nan, *x[1:]]
    for text in OF_HOLES.split():
        same(text, x)


@given(ROWS)
def test_rows_are_as_numpys(x):
    for text in OF_ROWS.split():
        same(text, x)


@given(TABLES)
def test_tables_are_as_numpys(x):
    for text in OF_TABLES.split():
        same(text, x)


@given(ALIKE)
def test_two_arrays_are_as_numpys(pair):
    for text in OF_TWO.split():
        same(text, *pair)


@pytest.mark.parametrize(
    "wrong",
    [
        "np.array([1, 2]) + np.array([1, 2, 3])",
        "np.array([1])[5]",
        "np.array([[1, 2], [3]])",
        "np.array([1, 2]) @ np.array([1])",
        "np.array([1, 2, 3]).__setitem__(slice(2), [1, 2, 3])",
        "np.array([[1, 2], [3, 4]]).__setitem__((slice(None), 0), [1, 2, 3, 4])",
        "np.array([1.0, 2.0]).__setitem__(slice(None), np.array([[1.0, 2.0], [3.0, 4.0]]))",
        "(a := np.array([3.5, 1.5, 7.5])).__setitem__(a > 2, [1.5, 2.5, 3.5])",
    ],
)
def test_it_refuses_what_numpy_refuses(wrong):
    for numpy in np, page:
        with pytest.raises((ValueError, IndexError)):
            eval(wrong, {"np": numpy})


@pytest.mark.parametrize("name", ["linalg.inv", "fft.rfft", "meshgrid", "random.seed"])
def test_what_is_missing_is_named_with_what_there_is(name):
    first, _, last = name.partition(".")
    with pytest.raises(AttributeError) as told:
        getattr(getattr(page, first), last or "shape")
    wanted = first if first in ("fft", "meshgrid") else name
    assert str(told.value).startswith(f"numpy.{wanted} is not in this page, which has a part of")
    assert " arctan2, " in str(told.value)
    assert "The notebook has all of it." in str(told.value)
    assert not hasattr(page.array([1.0]), "nonzero")


def test_an_array_is_shown_with_the_digits_that_are_asked():
    assert f"{page.array(2.5):.2f}" == "2.50"


def test_random_numbers_are_the_same_each_time_and_spread_as_asked():
    def drawn():
        random = page.random.default_rng(7)
        return random.normal(3.0, 2.0, 4000), random.uniform([0.0, 5.0], [1.0, 6.0], (2000, 2))

    (normal, table), (again, _) = drawn(), drawn()
    assert normal.tolist() == again.tolist()
    assert math.isclose(normal.mean(), 3.0, abs_tol=0.15)
    assert math.isclose(normal.std(), 2.0, abs_tol=0.15)
    assert table.shape == (2000, 2)
    assert np.allclose(table.mean(axis=0).tolist(), [0.5, 5.5], atol=0.05)
    assert set(page.random.default_rng(1).integers(0, 3, 200).tolist()) == {0, 1, 2}
    assert sorted(page.random.default_rng(1).permutation(5).tolist()) == list(range(5))


@given(st.lists(st.integers(-9, 9), min_size=2, max_size=5), NUMBERS, st.sampled_from("+-*/"))
def test_what_is_written_is_numpys_or_is_refused(whole, number, sign):
    """What would be cut off is refused, and what numpy refuses in place too."""
    for begin in (whole, list(map(float, whole))):
        ours, theirs = page.array(begin), np.array(begin)
        alias = ours
        code = f"a[0] = {number!r}", f"a[-1:] = {number!r}", f"a {sign}= {number!r}", "a *= 2"
        for line in code if number else code[-1:]:
            try:
                exec(line, {"a": theirs})
                cut = theirs.dtype.kind == "i" and "=" in line and "*= 2" not in line
            except TypeError:
                cut = True
            if cut:
                with pytest.raises(TypeError):
                    exec(line, {"a": ours})
                break
            exec(line, {"a": ours})
            assert ours.tolist() == pytest.approx(theirs.tolist(), abs=1e-9)
        assert alias is ours


@pytest.mark.parametrize(
    "code",
    [
        "a = np.arange(3.0); a[0] = 0.5",
        "a = np.arange(4.0); a += 0.5",
        "a = np.floor(np.array([1.5, 2.5])); a /= 2",
        "a = np.array([[1, 2], [3.5, 4]])[0].copy(); a[0] = 0.25",
        "a = np.array([1.0, -1.0, 7.0]); m = (a > 0) * (a < 6); a[m] = 0",
        "a = np.array([1.0, -1.0, 7.0]); m = a > 6; m[0] = 1; a[m] = 0",
    ],
)
def test_what_a_student_writes_comes_to_the_same(code):
    ours, theirs = {"np": page}, {"np": np}
    exec(code, ours)
    exec(code, theirs)
    np.testing.assert_allclose(ours["a"].tolist(), theirs["a"])


def test_a_number_that_would_be_lost_is_refused():
    with pytest.raises(TypeError):
        page.array([[1.0, 2.0]])[0].flat[1] = 5.0
    for code in ("np.linalg.norm([[1.0]], 1)", "np.unwrap([[1.0]])", "np.array([1.0])[[[0]]]"):
        with pytest.raises(AttributeError, match="not in this page"):
            eval(code, {"np": page})


PARTS = """
a[0] a[-1] a[:,1] a[1:] a[::2,::-1] a.T a.T[1] a.reshape(-1) a[:,1][::2] a[[1,0]] a[a>0] a.ravel()
a.T.ravel() a.T.reshape(-1) a[:,::2].reshape(-1) a[1:].ravel() a[:,1].reshape(3,1)
a[:,1].ravel() a[3:].ravel() a[:0].reshape(-1)
np.asarray(a,dtype=float) np.asarray(a) np.array(a)
"""
LINES = "a[0,1]=7 p[:]=5 p+=1 a[:,0]=[5,6,7] p[0]=p[-1] a*=2 p[::2]-=3"


@given(
    st.lists(st.lists(NUMBERS, min_size=3, max_size=3), min_size=3, max_size=3),
    st.sampled_from(PARTS.split()),
    st.permutations(LINES.split()),
)
def test_a_part_and_its_array_change_together_as_in_numpy(begin, part, lines):
    theirs, ours = (
        {"np": numpy, "a": numpy.array([list(map(float, row)) for row in begin])}
        for numpy in (np, page)
    )
    for line in (f"p={part}", *lines):
        for names in theirs, ours:
            try:
                exec(line, names)
            except IndexError:  # an empty part has no first number
                assert not names["p"].size
            except ValueError:  # or what is written does not fit
                assert names["p"].shape
        for name in "ap":
            np.testing.assert_allclose(ours[name].tolist(), theirs[name], err_msg=line)
