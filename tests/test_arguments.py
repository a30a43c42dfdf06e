"""Odd arguments, thrown at every public function: only a ValueError that names the argument."""

import inspect
import warnings
from datetime import date
from decimal import Decimal
from fractions import Fraction
from functools import cache
from itertools import combinations, product
from types import FunctionType

import numpy as np
import pytest

import wmrlib as wmr
from wmrbook.chapters import routes
from wmrbook.conventions import gains_near_goal, translate
from wmrbook.ellipsoid import sphere_error

PAPER = wmr.paper.outdoor()
POINT, OTHER = wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2
GAINS, ORIGIN, LIMITS = wmr.GENTLE_GAINS, wmr.Pose(0.0, 0.0, 0.0), wmr.Wheels(0.5, 2.0)
GOAL = wmr.Pose(1.0, 1.0, 0.0)
POLAR = {"rho": 1.0, "alpha": 0.5, "theta": 0.2}
DRIVE = {"method": "arc", "dt": 0.1, "duration": 1.0, "arrival_radius": 0.05, "wheels": LIMITS}
WAY, LINE = wmr.Pose([0.0, 1.0], [0.0, 1.0], 0.0), wmr.GeoPoint(lat=[33.0, 33.1], lon=44.0)


@cache
def a_run():
    return wmr.simulate(ORIGIN, GOAL, GAINS)


@cache
def a_route():
    return routes.drive_route(WAY, GAINS)


DRIVEN = {"trajectory": a_run, "route": a_route}  # only where a test needs it
VALID = {
    wmr.Pose: {"x": 0.0, "y": 0.0, "heading": 0.0},
    wmr.Gains: {"k_rho": 1.0, "k_alpha": 1.0, "h": 1.0, "v_max": 1.0},
    wmr.KanayamaGains: {"k_x": 1.0, "k_y": 1.0, "k_heading": 1.0},
    wmr.LinearGains: {"matrix": np.ones((2, 3))},
    wmr.GeoPoint: {"lat": 33.0, "lon": 44.0},
    wmr.wheels_to_twist: {"left": 1.0, "right": 1.0, "track_width": 0.5},
    wmr.twist_to_wheels: {"v": 1.0, "omega": 1.0, "track_width": 0.5},
    wmr.wrap_angle: {"angle": 1.0},
    wmr.pose_rate: {"heading": 1.0, "v": 1.0, "omega": 1.0},
    wmr.advance: {"pose": ORIGIN, "v": 1.0, "omega": 1.0, "dt": 0.1, "method": "arc"},
    wmr.polar_error: {"pose": ORIGIN, "goal": GOAL},
    wmr.pose_from_polar: {"polar": wmr.PolarError(1.0, 0.5, 0.2), "goal": GOAL},
    wmr.polar_rate: {"rho": 1.0, "alpha": 0.5, "v": 1.0, "omega": 1.0},
    wmr.control_law: POLAR | {"gains": GAINS, "law": "corrected"},
    wmr.closed_loop: {"gains": GAINS, "law": "corrected"},
    wmr.lyapunov: POLAR | {"h": 1.0, "L": 1.0},
    wmr.lyapunov_rate: POLAR | {"gains": GAINS, "law": "corrected", "L": 1.0},
    wmr.limit_wheels: {"v": 1.0, "omega": 1.0, "limits": LIMITS},
    wmr.haversine_distance: {"a": POINT, "b": OTHER, "radius": 1.0},
    wmr.initial_bearing: {"a": POINT, "b": OTHER},
    wmr.destination_point: {"a": POINT, "distance": 1.0, "bearing": 1.0, "radius": 10.0},
    wmr.local_position: {"origin": POINT, "point": OTHER, "radius": 10.0},
    wmr.point_at: {"origin": POINT, "east": 1.0, "north": 1.0, "radius": 10.0},
    wmr.simulate: {"start": ORIGIN, "goal": GOAL, "gains": GAINS, "law": "corrected"}
    | DRIVE
    | {"last_turn": wmr.LastTurn(), "hysteresis": 0.1},
    wmr.track: {"reference": wmr.paper.circle, "start": ORIGIN, "gains": GAINS, "law": "corrected"}
    | {"method": "arc", "dt": 0.1, "duration": 1.0, "wheels": LIMITS},
    wmr.sweep: {"starts": ORIGIN, "goals": GOAL, "gains": GAINS, "law": "corrected"}
    | DRIVE
    | {"last_turn": wmr.LastTurn(), "hysteresis": 0.1}
    | {"receiver": wmr.Receiver(0.5, 1.0), "seed": 1},
    wmr.Receiver: {"sigma": 0.5, "memory": 1.0, "period": 0.2, "delay": 0.1, "heading_delay": 0.0}
    | {"sight": 0.1},
    wmr.arrival: {"trajectory": a_run},
    wmr.residual: {"trajectory": a_run, "last": 1.0},
    routes.headings_along: {"x": [0.0, 1.0], "y": [0.0, 1.0]},
    routes.route_poses: {"points": LINE, "headings": [0.0, 1.0], "origin": POINT},
    routes.route_points: {"route": a_route, "origin": POINT},
    routes.drive_route: {"poses": WAY, "gains": GAINS, "start": ORIGIN, "stop": True}
    | {"duration": 1.0, "arrival_radius": 0.1, "pass_radius": 1.0},
    wmr.modes: {"gains": GAINS, "law": "corrected"},
    wmr.paper.outdoor: {"x_axis": "east"},
    wmr.paper.circle: {"t": 1.0},
    translate: {"polar": (1.0, 0.5, 0.2), "source": "aicardi", "target": "corke"},
    gains_near_goal: {"gains": GAINS, "convention": "corke"},
    sphere_error: {"lat": 33.0, "bearing": 1.0, "radius": 10.0},
}
# Tested where their files are.
ELSEWHERE = {"read_track", "write_geojson", "write_gpx"}
ELSEWHERE |= {"gain_map", "gains_for", "longest_step"}
NAMED = {  # what a text may call an argument that consists of others
    "matrix": ("matrix",),
    "polar": ("polar", "third angle", "rho", "alpha"),
    "points": ("points",),
    "dt": ("dt", "last_turn"),
}


