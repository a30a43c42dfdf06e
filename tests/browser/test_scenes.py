"""A scene that grows: what each of its ideas says is so."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

pytest.importorskip("anywidget", reason="what moves needs anywidget")
from host import mounted
from live import as_shown

from wmrbook import live
from wmrbook.live.scenes import SCENES


def flat_map(found):
    near, far, north, level = (np.hypot(*np.subtract(*each["maps"])) for each in found)
    return near < 1e-3, far / near == pytest.approx(1e4, rel=0.01), north > far, level < 1e-3 * far


def turning_centre(found):
    straight, arc, about, spot = found
    yield straight["omega"] == 0.0
    yield arc["centre"] > arc["wheels"][0][1]
    yield about["centre"] == pytest.approx(about["wheels"][0][1])
    yield spot["v"] == 0.0


def polar_angles(found):
    *_, before, robot, goal = ([each[name] for name in ("rho", "alpha", "theta")] for each in found)
    yield (np.not_equal(robot, before) == [False, True, False]).all()
    yield (np.not_equal(goal, robot) == [False, False, True]).all()


def bowl(found):
    for each in found:
        alpha, theta = np.array(each["run"]["alpha"]), np.array(each["run"]["theta"])
        V = alpha**2 + each["h"] * theta**2
        yield (np.diff(V) < 1e-9).all()
        steepest = np.arctan2(each["h"] * theta[0], alpha[0])
        went = np.arctan2(theta[0] - theta[5], alpha[0] - alpha[5])
        yield abs(steepest - went) > np.radians(20.0)


def lag(found):
    first, steep, fast = (each["residual"] for each in found)
    return first > 0.05, steep == pytest.approx(first / 2, rel=0.02), 0.4 < fast / first < 0.5


def window(found):
    swings, lags, inside = found
    yield not swings["inside"]
    yield not lags["inside"]
    yield inside["inside"]
    yield swings["late"][1] > 20.0
    yield inside["late"][1] < 1.0 < lags["late"][1]
    yield abs(swings["poles"][0][1]) > 0.0  # it swings, where the other only lags
    yield lags["poles"][0][1] == 0.0


def rising(found):
    up, down, again = (each["rate"] for each in found)
    return up > 0.0, down < 0.0, again > 0.0


def corners(found):
    passed, stopped, sharp, hardly = (
        (each["run"]["t"][-1], each["run"]["peakOmega"]) for each in found
    )
    return stopped[0] > passed[0], sharp[1] > passed[1], hardly[1] < 0.1


def race(found):
    backs = [{run["law"]: run["back"] for run in each["runs"]} for each in found]
    yield backs[0]["barrier"] > 1.5
    yield 0.1 < backs[1]["corrected"] < 0.5
    yield backs[2]["graceful"] == 0.0
    yield max(backs[3].values()) == 0.0


@pytest.mark.parametrize("name", SCENES)
def test_what_each_idea_says_is_so(emptied_page, name):
    thing, steps = getattr(live, name)(), SCENES[name]
    panel = mounted(emptied_page, thing)
    assert not emptied_page.locator(".live-steps:visible").count() or not thing.setup["ask"]
    panel.set(guess="skipped")
    knobs = [it for it in thing.setup["knobs"] if it["name"] != "time"]
    home = {it["name"]: it["value"] for it in knobs}
    found, pictures = [], []
    for k, step in enumerate(steps):
        away = {it["name"]: it["choices"][-1][0] if "choices" in it else it["high"] for it in knobs}
        panel.set(**away)  # what one did before does not count
        button = emptied_page.locator(".live-steps button").nth(k)
        button.click()
        panel.settled()
        assert button.get_attribute("aria-current") == "step"
        assert emptied_page.locator(".live-steps [aria-current]").count() == 1
        assert emptied_page.locator(".live-steps span").inner_text() == as_shown(step.says)
        assert {it: panel.get(it) for it in home} == home | step.to
        assert panel.get("time") in (None, 1.0)
        assert not emptied_page.locator(".live-trouble:visible").count()
        found.append(panel.found())
        pictures.append(panel.picture())
    assert all(a != b for a, b in itertools.pairwise(pictures))
    claims = list(globals()[name](found))
    assert claims
    assert all(claims), claims
