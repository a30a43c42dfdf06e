"""Checks of formulas on the Earth: the distance and the bearing between two GPS points, and the local frame."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from wmrlib.geodesy import GeoPoint, haversine_distance
from wmrlib.grading._hints import Passed, ask_number, close, expect, own_work
from wmrlib.paper import GPS_POINT_1, GPS_POINT_2

Function = Callable[[float, float, float, float], float]


def distance_known(distance: Function) -> Passed:
    """distance(lat_1, lon_1, lat_2, lon_2): degrees in, metres out; right for the paper's points and for places all over the Earth."""
    own_work(distance)
    for a, b in [(GPS_POINT_1, GPS_POINT_2), *_places(20)]:
        right, value = haversine_distance(a, b), ask_number(distance, a.lat, a.lon, b.lat, b.lon)
        if not close(value, right, 1e-6, 1e-6):
            expect(not _explains(value, lambda a=a, b=b: _haversine(a.lon, a.lat, b.lon, b.lat)), _SWAPPED)
            expect(
                not _explains(value, lambda a=a, b=b: _haversine(*(math.degrees(each) for each in (a.lat, a.lon, b.lat, b.lon)))), _DEGREES
            )
            expect(not close(value * 1000.0, right, 1e-3), "the result is in kilometres; metres are asked for.")
            expect(not close(2.0 * value, right, 1e-3), "the result is half as long as it should be: look at the factor in (12).")
            expect(
                close(value, right, 0.02),
                "the distance between two known places is wrong: compare your haversine with (11) to (13), term by term.",
            )
            expect(False, "the distance is nearly right: is the radius 6371 km, and is nothing rounded on the way?")
    return Passed(f"{haversine_distance(GPS_POINT_1, GPS_POINT_2):.2f} m between the paper's two points, and right elsewhere.")


def distance_properties(distance: Function) -> Passed:
    """It is the same there and back, nothing from a point to itself, and does not change when the Earth is turned about its axis."""
    own_work(distance)
    for a, b in _places(20):
        there = ask_number(distance, a.lat, a.lon, b.lat, b.lon)
        expect(there > 0.0, "the distance between two different places must be positive.")
        expect(close(there, ask_number(distance, b.lat, b.lon, a.lat, a.lon)), "the way back is not as long as the way there.")
        expect(abs(ask_number(distance, a.lat, a.lon, a.lat, a.lon)) < 1e-6, "from a point to itself it must be 0 m.")
        turned = ask_number(distance, a.lat, a.lon - 25.0, b.lat, b.lon - 25.0)
        expect(close(there, turned, 1e-6), "turn the Earth: if both longitudes change by the same, the distance must stay.")
    return Passed("There is as far as back, and only the difference of the longitudes counts.")


def distance_close(distance: Function) -> Passed:
    """A centimetre is a centimetre: the haversine keeps the digits that an acos loses."""
    own_work(distance)
    for metres in (1.0, 0.1, 0.01):
        lat = 33.273572 + math.degrees(metres / 6_371_000.0)
        value = ask_number(distance, 33.273572, 44.37316, lat, 44.37316)
        expect(
            close(value, metres, 1e-3),
            f"two points {metres:g} m apart come out {value:.4f} m apart: which function loses its digits near 0?",
        )
    return Passed("One centimetre comes out as one centimetre.")


_SWAPPED = "this is the distance for latitude and longitude swapped: which one has the cosine?"
_DEGREES = "this is what comes out when degrees go into a sine: `math.radians` first."


def _explains(value: float, mistaken: Callable[[], float]) -> bool:
    return close(value, mistaken(), 1e-9)


def _haversine(lat_1: float, lon_1: float, lat_2: float, lon_2: float) -> float:
    """For any numbers: a mistake may take a longitude for a latitude, which a GeoPoint refuses."""
    lat_1, lon_1, lat_2, lon_2 = (math.radians(each) for each in (lat_1, lon_1, lat_2, lon_2))
    e = math.sin((lat_2 - lat_1) / 2) ** 2 + math.cos(lat_1) * math.cos(lat_2) * math.sin((lon_2 - lon_1) / 2) ** 2
    e = min(1.0, max(0.0, e))
    return 6_371_000.0 * 2.0 * math.atan2(math.sqrt(e), math.sqrt(1.0 - e))


def _places(count: int) -> list[tuple[GeoPoint, GeoPoint]]:
    """Pairs of places that are the same each time, far enough from each other and from the poles for a mistake to show."""
    random = np.random.default_rng(1)
    lats, lons = random.uniform(-70.0, 70.0, (count, 2)), random.uniform(-150.0, 150.0, (count, 2))
    return [
        (GeoPoint(lat=lat[0], lon=lon[0]), GeoPoint(lat=lat[1], lon=lon[1])) for lat, lon in zip(lats.tolist(), lons.tolist(), strict=True)
    ]
