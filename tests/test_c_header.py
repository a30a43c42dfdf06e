"""The printed C header, compiled, against wmrlib: double to rounding, float to a few roundings."""

import ctypes
import math
import re
import shutil
import subprocess

import avr
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib import symbolic
from wmrlib.motion import keep_branch

CC = shutil.which("cc") or shutil.which("gcc")
CXX = shutil.which("c++") or shutil.which("g++")
STRICT = "-Wall -Wextra -Werror -pedantic -Wconversion -Wdouble-promotion -ffp-contract=off -O2"
FOLDER = symbolic.C_HEADER.parent
REALS = {"double": (ctypes.c_double, 1e-13), "float": (ctypes.c_float, 4e-6)}
GIVEN = {"local": ctypes.c_double, "local_e7": ctypes.c_int32}
LAWS = {name.removeprefix("law_").replace("law", "corrected"): name for name in symbolic.c_laws()}
CALLS = "".join(
    f"""void {name}(const R *s, R *out) {{
    wmr_polar e = {{s[0], s[1], s[2]}}; wmr_gains g = {{s[3], s[4], s[5], s[6]}};
    wmr_twist t = wmr_{function}(e, g); out[0] = t.v; out[1] = t.omega; out[2] = (R)t.status; }}
"""
    for name, function in LAWS.items()
)
CALLS += """
void polar(const R *s, R *out) { wmr_pose p = {s[0], s[1], s[2]}; wmr_pose g = {s[3], s[4], s[5]};
  wmr_polar e = wmr_polar_error(p, g); out[0] = e.rho; out[1] = e.alpha; out[2] = e.theta; }
void wheels(const R *s, R *out) { wmr_twist t = {s[0], s[1], WMR_OK};
  wmr_wheels w = wmr_limited_wheels(t, s[2], s[3]);
  out[0] = w.left; out[1] = w.right; out[2] = (R)w.status; }
void wrapped(const R *s, R *out) { out[0] = wmr_wrap(s[0]); }
void energy(const R *s, R *out) { out[0] = wmr_lyapunov_value(s[0], s[1], s[2], s[3], s[4]); }
void local(const double *s, R *out) {
  wmr_local_position(s[0], s[1], s[2], s[3], out, out + 1); }
void local_e7(const int32_t *s, R *out) {
  wmr_local_position_e7(s[0], s[1], s[2], s[3], out, out + 1); }
void branch(const R *s, R *out) { out[0] = wmr_keep_branch(s[0], s[1], s[2]); }
"""
AVR = """#include "wmr_drive.h"
#include <avr/pgmspace.h>
static uint16_t most = 0; /* of avr.py, which counts cycles */
typedef struct { int32_t gps[4]; float heading, goal_heading; wmr_gains gains; } drive;
static const drive DRIVES[] PROGMEM = {@drives@};
int main(void) {
  for (unsigned i = 0; i < sizeof DRIVES / sizeof *DRIVES; ++i) {
    drive d;
    memcpy_P(&d, &DRIVES[i], sizeof d);
    wmr_pose pose = {0, 0, d.heading}, goal = {0, 0, d.goal_heading};
    wmr_local_position_e7(d.gps[0], d.gps[1], d.gps[2], d.gps[3], &goal.x, &goal.y);
    wmr_twist twist = wmr_law(wmr_polar_error(pose, goal), d.gains);
    wmr_wheels wheels = wmr_limited_wheels(twist, 0.5F, 2.0F);
    printf("goes %.8e %.8e %.8e %.8e\\n", goal.x, goal.y, wheels.left, wheels.right);
  }
  return 0;
}
"""
STATE, WHEELS = [1.0, 0.5, -0.5, 2.0, 1.0, 0.3, 4.0], [1.0, 0.5, 0.4, 2.0]
STOP = [0, 0, 1]


compiler = pytest.mark.needs("compiler")


def build(source, folder, *options, compiler=(CC, "-std=c99")):
    program = folder / "built"
    command = [*compiler, *STRICT.split(), f"-I{FOLDER}", *options, source, "-o", program, "-lm"]
    subprocess.run(list(map(str, command)), check=True)
    return program


