"""What the small things to move show, against wmrlib and against python-control."""

from __future__ import annotations

import json
import math

import control
import numpy as np
import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from host import mounted
from test_live import NAMES

import wmrlib as wmr
from wmrbook import live

FOUND = """() => JSON.stringify(document.querySelector('.live').found,
    (_, it) => ArrayBuffer.isView(it) ? Array.from(it) : it)"""
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
        panel.set(**values)
        state = browser_page.evaluate("panel.get('state')")
        found = json.loads(browser_page.evaluate(FOUND))
        TRUTH[name](state, found, thing.setup["data"])


def test_the_poles_follow_the_hand_and_the_gains_follow_the_poles(browser_page):
    panel = mounted(browser_page, live.poles())
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
