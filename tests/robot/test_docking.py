"""The law as Nav2's docking server calls it, compiled against the real message headers."""

import ctypes
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import wmrlib as wmr
from wmrlib import symbolic
from wmrlib.body import hurry

INCLUDE = Path(sys.prefix, "include")
if not os.environ.get("WMR_INTERFACES"):  # which CI sets: there it must be present
    pytest.importorskip("rclpy", reason="this test needs rclpy: pip install '.[robot]' on Linux")
pytestmark = pytest.mark.needs("compiler")
FOLDER = Path(__file__).parents[2] / "book" / "robot" / "ros2" / "wmr_docking"
WHEELS = wmr.Wheels(0.5, max_speed=1.0, min_speed=0.1)
CALL = """#include "docking.hpp"
static const wmr_docking::Law law({0.2, 2.0, 2.0, 4.0}, {0.5, 1.0, 0.1, 2.0, 0.2, 1.0, 0.5});
extern "C" int command(double x, double y, double yaw, int backward, double *out) {
  geometry_msgs::msg::Pose pose;
  geometry_msgs::msg::Twist cmd;
  pose.position.x = x, pose.position.y = y;
  pose.orientation.z = std::sin(yaw / 2), pose.orientation.w = std::cos(yaw / 2);
  const bool good = law.computeVelocityCommand(pose, cmd, true, backward);
  out[0] = cmd.linear.x, out[1] = cmd.angular.z;
  return good;
}
extern "C" double turn(double angle, double now, double dt) {
  geometry_msgs::msg::Twist twist;
  twist.angular.z = now;
  return law.computeRotateToHeadingCommand(angle, twist, dt).angular.z;
}
"""


@pytest.fixture(scope="module")
def law(tmp_path_factory):
    folder = tmp_path_factory.mktemp("docking")
    (folder / "call.cpp").write_text(CALL, encoding="utf-8")
    paths = [FOLDER, symbolic.C_HEADER.parent, *INCLUDE.iterdir()]
    options = ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-DWMR_REAL=double"]
    command = [shutil.which("g++"), *options, *(f"-I{path}" for path in paths), "call.cpp"]
    subprocess.run([*command, "-o", "law.so"], cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "law.so"))
    library.command.argtypes = [ctypes.c_double] * 3 + [ctypes.c_int, ctypes.c_void_p]
    library.turn.argtypes, library.turn.restype = [ctypes.c_double] * 3, ctypes.c_double
    return library


def commanded(law, x, y, yaw, backward=False):
    out = (ctypes.c_double * 2)()
    return bool(law.command(x, y, yaw, backward, out)), tuple(out)


def test_it_commands_what_wmrlib_does_forwards_and_backwards(law):
    for x, y, yaw in np.random.default_rng(1).uniform(-3.0, 3.0, (50, 3)).tolist():
        error = wmr.polar_error(wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(x, y, yaw))
        twist = wmr.control_law(*error, wmr.Gains(0.2, 2.0, 2.0, 4.0))
        more = hurry(twist[0], error.alpha, WHEELS.min_speed)
        v, omega = wmr.limit_wheels(more * twist[0], more * twist[1], WHEELS)
        good, found = commanded(law, x, y, yaw)
        assert good
        assert found == pytest.approx((v, omega), abs=1e-9)
        assert commanded(law, -x, -y, yaw, True)[1] == pytest.approx((-v, omega), abs=1e-9)


def test_a_pose_that_is_no_number_is_a_stop(law):
    assert commanded(law, math.nan, 0.0, 0.0) == (False, (0.0, 0.0))


def test_a_turn_on_the_spot_keeps_to_its_acceleration(law):
    assert law.turn(1.0, 0.0, 0.1) == pytest.approx(0.05)
    assert law.turn(-0.3, -0.55, 1.0) == pytest.approx(-0.6)
    assert law.turn(0.01, 0.2, 1.0) == pytest.approx(0.2)
