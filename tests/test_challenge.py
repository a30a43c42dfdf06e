"""The tuning challenge: its cases as published, its score against single runs, by symmetry, and by another compiler's rounding."""

import json
import math
import os
import subprocess
import sys
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook import challenge
from wmrbook.challenge import Case, Challenge, drive, from_seed, rounded, score

PAPER = wmr.Gains(2.0, 1.0, 0.3, 4.0)
GENTLE = wmr.Gains(0.2, 2.0, 2.0, 4.0)
GOOD = wmr.Gains(0.128, 1.089, 1.42, 7.528)
WILD = wmr.Gains(5.0, 0.1, 5.0, 20.0)
all_gains = st.builds(
    wmr.Gains, st.floats(0.02, 4.0), st.floats(0.1, 6.0), st.floats(0.02, 6.0), st.floats(0.2, 10.0)
)
# centimetres and tenths of a degree, as published
PUBLISHED = [
    ("ahead", -1284, 560, -118, -479, 228, -1440),
    ("ahead", -1291, 611, -726, -3745, -2464, 1556),
    ("far ahead", 61, 1304, -186, 5370, 737, -138),
    ("close beside", -276, 653, -1754, -265, 319, -1166),
    ("beside", -259, -800, -1046, -2424, 12, -1541),
    ("half behind", 1787, 254, -242, 773, -245, -979),
    ("straight behind", -954, 803, -980, -822, 1231, 34),
    ("straight behind", 194, 486, -460, -1392, 2842, 713),
    ("near", 309, -335, -1794, 156, -429, -1482),
    ("near behind", -1626, 1619, 1763, -1576, 1712, 1177),
    ("across", 268, -334, 987, 1716, 972, 1440),
    ("far behind", 1788, -1905, -728, 1729, 3376, -1472),
]


def test_the_published_cases():
    game = from_seed()
    assert game is from_seed(challenge.SEED)
    assert (game.seed, game.dt, game.arrival_radius, game.duration, tuple(game.wheels)) == (
        2026,
        0.1,
        0.05,
        60.0,
        (0.5, 2.0),
    )
    rows = [
        (
            kind,
            *(
                round(value)
                for pose in poses
                for value in (100 * pose.x, 100 * pose.y, 10 * math.degrees(pose.heading))
            ),
        )
        for kind, *poses in game.cases
    ]
    assert rows == PUBLISHED


@given(st.integers(0, 2**63 - 1))
def test_every_seed_has_each_kind_of_case(seed):
    game = from_seed(seed)
    assert [case.kind for case in game.cases] == [row[0] for row in PUBLISHED]
    errors = {case.kind: wmr.polar_error(case.start, case.goal) for case in game.cases}
    off = {kind: abs(math.degrees(error.alpha)) for kind, error in errors.items()}
    assert 164 < off["straight behind"] < 176
    assert 79 < off["beside"] < 101
    assert 49 < errors["far ahead"].rho < 61
    assert max(errors["near"].rho, errors["near behind"].rho) < 2.02
    assert off["far ahead"] < 46
    for case in game.cases:
        assert abs(case.start.x) <= 20.0
        assert abs(case.start.y) <= 20.0
        assert abs(wmr.polar_error(case.start, case.goal).theta) < math.radians(152)


def test_seeds_differ_in_sides_too():
    left = [
        [wmr.polar_error(*case[1:]).alpha > 0 for case in from_seed(seed).cases]
        for seed in range(200)
    ]
    assert np.all(np.abs(np.mean(left, axis=0) - 0.5) < 0.12)


