"""Records of numbers and arrays: shown in a few lines and compared by one bool."""

import math

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib.runs import Arrival, Trajectories
from wmrlib.tuning import Modes

RECORDS = [
    *(wmr.Pose, wmr.PolarError, wmr.Reference, wmr.Gains, wmr.KanayamaGains, wmr.GeoPoint),
    *(wmr.Receiver, wmr.Wheels, wmr.LastTurn, Arrival, Trajectories, Modes),
]


def filled(kind, value):
    """A record with the value in each field."""
    names = getattr(kind, "_fields", None) or kind.__slots__
    return kind(**dict.fromkeys(names, value)), names


@pytest.mark.parametrize("kind", RECORDS, ids=lambda kind: kind.__name__)
def test_a_record_of_any_size_is_shown_in_a_few_lines(kind):
    for shape in ((0,), (3,), (30,), (2, 3), (40, 30), (100_000,)):
        one, names = filled(kind, np.linspace(0.1, 0.7, math.prod(shape)).reshape(shape))
        lines = repr(one).split("\n")
        assert len(lines) <= len(names)
        assert max(map(len, lines)) <= (88 if len(lines) > 1 else 3 * 88)
        for name in names:
            assert f"{name}=" in repr(one)
    assert "=<100000 numbers, from 0.1 to 0.7>" in repr(one)


@pytest.mark.parametrize("kind", RECORDS, ids=lambda kind: kind.__name__)
def test_records_are_equal_if_all_their_numbers_are(kind):
    for value in (0.5, [0.5], [0.5, 0.25], [[0.5], [0.25]], np.full(1000, 0.5)):
        value = value if type(value) is float else np.array(value)
        one, names = filled(kind, value)
        other, _ = filled(kind, np.copy(value) if np.ndim(value) else value)
        assert (one == other, one != other) == (True, False)
        for changed in (value + 0.125, np.append(value, 0.5), np.full(1, 0.5), 0.5, 0.25):
            if np.shape(changed) != np.shape(value) or not np.array_equal(changed, value):
                other, _ = filled(kind, changed)
                assert (one == other, one != other) == (False, True)
        assert one != "another thing"
        assert one != tuple(range(len(names) + 1))


def test_a_record_of_numbers_is_shown_and_hashed_as_it_was():
    assert repr(wmr.Pose(1, 2.5, 0.1)) == "Pose(x=1.0, y=2.5, heading=0.1)"
    assert repr(wmr.GeoPoint(lat=33.5, lon=44)) == "GeoPoint(lat=33.5, lon=44.0)"
    assert repr(wmr.Gains(1, 2, [1, 2])) == (
        "Gains(k_rho=1.0, k_alpha=2.0, h=array([1., 2.]), v_max=4.0)"
    )
    assert wmr.Pose(1, 2, 3) == (1.0, 2.0, 3.0)
    points = {wmr.GeoPoint(lat=33.5, lon=44), wmr.GeoPoint(lat=33.5, lon=44.0)}
    assert len(points) == len({wmr.Pose(1, 2, 3), wmr.Pose(1.0, 2.0, 3.0)}) == 1


def test_what_is_missing_is_counted():
    values = np.array([math.nan, math.inf, math.inf, *np.full(100, 0.25)])
    runs = Arrival(np.isfinite(values), values, *[0.0] * 4)
    assert "arrived=<103 bools, 100 of them True>" in repr(runs)
    assert "time=<103 numbers, 0.25, 2 infinite, 1 NaN>" in repr(runs)
    poles = wmr.modes(wmr.Gains(np.linspace(0.1, 1.0, 100), 2.0, 2.0)).poles
    assert "poles=(<100 numbers, real part from -4 to -0.4>" in repr(Modes(*[0.0] * 4, poles, 1, 1))
    assert Modes(*[0.0] * 4, poles, 1, 1) != Modes(*[0.0] * 4, poles[::-1], 1, 1)