class Unreadable:
    """Refuses to be an array, and to be shown."""

    def __array__(self, *_, **__):
        raise TypeError("not an array")

    def __repr__(self):
        raise RuntimeError("not a text")


LOOP = []
LOOP.append(LOOP)
ODD = [
    *("", "north", b"1", "3", 1j, ..., NotImplemented),
    *(np.datetime64("2026-01-01"), date(2026, 1, 1)),
    *({}, {1: 2}, {"x": 1.0}, set(), frozenset({1}), object(), Unreadable(), int, np.sin, LOOP),
    *(10**400, -(10**400), 10**5000, [1, 10**400], [1.0, 10**400], float("nan"), float("inf")),
    *([[1.0], [1.0, 2.0]], [None], [[]], [object()], ["a", 1.0], np.array([None, 1.0], object)),
    *(np.ma.masked, np.ma.array([1.0], mask=[True]), [np.ma.array([1.0, 2.0], mask=[True, False])]),
    *(np.zeros(3, "V8"), np.array(["a"]), np.zeros((2, 0), complex), range(0), iter([])),
    *(wmr.PolarError("a", None, 1.0), wmr.PolarError(10**400, 0, 0), wmr.Wheels(None, "fast")),
    *(wmr.Wheels([1.0, [2.0]], 1.0), wmr.Wheels(1.0, 10**400), (1.0,), (1.0, "a", 2.0)),
    *(Decimal(1), Fraction(1, 3), np.array([1 + 1j]), memoryview(b"12"), [True, 1.0], -1.0),
]


def valid_arguments(function):
    """What a function takes, with what is driven first."""
    valid = VALID[function]
    return valid | {name: make() for name, make in DRIVEN.items() if name in valid}


