"""Receivers against a plain loop with its own random numbers, against theory, and by property."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import wmrlib as wmr
from wmrlib import threads
from wmrlib.receiver import philox

DT, GAINS = 0.1, wmr.GENTLE_GAINS
START, GOAL = wmr.Pose(-6.0, 2.0, 0.5), wmr.Pose(0.0, 0.0, -1.0)
LIMITS = wmr.Wheels(track_width=0.5, max_speed=1.0)
SHORT = {"method": "arc", "dt": DT, "duration": 12.0, "arrival_radius": 0.3}


@pytest.mark.parametrize(
    "vector",
    [  # Random123's kat_vectors: counter, key and words; the last are digits of pi
        "00000000 00000000 00000000 00000000 00000000 00000000 6627e8d5 e169c58d bc57ac4c 9b00dbd8",
        "ffffffff ffffffff ffffffff ffffffff ffffffff ffffffff 408f276d 41c83b0e a20bc7c6 6d5451fd",
        "243f6a88 85a308d3 13198a2e 03707344 a4093822 299f31d0 d16cfe09 94fdcceb 5001e420 24126ea1",
    ],
)
def test_random_words_are_those_that_are_known(vector):
    words = [int(word, 16) for word in vector.split()]
    assert philox(words[:4], words[4:6]) == tuple(words[6:])


# A second way, sample by sample, with whole numbers that don't overflow ---------------------------


def two_normals(run, sample, seed, stream=0):
    a, b, c, d = run % 2**32, run // 2**32, sample, stream
    for n in range(10):
        key = (seed + n * 0x9E3779B9) % 2**32, (seed // 2**32 + n * 0xBB67AE85) % 2**32
        (two, b_next), (one, d_next) = divmod(0xCD9E8D57 * c, 2**32), divmod(0xD2511F53 * a, 2**32)
        a, b, c, d = two ^ b ^ key[0], b_next, one ^ d ^ key[1], d_next
    size, turn = ((2**21 * high + low // 2**11 + 0.5) / 2**53 for high, low in ((a, b), (c, d)))
    return np.sqrt(-2.0 * np.log(size)) * np.exp(2j * np.pi * turn)


def comes(run, fix, seed, stream, often):
    """The direction of what comes so often, or 0."""
    normal = two_normals(run, fix, seed, stream)
    return normal / abs(normal) if math.exp(-(abs(normal) ** 2) / 2) < 1 - math.exp(-often) else 0


def driven(receiver, seed, run=0, method="arc", wheels=None, gains=GAINS):
    """The poses and twists at each sample, and whether it believes to have arrived."""
    truth, twists, errors, fixes, over, jump = [START], [], {}, {}, 0, 0.0
    constant = receiver.bias * two_normals(run, 0, seed, 2)
    turned = receiver.compass * two_normals(run, 0, seed, 3).real
    late, heading_late = (round(age / DT) for age in receiver[3:5])
    every = max(round(receiver.period / DT), 1)
    for k in range(round(SHORT["duration"] / DT) + 1):
        fix, last = max(k - k % every - late, 0), max(fixes, default=-1)
        if fix > last >= 0 and receiver.dropout:
            begins = comes(run, fix, seed, 4, every * DT / receiver.dropout)
            if fix >= over and begins:
                over = fix + max(round(receiver.outage / DT), 1)
            fix = last if fix < over else fix
        if fix not in fixes:
            if fixes and receiver.jump_every:
                jump = comes(run, fix, seed, 5, (fix - last) * DT / receiver.jump_every) or jump
            error = two_normals(run, fix, seed)
            if errors and receiver.memory:
                last = max(errors)
                keep = math.exp(-(fix - last) * DT / receiver.memory)
                error = keep * errors[last] + math.sqrt(1.0 - keep**2) * error
            errors[fix] = error
            fixes[fix] = complex(truth[fix].x, truth[fix].y) + receiver.sigma * error
            fixes[fix] += constant + receiver.jump * jump
        heading = truth[max(k - heading_late, 0)].heading + turned
        polar = wmr.polar_error(wmr.Pose(fixes[fix].real, fixes[fix].imag, heading), GOAL)
        turn = receiver.sight * two_normals(run, k, seed, 1).real
        angles = (wmr.wrap_angle(angle + turn) for angle in polar[1:])
        v, omega = wmr.control_law(polar.rho, *angles, gains)
        v, omega = wmr.limit_wheels(v, omega, wheels) if wheels else (v, omega)
        twists.append((v, omega))
        if polar.rho <= SHORT["arrival_radius"]:
            return truth, twists, True
        truth.append(wmr.advance(truth[-1], v, omega, DT, method))
    return truth[:-1], twists, False


times = st.sampled_from([0.0, 0.1, 0.3, 1.0])
receivers = st.builds(
    wmr.Receiver, st.sampled_from([0.0, 0.2, 0.5]), st.sampled_from([0.0, 0.4, 30.0]), times, times,
    times, st.sampled_from([0.0, 0.1]), st.sampled_from([0.0, 0.5]), st.sampled_from([0.0, 2.0]),
    st.sampled_from([0.0, 1.0, 3.0]), st.sampled_from([0.0, 1.0]), st.sampled_from([0.0, 3.0]),
    st.sampled_from([0.0, 0.2]),
)  # fmt: skip


@settings(max_examples=25, deadline=None)
@example(wmr.Receiver(0.5, 3.0, 1.0, 0.3, 0.1), 2**64 - 1, 1, "euler", LIMITS)
@example(wmr.Receiver(bias=0.5, compass=3.0), 9, 1, "arc", None)
@example(wmr.Receiver(dropout=2.0, outage=1.5), 4, 1, "arc", None)
@example(wmr.Receiver(0.2, 5.0, 0.3, 0.3, jump=1.0, jump_every=2.0), 4, 1, "arc", None)
@example(wmr.Receiver(0.5, -0.0), 0, 0, "arc", None)
@example(wmr.Receiver(period=1.0), 0, 0, "arc", None)
@example(wmr.Receiver(heading_delay=0.3), 0, 0, "arc", None)
@example(wmr.Receiver(sight=0.2), 3, 1, "arc", None)
@given(receivers, st.integers(0, 2**64 - 1), st.integers(0, 1), st.sampled_from(["arc", "euler"]),
       st.none() | st.just(LIMITS))  # fmt: skip
def test_a_sweep_is_the_plain_loop_with_the_same_numbers(receiver, seed, run, method, wheels):
    options = SHORT | {"method": method, "wheels": wheels}
    starts = START._replace(x=np.full(2, START.x))
    options |= {"receiver": receiver, "seed": seed}
    ends, paths = wmr.sweep(starts, GOAL, GAINS, trajectories=True, **options)
    short = wmr.sweep(starts, GOAL, GAINS, **options)
    np.testing.assert_allclose(short, ends, rtol=0.0, atol=1e-8)
    truth, twists, arrived = driven(receiver, seed, run, method, wheels)
    count = len(truth)
    assert np.isfinite(paths.x[run]).sum() == count
    poses, twists = np.array(truth), np.array(twists)
    mine = np.array([getattr(paths, name)[run, :count] for name in ("x", "y", "v", "omega")])
    np.testing.assert_allclose(mine.T, np.hstack([poses[:, :2], twists]), rtol=0, atol=1e-8)
    end = truth[-1]
    assert ends.arrived[run] == arrived
    assert ends.time[run] == (pytest.approx((count - 1) * DT) if arrived else math.inf)
    off = wmr.wrap_angle(ends.heading_error[run] - (end.heading - GOAL.heading))
    assert abs(off) < 1e-8
    assert ends.distance[run] == pytest.approx(math.hypot(end.x, end.y), abs=1e-8)
    assert ends.peak_omega[run] == pytest.approx(np.abs(twists[:, 1]).max(), abs=1e-8)
    length = DT * np.abs(twists[: count - 1, 0]).sum()
    assert ends.path_length[run] == pytest.approx(length, abs=1e-8)
    polar = wmr.polar_error(wmr.Pose(*poses.T), GOAL)
    assert paths.rho[run, :count] == pytest.approx(polar.rho, abs=1e-8)


# The error itself: a robot that hardly moves steers by it -----------------------------------------


def errors(receiver, runs, samples, seed=5):
    """What the receiver adds, (axis, run, sample) in m, out of how the robot turns to a far goal.

    Its omega is k_alpha times the goal's bearing, which an error to the left turns to the right.
    """
    still, far, parts = wmr.Gains(0.0, 1e-12, 0.0, 1e-12), 1e6, []
    options = {"dt": 1.0, "duration": samples - 1.0, "seed": seed, "trajectories": True}
    for heading, goal in ((-math.pi / 2, (0.0, -far)), (0.0, (far, 0.0))):
        start, goal = wmr.Pose(np.zeros(runs), 0.0, heading), wmr.Pose(*goal, heading)
        _, paths = wmr.sweep(start, goal, still, receiver=receiver, method="arc", **options)
        parts.append(-far * np.tan(paths.omega / 1e-12))
    return np.array(parts)


@pytest.mark.parametrize("memory", [0.0, 8.0])
def test_the_error_keeps_its_size_and_forgets_as_fast_as_it_should(memory):
    samples = errors(wmr.Receiver(sigma=0.5, memory=memory), 4000, 40) / 0.5
    few = 5.0 / math.sqrt(4000.0)  # five standard deviations of a mean; a scatter has less
    assert np.abs(samples.mean(axis=1)).max() < few
    assert np.abs((samples**2).mean(axis=1) - 1.0).max() < math.sqrt(2.0) * few
    for lag in (1, 2, 5, 20):
        kept = math.exp(-lag / memory) if memory else 0.0
        for first in (0, 15):
            alike = (samples[:, :, first] * samples[:, :, first + lag]).mean(axis=1)
            assert np.abs(alike - kept).max() < math.sqrt(1.0 + kept**2) * few
    assert abs((samples[0] * samples[1]).mean()) < 5.0 / math.sqrt(
        4000.0 * 40.0 / (1.0 + 2.0 * memory)
    )
    assert abs((samples[:, 1:] * samples[:, :-1]).mean()) < 5.0 / math.sqrt(8000.0)
    assert (np.abs(samples) < 3.0).mean() == pytest.approx(math.erf(3.0 / math.sqrt(2.0)), abs=2e-3)


def test_jumps_come_at_random_times_and_point_anywhere():
    every = 3.0
    samples = errors(wmr.Receiver(jump=2.0, jump_every=every), 4000, 30)
    size, few = np.hypot(*samples), 5.0 / math.sqrt(4000.0)
    assert np.abs(np.where(size > 1.0, size - 2.0, size)).max() < 1e-5
    for at in (0, 1, 4, 29):
        assert abs((size[:, at] < 1.0).mean() - math.exp(-at / every)) < 0.5 * few
    east, north = samples / 2.0
    assert max(abs(east[:, -1].mean()), abs(north[:, -1].mean())) < few
    for lag in (1, 5):
        alike = (east[:, 20] * east[:, 20 + lag] + north[:, 20] * north[:, 20 + lag]).mean()
        jumped = 1.0 - math.exp(-20.0 / every)
        assert abs(alike - jumped * math.exp(-lag / every)) < few


def test_outages_hold_the_last_fix_as_often_and_as_long_as_they_should():
    dropout, outage = 4.0, 3.0
    samples = errors(wmr.Receiver(0.5, dropout=dropout, outage=outage), 1000, 300)
    held = np.abs(np.diff(samples[0], axis=1)) < 1e-9
    chance, lost = 1.0 - math.exp(-1.0 / dropout), max(outage, 1.0)
    share = lost / (lost + (1.0 - chance) / chance)  # of a renewal process, once it has settled
    assert abs(held[:, 99:].mean() - share) < 0.01
    assert abs(held[:, 0].mean() - chance) < 5.0 * math.sqrt(chance / 1000.0)
    ends = np.flatnonzero(np.diff(held.astype(int).ravel()))
    assert np.diff(ends).min() <= lost
    assert (held == (np.abs(np.diff(samples[1], axis=1)) < 1e-9)).all()


# What follows from it -----------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["arc", "euler"])
def test_a_receiver_that_shows_the_truth_changes_nothing(method):
    options = SHORT | {"method": method, "trajectories": True}
    starts = START._replace(y=np.array([2.0, -3.0]))
    none, path = wmr.sweep(starts, GOAL, GAINS, **options)
    for receiver in (wmr.Receiver(), wmr.Receiver(0.0, 9.0, DT, 0.04, 0.04)):
        ends, paths = wmr.sweep(starts, GOAL, GAINS, receiver=receiver, **options)
        assert all(map(np.array_equal, ends, none))
        assert all(np.array_equal(*pair, equal_nan=True) for pair in zip(paths, path, strict=True))


def test_errors_follow_from_the_seed_and_the_place_alone(monkeypatch):
    many = START._replace(x=np.linspace(-8.0, -4.0, 3000).reshape(2, 1500))
    receiver = wmr.Receiver(np.linspace(0.1, 1.0, 1500), [[0.0], [10.0]], 0.3)
    options = SHORT | {"receiver": receiver, "seed": 7}
    whole = wmr.sweep(many, GOAL, GAINS, **options)
    assert np.ptp(whole.distance) > 1.0
    assert 3.0 < np.abs(whole.heading_error).max() <= math.pi
    monkeypatch.setattr(threads, "CORES", 1)
    monkeypatch.setattr(wmr.sweeping, "_CHUNK", (1, 1))
    assert all(map(np.array_equal, whole, wmr.sweep(many, GOAL, GAINS, **options)))
    first = many._replace(x=many.x[0, :100])
    few = options | {"receiver": receiver._replace(sigma=receiver.sigma[:100], memory=0.0)}
    alone = wmr.sweep(first, GOAL, GAINS, **few)
    assert all(map(np.array_equal, [field[0, :100] for field in whole], alone))
    other = wmr.sweep(many, GOAL, GAINS, **options | {"seed": 7 + 2**32})
    assert (other.distance != whole.distance).mean() > 0.99


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"receiver": 0.5}, r"receiver = 0\.5 .* a Receiver is needed, not a float"),
        ({"method": "continuous"}, "method = 'continuous' .* 'arc' or 'euler' is needed: a rec"),
        ({"receiver": wmr.Receiver([0.1] * 3)}, r"receiver\.sigma has shape \(3,\)"),
        *(
            ({"seed": seed}, f"seed = {seed!r} is not allowed: a whole number from 0 to 2")
            for seed in (-1, 2**64, True, 1.0, None)
        ),
    ],
)  # fmt: skip
def test_bad_input_names_argument_value_and_range(options, message):
    options = SHORT | {"receiver": wmr.Receiver(0.5)} | options
    with pytest.raises(ValueError, match=message):
        wmr.sweep(START._replace(x=[-6.0, -5.0]), GOAL, GAINS, **options)
