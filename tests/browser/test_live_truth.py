"""What the small things to move show, against wmrlib and against python-control."""

from __future__ import annotations

import json
import math

import control
import numpy as np
import pytest
from scipy.integrate import solve_ivp

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from host import mounted
from test_live import NAMES, commit, quoted

import wmrlib as wmr
from wmrbook import live

FOUND = """() => JSON.stringify(document.querySelector('.live').found,
    (_, it) => ArrayBuffer.isView(it) ? Array.from(it) : it)"""
ROLLING = {"method": "continuous", "dt": 0.02, "duration": 12.0, "arrival_radius": 0.0}
TRIALS = 4  # places of the knobs, besides where they stand at first
AGREES = 1e-7  # m and rad, of a run


def pose(numbers) -> wmr.Pose:
    return wmr.Pose(*numbers)


def same_run(found, start, goal, gains, **how) -> None:
    """The run in the page is that of `simulate`."""
    how = {"method": "continuous", "dt": 0.05, "duration": 60.0} | how
    ours = wmr.simulate(pose(start), pose(goal), gains, **how)
    assert len(found["t"]) == len(ours.t)
    for name in ("x", "y"):
        np.testing.assert_allclose(found[name], getattr(ours, name), atol=AGREES)
    turned = np.array(found["heading"]) - ours.heading
    assert np.abs(wmr.wrap_angle(turned)).max() < AGREES


def last_metres(values, found, data) -> None:
    shares = np.array([1 - values["share"], values["share"]])
    between = np.exp(shares @ np.log([[*data["paper"].values()], [*data["gentle"].values()]]))
    same_run(found["run"], data["start"], data["goal"], wmr.Gains(*between))


def turning_centre(values, found, data) -> None:
    v, omega = wmr.wheels_to_twist(values["left"], values["right"], data["track"])
    assert (found["v"], found["omega"]) == pytest.approx((v, omega), abs=1e-12)
    if omega:  # the wheels roll round that point
        assert omega * (found["centre"] - data["track"] / 2) == pytest.approx(values["left"])


def poles(values, found, data) -> None:
    gains = wmr.Gains(data["k_rho"], values["k_alpha"], values["h"], data["v_max"])
    pace = gains.k_rho * gains.v_max
    loop = control.tf([1.0], [1.0, gains.k_alpha, gains.h * pace**2])
    theirs = np.array([complex(*each) for each in found["poles"]])
    apart = np.abs(np.sort_complex(loop.poles()) - np.sort_complex(theirs)).max()
    assert apart < 1e-9 * max(1.0, np.abs(theirs).max())
    same_run(found["run"], data["start"], data["goal"], gains, dt=0.02, duration=30.0)


def bowl(values, found, data) -> None:
    gains = wmr.Gains(**data["gains"][values["choice"]])
    same_run(found["run"], data["start"], data["goal"], gains, **ROLLING)
    ours = wmr.simulate(pose(data["start"]), pose(data["goal"]), gains, **ROLLING)
    height = wmr.lyapunov(0.0, ours.alpha, ours.theta, gains.h)
    assert found["height"] == pytest.approx(height[found["k"]], abs=AGREES)


def two_bars(values, found, data) -> None:
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
    np.testing.assert_allclose(found["bars"], ours, atol=1e-12)
    side = (2 * (np.arange(19) + 0.5) / 19 - 1) * np.pi
    states = np.array([(alpha, theta) for alpha in side for theta in side])
    rises = np.sum(parts(*states.T), axis=0) > 0
    np.testing.assert_allclose(np.reshape(found["marks"], (-1, 2)), states[rises], atol=1e-12)
    assert rises.any() == (values["law"] != "corrected")


def x_axis(values, found, data) -> None:
    case = wmr.paper.outdoor(values["axis"])
    same_run(found["run"], case.start, case.goal, case.gains)
    assert found["alpha"] == pytest.approx(wmr.polar_error(case.start, case.goal).alpha)
    east = wmr.paper.outdoor("east")  # the map is the same, however x points
    np.testing.assert_allclose(found["goal"][:2], east.goal[:2], atol=1e-9)
    bearing = math.pi / 2 - case.start.heading
    seen = bearing if values["axis"] == "north" else case.start.heading
    assert wmr.wrap_angle(found["start"][2] - seen) == pytest.approx(0.0, abs=1e-12)


def heading_left(values, found, data) -> None:
    ends, gains = (pose(data["start"]), pose(data["goal"])), data["gains"][values["choice"]]
    ours = wmr.simulate(
        *ends,
        wmr.Gains(**gains),
        method="continuous",
        dt=0.01,
        duration=120.0,
        arrival_radius=values["radius"],
    )
    assert found["left"] == pytest.approx(ours.heading_error[-1], abs=1e-6)
    assert found["time"] == pytest.approx(ours.t[-1], abs=1e-6)
    run = found["run"]
    late = np.array(run["rho"]) <= values["radius"]
    error = np.abs(wmr.wrap_angle(np.array(run["theta"]) - run["alpha"]))[late].max()
    assert found["largest"] == pytest.approx(max(error, abs(found["left"])), abs=1e-12)