def library(header, calls, real, folder, *options):
    """A header with these calls of its functions, of numbers R."""
    head = f'#define WMR_REAL {real}\n#include "{header}"\ntypedef WMR_REAL R;\n'
    (folder / "calls.c").write_text(head + calls)
    options = "-shared", "-fPIC", "-Wno-unused-function", *options
    return ctypes.CDLL(str(build(folder / "calls.c", folder, *options)))


@pytest.fixture(scope="module", params=REALS)
def compiled(request, tmp_path_factory):
    """(call a function of the header, tolerance, round a number to the header's type)."""
    kind, tolerance = REALS[request.param]
    built = library("wmr_law.h", CALLS, request.param, tmp_path_factory.mktemp(request.param))

    def call(name, *values):
        out, given = (kind * 3)(), GIVEN.get(name, kind)
        getattr(built, name)((given * len(values))(*values), out)
        return np.array(out[:], dtype=float)

    return call, tolerance, lambda values: [kind(value).value for value in values]


def replaced(values, place, value):
    return [*values[:place], value, *values[place + 1 :]]


def states(count=300):
    rng = np.random.default_rng(5)
    angles, gains = rng.uniform(-math.pi, math.pi, (2, count)), rng.uniform(0.05, 5, (4, count))
    drawn = np.column_stack([10 ** rng.uniform(-6, 3, count), *angles, *gains])
    alphas = (0, 1e-30, -1e-8, 2e-8, 1.5, 3.14, -3.14, math.pi, -math.pi)
    edges = np.array(np.meshgrid((0, 1e-30, 1e-9, 1e-8, 1, 1e6), alphas, (0, -3))).reshape(3, -1)
    tuned = np.tile([2.0, 1.0, 0.3, 4.0], (edges.shape[1], 1))
    return [*drawn.tolist(), *np.hstack([edges.T, tuned]).tolist()]


@compiler
def test_the_laws_are_those_of_wmrlib(compiled):
    call, tolerance, rounded = compiled
    for state in map(rounded, states()):
        rho, alpha, theta, *gains = state
        steepest = max(gains[0] * gains[3], gains[0])
        size = gains[1] * abs(alpha) + steepest * (abs(alpha) + gains[2] * abs(theta)) + 1e-30
        for law in LAWS:
            v, omega, status = call(law, *state)
            expected = wmr.control_law(rho, alpha, theta, wmr.Gains(*gains), law=law)
            assert status == 0
            assert abs(v - expected[0]) <= tolerance * steepest * rho, (law, state)
            steep = 2.0 * abs(expected[1] * math.tan(theta / 2)) if law == "barrier" else 0.0
            assert abs(omega - expected[1]) <= tolerance * (size + steep), (law, state)


@compiler
def test_theta_keeps_its_branch(compiled):
    call, tolerance, rounded = compiled
    for state in np.random.default_rng(8).uniform((-3.1, -7.0, 0.0), (3.1, 7.0, 3.0), (300, 3)):
        theta, before, hysteresis = rounded(state)
        assert call("branch", theta, math.nan, hysteresis)[0] == theta
        expected = keep_branch(theta, before, hysteresis)
        off = math.remainder(theta - before, 2 * math.pi)  # at a border, rounding decides
        if math.pi - abs(off) > 1e-4 < abs(abs(before + off) - math.pi - hysteresis):
            kept = call("branch", theta, before, hysteresis)[0]
            assert kept == pytest.approx(expected, abs=4 * tolerance), state


