"""The printed C header, compiled, against wmrlib: double to rounding, float to a few roundings."""

import ctypes
import math
import shutil
import subprocess

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib import symbolic

pytestmark = pytest.mark.needs("compiler")
CC = shutil.which("cc") or shutil.which("gcc")
CXX = shutil.which("c++") or shutil.which("g++")
STRICT = "-Wall -Wextra -Werror -pedantic -Wconversion -Wdouble-promotion -ffp-contract=off -O2"
FOLDER = symbolic.C_HEADER.parent
REALS = {"double": (ctypes.c_double, 1e-13), "float": (ctypes.c_float, 4e-6)}
LAWS = {name.removeprefix("law_").replace("law", "corrected"): name for name in symbolic.C_LAWS}
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
void local(const double *s, double *out) {
  wmr_local_position(s[0], s[1], s[2], s[3], out, out + 1); }
"""
STATE, WHEELS = [1.0, 0.5, -0.5, 2.0, 1.0, 0.3, 4.0], [1.0, 0.5, 0.4, 2.0]
STOP = [0, 0, 1]


def build(source, folder, *options, compiler=(CC, "-std=c99")):
    program = folder / "built"
    command = [*compiler, *STRICT.split(), f"-I{FOLDER}", *options, source, "-o", program, "-lm"]
    subprocess.run(list(map(str, command)), check=True)
    return program


@pytest.fixture(scope="module", params=REALS)
def compiled(request, tmp_path_factory):
    """(call a function of the header, tolerance, round a number to the header's type)."""
    kind, tolerance = REALS[request.param]
    folder = tmp_path_factory.mktemp(request.param)
    head = f'#define WMR_REAL {request.param}\n#include "wmr_law.h"\ntypedef WMR_REAL R;\n'
    (folder / "calls.c").write_text(head + CALLS)
    library = ctypes.CDLL(str(build(folder / "calls.c", folder, "-shared", "-fPIC")))

    def call(name, *values, kind=kind):
        out = (kind * 3)()
        getattr(library, name)((kind * len(values))(*values), out)
        return np.array(out[:], dtype=float)

    return call, tolerance, lambda values: [kind(value).value for value in values]


def replaced(values, place, value):
    return [*values[:place], value, *values[place + 1 :]]


def states(count=1000):
    rng = np.random.default_rng(5)
    angles, gains = rng.uniform(-math.pi, math.pi, (2, count)), rng.uniform(0.05, 5, (4, count))
    drawn = np.column_stack([10 ** rng.uniform(-6, 3, count), *angles, *gains])
    alphas = (0, 1e-30, -1e-8, 2e-8, 1.5, 3.14, -3.14, math.pi, -math.pi)
    edges = np.array(np.meshgrid((0, 1e-30, 1e-9, 1e-8, 1, 1e6), alphas, (0, -3))).reshape(3, -1)
    tuned = np.tile([2.0, 1.0, 0.3, 4.0], (edges.shape[1], 1))
    return [*drawn.tolist(), *np.hstack([edges.T, tuned]).tolist()]


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
            assert abs(omega - expected[1]) <= tolerance * size, (law, state)


def test_poses_angles_wheels_and_energy(compiled):
    call, tolerance, rounded = compiled
    rng = np.random.default_rng(6)
    for _ in range(1000):
        poses = rounded(rng.uniform(-3, 3, 6))
        expected = wmr.polar_error(wmr.Pose(*poses[:3]), wmr.Pose(*poses[3:]))
        got = call("polar", *poses)
        assert abs(got[0] - expected.rho) < 10 * tolerance
        turned = abs(wmr.wrap_angle(got[1:] - expected[1:])).max()
        assert turned < 3 * tolerance * (1 + 1 / expected.rho)
        v, omega, width, fastest = rounded(rng.uniform((-5, -5, 0.1, 0.1), (5, 5, 2, 4)))
        limited = wmr.limit_wheels(v, omega, wmr.WheelLimits(width, fastest))
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


def test_a_point_that_is_not_on_the_earth_stops_the_robot(compiled):
    call, _, _ = compiled
    off = [(0, 90.1), (0, -90.1), (2, 95.0), (1, 180.1), (3, -180.1), (3, 359.0)]
    off += [(place, value) for place in range(4) for value in (math.nan, math.inf, -math.inf)]
    for place, value in off:
        points = replaced([33.273572, 44.373160, 33.274087, 44.373264], place, value)
        east, north, _ = call("local", *points, kind=ctypes.c_double)
        assert math.isnan(east)
        assert math.isnan(north)
        error = call("polar", 0.0, 0.0, 1.2, east, north, -1.0)
        assert call("corrected", *error, *STATE[3:]).tolist() == STOP


def test_gps_points_stay_in_double(compiled):
    call, _, _ = compiled
    rng = np.random.default_rng(7)
    start = rng.uniform((-80, -179), (80, 179), (500, 2))
    pairs = np.hstack([start, start + rng.uniform(-1e-2, 1e-2, (500, 2))]).tolist()
    edges = [(90.0, 180.0, 89.9999, -180.0), (-90.0, -180.0, -89.9999, 180.0)]
    for points in [*pairs, *edges, (0.0, 180.0, 0.0, -180.0)]:
        a = wmr.GeoPoint(lat=points[0], lon=points[1])
        b = wmr.GeoPoint(lat=points[2], lon=points[3])
        got = call("local", *points, kind=ctypes.c_double)[:2]
        assert got == pytest.approx(wmr.local_position(a, b), abs=1e-8)


@pytest.mark.parametrize("option", ["-ffast-math", "-ffinite-math-only"])
def test_a_compiler_that_knows_no_nan_is_refused(tmp_path, option):
    (tmp_path / "empty.c").write_text('#include "wmr_law.h"\nint main(void) { return 0; }\n')
    build(tmp_path / "empty.c", tmp_path)
    command = [CC, option, f"-I{FOLDER}", "-fsyntax-only", str(tmp_path / "empty.c")]
    told = subprocess.run(command, capture_output=True, text=True)
    assert told.returncode
    assert "wmr_law.h needs NaN and infinity" in told.stderr


@pytest.mark.parametrize(("real", "tolerance"), [("double", 2e-9), ("float", 2e-3)])
def test_the_examples_drive_is_wmrlibs(tmp_path, real, tolerance):
    program = build(FOLDER / "example.c", tmp_path, f"-DWMR_REAL={real}")
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    steps, *reached = map(float, printed.split())
    east, north = wmr.local_position(wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2)
    pose, goal = wmr.Pose(0.0, 0.0, math.radians(72)), wmr.Pose(east, north, math.radians(-60))
    limits, count = wmr.WheelLimits(0.5, 2.0), 0
    while (error := wmr.polar_error(pose, goal)).rho > 0.05:
        twist = wmr.control_law(*error, wmr.Gains(0.2, 2.0, 2.0, 4.0))
        pose, count = wmr.advance(pose, *wmr.limit_wheels(*twist, limits), 0.05), count + 1
    assert abs(steps - count) <= (0 if real == "double" else 1)
    assert reached == pytest.approx(list(pose), abs=tolerance)


@pytest.mark.skipif(not CXX, reason="this test needs a C++ compiler (Debian: apt install g++)")
@pytest.mark.parametrize("real", REALS)
def test_it_is_cpp_too(tmp_path, real):
    text = f'#define WMR_REAL {real}\n#include "wmr_law.h"\nint main() {{ return 0; }}\n'
    (tmp_path / "empty.cpp").write_text(text)
    build(tmp_path / "empty.cpp", tmp_path, compiler=(CXX, "-std=c++11"))
