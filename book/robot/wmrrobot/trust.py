"""What a robot makes of its sensors: where it is, and which of them can be trusted.

`printing` prints all of it as ``wmr_drive.h``, so it is written in the Python that C has too.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, inf
from typing import NamedTuple

from wmrlib.body import Wheels
from wmrlib.checks import checked
from wmrlib.elementary import distance, wrap
from wmrrobot.odometry import Past, Place, carry, copy_place, look_back, remember

STATES = "wait", "drive", "turn", "parked", "stopped"
WAIT, DRIVE, TURN, PARKED, STOPPED = range(len(STATES))
REFUSALS = "none", "broken", "poor", "late", "stale", "frozen", "jumped", "turned"
NONE, BROKEN, POOR, LATE, STALE, FROZEN, JUMPED, TURNED = range(len(REFUSALS))


@checked("above_0", at_least_0=("slip", "battery"), at_most_1=("share",))
class Rules(NamedTuple):
    """How far a robot trusts its sensors.

    What is wrong by less than these say goes unnoticed: a compass that is off by less than
    `astray`, or by any angle on a drive shorter than `course`; a position that drifts so slowly
    that the wheels could have done it.

    Parameters
    ----------
    arrival_radius : float, m. There it parks, or begins the last turn.
    patience : float, s since the last usable fix; then it stops, and waits.
    oldest, largest_error : float; s, m. A fix that is older, or says that it is worse, is not used.
        Give `oldest` the usual delay of your receiver and 0.2 s more, `patience` two fixes more.
    settle : int. So many good fixes in a row let it drive.
    jump, slip : float; m, no unit. Nor is one used that is farther than jump from where the wheels
        can be; the place that they tell may err by the share slip of what they rolled. One wheel
        alone may slip by about astray times the track width over `course`: then it is `astray`.
    frozen : float, m. Rolled so far, a robot whose position has the same bits has no receiver.
    course, astray : float; m, rad. Over legs so long, headings by fixes and wheels are compared.
    wheel, share : float; m, no unit. When a wheel was to roll, or rolled, so far, and did less than
        this share of it, it is stuck; and loose the other way round.
    longest_period, longest_drive : float, s
    farthest : float, m. A goal that is farther away is a mistake.
    battery : float, V. Below it for the time of `patience`, the robot stops.
    """

    arrival_radius: float = 0.2
    patience: float = 0.5
    oldest: float = 0.3
    largest_error: float = 1.0
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
    farthest: float = 500.0
    battery: float = 0.0


class Seen(NamedTuple):
    """What the sensors say in a period: clock, encoders, battery, fence, and a fix if it is new.

    Parameters
    ----------
    seconds : float, s since the period before by the robot's clock
    left, right : float, m that the wheels rolled in that time, by their encoders
    battery : float, V
    goal_inside, inside, fresh : int, 0 if the goal, or the fix, is outside the fence, and if there
        is no new fix: then what follows is not read
    x, y, heading : float; m, m, rad
    quality : int, NMEA's: 1 to 5 are GPS, differential, PPS and RTK, others are no fix
    error : float, m. What the receiver, or a filter, says of its own accuracy; 0 if nothing
    later, age : float, s from the fix before by the receiver's own time, and since it was true
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
    quality: int = 4
    error: float = 0.0
    later: float = 0.1
    age: float = 0.0


@dataclass(slots=True)
class Wheel:
    """A wheel: its command and its speed due [m/s], and what is due and what it rolled [m]."""

    told: float = 0.0
    speed: float = 0.0
    due: float = 0.0
    rolled: float = 0.0
    stuck: int = 0
    loose: int = 0


@dataclass(slots=True)
class Memory:
    """All that a drive keeps from one period to the next; it begins with zeros."""

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
    past: Past = field(default_factory=Past)
    fix: Place = field(default_factory=Place)  # the last one, brought up to now
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
    rho: float = 0.0
    off: float = 0.0  # rad that are still to be turned by
    facing: int = 0  # periods in a row with the goal's heading
    faced: float = 0.0  # s of these