@compiler
def test_poses_angles_wheels_and_energy(compiled):
    call, tolerance, rounded = compiled
    rng = np.random.default_rng(6)
    for _ in range(300):
        poses = rounded(rng.uniform(-3, 3, 6))
        expected = wmr.polar_error(wmr.Pose(*poses[:3]), wmr.Pose(*poses[3:]))
        got = call("polar", *poses)
        assert abs(got[0] - expected.rho) < 10 * tolerance
        turned = abs(wmr.wrap_angle(got[1:] - expected[1:])).max()
        assert turned < 3 * tolerance * (1 + 1 / expected.rho)
        v, omega, width, fastest = rounded(rng.uniform((-5, -5, 0.1, 0.1), (5, 5, 2, 4)))
        limited = wmr.limit_wheels(v, omega, wmr.Wheels(width, fastest))
        sides = [*wmr.twist_to_wheels(*limited, width), 0]
        assert call("wheels", v, omega, width, fastest) == pytest.approx(sides, abs=10 * tolerance)
        values = rounded(rng.uniform((0, -3, -3, 0.1, 0.5), (3, 3, 3, 2, 2)))
        energy = wmr.lyapunov(*values)
        assert call("energy", *values)[0] == pytest.approx(energy, rel=10 * tolerance)
    for angle in (0, math.pi, -math.pi, 3.2, -3.2, 9.0, -9.0, 50.0):
        got, turn = call("wrapped", angle)[0], 2 * math.pi
        assert got % turn == pytest.approx(angle % turn, abs=20 * tolerance)
        assert abs(got) <= math.pi + tolerance
    assert call("polar", 1, 2, 0.5, 1, 2, 0.5)[0] == 0
    no_limit = call("wheels", 100.0, 5.0, 0.5, math.inf)
    assert no_limit == pytest.approx([98.75, 101.25, 0], rel=tolerance)


@compiler
def test_what_is_no_number_or_out_of_range_stops_the_robot(compiled):
    call, _, _ = compiled
    never = (math.nan, math.inf, -math.inf)
    for law in LAWS:
        bad = [(place, value) for place in range(7) for value in never]
        bad += [(place, -1.0) for place in (0, 3, 4, 5, 6)] + [(6, 0.0)]
        for place, value in bad:
            assert call(law, *replaced(STATE, place, value)).tolist() == STOP, (law, place, value)
        for place in (0, 3, 4, 5):  # 0 shows what a gain does
            assert call(law, *replaced(STATE, place, 0.0))[2] == 0
        assert call(law, *STATE)[2] == 0
    bad = [
        (place, value) for place in range(4) for value in never if (place, value) != (3, math.inf)
    ]
    for place, value in bad + [(place, value) for place in (2, 3) for value in (0.0, -1.0)]:
        assert call("wheels", *replaced(WHEELS, place, value)).tolist() == STOP, (place, value)


@compiler
def test_a_point_that_is_not_on_the_earth_stops_the_robot(compiled):
    call, _, _ = compiled
    points = [33.273572, 44.373160, 33.274087, 44.373264]
    off = [(0, 90.1), (0, -90.1), (2, 95.0), (1, 180.1), (3, -180.1), (3, 200.0)]
    bad = [("local", *replaced(points, *change)) for change in off]
    bad += [("local_e7", *(round(1e7 * value) for value in point)) for _, *point in bad]
    never = (math.nan, math.inf, -math.inf, 359.0)
    bad += [("local", *replaced(points, k, value)) for k in (1, 3) for value in never]
    bad += [("local", *replaced(points, k, value)) for k in (0, 2) for value in never]
    integers = [round(1e7 * value) for value in points]
    no_fix = (-(2**31), 2**31 - 1)
    bad += [("local_e7", *replaced(integers, k, change)) for k in range(4) for change in no_fix]
    for name, *point in bad:
        east, north, _ = call(name, *point)
        assert math.isnan(east), (name, point)
        assert math.isnan(north), (name, point)
        error = call("polar", 0.0, 0.0, 1.2, east, north, -1.0)
        assert call("corrected", *error, *STATE[3:]).tolist() == STOP


latitudes = st.integers(-800_000_000, 800_000_000)
longitudes = st.integers(-1_800_000_000, 1_800_000_000)
apart = st.integers(-100_000, 100_000)  # up to 1.1 km


@compiler
@given(lat=latitudes, lon=longitudes, dlat=apart, dlon=apart)
@example(lat=0, lon=1_800_000_000, dlat=5_150, dlon=1_040)  # over the date line
@example(lat=0, lon=-1_800_000_000, dlat=0, dlon=-1)
def test_gps_points_as_degrees_and_as_integers(compiled, lat, lon, dlat, dlon):
    call, tolerance, _ = compiled
    date_line = 1_800_000_000
    points = [lat, lon, lat + dlat, (lon + dlon + date_line) % (2 * date_line) - date_line]
    degrees = [integer / 1e7 for integer in points]
    a = wmr.GeoPoint(lat=degrees[0], lon=degrees[1])
    b = wmr.GeoPoint(lat=degrees[2], lon=degrees[3])
    expected = wmr.local_position(a, b)
    close = 1e-8 + 0.2 * tolerance * math.hypot(*expected)  # in float under 1 mm of 1 km
    assert call("local_e7", *points)[:2] == pytest.approx(expected, abs=close)
    assert call("local", *degrees)[:2] == pytest.approx(expected, abs=close)


