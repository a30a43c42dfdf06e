"""The drive round the law: it survives every fault, in Python and in C."""

import json
import math
import sys
from pathlib import Path

import compiled
import drive_faults as faults
import numpy as np
import pytest
import world
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr
import wmrrobot as wr
from wmrrobot import monitor, sensing
from wmrrobot.drive import TABLE

CASES = {case.name: case for case in faults.CASES}


@pytest.fixture(scope="module")
def ran():
    return {name: faults.run(case) for name, case in CASES.items()}


@pytest.mark.parametrize("name", CASES)
def test_a_fault_is_survived_and_none_drives_blind(ran, name):
    assert faults.holds(CASES[name], ran[name]), ran[name][:5]


def test_each_reason_of_the_table_has_its_fault():
    assert {row.reason for row in TABLE} - {""} <= {
        ran.must.partition(": ")[2] for ran in faults.CASES
    }


def test_the_command_prints_the_table(monkeypatch, capsys):
    case, slight = faults.CASES[2], faults.SLIGHT[0]
    monkeypatch.setattr(faults, "CASES", [case])
    monkeypatch.setattr(faults, "SLIGHT", [slight])
    monkeypatch.setattr(sys, "argv", ["drive_faults.py"])
    faults.main()
    _, fault, held, unnoticed = capsys.readouterr().out.splitlines()
    assert fault.startswith(case.name)
    assert case.must in fault
    assert held == "5 of 5 as they must"
    assert unnoticed.startswith(slight.name)


def test_the_page_shows_the_faults_as_they_come_out(ran):
    stored = json.loads((Path(faults.__file__).parents[1] / "faults.json").read_text("utf-8"))
    assert [row[0] for row in stored["faults"]] == [*CASES]
    for name, end, far, within in stored["faults"]:
        came = ran[name].distance if end == "parked" else ran[name].blind
        assert (end, within) == (ran[name].end, CASES[name].within)
        assert far == pytest.approx(came, abs=0.02)  # the last bits of processors
    for (name, end, *numbers), case in zip(stored["slight"], faults.SLIGHT, strict=True):
        came = faults.run(case)
        assert (name, end) == (case.name, came.end)
        assert faults.holds(case, came)
        drift = came.blind, came.distance, math.degrees(came.heading)
        assert numbers == pytest.approx(drift, abs=1.0)


def step_alike(drives, seen):
    """Let both drives take a step; return the first one's speeds."""
    ours, theirs = (drive.step(seen) for drive in drives)
    assert theirs == pytest.approx(ours, abs=1e-12)
    assert drives[0].state == drives[1].state
    assert drives[0].reason == drives[1].reason
    return ours


@pytest.mark.needs("compiler")
@pytest.mark.parametrize("name", CASES)
def test_c_decides_the_same_in_each_period(ran, name):
    case, seen = CASES[name], ran[name].readings
    if case.wrong.get("hangs"):
        assert faults.run(case, compiled.CDrive).decisions == ran[name].decisions
        return
    plan, rules = (faults.CASE.goal, faults.GAINS, faults.WHEELS), wr.Rules(**case.rules)
    drives = [kind(*plan, rules=rules) for kind in (wr.Drive, compiled.CDrive)]
    for period, decided in zip(seen, ran[name].decisions, strict=True):
        step_alike(drives, period)
        assert (drives[0].state, drives[0].reason) == decided


def goes(drive, pose, seconds, until="", off=(0.0, 0.0), width=0.5, **fields):
    """Let a robot with perfect wheels drive for a time, or until a state, its fixes `off`."""
    states, left, right = [], 0.0, 0.0
    for _ in range(round(seconds / 0.05)):
        if drive.state == until:
            break
        fix = pose._replace(x=pose.x + off[0], y=pose.y + off[1])
        seen = wr.Seen(0.05, 0.05 * left, 0.05 * right, fresh=1, **fix._asdict(), **fields)
        left, right = drive.step(seen)
        pose = wmr.advance(pose, *wmr.wheels_to_twist(left, right, width), 0.05)
        states.append(drive.state)
    return pose, states


@pytest.mark.slow
@pytest.mark.parametrize("seed", [2, 3, 4, 5])
def test_a_fault_is_survived_whatever_the_sensors_noise(seed):
    ran = {case.name: faults.run(case, seed=seed) for case in faults.CASES}
    assert [name for name in ran if not faults.holds(CASES[name], ran[name])] == []