def bring_up(m: Memory, seen: Seen) -> None:
    """Carry a fix on by what the wheels rolled since it was true."""
    look_back(m.past, seen.age)
    m.fix.x, m.fix.y, m.fix.heading = seen.x, seen.y, seen.heading
    carry(m.fix, m.past.since.ahead, m.past.since.turn)


def watch_wheel(wheel: Wheel, rolled: float, dt: float, rules: Rules, wheels: Wheels) -> None:
    """Hold what a wheel rolled against what it was told."""
    told = 0.0 if abs(wheel.told) < wheels.dead_band else wheel.told
    reach = wheels.acceleration * dt
    wheel.speed += min(max((told - wheel.speed) * dt / (wheels.lag + dt), -reach), reach)
    wheel.due += wheel.speed * dt
    wheel.rolled += rolled
    if max(abs(wheel.due), abs(wheel.rolled)) >= rules.wheel:
        both = wheel.due * wheel.rolled
        if abs(wheel.due) >= abs(wheel.rolled):
            wheel.stuck = both < rules.share * wheel.due * wheel.due
        else:
            wheel.loose = both < rules.share * wheel.rolled * wheel.rolled
        wheel.due, wheel.rolled = 0.0, 0.0


def refusal_of(m: Memory, seen: Seen, rules: Rules) -> int:
    """Why a fix can't be used; NONE if it can. On the way, the fix is carried on to now."""
    if not (abs(seen.x) + abs(seen.y) + abs(seen.heading) < 1e9 and abs(seen.age) < 1e9):
        return BROKEN
    measured = seen.quality >= 1 and seen.quality <= 5
    if not measured or not seen.error <= rules.largest_error:
        return POOR
    if seen.age > rules.oldest or seen.age < 0.0:
        return LATE
    bring_up(m, seen)
    if not seen.later > 0.0:
        return STALE
    if m.still > rules.frozen:
        return FROZEN
    gap = distance(m.fix.x - m.pose.x, m.fix.y - m.pose.y)
    if gap > rules.jump + rules.slip * m.since:
        return JUMPED
    if abs(wrap(m.fix.heading - m.leg.heading)) > rules.astray and m.driven > 0.0:
        return TURNED
    return NONE


def compare(m: Memory, rules: Rules) -> None:
    """Hold a leg of the fixes against that of the wheels; then, or when it curls, begin anew."""
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


def read(m: Memory, seen: Seen, rules: Rules) -> None:
    """Take a fix, or say why not; before the first drive a jump is a new beginning."""
    if seen.x != m.x or seen.y != m.y:
        m.still = 0.0
    m.x, m.y = seen.x, seen.y
    m.refused = refusal_of(m, seen, rules)
    m.turned = m.turned + 1 if m.refused == TURNED else 0
    first = m.refused == JUMPED and m.driven == 0.0
    again = m.refused == STALE  # the same fix, told twice
    m.good = 0 if first or (m.refused != NONE and not again) else m.good
    if m.refused == NONE or first:
        m.good += 1
        m.silence, m.since, m.outside = seen.age, 0.0, not seen.inside
        copy_place(m.pose, m.fix)
        compare(m, rules)


def look(m: Memory, seen: Seen, rules: Rules, wheels: Wheels) -> None:
    """Take in a period: the clock, the wheels, the battery, and a fix if there is one."""
    sound = abs(seen.left) + abs(seen.right) < 1e9  # or an encoder says no number
    m.regular = seen.seconds > 0.0 and seen.seconds <= rules.longest_period and sound
    passed = seen.seconds if seen.seconds > 0.0 else 0.0  # not what is no number
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
    m.driven += dt if m.state == DRIVE or m.state == TURN else 0.0
    m.good = m.good if m.regular and m.silence <= rules.patience else 0
    if seen.fresh:
        read(m, seen, rules)
