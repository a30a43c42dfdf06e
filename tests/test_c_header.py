"""The printed C header, compiled, against wmrlib: in double to rounding, in float to a few of its roundings."""

import ctypes
import math
import os
import shutil
import subprocess

import numpy as np
import pytest
import sympy as sp

import wmrlib as wmr
from wmrlib import symbolic

CC = shutil.which("cc") or shutil.which("gcc")
CXX = shutil.which("c++") or shutil.which("g++")
STRICT = [
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pedantic",
    "-Wconversion",
    "-Wdouble-promotion",
    "-ffp-contract=off",
    "-O2",
]
FOLDER = symbolic.C_HEADER.parent
GENTLE, LIMITS = wmr.Gains(0.2, 2.0, 2.0, 4.0), wmr.WheelLimits(0.5, 2.0)
REALS = {
    "double": (ctypes.c_double, 1e-13),
    "float": (ctypes.c_float, 4e-6),
}  # float: about 32 roundings of 1.2e-7
LAWS = {"corrected": "wmr_law", "printed": "wmr_law_printed", "aicardi": "wmr_law_aicardi"}
CALLS = "".join(
    f"void {name}(const R *s, R *out) {{ wmr_polar e = {{s[0], s[1], s[2]}}; wmr_gains g = {{s[3], s[4], s[5], s[6]}};"
    f" wmr_twist t = {function}(e, g); out[0] = t.v; out[1] = t.omega; out[2] = (R)t.status; }}\n"
    for name, function in LAWS.items()
)
CALLS += """
void polar(const R *s, R *out) { wmr_pose p = {s[0], s[1], s[2]}; wmr_pose g = {s[3], s[4], s[5]};
  wmr_polar e = wmr_polar_error(p, g); out[0] = e.rho; out[1] = e.alpha; out[2] = e.theta; }
void wheels(const R *s, R *out) { wmr_twist t = {s[0], s[1], WMR_OK}; wmr_wheels w = wmr_limited_wheels(t, s[2], s[3]);
  out[0] = w.left; out[1] = w.right; out[2] = (R)w.status; }
void wrapped(const R *s, R *out) { out[0] = wmr_wrap(s[0]); }
void energy(const R *s, R *out) { out[0] = wmr_lyapunov_value(s[0], s[1], s[2], s[3], s[4]); }
void local(const double *s, double *out) { wmr_local_position(s[0], s[1], s[2], s[3], out, out + 1); }
"""


@pytest.fixture(scope="module", autouse=True)
def compiler():
    if not CC and "CI" in os.environ:
        pytest.fail("a C compiler is needed")
    if not CC:
        pytest.skip("there is no C compiler")


def build(command, source, folder, *options):
    subprocess.run(
        [
            *command,
            *STRICT,
            f"-I{FOLDER}",
            *options,
            str(source),
            "-o",
            str(folder / "built"),
            "-lm",
        ],
        check=True,
    )
    return folder / "built"


