"""The printed filter: what is committed is what is printed, and C does what Python does."""

import math

import numpy as np
import pytest
from compiled import INCLUDES
from driven import ARM, DT, FIRST, NOISE, drive
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from test_c_header import REALS, compiler, library

from wmrrobot import estimation, printing
from wmrrobot.estimation import Estimate


def test_what_is_committed_is_what_is_printed():
    for path, text in (
        (printing.PYTHON_MODULE, printing.python_module()),
        (printing.C_FILTER_HEADER, printing.c_filter_header()),
        (printing.C_DRIVE, printing.c_drive()),
    ):
        assert path.read_text(encoding="utf-8") == text, "run python -m wmrrobot"


CALLS = """
static wmr_filter filter;
void start(const R *s) { wmr_pose p = {s[0], s[1], s[2]};
  filter = wmr_filter_start(p, s[3], s[4], s[5], s[6]); }
int carry(const R *s) { wmr_noise n = {s[4], s[5], s[6], s[7], s[8], s[9]};
  return wmr_filter_predict(&filter, s[0], s[1], s[2], s[3], n, s[10]); }
int lost(const R *s) { return s[0] > 0 && wmr_filter_is_lost(&filter); }
int position(const R *s) {
  return wmr_filter_position(&filter, s[0], s[1], s[2], s[3], s[4], s[5]); }
int doubt(const R *s) { wmr_filter_doubt(&filter, s[0]); return 1; }
int heading(const R *s) { return wmr_filter_heading(&filter, s[0], s[1], s[2]); }
int course(const R *s) {
  return wmr_filter_course(&filter, s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7]); }
void tell(R *out) { int i, j, k = 0;
  wmr_pose p = wmr_filter_pose(&filter); out[k++] = p.x; out[k++] = p.y; out[k++] = p.heading;
  out[k++] = filter.state[3]; out[k++] = filter.state[4]; out[k++] = filter.surprise;
  for (i = 0; i < 5; ++i) for (j = 0; j < 5; ++j) out[k++] = filter.covariance[i][j]; }
"""


@pytest.fixture(scope="module", params=REALS)
def in_c(request, tmp_path_factory):
    """(the name of its numbers, call a function by name, tell the state as an Estimate)."""
    folder, (kind, _) = tmp_path_factory.mktemp(request.param), REALS[request.param]
    built = library("wmr_filter.h", CALLS, request.param, folder, *INCLUDES)

    def call(name, *values):
        return bool(getattr(built, name)((kind * len(values))(*values)))

    def tell():
        out = (kind * 31)()
        built.tell(out)
        numbers = np.array(out[:], dtype=float)
        return Estimate(numbers[:5], numbers[6:].reshape(5, 5), numbers[5])

    return request.param, call, tell


@compiler
def test_c_has_the_same_filter(in_c):
    kind, call, tell = in_c
    call("start", 1.0, -2.0, 0.4, 0.5, 0.2, 0.02, 0.03)
    ours, used, worst = FIRST, [], 0.0
    for n, ((v, omega, gyro), fix, heading) in enumerate(drive()):
        gyro += 0.5 * (n == 130)  # the wheels slip
        ours = estimation.predict(ours, v, omega, gyro, DT, NOISE)
        good = call("carry", v, omega, gyro, DT, *NOISE, estimation.GATE_1)
        used.append((good, math.isnan(gyro) or ours.surprise <= estimation.GATE_1))
        if n % 5 == 0:
            fix += 3.0 * (n == 200)  # a jump
            ours = estimation.use_position(ours, *fix, 0.02, **ARM)
            good = call("position", *fix, 0.02, *ARM.values(), estimation.GATE_2)
            used.append((good, ours.surprise <= estimation.GATE_2))
            if not good:
                factor = ours.surprise / estimation.GATE_2
                ours = estimation.doubt(ours, factor)
                call("doubt", factor)
        if n % 7 == 0:
            ours = estimation.use_heading(ours, heading, 0.05)
            good = call("heading", heading, 0.05, estimation.GATE_1)
            used.append((good, ours.surprise <= estimation.GATE_1))
        if n % 11 == 0:
            course = heading + (math.pi if v < 0 else 0.0)
            ours = estimation.use_course(ours, course, 0.3, v, omega, **ARM)
            good = call("course", course, 0.3, v, omega, *ARM.values(), 0.3, estimation.GATE_1)
            used.append((good, v != 0.0 and ours.surprise <= estimation.GATE_1))
        theirs = tell()
        scale = np.outer(ours.sigma, ours.sigma)
        off = np.abs(theirs.covariance - ours.covariance) / scale
        worst = max(worst, off.max(), (np.abs(theirs.state - ours.state) / ours.sigma).max())
    assert worst < {"double": 1e-9, "float": 5e-3}[kind]
    assert sum(not good for good, _ in used) >= 2
    assert all(one == other for one, other in used)


