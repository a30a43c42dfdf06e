"""From ROS messages to `wr.Seen`, and from parameters to `wr.Drive`: no ROS needed, no law here.

Frames are those of REP-103 and REP-105: `map` is east, north, up with its origin at the parameter
`start`; yaw 0 is east and counts counter-clockwise, in `Imu` too; `odom` and `base_link` are the
odometry's.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

import wmrlib as wmr
import wmrrobot as wr
from wmrlib.elementary import sinc
from wmrrobot import estimation
from wmrrobot.monitor import rank
from wmrrobot.sensing import antenna

QUALITY = {0: 1, 1: 2, 2: 4}  # of a NavSatStatus, as NMEA says it
PATIENT = 5  # fixes that the filter refuses before it doubts itself
HEADINGS = 256  # the last ones, of which the nearest to a fix is taken; and as many fixes
SOON = 0.05  # s by which a fix may be later than the odometry, whose topic does not wait for its
OWN = {"oldest": "oldest_fix"}  # what "My robot" calls a field of the rules

DEFAULTS: dict[str, Any] = {
    "start": [math.nan, math.nan],  # degrees north and east; no robot has a default place
    "goal": [math.nan, math.nan],
    "goal_heading": 0.0,
    "law": "corrected",
    "fence": [-math.inf, -math.inf, math.inf, math.inf],  # west, south, east, north of start, m
    "antenna": [0.0, 0.0],  # ahead and left of the middle between the wheels, m
    "filter": True,
    "compass_sigma": math.radians(5.0),
    "two_antennas": False,  # each orientation is a new measurement, not one compass error for all
    "odom_frame": "odom",
    "base_frame": "base_link",
    "watchdog": 0.25,  # s without odometry, by a clock that nothing sets
    "track_width": 0.5,
    **{name: wmr.Wheels._field_defaults[name] for name in wmr.Wheels._fields[1:]},
    **{OWN.get(name, name): value for name, value in wr.Rules()._asdict().items()},
    **{f"gains.{name}": value for name, value in wmr.GENTLE_GAINS._asdict().items()},
    **{f"last_turn.{name}": value for name, value in wmr.LastTurn()._asdict().items()},
}
"""Every parameter of the node with its default, in m, s, rad and, for points, degrees."""


def typed(given: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters, 1 for 1.0 too; ValueError that names the one of another kind."""
    values = {}
    for name, value in given.items():
        try:
            values[name] = _like(DEFAULTS[name], value)
        except TypeError:
            text = f"{name} = {value!r} is not allowed: like {DEFAULTS[name]!r} is needed"
            raise ValueError(text) from None
    return values


def _like(usual: Any, value: Any) -> Any:
    if isinstance(usual, list):
        return [_like(usual[0], entry) for entry in value]
    if type(usual) is float and type(value) is int:
        return float(value)
    if type(value) is not type(usual):
        raise TypeError
    return value


def place(start: wmr.GeoPoint, lat: float, lon: float) -> tuple[float, float]:
    """East and north of `start` in m; NaN where the point is none, which the drive refuses."""
    try:
        east, north = wmr.local_position(start, wmr.GeoPoint(lat=lat, lon=lon))
    except ValueError:
        return math.nan, math.nan
    return float(east), float(north)


def point(degrees: Any) -> wmr.GeoPoint:
    """A parameter's degrees north and east; ValueError if there is no such place."""
    return wmr.GeoPoint(lat=degrees[0], lon=degrees[1])


def goal_of(given: Mapping[str, Any]) -> wmr.Pose:
    """The goal that the parameters say, in the map frame; ValueError if its point is none."""
    x, y = place(point(given["start"]), *given["goal"])
    if not math.isfinite(x + y):
        raise ValueError(f"goal = {given['goal']} is not allowed: degrees north, east are needed")
    return wmr.Pose(x, y, given["goal_heading"])