ANYWHERE = (-99.0, -99.0, 99.0, 99.0)
GOAL, START = wmr.Pose(3.0, 0.0, 1.5), wmr.Pose(0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "kind", [wr.Drive, pytest.param(compiled.CDrive, marks=pytest.mark.needs("compiler"))]
)
def test_without_a_last_turn_it_parks_as_it_arrives(kind):
    drive = kind(GOAL, wmr.GENTLE_GAINS, faults.WHEELS, last_turn=None)
    pose, states = goes(drive, START, 20.0)
    assert list(dict.fromkeys(states)) == ["wait", "drive", "parked"]
    assert abs(pose.heading - GOAL.heading) > 0.1


def test_carried_off_during_the_last_turn_it_drives_again():
    drive = wr.Drive(GOAL, wmr.GENTLE_GAINS, faults.WHEELS, rules=wr.Rules(jump=2.0))
    pose, _ = goes(drive, START, 20.0, until="turn")
    pose, states = goes(drive, pose._replace(x=pose.x - 1.0), 20.0)
    assert list(dict.fromkeys(states)) == ["drive", "turn", "parked"]
    assert pose.heading == pytest.approx(GOAL.heading, abs=0.03)


def test_what_has_stopped_or_parked_stays_so_until_it_is_reset():
    drive = wr.Drive(GOAL, wmr.GENTLE_GAINS, faults.WHEELS, rules=wr.Rules(battery=20.0))
    pose, _ = goes(drive, START, 2.0, battery=24.0)
    pose, _ = goes(drive, pose, 2.0, battery=19.0)
    assert (drive.state, drive.reason) == ("stopped", "battery low")
    stands, _ = goes(drive, pose, 5.0, battery=24.0)
    assert stands == pose
    drive.reset()
    goes(drive, pose, 20.0, battery=24.0)
    assert (drive.state, drive.reason) == ("parked", "")


@pytest.mark.parametrize(("gap", "refused"), [(1.1, monitor.NONE), (1.3, monitor.JUMPED)])
def test_a_jump_is_measured_from_where_an_old_fix_is_by_now(gap, refused):
    m, rules = monitor.Memory(driven=1.0, since=1.0), wr.Rules()  # 1 m, and 0.2 m of slip
    monitor.remember(m.past, 0.6, 0.0, 0.3, rules.oldest)
    seen = wr.Seen(0.05, 0.0, 0.0, x=-gap - 0.6, age=0.3)
    assert monitor.refusal_of(m, seen, rules) == refused


@given(
    st.lists(st.tuples(st.floats(0.005, 0.15), st.floats(-1, 1), st.floats(-3, 3)), min_size=1),
    st.floats(0.0, 1.0),
    st.floats(0.1, 1.0),
    st.booleans(),
)
def test_an_old_fix_is_carried_on_by_what_the_wheels_rolled_since(rows, share, oldest, steady):
    """Exactly while they keep a twist; otherwise to within what they turn in a stretch or so."""
    m, pose = monitor.Memory(), START
    v, omega = rows[0][1:]
    path, now = [], 0.0
    for dt, *twist in rows * 20:
        v, omega = (v, omega) if steady else twist
        path.append((now, pose, v, omega))
        pose, now = wmr.advance(pose, v, omega, dt), now + dt
        monitor.remember(m.past, v * dt, omega * dt, dt, oldest)
    age = min(share * oldest, now)
    begin, then, *twist = next(row for row in path[::-1] if row[0] <= now - age)
    then = wmr.advance(then, *twist, now - age - begin)
    monitor.bring_up(m, wr.Seen(0.05, 0.0, 0.0, **then._asdict(), age=age))
    off = abs(wmr.wrap_angle(m.fix.heading - pose.heading))
    assert m.past.since.seconds == pytest.approx(age, abs=1e-9)
    if steady:
        assert off < 1e-6
        assert (m.fix.x, m.fix.y) == pytest.approx((pose.x, pose.y), abs=1e-6)
    assert off <= 3.0 * (oldest / 6 + 0.15) + 1e-9


@pytest.mark.parametrize("late", [0.0, 0.5])
def test_honest_drives_with_late_fixes_park(monkeypatch, late):
    """And as near, whatever the delay; the wheels know what the fixes don't say yet."""
    rng, rules = np.random.default_rng(1), {"oldest": late + 0.2, "patience": late + 0.4}
    case = faults.Case("late", {"delay": late}, "parked", 0.3, 0.0, rules=rules, fence=ANYWHERE)
    for seed in range(15):
        start, goal = wmr.Pose(0.0, 0.0, rng.uniform(-3, 3)), wmr.Pose(*rng.uniform(-9, 9, 2), 1.0)
        fake = faults.CASE._replace(start=start, goal=goal)
        for module in (faults, world):
            monkeypatch.setattr(module, "CASE", fake)
        ran = faults.run(case, seed=seed)
        assert faults.holds(case, ran), (ran[:5], start, goal)
        assert ran.heading < 0.04