@compiler
def test_c_changes_nothing_for_a_number_that_is_none(in_c):
    _, call, tell = in_c
    call("start", 1.0, -2.0, 0.4, 0.5, 0.2, 0.02, 0.03)
    before = tell()
    for bad in (math.nan, math.inf):
        assert not call("carry", bad, 0.0, 0.0, 0.1, *NOISE, 10.0)
        assert not call("carry", 0.0, 0.0, 0.0, bad, *NOISE, 10.0)
        assert not call("position", 1.0, bad, 0.1, 0.0, 0.0, 10.0)
        assert not call("heading", bad, 0.1, 10.0)
        assert not call("heading", 0.4, bad, 10.0)
        assert not call("course", 0.4, 0.1, bad, 0.0, 0.0, 0.0, 0.3, 10.0)
    assert not call("carry", 0.0, 0.0, 0.0, 0.0, *NOISE, 10.0)
    assert not call("heading", 0.4, 0.0, 10.0)
    after = tell()
    assert (after.state == before.state).all()
    assert (after.covariance == before.covariance).all()


@compiler
def test_c_changes_nothing_for_a_speed_that_wheels_cannot_have(in_c):
    """As Python, which raises: a counter that begins anew reads 2,000 m/s for a period."""
    _, call, tell = in_c
    call("start", 1.0, -2.0, 0.4, 0.5, 0.2, 0.02, 0.03)
    noise, before = NOISE._replace(max_speed=2.0), tell()
    for v, omega, dt in ((-2000.0, 0.0, 0.05), (3.1, 0.0, 0.1), (2.0, 5.0, 0.1), (0.0, 0.0, 61.0)):
        assert not call("carry", v, omega, math.nan, dt, *noise, estimation.GATE_1)
        with pytest.raises(ValueError, match="not allowed"):
            estimation.predict(FIRST, v, omega, math.nan, dt, noise)
    after = tell()
    assert (after.state == before.state).all()
    assert (after.covariance == before.covariance).all()
    assert call("carry", 2.9, 0.0, math.nan, 0.1, *noise, estimation.GATE_1)


wild = st.floats(-(2.0**100), 2.0**100, width=32) | st.floats(-3.0, 3.0, width=32)


@compiler
@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@example([(99.0, 0.0, 0.0, 59.0, 0.0)] * 9)
@given(st.lists(st.tuples(wild, wild, wild, st.floats(0.0, 2.0**100, width=32), wild), max_size=30))
def test_after_whatever_it_was_told_c_finds_the_robot_again(in_c, nonsense):
    """It doubts after five refusals in a row, and begins anew from a fix when it is lost."""
    _, call, tell = in_c
    call("start", 0.0, 0.0, 0.0, 0.5, 0.2, 0.02, 0.03)
    for v, omega, gyro, dt, fix in nonsense:
        call("carry", v, omega, gyro, dt, *NOISE, estimation.GATE_1)
        call("position", fix, -fix, 0.02, 0.3, 0.0, estimation.GATE_2)
        call("heading", fix, 0.1, estimation.GATE_1)
    refused = 0
    for _ in range(60):
        call("carry", 0.0, 0.0, math.nan, 0.2, *NOISE, estimation.GATE_1)
        call("heading", 0.7, 0.1, estimation.GATE_1)
        used = call("position", 5.0, 6.0, 0.02, 0.0, 0.0, estimation.GATE_2)
        refused = 0 if used else refused + 1
        if refused >= 5:
            call("doubt", 4.0)
        if refused and call("lost", 1.0):
            call("start", 5.0, 6.0, 0.7, 0.02, 0.1, 0.02, 0.03)
    assert tell().state[:2] == pytest.approx((5.0, 6.0), abs=0.1)