# The score ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("gains", [PAPER, GENTLE, GOOD])
def test_the_score_is_that_of_single_runs(gains):
    """By `simulate` and `arrival`, one case after the other."""
    game, points = from_seed(), []
    for case, run, row in zip(game.cases, drive(gains), score(gains).cases, strict=True):
        single = wmr.simulate(
            case.start,
            case.goal,
            gains,
            dt=game.dt,
            duration=game.duration,
            arrival_radius=game.arrival_radius,
            wheels=game.wheels,
        )
        np.testing.assert_array_equal(single.x, run.x)
        end = wmr.arrival(single)
        assert end.arrived
        points.append(end.time + 0.5 * abs(math.degrees(end.heading_error)) + 4.0 * end.peak_omega)
        assert (row.time, row.peak_omega) == (
            pytest.approx(end.time),
            pytest.approx(end.peak_omega),
        )
        assert row.heading_error_deg == pytest.approx(abs(math.degrees(end.heading_error)))
        assert row.points == pytest.approx(points[-1])
        assert row.distance == pytest.approx(math.dist(case.start[:2], case.goal[:2]))
        assert np.all(np.abs(run.v) + 0.25 * np.abs(run.omega) <= 2.0 + 1e-9)
    assert score(gains).total == pytest.approx(np.mean(points), abs=0.00501)


def test_the_published_scores():
    assert [score(gains).total for gains in (PAPER, GENTLE, GOOD)] == [52.28, 25.78, 21.81]


def test_neither_extreme_wins():
    """A coarse sweep: the best gains lie inside, the paper's lose clearly, gentle ones are better than those, and not the best."""
    grid = {
        "k_rho": [0.05, 0.1, 0.2, 0.4, 0.8, 2.0],
        "k_alpha": [0.2, 0.5, 1.0, 2.0, 5.0],
        "h": [0.1, 0.4, 1.5, 4.0, 10.0],
    }
    totals = np.array(
        [
            [[score(wmr.Gains(a, b, c, 6.0)).total for c in grid["h"]] for b in grid["k_alpha"]]
            for a in grid["k_rho"]
        ]
    )
    best = np.unravel_index(np.argmin(totals), totals.shape)
    assert all(0 < place < size - 1 for place, size in zip(best, totals.shape, strict=True))
    assert score(PAPER).total > 2.0 * totals.min()
    assert 1.1 * totals.min() < score(GENTLE).total < 0.6 * score(PAPER).total
    assert np.mean(totals < score(GENTLE).total) > 0.02
    along_v_max = [
        score(wmr.Gains(0.96 / v_max, 1.089, 1.42, v_max)).total
        for v_max in (0.5, 1.0, 2.0, 4.0, 7.5, 20.0, 100.0)
    ]
    assert 0 < int(np.argmin(along_v_max)) < 6


@settings(max_examples=60)
@given(all_gains)
def test_a_score_is_finite_and_a_case_never_costs_more_than_not_arriving(gains):
    mine = score(gains)
    assert mine.game.penalty == 60.0 + 90.0 + 4.0 * 8.0
    assert 0.0 < mine.total <= mine.game.penalty
    for case in mine.cases:
        assert case.points <= mine.game.penalty + 1e-9
        assert (case.points == mine.game.penalty) == bool(case.note)
        assert (case.time == math.inf) == (case.note == "not reached")
    assert mine.reached == sum(not case.note for case in mine.cases)
    assert mine.total == round(np.mean([case.points for case in mine.cases]), 2)


def mirrored(game):
    def flip(pose):
        return wmr.Pose(pose.x, -pose.y, -pose.heading)

    return replace(
        game, cases=tuple(Case(kind, flip(start), flip(goal)) for kind, start, goal in game.cases)
    )


@settings(max_examples=40)
@given(all_gains, st.integers(0, 50))
def test_mirrored_cases_score_alike(gains, seed):
    one, other = score(gains, from_seed(seed)), score(gains, mirrored(from_seed(seed)))
    assert one.total == pytest.approx(other.total, abs=0.011)
    assert [case.note for case in one.cases] == [case.note for case in other.cases]


@settings(max_examples=40)
@given(all_gains)
def test_what_rounding_could_do_changes_no_score(gains):
    """Starts moved by 1e-12 m, a thousand times what rounding does to them: as on another machine."""
    game = from_seed()
    moved = replace(
        game,
        cases=tuple(
            case._replace(start=case.start._replace(x=case.start.x + 1e-12, y=case.start.y - 1e-12))
            for case in game.cases
        ),
    )
    one, other = score(gains, game), score(gains, moved)
    assert one.total == other.total
    assert [case.note for case in one.cases] == [case.note for case in other.cases]