def lag(values, found, data) -> None:
    gains = wmr.paper.CIRCLE_GAINS._replace(k_rho=values["k_rho"], v_max=values["v_max"])
    ours = wmr.track(
        wmr.paper.circle,
        wmr.paper.CIRCLE_START,
        gains,
        duration=40.0,
        dt=0.1,
        method="continuous",
    )
    np.testing.assert_allclose(found["run"]["rho"], ours.rho, atol=AGREES)
    assert found["residual"] == pytest.approx(wmr.residual(ours), abs=AGREES)
    kept = wmr.control_law(found["predicted"], 0.0, 0.0, gains)[0]  # there it keeps up
    assert kept == pytest.approx(wmr.paper.CIRCLE_SPEED, rel=1e-12)


def lqr(values, found, data) -> None:
    A, B = np.array(data["A"]), np.array(data["B"])
    K, _, poles = control.lqr(A, B, values["q"] * np.eye(3), np.eye(2))
    np.testing.assert_allclose(found["K"], K, atol=1e-9)
    theirs = np.array([complex(*each) for each in found["poles"]])
    assert np.abs(np.sort_complex(theirs) - np.sort_complex(poles)).max() < 1e-6
    ours = wmr.track(
        wmr.paper.circle,
        wmr.paper.CIRCLE_START,
        wmr.LinearGains(-K),
        law="linear",
        duration=40.0,
        dt=0.1,
        method="continuous",
    )
    np.testing.assert_allclose(found["run"]["x"], ours.x, atol=AGREES)
    np.testing.assert_allclose(found["run"]["omega"], ours.omega, atol=1e-6)


def phase(values, found, data) -> None:
    gains = wmr.Gains(**data["gains"])
    gains = gains._replace(k_alpha=2 * values["damping"] * wmr.modes(gains).natural_frequency)

    def rates(t, state):
        near = 1e-9  # m: the goal itself has no direction
        twist = wmr.control_law(near, *state, gains)
        return wmr.polar_rate(near, state[0], *twist)[1:]

    start = np.radians([values["alpha"], values["theta"]])
    ours = solve_ivp(rates, (0, 8), start, t_eval=[1.0, 4.0, 8.0], rtol=1e-9, atol=1e-11)
    run = found["run"]
    theirs = [[run[name][k] for k in (100, 400, 800)] for name in ("alpha", "theta")]
    np.testing.assert_allclose(theirs, ours.y, atol=1e-6)


TRUTH = {name: globals()[name] for name in NAMES}  # each has its own, of the same name


@pytest.mark.parametrize("name", NAMES)
def test_what_is_shown_is_true(browser_page, name):
    thing = getattr(live, name)()
    panel, random = mounted(browser_page, thing), np.random.default_rng(NAMES.index(name))
    for trial in range(TRIALS + 1):
        values = {}
        for knob in thing.setup["knobs"] if trial else ():
            if "choices" in knob:
                values[knob["name"]] = str(random.choice([each for each, _ in knob["choices"]]))
            else:
                values[knob["name"]] = float(random.uniform(knob["low"], knob["high"]))
        panel.set(**quoted(values))
        state = browser_page.evaluate("panel.get('state')")
        found = json.loads(browser_page.evaluate(FOUND))
        TRUTH[name](state, found, thing.setup["data"])


def test_the_poles_follow_the_hand_and_the_gains_follow_the_poles(browser_page):
    panel = mounted(browser_page, live.poles())
    commit(panel, live.poles().setup["ask"])
    scale = browser_page.locator("canvas").first.bounding_box()["width"]
    before = json.loads(browser_page.evaluate(FOUND))["poles"]
    panel.drag(browser_page.locator("[data-handle=pole-0]"), -0.05 * scale, -0.1 * scale)
    found = json.loads(browser_page.evaluate(FOUND))
    assert found["poles"][0][0] < before[0][0]
    assert found["poles"][0][1] > before[0][1]
    assert panel.get("k_alpha") == pytest.approx(-2 * found["poles"][0][0], rel=1e-12)
    size = math.hypot(*found["poles"][0])
    assert panel.get("h") * found["pace"] ** 2 == pytest.approx(size**2, rel=1e-12)
    held = panel.get("k_alpha")
    panel.drag(browser_page.locator("[data-handle=pole-0]"), 0.6 * scale, 0)
    assert "k_alpha would be" in browser_page.locator(".live-trouble").inner_text()
    assert 0 <= panel.get("k_alpha") <= held
