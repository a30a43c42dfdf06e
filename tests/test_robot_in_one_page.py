"""The file that a student takes along drives exactly as the library does."""

import math
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import wmrlib as wmr

PAGE = Path(__file__).parent.parent / "notebooks" / "robot_in_one_page.py"
page = runpy.run_path(str(PAGE))
START, GOAL, _, DT = wmr.paper.outdoor()
SETTLING = wmr.gains_for(0.8, heading_rate=1.6, damping=1.0)


@pytest.mark.parametrize("gains", [wmr.GENTLE_GAINS, SETTLING])
@pytest.mark.parametrize("away", [START, wmr.Pose(5.0, 60.0, 3.0), wmr.Pose(-20.0, 80.0, -1.0)])
def test_each_pose_is_that_of_simulate(gains, away):
    run = wmr.simulate(away, GOAL, gains, dt=DT)
    poses = page["drive"](tuple(away), tuple(GOAL), tuple(gains), DT)
    np.testing.assert_allclose(poses, np.transpose([run.x, run.y, run.heading]), atol=1e-9)
    assert run.outcome is wmr.Outcome.ARRIVED


def test_it_stops_when_the_time_is_up():
    for dt, duration in ((0.1, 0.3), (0.3, 10.0), (0.35, 10.0)):
        run = wmr.simulate(START, GOAL, SETTLING, dt=dt, duration=duration)
        assert len(page["drive"](START, GOAL, SETTLING, dt, duration)) == len(run)


close = st.tuples(st.floats(-80.0, 80.0), st.floats(-179.0, 179.0))


@given(close, st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
def test_the_map_is_that_of_the_library(first, north, east):
    points = *first, first[0] + north, first[1] + east
    a, b = (wmr.GeoPoint(lat=lat, lon=lon) for lat, lon in (points[:2], points[2:]))
    distance = wmr.haversine_distance(a, b)
    assert page["haversine_distance"](*points) == pytest.approx(distance, rel=1e-12, abs=1e-9)
    position = wmr.local_position(a, b)
    assert page["local_position"](*points) == pytest.approx(position, rel=1e-12, abs=1e-9)


def test_as_a_script_it_prints_where_the_robot_parks():
    run = wmr.simulate(START, GOAL, wmr.GENTLE_GAINS, dt=DT)
    command = [sys.executable, "-I", "-S", str(PAGE)]  # -S: without any package but Python's own
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    end = f"After {run.t[-1]:.1f} s the robot is {run.rho[-1]:.3f} m from it,"
    facing = f"faces {math.degrees(run.heading_error[-1]):.1f} deg away"
    for words in ("The goal is 58.08 m away.", end, facing):
        assert words in text
    imports = [line for line in PAGE.read_text().splitlines() if "import " in line]
    assert imports == ["import math"]
