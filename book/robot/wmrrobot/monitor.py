"""The checks of a robot's sensors: its pose by fixes and odometry, and the faults that stop it.

`printing` prints all of it as ``wmr_drive.h``, so it is written in the Python that C has too.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, inf
from typing import NamedTuple

from wmrlib.body import Wheels
from wmrlib.checks import checked
from wmrlib.compilation import formula
from wmrlib.elementary import distance, wrap
from wmrrobot.odometry import Past, Place, carry, copy_place, look_back, remember, shift

STATES = "wait", "drive", "turn", "parked", "stopped"
WAIT, DRIVE, TURN, PARKED, STOPPED = range(len(STATES))
REFUSALS = "none", "broken", "poor", "late", "stale", "frozen", "jumped", "turned"
NONE, BROKEN, POOR, LATE, STALE, FROZEN, JUMPED, TURNED = range(len(REFUSALS))


@checked("above_0", at_least_0=("slip", "battery"), at_most_1=("share",))
class Rules(NamedTuple):
    """The thresholds of the checks of a robot's sensors.

    Smaller faults stay undetected: a compass error below `astray`, or any compass error on a drive
    shorter than `course`; a position that drifts so slowly that the wheels could have done it.

    Parameters
    ----------
    arrival_radius : float, m. Within it the robot parks, or begins the last turn.
    patience : float, s. So long after the last usable fix the robot stops and waits.
    oldest, largest_error : float; s, m. An older fix, or one with a larger error, is not used.
        Give `oldest` the usual delay of your receiver and 0.2 s more, `patience` two fixes more.
    least : int. Nor is a fix of a lower quality used, by NMEA: 1 GPS, 2 differential, 3 PPS, 5 RTK
        float and, the best, 4 RTK fixed.
    settle : int. Number of good fixes in a row after which the robot may drive.
    jump, slip : float; m, no unit. Nor is a fix used that is farther than jump from the position by
        odometry, which may itself err by the share slip of the rolled distance. After a jump, it
        is used again once `settle` fixes in a row are within jump alone. One wheel alone may slip
        by about astray times the track width over `course`: then it is `astray`.
    frozen : float, m. After rolling so far with the same position to the last bit, the receiver
        counts as dead.
    course, astray : float; m, rad. Over legs of length course, the headings by fixes and by wheels
        are compared, and may differ by astray.
    wheel, share : float; m, no unit. A wheel that was commanded to roll the distance wheel and
        rolled less than this share of it is stuck; one that rolled so far and was commanded less
        than this share is loose.
    longest_period, longest_drive, longest_wait : float, s. Longer periods count as a jump of the
        clock; a longer drive is stopped, and so is one that waits longer on its way.
    farthest : float, m. A goal that is farther away counts as a mistake.
    battery : float, V. Below it for the time of `patience`, the robot stops.
    """

    arrival_radius: float = 0.2
    patience: float = 0.5
    oldest: float = 0.3
    largest_error: float = 1.0
    least: int = 1
    settle: int = 3
    jump: float = 1.0
    slip: float = 0.2
    frozen: float = 0.3
    course: float = 4.0
    astray: float = 0.8
    wheel: float = 0.48
    share: float = 0.25
    longest_period: float = 0.15
    longest_drive: float = 300.0
    longest_wait: float = 60.0
    farthest: float = 500.0
    battery: float = 0.0


class Seen(NamedTuple):
    """The readings of all sensors in a period: clock, encoders, battery, fence, and a new fix.

    Parameters
    ----------
    seconds : float, s since the period before by the robot's clock
    left, right : float, m that the wheels rolled in that time, by their encoders
    battery : float, V
    goal_inside, inside, fresh : int; whether the goal is inside the fence, whether the fix is, and
        whether there is a new fix: with 0 the fields below are not read
    x, y, heading : float; m, m, rad
    antenna_ahead, antenna_left : float, m. The place on the robot that x and y are of, from the
        middle between the wheels: the receiver's antenna, or 0 for a filter's position.
    quality : int, NMEA's: 1 to 5 are GPS, differential, PPS and RTK, others are no fix
    error : float, m. The accuracy that the receiver, or a filter, reports; 0 if it reports none
    later, age : float, s; time from the fix before by the receiver's own clock, and age of the fix
    """

    seconds: float
    left: float
    right: float
    battery: float = inf
    goal_inside: int = 1
    inside: int = 1
    fresh: int = 0
    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0
    antenna_ahead: float = 0.0
    antenna_left: float = 0.0
    quality: int = 4
    error: float = 0.0
    later: float = 0.1
    age: float = 0.0


@dataclass(slots=True)
class Wheel:
    """The state of a wheel and its checks.

    `commanded` and `speed` are its command and the speed expected of it, m/s; `due` and `rolled`
    are the expected and the counted distance since the last check, m.
    """

    commanded: float = 0.0
    speed: float = 0.0
    due: float = 0.0
    rolled: float = 0.0
    stuck: int = 0
    loose: int = 0


@dataclass(slots=True)
class Memory:
    """The state of a drive from one period to the next: pose, checks and counters; first all 0."""

    state: int = WAIT
    reason: int = 0
    pose: Place = field(default_factory=Place)  # the last usable fix, carried on by odometry
    left: Wheel = field(default_factory=Wheel)
    right: Wheel = field(default_factory=Wheel)
    regular: int = 0  # the clock went on by a period
    low: float = 0.0  # s of a low battery
    silence: float = 0.0  # s since the last usable fix
    good: int = 0  # usable fixes in a row
    refused: int = NONE  # why the last fix was not used
    near: int = 0  # fixes in a row that had not jumped
    past: Past = field(default_factory=Past)
    fix: Place = field(default_factory=Place)  # the last one, carried on to now by odometry
    since: float = 0.0  # m rolled since the last usable fix
    x: float = 0.0  # of the last fix, usable or not
    y: float = 0.0
    still: float = 0.0  # m rolled since these changed
    outside: int = 0
    outran: int = 0  # the fixes went farther than the wheels can have rolled
    begin: Place = field(default_factory=Place)  # of a leg
    leg: Place = field(default_factory=Place)  # where the wheels are by now
    length: float = 0.0  # m of it
    turning: float = 0.0  # rad of it
    turned: int = 0  # fixes in a row whose heading is not the wheels'
    astray: int = 0
    slipping: int = 0
    driven: float = 0.0  # s
    waited: float = 0.0  # s in a row, on its way
    rho: float = 0.0
    remaining_turn: float = 0.0  # rad to the goal's heading
    facing: int = 0  # periods in a row with the goal's heading
    faced: float = 0.0  # s of these


@formula
def rank(quality: int) -> int:
    """The order of NMEA's qualities: RTK float, 5, is worse than RTK fixed, 4; 0 is no fix."""
    if quality < 1 or quality > 5:
        return 0
    return quality if quality < 4 else 9 - quality


