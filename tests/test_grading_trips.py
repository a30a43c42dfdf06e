"""The checks of a trip: other right answers pass, and what is no answer gets a clear hint."""

import math

import pytest

import wmrlib as wmr
from wmrbook.grading import Hint, trips


def poses(start_point, goal_point, start_course, goal_course):
    """By distance and bearing, as lists, with headings of more than a turn."""
    length, bearing = (
        wmr.haversine_distance(start_point, goal_point),
        wmr.initial_bearing(start_point, goal_point),
    )
    headings = [math.radians(450.0 - course) for course in (start_course, goal_course)]
    return [
        [0, 0, headings[0]],
        [length * math.sin(bearing), length * math.cos(bearing), headings[1]],
    ]


def parked(run):
    """A numpy bool, from the run's own heading error."""
    result = wmr.arrival(run)
    return (run.rho[-1] < 0.1) & (math.cos(result.heading_error) > math.cos(math.radians(5.0)))


def test_other_forms_pass():
    for check in (trips.poses_known, trips.poses_facing):
        assert check(poses)
    for check in (trips.parked_runs, trips.parked_wrapped):
        assert check(parked)
    for gains in (wmr.Gains(0.3, 1.5, 1, 4), wmr.Gains(0.3, 1.75, 1.25)):
        for check in (trips.home_time, trips.home_heading, trips.home_omega):
            assert check(gains)


@pytest.mark.parametrize(
    ("change", "hint"),
    [
        (lambda start, goal: ([5, 5, start[2]], goal), r"not at \(0, 0\)"),
        (lambda start, goal: (start, [-goal[0], -goal[1], goal[2]]), "opposite side"),
        (lambda start, goal: (start, [0, 0, goal[2]]), "is not where it should be"),
        (lambda start, goal: (start, [*goal[:2], goal[2] + math.pi]), "the goal looks backwards"),
        (lambda start, goal: ([*start[:2], 1.0], goal), "the start's heading is wrong"),
        (lambda start, goal: start, "two poses are needed"),
        (lambda start, goal: None, "two poses are needed"),
        (lambda start, goal: (0.0, 0.0), "two poses are needed"),
        (lambda start, goal: {tuple(start), tuple(goal)}, "two poses are needed"),
        (lambda start, goal: (start, goal, goal), "two poses are needed"),
        (lambda start, goal: (start, goal[:2]), "two poses are needed"),
        (lambda start, goal: (start, (None, 1, 2)), "the goal's x has no value yet"),
    ],
)
def test_poses_hints(change, hint):
    with pytest.raises(Hint, match=hint):
        trips.poses_known(lambda *each: change(*poses(*each)))


def test_poses_that_face_the_wrong_way():
    with pytest.raises(Hint, match="straight ahead"):
        trips.poses_facing(lambda a, b, c, d: poses(a, b, c + 20, d))
    with pytest.raises(Hint, match="theta must be 0"):
        trips.poses_facing(lambda a, b, c, d: poses(a, b, c, d + 20))
    with pytest.raises(Hint, match="the same place"):
        trips.poses_facing(lambda a, b, c, d: poses(a, a, c, d))


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (lambda run: None, "returns nothing"),
        (lambda run: 1, "True or False"),
        (lambda run: True, "counts as parked"),
        (lambda run: False, "has parked, and is said not to have"),
        (lambda run: run.rho[-1] < 0.1, "does it look at the heading"),
        (lambda run: abs(run.heading_error[-1]) < 0.08, "look at the distance"),
        (lambda run: run.rho[-1] < 1.0 and abs(run.heading_error[-1]) < 0.08, "arrival radius"),
        (
            lambda run: run.outcome is wmr.Outcome.ARRIVED and parked(run),
            "went on until the time was up",
        ),
        (
            lambda run: run.rho[-1] <= 0.1 and abs(run.theta[-1]) <= 0.087,
            "neither is the error of the heading",
        ),
        (
            lambda run: run.rho[-1] <= 0.1 and abs(run.alpha[-1]) <= 0.087,
            "neither is the error of the heading",
        ),
        (
            lambda run: run.rho[-1] <= 0.1 and abs(run.heading_error[-1]) <= math.radians(20.0),
            "5 deg are asked for",
        ),
        (
            lambda run: run.rho[-1] <= 0.4 and abs(run.heading_error[-1]) <= 0.087,
            "0.1 m are asked for",
        ),
        (
            lambda run: (
                run.rho[-1] <= 0.1 and abs(abs(run.heading[-1]) - abs(run.goal.heading)) <= 0.087
            ),
            "opposite directions",
        ),
        (
            lambda run: run.rho[-1] <= 0.1 and abs(math.sin(run.heading_error[-1])) <= 0.087,
            "opposite directions",
        ),
    ],
)
def test_parked_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        trips.parked_runs(answer)


def test_parked_wrapped_is_not_fooled():
    with pytest.raises(Hint, match="every run counts"):
        trips.parked_wrapped(lambda run: True)
    sides = {run.heading[-1] > 0 for run in trips._western_runs()}
    assert sides == {True, False}


@pytest.mark.parametrize(
    ("gains", "hint"),
    [
        (None, "no value yet"),
        ((0.3, 1.5, 1.0), "has to be"),
        (wmr.Gains(0.3, 1.5, 1.0, 8.0), "can do no more"),
        (wmr.Gains(0.0, 1.5, 1.0), "does not come home"),
    ],
)
def test_home_hints(gains, hint):
    for check in (trips.home_time, trips.home_heading, trips.home_omega):
        with pytest.raises(Hint, match=hint):
            check(gains)
