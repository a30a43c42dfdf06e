"""What the small things to move show, against wmrlib and against python-control."""

from __future__ import annotations

import math
from zlib import crc32

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from host import mounted
from test_live import NAMES

import wmrlib as wmr
from wmrbook import live
from wmrbook.chapters import routes
from wmrbook.live import real_robot

ROLLING = {"method": "continuous", "dt": 0.02, "duration": 12.0, "arrival_radius": 0.0}
TRIALS = 4  # places of the knobs, besides where they stand at first
AGREES = 1e-7  # m and rad, of a run


def python_control():
    """The package, imported by the tests that need it: this takes 2 s in each worker."""
    import control

    return control


def pose(numbers) -> wmr.Pose:
    return wmr.Pose(*numbers)


def same_run(results, start, goal, gains, **options) -> wmr.Trajectory:
    """The run in the page is that of `simulate`, which is returned."""
    options = {"method": "continuous", "dt": 0.05, "duration": 60.0} | options
    ours = wmr.simulate(pose(start), pose(goal), gains, **options)
    assert len(results["t"]) == len(ours.t)
    for name in ("x", "y"):
        np.testing.assert_allclose(results[name], getattr(ours, name), atol=AGREES)
    turned = np.array(results["heading"]) - ours.heading
    assert np.abs(wmr.wrap_angle(turned)).max() < AGREES
    return ours


def stopping(values, results, data) -> None:
    gains, ends = wmr.Gains(**data[values["gains"]]), (pose(data["start"]), pose(data["goal"]))
    same_run(results["run"], *ends, gains, dt=0.005, arrival_radius=0.01)
    stopped = wmr.simulate(*ends, gains, method="continuous", arrival_radius=values["stop"])
    assert results["off"] == pytest.approx(stopped.heading_error[-1], abs=1e-3)
    assert results["t"] == pytest.approx(stopped.t[-1], abs=1e-3)


def bearing(values, results, data) -> None:
    here = wmr.paper.GPS_POINT_1
    there = wmr.point_at(here, values["east"], values["north"])
    off = results["bearing"] - wmr.initial_bearing(here, there)
    assert wmr.wrap_angle(off) == pytest.approx(0.0, abs=1e-7)
    assert results["rho"] == pytest.approx(wmr.haversine_distance(here, there), abs=1e-6)
    pair = wmr.Pose(0.0, 0.0, 0.0), wmr.Pose(values["east"], values["north"], 0.0)
    assert results["sight"] == pytest.approx(wmr.polar_error(*pair).alpha)


def flat_map(values, results, data) -> None:
    origin = wmr.GeoPoint(lat=values["lat"], lon=0.0)
    point = wmr.destination_point(origin, 1000 * values["km"], math.pi / 4)
    on_sphere, flat = results["maps"]
    assert on_sphere == pytest.approx(wmr.local_position(origin, point), rel=1e-9, abs=1e-7)
    lat, lon = np.radians([point.lat - origin.lat, point.lon])
    there = data["radius"] * np.array([lon * math.cos(math.radians(origin.lat)), lat])
    assert flat == pytest.approx(there, rel=1e-9, abs=1e-7)
    step = math.degrees(values["km"] / data["radius"])
    ahead = wmr.GeoPoint(lat=point.lat + step, lon=point.lon)
    x, y = np.subtract(wmr.local_position(origin, ahead), on_sphere)
    assert results["leans"] == pytest.approx(math.atan2(-x, y), abs=1e-6)


def one_step(values, results, data) -> None:
    whole, left = divmod(math.pi / data["omega"], values["dt"])
    for method in ("arc", "euler"):
        at = wmr.Pose(0.0, 0.0, 0.0)
        for dt in [values["dt"]] * int(whole) + [left]:
            at = wmr.advance(at, data["v"], data["omega"], dt, method=method)
        assert results[method][-1][:2] == pytest.approx(at[:2], abs=1e-9)


def polar_angles(values, results, data) -> None:
    angles = np.radians([values["heading"], values["goal_heading"]])
    robot = wmr.Pose(values["x"], values["y"], angles[0])
    goal = wmr.Pose(*data["goal"][:2], angles[1])
    theirs = wmr.polar_error(robot, goal)
    assert [results[name] for name in theirs._fields] == pytest.approx(theirs, abs=1e-12)
    turned = wmr.wrap_angle(results["gamma"] - (theirs.theta - theirs.alpha))
    assert turned == pytest.approx(0.0, abs=1e-12)


def half_turn(values, results, data) -> None:
    heading = data["start"][2] - math.radians(values["off"])
    start = [*data["start"][:2], heading]
    same_run(results["run"], start, data["goal"], wmr.Gains(**data["gains"]))
    ends, options = (pose([*start[:2], -heading]), pose(data["goal"])), {"method": "continuous"}
    mirrored = wmr.simulate(*ends, wmr.Gains(**data["gains"]), dt=0.05, **options)
    np.testing.assert_allclose(results["run"]["y"], -mirrored.y, atol=AGREES)