@given(distance=st.floats(0.25, 1.0), heading=st.floats(-1.2, 1.2), least=st.floats(0.1, 0.8))
def test_the_least_speed_keeps_the_path_of_the_law(distance, heading, least):
    """Near its goal, where the law alone would drive more slowly, both wheels hurry alike."""
    wheels, gains = wmr.Wheels(0.5, min_speed=least), wmr.Gains(0.1, 0.5, 2.0, 1.0)
    start, goal = wmr.Pose(0.0, 0.0, heading), wmr.Pose(distance, 0.0, 0.4)
    drive = wr.Drive(goal, gains, wheels)
    while drive.state != "drive":
        speeds = drive.step(wr.Seen(0.05, 0.0, 0.0, fresh=1, **start._asdict()))
    error = wmr.polar_error(start, goal)
    v, omega = wmr.control_law(*error, gains)
    hurried = wmr.wheels_to_twist(*speeds, 0.5)
    assert hurried == pytest.approx([max(1.0, least * math.cos(error.alpha) / v) * speed
                                     for speed in (v, omega)])  # fmt: skip


anywhere = st.builds(wmr.Pose, *[st.floats(-50.0, 50.0)] * 2, st.floats(-3.1, 3.1))
arms = st.floats(-2.0, 2.0)


@given(anywhere, arms, arms)
def test_wherever_the_antenna_is_the_robot_is_where_its_wheels_are(pose, ahead, left):
    x, y = sensing.antenna(*pose, ahead, left)
    arm = {"antenna_ahead": ahead, "antenna_left": left}
    m = monitor.Memory()
    monitor.bring_up(m, wr.Seen(0.05, 0.0, 0.0, x=x, y=y, heading=pose.heading, **arm))
    assert (m.fix.x, m.fix.y, m.fix.heading) == pytest.approx(tuple(pose), abs=1e-9)


@given(st.sampled_from(range(-3, 9)), st.sampled_from([1, 2, 3, 5, 4]))
def test_a_fix_below_the_least_quality_is_refused(quality, least):
    """From worst to best: none, GPS, differential, PPS, RTK float, which is 5, and fixed."""
    order = [1, 2, 3, 5, 4]
    seen = wr.Seen(0.05, 0.0, 0.0, quality=quality)
    refused = monitor.refusal_of(monitor.Memory(), seen, wr.Rules(least=least))
    good = quality in order and order.index(quality) >= order.index(least)
    assert (refused == monitor.NONE) == good


@settings(max_examples=15, deadline=None)
@given(st.floats(0.15, 3.0), st.floats(-3.1, 3.1), st.floats(0.5, 4.0), st.floats(0.5, 3.0))
def test_with_rtk_a_wrong_fix_that_lasts_stops_the_robot(off, towards, begin, wait):
    """By the rules of its sheet: it neither believes the fix in the end nor waits for ever."""
    numbers = wr.sheet(wr.Robot())
    goal, rules = (
        wmr.Pose(numbers.x, numbers.y, numbers.heading),
        numbers.rules._replace(longest_wait=wait),
    )
    drive = wr.Drive(goal, numbers.gains, numbers.wheels, numbers.turn, rules)
    pose = wmr.Pose(0.0, 0.0, math.atan2(numbers.y, numbers.x))
    pose, _ = goes(drive, pose, 1.0 + begin, width=0.4)
    assert drive.state == "drive"
    east, north = off * math.cos(towards), off * math.sin(towards)
    _, states = goes(drive, pose, rules.patience + wait + 1.0, "stopped", (east, north), width=0.4)
    assert (drive.state, drive.reason) == ("stopped", "waited too long")
    assert 0.05 * states.count("wait") == pytest.approx(wait, abs=0.11)


@settings(max_examples=10, deadline=None)
@given(st.floats(0.0, 0.2), st.booleans())
def test_with_rtk_a_wheel_may_slip_by_a_fifth(slip, left):
    """A soft tyre is no wrong heading: the rules of the sheet compare short legs."""
    numbers, robot = wr.sheet(wr.Robot()), wr.Robot()
    goal = wmr.Pose(numbers.x, numbers.y, numbers.heading)
    drive = wr.Drive(goal, numbers.gains, numbers.wheels, numbers.turn, numbers.rules)
    pose, speeds = wmr.Pose(0.0, 0.0, math.atan2(numbers.y, numbers.x)), (0.0, 0.0)
    grip = (1.0 - slip, 1.0) if left else (1.0, 1.0 - slip)
    for _ in range(600):
        rolled = [0.05 * speed for speed in speeds]
        speeds = drive.step(wr.Seen(0.05, *rolled, fresh=1, **pose._asdict()))
        true = [share * speed for share, speed in zip(grip, speeds, strict=True)]
        pose = wmr.advance(pose, *wmr.wheels_to_twist(*true, robot.track_width), 0.05)
    assert drive.state == "drive"


