"""A drive that a page plays over its picture."""

from __future__ import annotations

import pytest
from live import chapters

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
  const last = values => values.reduce((sum, it) => sum + it, 0) / 10000;
  return { count: sum, at: [x / sum / width, y / sum / height], seconds,
           end: [last(robots[0].x), last(robots[0].y)] };
}"""


def test_a_drive_plays_over_its_picture_and_waits_where_it_is_paused(opened):
    page = opened(f"notebooks/{chapters()[12].stem}.html")
    player = page.query_selector(".player")
    player.scroll_into_view_if_needed()
    assert player.evaluate(DRAWN)["count"] == 0  # the picture speaks for itself
    slider, button = player.query_selector("input"), player.query_selector("button")
    slider.press("End")
    seen = player.evaluate(DRAWN)
    assert seen["at"] == pytest.approx(seen["end"], abs=0.02)
    assert slider.get_attribute("aria-valuetext") == f"{seen['seconds']:.1f} s"
    slider.press("Home")
    button.click()
    page.wait_for_function("it => it.ariaValueText !== '0.0 s'", arg=slider)
    button.click()
    assert button.inner_text() == "Play"
    assert slider.get_attribute("aria-valuetext") != "0.0 s"