@formula
def bring_up(m: Memory, seen: Seen) -> None:
    """Carry a fix from the antenna to the middle, and on by the odometry since it was measured."""
    look_back(m.past, seen.age)
    m.fix.x, m.fix.y, m.fix.heading = seen.x, seen.y, seen.heading
    shift(m.fix, -seen.antenna_ahead, -seen.antenna_left)
    carry(m.fix, m.past.since.ahead, m.past.since.turn)


@formula
def watch_wheel(wheel: Wheel, rolled: float, dt: float, rules: Rules, wheels: Wheels) -> None:
    """Compare the distance that a wheel rolled with its commands."""
    commanded = 0.0 if abs(wheel.commanded) < wheels.dead_band else wheel.commanded
    reach = wheels.acceleration * dt
    wheel.speed += min(max((commanded - wheel.speed) * dt / (wheels.lag + dt), -reach), reach)
    wheel.due += wheel.speed * dt
    wheel.rolled += rolled
    if max(abs(wheel.due), abs(wheel.rolled)) >= rules.wheel:
        both = wheel.due * wheel.rolled
        if abs(wheel.due) >= abs(wheel.rolled):
            wheel.stuck = both < rules.share * wheel.due * wheel.due
        else:
            wheel.loose = both < rules.share * wheel.rolled * wheel.rolled
        wheel.due, wheel.rolled = 0.0, 0.0