def drive_of(given: Mapping[str, Any], goal: wmr.Pose) -> wr.Drive:
    """The drive to a goal by the parameters; ValueError as `wr.Drive`."""
    gains = wmr.Gains(*(given[f"gains.{name}"] for name in wmr.Gains._fields))
    wheels = wmr.Wheels(*(given[name] for name in wmr.Wheels._fields))
    turn = wmr.LastTurn(*(given[f"last_turn.{name}"] for name in wmr.LastTurn._fields))
    rules = wr.Rules(*(given[OWN.get(name, name)] for name in wr.Rules._fields))
    return wr.Drive(goal, gains, wheels, turn, rules, given["law"])


def elapsed(new: Any, old: Any) -> float:
    """From one message's stamp to another's, in s."""
    return _between(new.header.stamp, old.header.stamp)


def _between(new: Any, old: Any) -> float:
    """In s to the nanosecond: a double of the seconds since 1970 keeps only 0.2 us."""
    return (new.sec - old.sec) + 1e-9 * (new.nanosec - old.nanosec)


def yaw(q: Any) -> float:
    """The heading of a quaternion; NaN for one that is not of length 1."""
    if not abs(q.x**2 + q.y**2 + q.z**2 + q.w**2 - 1.0) < 1e-3:
        return math.nan
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y**2 + q.z**2))