@pytest.mark.parametrize(
    "gains",
    [
        (5.827, 0.377, 7.336, 2.639),
        (3.048, 0.187, 7.132, 3.55),
        (2.101, 0.178, 4.685, 7.521),
        (4.626, 1.308, 5.188, 7.859),
        (3.244, 0.156, 4.343, 4.542),
        (5.775, 0.192, 4.054, 4.822),
        (5.452, 0.293, 4.745, 2.552),
        (3.528, 1.548, 3.913, 10.59),
    ],
)
def test_chaotic_runs_score_the_same_wherever_rounding_pushes_them(gains):
    """Of 4000 random gains these changed their score while each case was driven twice and not five times."""
    rng, one = np.random.default_rng(1), score(wmr.Gains(*gains))
    for push in rng.normal(0.0, 1e-12, (10, 3)):
        moved = tuple(
            case._replace(start=wmr.Pose(*np.add(case.start, push).tolist()))
            for case in one.game.cases
        )
        assert score(wmr.Gains(*gains), replace(one.game, cases=moved)).total == one.total


def test_plain_python_scores_the_same():
    """Without the compiler, which contracts products and sums, every run is rounded differently."""
    chosen = [PAPER, GENTLE, GOOD, WILD, wmr.Gains(1.9, 1.0, 0.05, 4.0)]
    code = "import json, sys, wmrlib as w; print(json.dumps([w.challenge.score(w.Gains(*g)).total for g in json.loads(sys.argv[1])]))"
    told = subprocess.run(
        [sys.executable, "-c", code, json.dumps(chosen)],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert json.loads(told.stdout) == [score(gains).total for gains in chosen]


def test_a_run_that_hangs_on_rounding_is_not_reached():
    wild = score(WILD)
    notes = [case.note for case in wild.cases]
    assert notes.count("hangs on rounding") >= 1
    assert notes.count("not reached") >= 1
    k = notes.index("hangs on rounding")
    assert wild.cases[k].time < math.inf
    assert wild.cases[k].points == wild.game.penalty


@pytest.mark.parametrize("turn", [0.0, math.pi / 2])
def test_a_goal_exactly_behind_hangs_on_rounding_on_whichever_axis_it_lies(turn):
    """Left or right is then a matter of the last digit, and only a start that is pushed sideways tells."""
    goal = wmr.Pose(-5.0 * round(math.cos(turn)), -5.0 * round(math.sin(turn)), turn + 1.0)
    exactly = score(GENTLE, Challenge(0, (Case("behind", wmr.Pose(0.0, 0.0, turn), goal),)))
    assert exactly.cases[0].note == "hangs on rounding"
    beside = score(GENTLE, Challenge(0, (Case("behind", wmr.Pose(0.0, 0.0, turn + 0.1), goal),)))
    assert beside.reached == 1


def test_worse_gains_score_worse():
    for worse in (
        {"h": 0.0},
        {"h": 30.0},
        {"k_rho": 0.02},
        {"k_rho": 3.0},
        {"k_alpha": 0.1},
        {"k_alpha": 10.0},
        {"v_max": 0.5},
    ):
        assert score(GOOD._replace(**worse)).total > score(GOOD).total + 1.0, worse


def test_a_robot_that_stands_still_and_one_that_leaves_the_numbers_get_the_penalty():
    for gains in (wmr.Gains(0.0, 0.0, 0.0, 1.0), wmr.Gains(1e300, 1e300, 1e300, 1e300)):
        assert score(gains).total == from_seed().penalty
        assert score(gains).reached == 0


def test_gains_count_with_three_decimals():
    near = wmr.Gains(GOOD.k_rho + 4e-4, GOOD.k_alpha - 4e-4, GOOD.h, GOOD.v_max)
    assert score(near).gains == rounded(near) == GOOD
    assert score(near).total == score(GOOD).total
    assert score(near._replace(k_rho=0.1286)).gains.k_rho == 0.129
    assert math.copysign(1.0, rounded(wmr.Gains(-0.0, 1.0, 1.0)).k_rho) == 1.0


def test_a_start_within_the_arrival_radius_is_reached_at_once_and_one_on_the_goal_itself_hangs_on_rounding():
    goal = wmr.Pose(1.0, 2.0, 0.5)
    one, other = (
        score(GENTLE, Challenge(0, (Case("there", goal._replace(y=y), goal),))) for y in (1.97, 2.0)
    )
    assert (one.reached, one.cases[0].time) == (1, 0.0)
    assert other.cases[0].note == "hangs on rounding"  # its line of sight has no direction


def test_what_it_says():
    assert (
        repr(score(PAPER)).splitlines()[0]
        == "<Score: 52.28 points, 12 of 12 reached; k_rho 2, k_alpha 1, h 0.3, v_max 4; seed 2026>"
    )
    assert len(repr(score(PAPER)).splitlines()) == 14
    assert repr(score(WILD)).count("hangs on rounding") == sum(
        case.note == "hangs on rounding" for case in score(WILD).cases
    )
    assert (
        "   7  straight behind           4.5       3.8            5.0           5.89    29.85"
        in repr(score(PAPER))
    )
    assert repr(from_seed()).startswith(
        "<Challenge: seed 2026, 12 cases, wheels up to 2 m/s, 60 s each>"
    )
    assert len(repr(from_seed()).splitlines()) == 14


def test_nothing_can_be_changed():
    with pytest.raises(FrozenInstanceError):
        from_seed().dt = 1.0
    with pytest.raises(FrozenInstanceError):
        score(PAPER).total = 0.0


def test_the_seed_of_a_challenge_is_a_plain_number():
    game = Challenge(np.int64(7), from_seed(7).cases)
    assert game == from_seed(7)
    assert type(game.seed) is int


ONE = from_seed().cases[0]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        *(
            (lambda seed=seed: from_seed(seed), "seed = .* is not allowed: a whole number")
            for seed in (-1, 2.0, True, "1", None, 2**63, [1])
        ),
        (lambda: score((1, 2, 3, 4)), "a Gains is needed, not a tuple"),
        (lambda: score(PAPER, 2026), "a Challenge is needed, not a int"),
        (
            lambda: score(wmr.Gains(np.ones(2), 1.0, 1.0)),
            "k_rho = .* is not allowed: one number is needed",
        ),
        (lambda: score(wmr.Gains(1.0, 1.0, 1.0, 1e-4)), r"v_max = 0\.0 is not allowed"),
        (lambda: drive(PAPER, "x"), "a Challenge is needed"),
        (lambda: Challenge(0, ()), "a tuple of at least one Case is needed"),
        (lambda: Challenge(0, (1,)), r"cases\[0\] = 1 is not allowed: a Case is needed"),
        *(
            (
                lambda seed=seed: Challenge(seed, from_seed().cases),
                "seed = .* is not allowed: a whole number",
            )
            for seed in ("abc", -1, True, 2.0)
        ),
        (
            lambda: Challenge(0, (ONE, Case(None, *ONE[1:]))),
            r"cases\[1\]\.kind = None is not allowed: a str is needed",
        ),
        (
            lambda: Challenge(0, (Case("x", None, None),)),
            r"cases\[0\]\.start = None is not allowed: a Pose is needed",
        ),
        (
            lambda: Challenge(0, (ONE._replace(goal=(1.0, 2.0, 0.0)),)),
            r"cases\[0\]\.goal = \(1\.0, 2\.0, 0\.0\) .* a Pose is needed",
        ),
        (
            lambda: Challenge(0, (ONE._replace(start=wmr.Pose([1.0, 2.0], 0, 0)),)),
            r"cases\[0\]\.start\.x = .* one number is needed",
        ),
        (
            lambda: replace(from_seed(), wheels=None),
            "wheels = None is not allowed: a WheelLimits is needed",
        ),
        (
            lambda: replace(from_seed(), wheels=wmr.WheelLimits(np.ones(2), 2.0)),
            r"wheels\.track_width = .* one number is needed",
        ),
        (
            lambda: replace(from_seed(), wheels=wmr.WheelLimits(0.5)),
            r"wheels\.max_speed = inf is not allowed",
        ),
        (lambda: replace(from_seed(), dt=0.0), r"dt = 0\.0 is not allowed"),
        (
            lambda: replace(from_seed(), arrival_radius=-1.0),
            r"arrival_radius = -1\.0 is not allowed",
        ),
    ],
)
def test_bad_input(make, message):
    with pytest.raises(ValueError, match=message):
        make()