@formula
def refusal_of(m: Memory, seen: Seen, rules: Rules) -> int:
    """The reason why a fix cannot be used, or NONE; the fix is carried on to now."""
    if not (abs(seen.x) + abs(seen.y) + abs(seen.heading) < 1e9 and abs(seen.age) < 1e9):
        return BROKEN
    good = rank(seen.quality) >= rank(rules.least)
    if not good or not seen.error <= rules.largest_error:
        return POOR
    if seen.age > rules.oldest or seen.age < 0.0:
        return LATE
    bring_up(m, seen)
    if not seen.later > 0.0:
        return STALE
    if m.still > rules.frozen:
        return FROZEN
    gap = distance(m.fix.x - m.pose.x, m.fix.y - m.pose.y)
    jumped = m.refused == JUMPED and m.driven > 0.0  # the fix before: now odometry is no excuse
    m.near = m.near + 1 if gap <= rules.jump + (0.0 if jumped else rules.slip * m.since) else 0
    if m.near == 0 or (jumped and m.near < rules.settle):
        return JUMPED
    if abs(wrap(m.fix.heading - m.leg.heading)) > rules.astray and m.driven > 0.0:
        return TURNED
    return NONE


@formula
def compare(m: Memory, rules: Rules) -> None:
    """Compare a leg by fixes with the same leg by the wheels, and begin the next leg."""
    east, north = m.leg.x - m.begin.x, m.leg.y - m.begin.y
    x, y = m.fix.x - m.begin.x, m.fix.y - m.begin.y
    rolled = distance(east, north)
    if rolled >= rules.course:
        m.slipping = distance(x, y) < 0.5 * rolled
        m.outran = distance(x, y) > 2.0 * rolled
        m.astray = abs(atan2(east * y - north * x, east * x + north * y)) > rules.astray
    curls = m.length > 4.0 * rules.course or m.turning > 3.0
    if rolled >= rules.course or curls or m.driven == 0.0:
        copy_place(m.begin, m.fix)
        copy_place(m.leg, m.fix)
        m.length, m.turning = 0.0, 0.0


@formula
def take_fix(m: Memory, seen: Seen, rules: Rules) -> None:
    """Use a fix or note why not; before the first drive a jump is a new beginning."""
    if seen.x != m.x or seen.y != m.y:
        m.still = 0.0
    m.x, m.y = seen.x, seen.y
    m.refused = refusal_of(m, seen, rules)
    m.turned = m.turned + 1 if m.refused == TURNED else 0
    first = m.refused == JUMPED and m.driven == 0.0
    again = m.refused == STALE  # the same fix, sent twice
    m.good = 0 if first or (m.refused != NONE and not again) else m.good
    if m.refused == NONE or first:
        m.good += 1
        m.silence, m.since, m.outside = seen.age, 0.0, not seen.inside
        copy_place(m.pose, m.fix)
        compare(m, rules)


@formula
def observe(m: Memory, seen: Seen, rules: Rules, wheels: Wheels) -> None:
    """Check the readings of a period, carry the pose on, and use a new fix."""
    sound = abs(seen.left) + abs(seen.right) < 1e9  # else an encoder reading is no number
    m.regular = seen.seconds > 0.0 and seen.seconds <= rules.longest_period and sound
    passed = seen.seconds if seen.seconds > 0.0 else 0.0  # 0 for NaN too
    dt = min(passed, rules.longest_period)
    left, right = seen.left if sound else 0.0, seen.right if sound else 0.0
    ahead, turn = 0.5 * (left + right), (right - left) / wheels.track_width
    if m.regular:
        watch_wheel(m.left, left, dt, rules, wheels)
        watch_wheel(m.right, right, dt, rules, wheels)
    carry(m.pose, ahead, turn)
    carry(m.leg, ahead, turn)
    remember(m.past, ahead, turn, dt, rules.oldest)
    m.since += abs(ahead)
    m.still += abs(ahead)
    m.length += abs(ahead)
    m.turning += abs(turn)
    m.silence += passed
    m.low = m.low + dt if not seen.battery >= rules.battery else 0.0
    m.waited = m.waited + dt if m.state == WAIT and m.driven > 0.0 else 0.0
    m.driven += dt if m.state == DRIVE or m.state == TURN else 0.0
    m.good = m.good if m.regular and m.silence <= rules.patience else 0
    if seen.fresh:
        take_fix(m, seen, rules)