class Sensors:
    """The messages since the last odometry, and the filter; `seen` returns a period's `Seen`."""

    def __init__(self, given: Mapping[str, Any]) -> None:
        self.given, self.start = given, point(given["start"])
        fastest = min(given["max_speed"], estimation.Noise().max_speed)
        self.noise = estimation.Noise(track_width=given["track_width"], max_speed=fastest)
        self.odom = self.fixed = self.gyro = self.last_position = None
        self.fixes: deque = deque(maxlen=HEADINGS)
        self.headings: deque = deque(maxlen=HEADINGS)
        self.battery, self.refused = math.inf, 0
        self.estimate: estimation.Estimate | None = None

    def take_imu(self, imu: Any) -> None:
        """An `Imu`; a covariance of -1 says that it lacks the orientation, or the turning rate."""
        if imu.orientation_covariance[0] != -1.0:
            self.headings.append((imu.header.stamp, yaw(imu.orientation)))
        if imu.angular_velocity_covariance[0] != -1.0:
            self.gyro = imu.header.stamp, imu.angular_velocity.z

    def inside(self, x: float, y: float) -> int:
        """Whether a place is inside the fence; NaN is not."""
        west, south, east, north = self.given["fence"]
        return int(west <= x <= east and south <= y <= north)

    def seen(self, odom: Any, goal: wmr.Pose) -> wr.Seen:
        """The period that ends with this odometry; with the first one, a period of no length."""
        last, self.odom = self.odom or odom, odom
        past, before, now = elapsed(odom, last), last.pose.pose, odom.pose.pose
        heading = yaw(before.orientation)
        turn = float(wmr.wrap_angle(yaw(now.orientation) - heading))
        east, north = now.position.x - before.position.x, now.position.y - before.position.y
        middle = heading + 0.5 * turn
        ahead = (math.cos(middle) * east + math.sin(middle) * north) / sinc(0.5 * turn)
        half = 0.5 * self.given["track_width"] * turn
        readings = wr.Seen(past, ahead - half, ahead + half, self.battery)
        readings = readings._replace(goal_inside=self.inside(goal.x, goal.y))
        if self.estimate and 0.0 < past <= self.given["longest_period"]:
            self._carry(ahead / past, turn / past, past)
        fix = self._due()
        return self._with_fix(readings, fix) if fix else readings

    def _due(self) -> Any:
        """The newest fix that the odometry has reached; one that is a little later waits.

        One that is later by more has a clock of its own: the drive sees its age and refuses it.
        """
        ages = [(elapsed(self.odom, fix), fix) for fix in self.fixes]
        soon = [fix for age, fix in ages if -SOON <= age < 0.0]
        here = [fix for age, fix in ages if age >= 0.0]
        odd = [fix for age, fix in ages if not age >= -SOON]
        self.fixes = deque(soon, HEADINGS)
        return (here or odd or [None])[-1]

    def _carry(self, v: float, omega: float, past: float) -> None:
        if math.isfinite(v + omega):
            stamp, gyro = self.gyro or (None, math.nan)
            if stamp and abs(_between(self.odom.header.stamp, stamp)) > self.given["patience"]:
                gyro = math.nan  # its sensor fell silent: the wheels alone count
            with suppress(ValueError):  # faster than a wheel can be: the drive sees it too
                self.estimate = estimation.predict(self.estimate, v, omega, gyro, past, self.noise)

    def _heading(self, stamp: Any) -> float:
        """The heading measured at the time of a fix; NaN without one close to it."""
        gap = lambda heading: abs(_between(heading[0], stamp))  # noqa: E731
        nearest = min(self.headings, key=gap, default=None)
        return nearest[1] if nearest and gap(nearest) <= self.given["patience"] else math.nan

    def _with_fix(self, readings: wr.Seen, fix: Any) -> wr.Seen:
        stamp, variance = fix.header.stamp, fix.position_covariance
        later = _between(stamp, self.fixed) if self.fixed else 1.0
        self.fixed = stamp
        x, y = place(self.start, fix.latitude, fix.longitude)
        known = fix.position_covariance_type != 0
        readings = readings._replace(
            fresh=1,
            heading=self._heading(stamp),
            quality=QUALITY.get(fix.status.status, 0),
            error=math.sqrt(max(variance[0], variance[4])) if known else 0.0,
            later=later,
            age=elapsed(self.odom, fix),
        )
        position_before, self.last_position = self.last_position, (fix.latitude, fix.longitude)
        if self.given["filter"] and self.last_position != position_before:
            return self._filtered(readings, x, y)
        if self.estimate:  # a fix with the same bits goes on as it is: the drive watches for that
            readings = readings._replace(heading=self.estimate.pose.heading)
        ahead, left = self.given["antenna"]
        inside = self.inside(x, y)
        return readings._replace(x=x, y=y, antenna_ahead=ahead, antenna_left=left, inside=inside)

    def _filtered(self, readings: wr.Seen, x: float, y: float) -> wr.Seen:
        """The filter's pose in place of the fix; no fix if the filter refuses it."""
        given, arm = self.given, self.given["antenna"]
        sigma, heading = readings.error or given["largest_error"], readings.heading
        readings = readings._replace(x=x, y=y, inside=self.inside(x, y))
        good = rank(readings.quality) >= rank(given["least"])
        usable = readings.later > 0.0 and good and sigma <= given["largest_error"]
        if not (usable and 0.0 <= readings.age <= given["oldest_fix"] and math.isfinite(x + y)):
            return readings  # the drive says why
        if self.estimate is None:
            if not math.isfinite(heading):
                return readings
            compass = given["compass_sigma"]
            east, north = antenna(0.0, 0.0, heading, *arm)
            pose = wmr.Pose(x - east, y - north, heading)
            self.estimate = estimation.start(pose, sigma + math.hypot(*arm) * compass, compass)
        behind = (
            0.5 * (readings.left + readings.right) / readings.seconds * readings.age
            if readings.seconds
            else 0.0
        )
        self.estimate = estimation.use_position(self.estimate, x, y, sigma, arm[0] - behind, arm[1])
        refused = self.estimate.surprise > estimation.GATE_2
        self.refused = self.refused + 1 if refused else 0
        if self.refused >= PATIENT:  # it may be the filter that is wrong
            self.estimate = estimation.doubt(self.estimate, 4.0)
        if refused and self.estimate.lost:  # the next fix begins anew
            self.estimate = None
            return readings._replace(fresh=0)
        if given["two_antennas"] and math.isfinite(heading):
            self.estimate = estimation.use_heading(self.estimate, heading, given["compass_sigma"])
        pose = self.estimate.pose
        # The filter has carried the fix on to now, which the drive does with age.
        return readings._replace(
            fresh=int(not refused), **pose._asdict(), age=0.0, inside=self.inside(pose.x, pose.y)
        )
