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


def flat_map(results):
    near, far, north, level = (np.hypot(*np.subtract(*result["maps"])) for result in results)
    return near < 1e-3, far / near == pytest.approx(1e4, rel=0.01), north > far, level < 1e-3 * far


def polar_angles(results):
    *_, before, robot, goal = (
        [result[name] for name in ("rho", "alpha", "theta")] for result in results
    )
    yield (np.not_equal(robot, before) == [False, True, False]).all()
    yield (np.not_equal(goal, robot) == [False, False, True]).all()


def bowl(results):
    for result in results:
        alpha, theta = np.array(result["run"]["alpha"]), np.array(result["run"]["theta"])
        V = alpha**2 + result["h"] * theta**2
        yield (np.diff(V) < 1e-9).all()
        steepest = np.arctan2(result["h"] * theta[0], alpha[0])
        went = np.arctan2(theta[0] - theta[5], alpha[0] - alpha[5])
        yield abs(steepest - went) > np.radians(20.0)


def lag(results):
    first, steep, fast = (result["residual"] for result in results)
    return first > 0.05, steep == pytest.approx(first / 2, rel=0.02), 0.4 < fast / first < 0.5


def window(results):
    swings, lags, inside = results
    yield not swings["inside"]
    yield not lags["inside"]
    yield inside["inside"]
    yield swings["late"][1] > 20.0
    yield inside["late"][1] < 1.0 < lags["late"][1]
    yield swings["fan"][0] < -10 < 10 < swings["fan"][1]  # it swings, where the other only lags
    yield min(map(abs, lags["fan"])) < 1


def corners(results):
    passed, stopped, sharp, hardly = (
        (result["run"]["t"][-1], result["run"]["peakOmega"]) for result in results
    )
    return stopped[0] > passed[0], sharp[1] > passed[1], hardly[1] < 0.1


@pytest.mark.parametrize("name", SCENES)
def test_what_each_idea_says_is_so(emptied_page, name):
    thing, steps = getattr(live, name)(), SCENES[name]
    panel = mounted(emptied_page, thing)
    chips, line = (emptied_page.locator(it) for it in (".live-steps .live-chip", "[data-on=true]"))
    assert not chips.locator("visible=true").count() or not thing.setup["ask"]
    panel.set(guess="skipped")
    knobs = [it for it in thing.setup["knobs"] if it["name"] != "time"]
    home = {it["name"]: it["value"] for it in knobs}
    results, pictures = [], []
    for k, step in enumerate(steps):
        away = {it["name"]: it["choices"][-1][0] if "choices" in it else it["high"] for it in knobs}
        panel.set(**away)  # what one did before does not count
        button = chips.nth(k)
        button.click()
        panel.settled()
        assert button.get_attribute("aria-current") == "step"
        assert emptied_page.locator(".live-steps [aria-current]").count() == 1
        assert line.first.inner_text() == as_shown(step.says)
        assert {it: panel.get(it) for it in home} == home | step.to
        assert panel.get("time") in (None, 1.0)
        assert not emptied_page.locator(".live-trouble:visible").count()
        results.append(panel.results())
        pictures.append(panel.picture())
    assert all(a != b for a, b in itertools.pairwise(pictures))
    claims = list(globals()[name](results))
    assert claims
    assert all(claims), claims
