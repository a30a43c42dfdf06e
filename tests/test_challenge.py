"""The tuning challenge: published cases, and its score by single runs, symmetry and rounding."""

import math
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrbook.chapters import challenge
from wmrbook.chapters.challenge import Challenge, drive_cases, from_seed, rounded, score

PAPER, GENTLE = wmr.paper.OUTDOOR_GAINS, wmr.GENTLE_GAINS
GOOD, WILD = wmr.Gains(0.128, 1.089, 1.42, 7.528), wmr.Gains(5.0, 0.1, 5.0, 20.0)
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
CHAOTIC = [  # of 4000 random gains, those whose score hung on rounding with two drives a case
    wmr.Gains(5.827, 0.377, 7.336, 2.639),
    wmr.Gains(3.048, 0.187, 7.132, 3.55),
    wmr.Gains(2.101, 0.178, 4.685, 7.521),
    wmr.Gains(4.626, 1.308, 5.188, 7.859),
    wmr.Gains(3.244, 0.156, 4.343, 4.542),
    wmr.Gains(5.775, 0.192, 4.054, 4.822),
    wmr.Gains(5.452, 0.293, 4.745, 2.552),
    wmr.Gains(3.528, 1.548, 3.913, 10.59),
]


# The cases --------------------------------------------------------------------------------------


def test_the_published_cases():
    game = from_seed()
    assert game is from_seed(challenge.SEED) == Challenge(np.int64(2026), game.cases)
    assert type(Challenge(np.int64(2026), game.cases).seed) is int
    assert game.limits == {
        "dt": 0.1,
        "duration": 60.0,
        "arrival_radius": 0.05,
        "wheels": wmr.Wheels(0.5, 2.0),
    }
    units = 100, 100, 1800 / math.pi
    for (kind, *poses), row in zip(game.cases, PUBLISHED, strict=True):
        numbers = [value * unit for pose in poses for value, unit in zip(pose, units, strict=True)]
        assert (kind, *map(round, numbers)) == row
    with pytest.raises(FrozenInstanceError):
        game.dt = 1.0


@given(st.integers(0, 2**63 - 1))
def test_every_seed_has_each_kind_of_case(seed):
    game = from_seed(seed)
    assert [case.kind for case in game.cases] == [row[0] for row in PUBLISHED]
    errors = {case.kind: wmr.polar_error(case.start, case.goal) for case in game.cases}
    off = {kind: abs(math.degrees(error.alpha)) for kind, error in errors.items()}
    assert 164 < off["straight behind"] < 176
    assert 79 < off["beside"] < 101
    assert off["far ahead"] < 46
    assert 49 < errors["far ahead"].rho < 61
    assert max(errors["near"].rho, errors["near behind"].rho) < 2.02
    for case in game.cases:
        assert max(abs(case.start.x), abs(case.start.y)) <= 20.0
        assert abs(wmr.polar_error(case.start, case.goal).theta) < math.radians(152)


# The score --------------------------------------------------------------------------------------


def test_the_score_is_that_of_single_runs():
    """By `simulate` and `arrival`, one case after the other; and the published totals."""
    game = from_seed()
    for gains, total in ((PAPER, 52.28), (GENTLE, 25.78), (GOOD, 21.81)):
        points = []
        for case, run, row in zip(game.cases, drive_cases(gains), score(gains).cases, strict=True):
            single = wmr.simulate(case.start, case.goal, gains, **game.limits)
            np.testing.assert_array_equal(single.x, run.x)
            end = wmr.arrival(single)
            assert end.arrived
            error = abs(math.degrees(end.heading_error))
            points.append(end.time + 0.5 * error + 4.0 * end.peak_omega)
            distance = math.dist(case.start[:2], case.goal[:2])
            wanted = distance, end.time, error, end.peak_omega, points[-1]
            assert row[1:6] == pytest.approx(wanted)
            assert np.all(np.abs(run.v) + 0.25 * np.abs(run.omega) <= 2.0 + 1e-9)
        assert score(gains).total == total == pytest.approx(np.mean(points), abs=0.00501)