def refusal_of(function, *arguments, **named):
    """The text of the ValueError that comes, or nothing; no other error may come."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", UserWarning)
            warnings.simplefilter("error", DeprecationWarning)
            with np.errstate(all="ignore"):
                function(*arguments, **named)
    except ValueError as error:
        return str(error)
    return ""


def refused(function, arguments, name):
    """Whether a ValueError comes, whose text names the argument."""
    text = refusal_of(function, **arguments)
    assert not text or any(word in text for word in (name, *NAMED.get(name, ()))), (name, text)
    return bool(text)


def test_every_public_function_is_among_them():
    public = [getattr(wmr, name) for name in wmr.__all__ if name not in ELSEWHERE]
    public += [getattr(wmr.paper, name) for name in ("outdoor", "circle")]
    functions = {member for member in public if inspect.isfunction(member)}
    assert functions <= set(VALID)
    for function in VALID:
        arguments = valid_arguments(function)
        function(**arguments)
        if isinstance(function, FunctionType):
            parameters = inspect.signature(function).parameters
            flags = {"options", "trajectories", "progress", "executor"}
            assert set(arguments) == set(parameters) - flags, function


@pytest.mark.parametrize("function", VALID, ids=lambda function: function.__name__)
def test_odd_arguments_are_refused_by_name(function):
    valid = valid_arguments(function)
    for name in valid:
        for odd in ODD:
            if name not in ("reference", "law") or not callable(odd):  # its own errors are its own
                refused(function, valid | {name: odd}, name)
        no_numbers = (float("inf"), *([] if name == "headings" else [float("nan")]))
        for odd in (object(), 10**5000, LOOP, Unreadable(), np.ma.masked, *no_numbers):
            assert refused(function, valid | {name: odd}, name), (name, type(odd))


BOUNDS = {  # a value just beyond what is allowed, what is needed, and the arguments that need it
    ("Corrected", "one of '"): "law method x_axis source target convention",
    (-1e-9, "a finite number at least 0"): "rho h k_rho k_alpha k_x k_heading distance sigma memory"
    " period delay heading_delay arrival_radius pass_radius"
    " hysteresis sight",
    (0.0, "a finite number above 0"): "radius track_width L v_max k_y dt duration last",
    (90.1, "a finite number at least -90 and at most 90"): "lat",
    (-180.1, "a finite number at least -180 and at most 180"): "lon",
}
BEYOND = [
    (function, name, odd, needed)
    for (odd, needed), names in BOUNDS.items()
    for function, name in product(VALID, names.split())
    if name in VALID[function] and (function, name) != (wmr.polar_rate, "rho")
]


@pytest.mark.parametrize(("function", "name", "odd", "needed"), BEYOND)
def test_what_is_just_beyond_a_bound_is_refused_with_what_is_needed(function, name, odd, needed):
    odd = -1e-9 if (function, name) == (wmr.advance, "dt") else odd  # 0 s are allowed there
    text = refusal_of(function, **(valid_arguments(function) | {name: odd}))
    assert text.startswith(f"{name} = {odd!r} is not allowed: {needed.split(' above')[0]}")
    assert "at least 0" in text or needed in text


@pytest.mark.parametrize("function", VALID, ids=lambda function: function.__name__)
def test_arrays_of_other_lengths_are_refused_with_their_shapes(function):
    valid = valid_arguments(function)
    numbers = {
        name: value
        for name, value in valid.items()
        if type(value) is float and not refusal_of(function, **(valid | {name: np.full(2, value)}))
    }
    for (one, first), (other, second) in combinations(numbers.items(), 2):
        shapes = {one: np.full(2, first), other: np.full(3, second)}
        text = refusal_of(function, **(valid | shapes))
        assert text.startswith("mismatched lengths: ")
        assert f"{one} has shape (2,)" in text
        assert f"{other} has shape (3,)" in text


REFERENCES = [
    lambda t: None,
    lambda t: wmr.Reference(None, 0.0, 0.0, 0.0, 0.0),
    lambda t: wmr.Reference(np.zeros(3), 0.0, 0.0, 0.0, 0.0),
    lambda t: wmr.Reference(np.zeros((2, t.size)), 0.0, 0.0, 0.0, 0.0),
    lambda t: wmr.Reference(10**400, 0.0, 0.0, 0.0, 0.0),
    lambda t: wmr.Reference(np.ma.array(t, mask=t > 0.5), 0.0, 0.0, 0.0, 0.0),
    lambda t: wmr.Reference("here", 0.0, 0.0, 0.0, 0.0),
]


@pytest.mark.parametrize("reference", REFERENCES)
def test_what_a_reference_returns_is_named(reference):
    with pytest.raises(ValueError, match=r"reference\(t\)"):
        wmr.track(reference, ORIGIN, GAINS, duration=1.0)


class Quantity:
    """A number with a unit, which numpy reads without it; tests/test_units.py has real ones."""

    units = "degree"

    def __array__(self, dtype=None, copy=None):
        return np.asarray(1.0, dtype)


WITHOUT_UNIT = {"h", "matrix"}


@pytest.mark.parametrize("function", VALID, ids=lambda function: function.__name__)
def test_a_number_with_a_unit_is_refused_with_the_documented_one(function):
    text = inspect.getdoc(function)
    also = [getattr(wmr, name, None) for name in text.split("`")[1::2]]  # "as for `control_law`"
    documented = "".join(map(inspect.getdoc, [function, *filter(None, also)]))
    for name, value in valid_arguments(function).items():
        if type(value) is float or name == "matrix":
            text = refusal_of(function, **(valid_arguments(function) | {name: Quantity()}))
            assert text.startswith(f"{name} = <")
            needed, _, unit = text.partition(" with a unit: give ")
            assert needed.endswith("Quantity"), text
            if name in WITHOUT_UNIT:
                assert unit == "a plain number, in the documented unit"
            else:
                unit = unit.removeprefix("the number in ").split()[0]
                assert unit in documented, (name, unit)
