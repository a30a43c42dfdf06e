"""The rover's text, the limits of its numbers, and what is stored of it, without MuJoCo."""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from wmrbook.panel.rover import SLIDERS
from wmrbook.rover_model import GRAVITY, LIMITS, Rover, mjcf, stored


def test_its_text_has_its_numbers_and_no_brace_is_left():
    root = ET.fromstring(mjcf(Rover(load=33.5, slope_deg=30.0, downhill_deg=90.0)))
    assert root.find(".//geom[@name='load']").get("mass") == "33.5"
    down = [float(part) for part in root.find("option").get("gravity").split()]
    assert down == pytest.approx([0.0, 0.5 * GRAVITY, -math.sqrt(0.75) * GRAVITY])
    assert "{" not in mjcf()


@pytest.mark.parametrize("name", LIMITS)
def test_a_number_beyond_its_limits_is_refused_by_name(name):
    low, high = LIMITS[name]
    for value in (low - 1.0, 1.01 * high + 1.0, math.nan, "much"):
        with pytest.raises(ValueError, match=rf"rover\.{name} = .* is needed"):
            mjcf(Rover()._replace(**{name: value}))
    with pytest.raises(ValueError, match="rover = 3 is not allowed"):
        mjcf(3)


def test_the_sliders_stay_within_the_limits():
    for name, (_, _, low, high, _) in SLIDERS.items():
        least, most = LIMITS.get(name, (0.0, math.inf))
        assert least <= low < high <= most


def test_the_sentences_of_the_page_follow_from_what_is_stored():
    found = stored()

    def rows(**wanted):
        drives = (it for it in found["drives"] if not {"height", "load", "timestep"} & {*it})
        return [it for it in drives if it.items() >= wanted.items()]

    for row in rows(ground="wet grass", slope_deg=10.0):
        assert row["off_deg"] is None
    for row in [
        *rows(ground="concrete", gains="gentle")[:-1],
        *rows(gains="gentle", slope="level"),
    ]:
        assert abs(row["off_deg"]) < 5.0
        assert row["slip_deg"] < 1.0
    assert rows(ground="wet grass", gains="the paper's", slope="level")[0]["slip_deg"] > 45.0
    assert rows(acceleration=1000.0)[0]["off_deg"] is None
    # On wet grass the window is lost at 4 m/s, and kept at 2.
    parked = {
        (pace, ground): np.count_nonzero(abs(np.array(errors, dtype=float)[..., 0]) < 5.0)
        for pace, ground, errors in found["windows"]
    }
    assert parked[2.0, "wet grass"] < 0.3 * parked[2.0, "concrete"]
    assert parked[1.0, "wet grass"] == parked[1.0, "concrete"]