def test_neither_extreme_wins():
    """The best of a coarse sweep lie inside; the paper's gains lose clearly, gentle ones less."""
    k_rho, k_alpha = [0.05, 0.1, 0.2, 0.4, 0.8, 2.0], [0.2, 0.5, 1.0, 2.0, 5.0]
    h = [0.1, 0.4, 1.5, 4.0, 10.0]
    totals = np.array(
        [[[score(wmr.Gains(a, b, c, 6.0)).total for c in h] for b in k_alpha] for a in k_rho]
    )
    best = np.unravel_index(np.argmin(totals), totals.shape)
    assert all(0 < place < size - 1 for place, size in zip(best, totals.shape, strict=True))
    assert score(PAPER).total > 2.0 * totals.min()
    assert 1.1 * totals.min() < score(GENTLE).total < 0.6 * score(PAPER).total
    assert np.mean(totals < score(GENTLE).total) > 0.02
    speeds = 0.5, 1.0, 2.0, 4.0, 7.5, 20.0, 100.0
    along_v_max = [score(wmr.Gains(0.96 / top, 1.089, 1.42, top)).total for top in speeds]
    assert 0 < int(np.argmin(along_v_max)) < 6


@settings(max_examples=60)
@given(all_gains)
def test_a_score_is_finite_and_a_case_never_costs_more_than_not_arriving(gains):
    mine = score(gains)
    assert mine.game.penalty == 60.0 + 90.0 + 4.0 * 8.0
    for case in mine.cases:
        assert case.points <= mine.game.penalty + 1e-9
        assert (case.points == mine.game.penalty) == bool(case.note)
        assert (case.time == math.inf) == (case.note == "not reached")
    assert mine.reached == sum(not case.note for case in mine.cases)
    assert mine.total == round(np.mean([case.points for case in mine.cases]), 2) > 0.0


def test_who_never_arrives_gets_the_penalty():
    for gains in (wmr.Gains(0.0, 0.0, 0.0, 1.0), wmr.Gains(1e300, 1e300, 1e300, 1e300)):
        assert (score(gains).total, score(gains).reached) == (from_seed().penalty, 0)


def test_gains_count_with_three_decimals():
    near = wmr.Gains(GOOD.k_rho + 4e-4, GOOD.k_alpha - 4e-4, GOOD.h, GOOD.v_max)
    assert score(near) == score(GOOD)
    assert score(near).gains == rounded(near) == GOOD
    assert rounded(near._replace(k_rho=0.1286)).k_rho == 0.129
    assert math.copysign(1.0, rounded(wmr.Gains(-0.0, 1.0, 1.0)).k_rho) == 1.0


# Rounding --------------------------------------------------------------------------


@settings(max_examples=80)
@given(st.sampled_from(CHAOTIC) | all_gains, st.integers(0, 2**32))
def test_what_rounding_could_do_changes_no_score(gains, seed):
    """Starts moved by about 1e-12, a thousand times what rounding does: as on another machine."""
    push, one = np.random.default_rng(seed).normal(0.0, 1e-12, 3), score(gains)
    cases = (
        case._replace(start=wmr.Pose(*np.add(case.start, push).tolist())) for case in one.game.cases
    )
    other = score(gains, replace(one.game, cases=tuple(cases)))
    assert one.total == other.total
    assert [case.note for case in one.cases] == [case.note for case in other.cases]


def test_a_run_that_hangs_on_rounding_is_not_reached():
    wild = score(WILD)
    notes = [case.note for case in wild.cases]
    assert "not reached" in notes
    hanging = wild.cases[notes.index("hangs on rounding")]
    assert hanging.time < math.inf
    assert hanging.points == wild.game.penalty


def test_bad_input():
    game, one = from_seed(), from_seed().cases[0]
    many = wmr.Pose([1.0, 2.0], 0, 0)
    seeds = (-1, 2.0, True, "1", None, 2**63, [1])
    for make, message in (
        *((lambda seed=seed: from_seed(seed), "seed = .* a whole number") for seed in seeds),
        *((lambda seed=seed: replace(game, seed=seed), "seed = .* a whole") for seed in seeds),
        (lambda: score((1, 2, 3, 4)), "a Gains is needed, not a tuple"),
        (lambda: score(PAPER, 2026), "a Challenge is needed, not an int"),
        (lambda: score(wmr.Gains(np.ones(2), 1.0, 1.0)), "k_rho = .* one number is needed"),
        (lambda: Challenge(0, ()), "a tuple of at least one Case is needed"),
        (lambda: Challenge(0, (one._replace(goal=(1, 2, 0)),)), r"cases\[0\]\.goal = .* a Pose"),
        (
            lambda: Challenge(0, (one._replace(start=many),)),
            r"cases\[0\]\.start\.x = .* one number is needed",
        ),
        (lambda: replace(game, wheels=wmr.Wheels(0.5)), r"wheels\.max_speed = inf is not"),
        (lambda: replace(game, dt=0.0), r"dt = 0\.0 is not allowed"),
    ):
        with pytest.raises(ValueError, match=message):
            make()