@pytest.fixture(scope="module", params=REALS)
def compiled(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(request.param)
    (folder / "calls.c").write_text(
        f'#define WMR_REAL {request.param}\n#include "wmr_law.h"\ntypedef WMR_REAL R;\n' + CALLS
    )
    library = ctypes.CDLL(
        str(build([CC, "-std=c99"], folder / "calls.c", folder, "-shared", "-fPIC"))
    )
    kind, tolerance = REALS[request.param]

    def call(name, *values, kind=kind):
        out = (kind * 3)()
        getattr(library, name)((kind * len(values))(*values), out)
        return np.array(out[:], dtype=float)

    return call, tolerance


def rounded(values, tolerance):
    """The values as the C program is given them."""
    return [float(np.float32(value)) if tolerance > 1e-10 else value for value in values]


def states(count=2000):
    rng = np.random.default_rng(5)
    angles, gains = rng.uniform(-math.pi, math.pi, (2, count)), rng.uniform(0.05, 5, (4, count))
    drawn = np.column_stack([10 ** rng.uniform(-6, 3, count), *angles, *gains])
    distances, alphas = (
        (0, 1e-30, 1e-9, 1e-8, 1, 1e6),
        (0, 1e-30, -1e-8, 2e-8, 1.5, 3.14, -3.14, math.pi, -math.pi),
    )
    edges = [
        (rho, alpha, theta, 2.0, 1.0, 0.3, 4.0)
        for rho in distances
        for alpha in alphas
        for theta in (0, -3)
    ]
    return [*drawn.tolist(), *edges]


def test_the_committed_header_is_what_is_printed():
    assert symbolic.C_HEADER.read_text(encoding="utf-8") == symbolic.c_header(), (
        "run python -m wmrlib.symbolic"
    )


@pytest.mark.parametrize("law", LAWS)
def test_the_laws_are_those_of_wmrlib(compiled, law):
    call, tolerance = compiled
    for state in states():
        state = rounded(state, tolerance)
        v, omega, status = call(law, *state)
        rho, alpha, theta, *gains = state
        expected = wmr.control_law(rho, alpha, theta, wmr.Gains(*gains), law=law)
        pull = max(gains[0] * gains[3], gains[0])
        size = gains[1] * abs(alpha) + pull * (abs(alpha) + gains[2] * abs(theta)) + 1e-30
        assert status == 0
        assert abs(v - expected[0]) <= tolerance * pull * rho
        assert abs(omega - expected[1]) <= tolerance * size


def test_poses_angles_wheels_and_energy(compiled):
    call, tolerance = compiled
    rng = np.random.default_rng(6)
    for _ in range(2000):
        poses = rounded(rng.uniform(-3, 3, 6), tolerance)
        expected = wmr.polar_error(wmr.Pose(*poses[:3]), wmr.Pose(*poses[3:]))
        got = call("polar", *poses)
        assert abs(got[0] - expected.rho) < 10 * tolerance
        assert abs(wmr.wrap_angle(got[1:] - expected[1:])).max() < 3 * tolerance * (
            1 + 1 / expected.rho
        )
        v, omega, width, fastest = rounded(rng.uniform((-5, -5, 0.1, 0.1), (5, 5, 2, 4)), tolerance)
        limited = wmr.limit_wheels(v, omega, wmr.WheelLimits(width, fastest))
        left, right, status = call("wheels", v, omega, width, fastest)
        assert [left, right] == pytest.approx(
            wmr.twist_to_wheels(*limited, width), abs=10 * tolerance
        )
        assert status == 0
        values = rounded(rng.uniform((0, -3, -3, 0.1, 0.5), (3, 3, 3, 2, 2)), tolerance)
        assert call("energy", *values)[0] == pytest.approx(
            wmr.lyapunov(*values), rel=10 * tolerance
        )
    for angle in (0, math.pi, -math.pi, 3.2, -3.2, 9.0, -9.0, 50.0):
        assert call("wrapped", angle)[0] % (2 * math.pi) == pytest.approx(
            angle % (2 * math.pi), abs=20 * tolerance
        )
        assert abs(call("wrapped", angle)[0]) <= math.pi + tolerance
    assert call("polar", 1, 2, 0.5, 1, 2, 0.5)[0] == 0


def test_what_is_out_of_range_stops_the_robot(compiled):
    call, _ = compiled
    good = [1.0, 0.5, -0.5, 2.0, 1.0, 0.3, 4.0]
    for law in LAWS:
        assert call(law, *good)[2] == 0
        for place in (0, 3, 4, 5, 6):
            assert call(law, *good[:place], -1.0, *good[place + 1 :]).tolist() == [0, 0, 1], (
                law,
                place,
            )
            state = [*good[:place], 0.0, *good[place + 1 :]]
            assert call(law, *state)[2] == (place == 6), (
                law,
                place,
            )  # 0 shows what a gain does, but v_max has to be above 0
        assert call(law, *good[:3], 0.0, 0.0, 0.0, 0.0).tolist() == [0, 0, 1]  # wmr_gains {0}
    for place in (2, 3):
        for value in (0.0, -1.0):
            wheels = [1.0, 0.5, 0.4, 2.0]
            wheels[place] = value
            assert call("wheels", *wheels).tolist() == [0, 0, 1]


def test_an_infinite_top_speed_is_no_limit(compiled):
    call, tolerance = compiled
    assert call("wheels", 100.0, 5.0, 0.5, math.inf) == pytest.approx(
        [98.75, 101.25, 0], rel=tolerance
    )


OFF_EARTH = [(0, 90.1), (0, -90.1), (0, 95.0), (2, 95.0), (1, 180.1), (3, -180.1), (3, 359.0)]
OFF_EARTH += [(place, value) for place in range(4) for value in (math.nan, math.inf, -math.inf)]


@pytest.mark.parametrize(("place", "value"), OFF_EARTH)
def test_a_point_that_is_not_on_the_earth_stops_the_robot(compiled, place, value):
    call, _ = compiled
    points = [33.273572, 44.373160, 33.274087, 44.373264]
    points[place] = value
    east, north, _ = call("local", *points, kind=ctypes.c_double)
    assert math.isnan(east)
    assert math.isnan(north)
    error = call("polar", 0.0, 0.0, 1.2, east, north, -1.0)
    for law in LAWS:
        assert call(law, *error, 2.0, 1.0, 0.3, 4.0).tolist() == [0, 0, 1]


def test_the_edges_of_the_map_are_on_the_earth(compiled):
    call, _ = compiled
    for points in (
        (90.0, 180.0, 89.9999, -180.0),
        (-90.0, -180.0, -89.9999, 180.0),
        (0.0, 180.0, 0.0, -180.0),
    ):
        a, b = (
            wmr.GeoPoint(lat=points[0], lon=points[1]),
            wmr.GeoPoint(lat=points[2], lon=points[3]),
        )
        assert call("local", *points, kind=ctypes.c_double)[:2] == pytest.approx(
            wmr.local_position(a, b), abs=1e-8
        )


@pytest.mark.parametrize("option", ["-ffast-math", "-ffinite-math-only"])
def test_a_compiler_that_knows_no_nan_is_refused(tmp_path, option):
    (tmp_path / "empty.c").write_text('#include "wmr_law.h"\nint main(void) { return 0; }\n')
    build([CC, "-std=c99"], tmp_path / "empty.c", tmp_path)
    told = subprocess.run(
        [CC, option, f"-I{FOLDER}", "-fsyntax-only", str(tmp_path / "empty.c")],
        capture_output=True,
        text=True,
    )
    assert told.returncode
    assert "wmr_law.h needs NaN and infinity" in told.stderr


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_stops_the_robot(compiled, bad):
    call, _ = compiled
    good = [1.0, 0.5, -0.5, 2.0, 1.0, 0.3, 4.0]
    for law in LAWS:
        for place in range(7):
            state = [*good[:place], bad, *good[place + 1 :]]
            assert call(law, *state).tolist() == [0, 0, 1], (law, place)
        assert call(law, -1.0, *good[1:]).tolist() == [0, 0, 1]
    for place in range(4):
        values = [1.0, 0.5, 0.4, 2.0]
        values[place] = bad
        if place < 3 or bad != math.inf:  # an infinite top speed is no limit
            assert call("wheels", *values).tolist() == [0, 0, 1]


def test_gps_points_stay_in_double(compiled):
    call, _ = compiled
    rng = np.random.default_rng(7)
    for lat, lon, north, east in rng.uniform((-80, -179, -1, -1), (80, 179, 1, 1), (1000, 4)):
        a, b = (
            wmr.GeoPoint(lat=lat, lon=lon),
            wmr.GeoPoint(lat=lat + 1e-2 * north, lon=lon + 1e-2 * east),
        )
        got = call("local", a.lat, a.lon, b.lat, b.lon, kind=ctypes.c_double)[:2]
        assert got == pytest.approx(wmr.local_position(a, b), abs=1e-9)


def test_the_geodesy_is_the_papers():
    e = symbolic.EQUATIONS
    own = {name: formula.value for name, formula in symbolic.GEODESY.items()}
    assert own["epsilon"] == e[13].rhs
    assert (
        sp.simplify(
            (own["epsilon"] + own["rest"] - 1)
            .rewrite(sp.exp)
            .subs(symbolic.dlat, symbolic.lat2 - symbolic.lat1)
        )
        == 0
    )
    assert own["zeta_x"] == e[16].rhs
    difference = own["zeta_y"].subs(symbolic.dlat, symbolic.lat2 - symbolic.lat1) - e[17].rhs
    assert sp.simplify(sp.expand_trig(difference).rewrite(sp.exp)) == 0


def python_drive():
    """The example's drive, by wmrlib."""
    east, north = wmr.local_position(wmr.paper.GPS_POINT_1, wmr.paper.GPS_POINT_2)
    pose, goal = wmr.Pose(0.0, 0.0, math.radians(72)), wmr.Pose(east, north, math.radians(-60))
    count = 0
    while (error := wmr.polar_error(pose, goal)).rho > 0.05:
        pose, count = (
            wmr.advance(pose, *wmr.limit_wheels(*wmr.control_law(*error, GENTLE), LIMITS), 0.05),
            count + 1,
        )
    return count, *pose


@pytest.mark.parametrize(("real", "tolerance"), [("double", 2e-9), ("float", 2e-3)])
def test_the_examples_drive_is_wmrlibs(tmp_path, real, tolerance):
    program = build([CC, "-std=c99"], FOLDER / "example.c", tmp_path, f"-DWMR_REAL={real}")
    count, *pose = map(
        float,
        subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout.split(),
    )
    expected = python_drive()
    assert abs(count - expected[0]) <= (0 if real == "double" else 1)
    assert pose == pytest.approx(expected[1:], abs=tolerance)


@pytest.mark.parametrize("real", REALS)
def test_it_is_cpp_too(tmp_path, real):
    if not CXX:
        pytest.skip("there is no C++ compiler")
    (tmp_path / "empty.cpp").write_text(
        f'#define WMR_REAL {real}\n#include "wmr_law.h"\nint main() {{ return 0; }}\n'
    )
    build([CXX, "-std=c++11"], tmp_path / "empty.cpp", tmp_path)