@given(st.floats(-0.05, 0.05))
def test_what_is_rolled_counts_backwards_too(rolled):
    m = monitor.Memory()
    monitor.observe(m, wr.Seen(0.05, rolled, rolled), wr.Rules(), wmr.Wheels(0.4))
    assert (m.since, m.still, m.length) == (abs(rolled),) * 3


@given(st.floats(0.1, 60.0), st.floats(0.02, 0.5))
def test_a_last_turn_that_would_swing_in_the_longest_period_is_refused(gain, period):
    turn, rules = wmr.LastTurn(gain=gain, max_rate=3.0), wr.Rules(longest_period=period)
    if gain * period < 2.0:
        assert wr.Drive(GOAL, wmr.GENTLE_GAINS, faults.WHEELS, turn, rules).end == turn
    else:
        with pytest.raises(ValueError, match=r"^last_turn\.gain = .* a period of "):
            wr.Drive(GOAL, wmr.GENTLE_GAINS, faults.WHEELS, turn, rules)


numbers = st.one_of(st.floats(-3.0, 3.0), st.sampled_from([float("nan"), float("inf"), 1e6]))
periods = st.builds(
    wr.Seen,
    seconds=st.sampled_from([0.05] * 9 + [0.0, 1.0, -1.0, 1e30, float("nan")]),
    left=st.one_of(st.floats(-0.1, 0.1), st.sampled_from([float("nan"), 1e30])),
    right=st.floats(-0.1, 0.1),
    battery=st.sampled_from([24.0, 24.0, 20.0, float("nan")]),
    goal_inside=st.just(1),
    inside=st.sampled_from([1, 1, 1, 0]),
    fresh=st.sampled_from([1, 1, 0]),
    x=numbers,
    y=numbers,
    heading=numbers,
    quality=st.sampled_from([4, 4, 4, 0, 6]),  # whole numbers in C
    error=st.sampled_from([0.0, 0.5, 2.0, float("nan")]),
    later=st.sampled_from([0.1, 0.1, 0.0, -0.1, float("nan")]),
    age=st.sampled_from([0.05, 0.05, 0.4, -1.0, float("nan")]),
)


@pytest.mark.needs("compiler")
@given(st.lists(st.tuples(periods, st.integers(1, 8)), max_size=20))
def test_whatever_the_sensors_say_c_and_python_agree_and_the_unsettled_stand(given_):
    rules = wr.Rules(jump=4.0, battery=22.0)
    given_ = [seen for seen, times in given_ for _ in range(times)]
    plan, silent = (GOAL, wmr.GENTLE_GAINS, faults.WHEELS), 0.0
    drives = [kind(*plan, rules=rules) for kind in (wr.Drive, compiled.CDrive)]
    for seen in given_:
        speeds = step_alike(drives, seen)
        trusted = seen.fresh and 1 <= seen.quality <= 5 and seen.later > 0 and seen.age >= 0
        silent = 0.0 if trusted else silent + (seen.seconds if seen.seconds > 0.0 else 0.0)
        if silent > rules.patience or drives[0].state not in ("drive", "turn"):
            assert speeds == (0.0, 0.0)


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"goal": (0, 0, 0)}, "goal"),
        ({"gains": wmr.KanayamaGains(1, 1, 1)}, "gains"),
        ({"rules": wr.Rules(settle=2.5)}, "rules.settle = 2.5"),
        ({"law": "kanayama"}, "law"),
        ({"last_turn": wmr.LastTurn(tolerance=float("nan"))}, "last_turn.tolerance"),
        ({"wheels": wmr.Wheels(0.5, dead_band=0.05)}, "last_turn.min_rate = 0.2"),
    ],
)
def test_an_argument_that_is_not_allowed_is_named(change, named):
    given_ = {"goal": GOAL, "gains": wmr.GENTLE_GAINS, "wheels": faults.WHEELS} | change
    with pytest.raises(ValueError, match=f"^{named}"):
        wr.Drive(**given_)


@pytest.mark.parametrize("name", wr.Rules._fields)
def test_a_rule_that_means_nothing_is_refused(name):
    for wrong in (-1.0, float("nan"), *((2.0,) if name == "share" else ())):
        with pytest.raises(ValueError, match=f"^{name} = "):
            wr.Rules(**{name: wrong})
