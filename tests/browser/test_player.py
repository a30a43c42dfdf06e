"""Drives that a page plays over their pictures."""

from __future__ import annotations

import pytest
from live import chapters

PLAYERS = {"00": 1, "05": 1, "07": 1, "12": 2}
# Where on its canvas something is drawn: the middle of it, in parts of its size.
DRAWN = """player => {
  const box = [player.previousElementSibling, player.previousElementSibling.previousElementSibling]
      .find(it => it.matches('.figure-box')), canvas = box.querySelector('canvas');
  const { width, height } = canvas, data = canvas.getContext('2d')
      .getImageData(0, 0, width, height).data;
  let sum = 0, x = 0, y = 0;
  for (let k = 0; k < width * height; k += 1) if (data[4 * k + 3] > 200) {
    sum += 1; x += k % width; y += Math.floor(k / width);
  }
  const { seconds, robots } = JSON.parse(box.querySelector('script').text);
  return { count: sum, at: [x / sum / width, y / sum / height], seconds,
           ways: robots.map(it => [it.x, it.y].map(values => {
             let sum = 0;
             return values.map(v => (sum += v) / 10000);
           })) };
}"""


@pytest.mark.parametrize("chapter", PLAYERS)
def test_a_drive_plays_over_its_picture_and_waits_where_it_is_paused(opened, chapter):
    (name,) = [path.stem for path in chapters() if path.stem[:2] == chapter]
    page = opened(f"notebooks/{name}.html")
    players = page.query_selector_all(".player")
    assert len(players) == PLAYERS[chapter]
    for player in players:
        player.scroll_into_view_if_needed()
        assert player.evaluate(DRAWN)["count"] == 0  # the picture speaks for itself
        slider, button = player.query_selector("input"), player.query_selector("button")
        for key, place in (("End", -1), ("Home", 0)):
            slider.focus()
            page.keyboard.press(key)
            seen = player.evaluate(DRAWN)
            if len(seen["ways"]) == 1:
                expected = [values[place] for values in seen["ways"][0]]
                assert seen["at"] == pytest.approx(expected, abs=0.02)
            assert seen["count"] > 20
            said = seen["seconds"] if place else 0.0
            assert slider.get_attribute("aria-valuetext") == f"{said:.1f} s"
        if chapter not in ("00", "12"):  # the second has two
            continue
        button.click()
        assert button.inner_text() == "Pause"
        page.wait_for_function("it => it.ariaValueText !== '0.0 s'", arg=slider)
        button.click()
        waits = slider.get_attribute("aria-valuetext")
        page.wait_for_timeout(200)
        assert slider.get_attribute("aria-valuetext") == waits != "0.0 s"
        slider.focus()
        for key in ("End", "PageDown"):  # not long before it has parked
            page.keyboard.press(key)
        button.click()
        page.wait_for_function("b => b.textContent === 'Play'", arg=button, timeout=20_000)
        assert slider.get_attribute("aria-valuetext") == f"{seen['seconds']:.1f} s"