@compiler
def test_a_compiler_that_knows_no_nan_is_refused(tmp_path, capfd):
    (tmp_path / "empty.c").write_text('#include "wmr_law.h"\nint main(void) { return 0; }\n')
    build(tmp_path / "empty.c", tmp_path)
    with pytest.raises(subprocess.CalledProcessError):
        build(tmp_path / "empty.c", tmp_path, "-ffast-math")
    assert "wmr_law.h needs NaN and infinity" in capfd.readouterr().err


@compiler
@pytest.mark.skipif(not CXX, reason="this test needs a C++ compiler (Debian: apt install g++)")
@pytest.mark.parametrize("real", REALS)
def test_it_is_cpp_too(tmp_path, real):
    text = f'#define WMR_REAL {real}\n#include "wmr_law.h"\nint main() {{ return 0; }}\n'
    (tmp_path / "empty.cpp").write_text(text)
    build(tmp_path / "empty.cpp", tmp_path, compiler=(CXX, "-std=c++11"))


# On an ATmega328P, where double is float and <math.h> has no expm1.


@pytest.mark.needs("avr", "simavr")
def test_on_a_board_whose_double_has_4_bytes_it_is_as_good_as_in_float():
    rng = np.random.default_rng(8)
    places = rng.integers((-800_000_000, -1_790_000_000), (800_000_000, 1_790_000_000), (150, 2))
    points = np.hstack([places, places + rng.integers(-30_000, 30_000, places.shape)]).tolist()
    low, high = (-3, -3, 0.05, 0.1, 0.05, 0.5), (3, 3, 3, 3, 3, 4)
    floats = np.float32(rng.uniform(low, high, (len(points), 6))).tolist()
    drives = [*zip(points, floats, strict=True)]
    lines = [f"{{{{{gps}}}, {a!r}, {b!r}, {{{gains}}}}},\n" for gps, (a, b, *gains) in drives]
    text = "".join(lines).replace("[", "").replace("]", "")
    output, *_ = avr.printed_by(AVR.replace("@drives@", text))
    rows = re.findall(r"goes (.+)", output)
    assert len(rows) == len(drives)
    for row, (gps, (heading, goal_heading, *gains)) in zip(rows, drives, strict=True):
        east, north, *wheels = map(float, row.split())
        a, b = (wmr.GeoPoint(lat=gps[k] / 1e7, lon=gps[k + 1] / 1e7) for k in (0, 2))
        expected = wmr.local_position(a, b)
        assert (east, north) == pytest.approx(expected, abs=2e-4)
        error = wmr.polar_error(wmr.Pose(0, 0, heading), wmr.Pose(*expected, goal_heading))
        twist = wmr.control_law(*error, wmr.Gains(*gains))
        limited = wmr.limit_wheels(*twist, wmr.Wheels(0.5, 2.0))
        assert wheels == pytest.approx(wmr.twist_to_wheels(*limited, 0.5), abs=2e-5)


@pytest.mark.needs("avr")
def test_there_degrees_in_double_do_not_compile(find_tool, tmp_path, capfd):
    def board(call):
        head = '#define WMR_REAL float\n#include "wmr_law.h"\n'
        (tmp_path / "board.c").write_text(f"{head}int main(void) {{ float x, y; {call} }}\n")
        avr = find_tool("avr"), "-mmcu=atmega328p", "-std=c99"
        build(tmp_path / "board.c", tmp_path, "-Wno-double-promotion", compiler=avr)

    board("wmr_local_position_e7(332000000, 443000000, 333000000, 444000000, &x, &y);")
    with pytest.raises(subprocess.CalledProcessError):
        board("wmr_local_position(33.2, 44.3, 33.3, 44.4, &x, &y);")
    assert "a_double_has_4_bytes_here_call_wmr_local_position_e7" in capfd.readouterr().err