def silence(values, results, data) -> None:
    far = real_robot.rolled(values["speed"], values["timeout"], values["brake"])
    assert results["far"] == pytest.approx(far, rel=1e-9)
    assert results["faith"] == pytest.approx(values["speed"] * values["timeout"])


def same_route(results, poses, radii, gains, stop) -> None:
    options = {"stop": stop, "arrival_radius": radii[-1], "pass_radius": radii[0]}
    ours = routes.drive_route(wmr.Pose(*np.transpose(poses)), gains, **options)
    assert results["arrived"] == (ours.outcome is wmr.Outcome.ARRIVED)
    assert results["leg"] == ours.leg.tolist()
    for name in ("t", "x", "y", "v", "V"):
        np.testing.assert_allclose(results[name], getattr(ours, name), rtol=1e-6, atol=1e-6)
    assert results["peakOmega"] == pytest.approx(max(it.peak_omega for it in ours.arrivals))


def corners(values, results, data) -> None:
    points = [data["first"], (values["x"], values["y"]), data["last"]]
    headings = routes.headings_along(*np.transpose(points))
    assert [results[key] for key in ("come", "heading", "leave")] == pytest.approx(headings)
    poses = [(*at, heading) for at, heading in zip(points, headings, strict=True)]
    radii = data[values["stop"]], data["stop"]
    same_route(results["run"], poses, radii, wmr.Gains(**data["gains"]), values["stop"] == "stop")


def bowl(values, results, data) -> None:
    gains = wmr.Gains(**data["gains"][values["choice"]])
    ours = same_run(results["run"], data["start"], data["goal"], gains, **ROLLING)
    height = wmr.lyapunov(0.0, ours.alpha, ours.theta, gains.h)
    assert results["height"] == pytest.approx(height[results["k"]], abs=AGREES)


def two_bars(values, results, data) -> None:
    def parts(alpha, theta):
        twist = {
            "nothing": lambda: (1.0, 0.0),
            "speed": lambda: (wmr.control_law(rho, alpha, theta, gains)[0], 0.0),
            "corrected": lambda: wmr.control_law(rho, alpha, theta, gains),
            "printed": lambda: wmr.control_law(rho, alpha, theta, gains, law="printed"),
        }[values["law"]]()
        rates = wmr.polar_rate(rho, alpha, *twist)
        return rho * rates[0], alpha * rates[1] + gains.h * theta * rates[2]

    rho, gains = data["rho"], wmr.Gains(**data["gains"])
    ours = parts(math.radians(values["alpha"]), math.radians(values["theta"]))
    np.testing.assert_allclose(results["bars"], ours, atol=1e-12)
    side = (2 * (np.arange(19) + 0.5) / 19 - 1) * np.pi
    states = np.array([(alpha, theta) for alpha in side for theta in side])
    rises = np.sum(parts(*states.T), axis=0) > 0
    np.testing.assert_allclose(np.reshape(results["marks"], (-1, 2)), states[rises], atol=1e-12)
    assert rises.any() == (values["law"] != "corrected")


def window(values, results, data) -> None:
    gains, start = wmr.Gains(1.0, values["kappa"], values["h"], 1.0), pose(data["start"])
    options = {"dt": 0.02, "duration": 90.0, "arrival_radius": 1e-6}
    same_run(results["run"], start, wmr.Pose(0, 0, 0), gains, **options)
    assert results["inside"] == (wmr.modes(gains).slower < 1)
    other = wmr.Gains(0.5, 3.0 * values["kappa"], values["h"], 6.0)  # in metres and seconds
    start, options = wmr.Pose(2 * start.x, 2 * start.y, start.heading), {"method": "continuous"}
    run = wmr.simulate(start, wmr.Pose(0, 0, 0), other, dt=0.005, arrival_radius=2e-6, **options)
    error = np.degrees(np.abs(wmr.wrap_angle(run.theta - run.alpha)))
    late = [error[run.rho <= radius].max() for radius in (0.2, 0.02)]
    np.testing.assert_allclose(results["late"], late, atol=0.5)


TRUTH = {name: globals()[name] for name in NAMES}  # each has its own, of the same name


@pytest.mark.parametrize("name", NAMES)
def test_what_is_shown_is_true(emptied_page, name):
    thing = getattr(live, name)()
    thing.setup = thing.setup | {"ask": None}  # until then it shows its first values
    panel, random = mounted(emptied_page, thing), np.random.default_rng(crc32(name.encode()))
    for trial in range(TRIALS + 1):
        values, chosen = {}, 0
        for knob in thing.setup["knobs"] if trial else ():
            if "choices" in knob:
                turn = trial // 2**chosen % len(knob["choices"])  # so that each has its turn
                values[knob["name"]], chosen = knob["choices"][turn][0], chosen + 1
            else:
                values[knob["name"]] = float(random.uniform(knob["low"], knob["high"]))
        panel.set(**values, guess="skipped")
        TRUTH[name](panel.state(), panel.results(), thing.setup["data"])
