r"""What a class gained between two tests: Hake's normalised gain, and how sure it is.

With the share of right answers before and after, over the students who sat both,

    <g> = (after - before)/(1 - before),

the share of what could be gained that was gained (Hake 1998). Why this ratio: a student knows the
answer or guesses, rightly with probability c. Of n questions that a class does not know, n (1 - c)
are expected to be answered wrongly, so in <g> = 1 - wrong after/wrong before the factor 1 - c
cancels: <g> estimates the share of what was not known before that is known after, *by these
students, of these questions*, whatever c is, as long as it is the same in both tests.

How far off it is, by guessing alone: before, n wrong answers are a binomial number with relative
variance c/((1 - c) n), after it c/((1 - c)(1 - g) n), so the standard error is

    (1 - g) sqrt(c/((1 - c) n) (1 + 1/(1 - g))).

With 30 students, 21 questions of five options (c = 1/5), a third of them known before (n = 420) and
g = 0.4 this is 0.024: 96 in 100 classes are within 0.05. With g = 0.2 and half known before it is
0.034, and only 86 in 100 are.

There c helps where it is known. If nothing is forgotten, what is answered wrongly after was never
known, so its answers before are guesses: how many of them were right says nothing about learning.
Replacing the number wrong both times by its expectation, (1 - c) times the number wrong after (Rao
and Blackwell's step: the estimate's mean over what is pure chance), leaves

    g = 1 - wrong after/(gained + (1 - c) wrong after),

with `gained` right after and wrong before. It needs c, and students who guess evenly; options that
attract them make c smaller than one in five. `Gain.remark` says when the answers contradict it.

What no estimate from 630 answers can do: if each answer is drawn anew, from a student's probability
of being right, instead of following from what the student knows, the answers after alone leave a
standard error of 0.02 to 0.03, and 0.05 holds in 66 to 92 of 100 classes (15 to 45 % known before,
g 0.2 to 0.6). The interval, a bootstrap over students, is for classes of such students. Of a class
that knows or guesses it holds the gain in 98 of 100, which is more than it says; of one whose
answers are drawn anew in 92 to 97.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from wmrlib.checks import refusal, scalar

_RESAMPLED, _SEED = 4000, 2026
_FEW = 12  # students; below it a bootstrap's interval is too narrow


class Gain(NamedTuple):
    """The gain of the students who sat both tests.

    gain, low, high: the estimate and its 95 % interval; before, after: shares of right answers;
    by_question: a row (before, after, gain) of each, its gain NaN if all were right before;
    names: who counts; only_before, only_after: who does not; remark: what is in doubt, or "".
    """

    gain: float
    low: float
    high: float
    before: float
    after: float
    by_question: np.ndarray
    names: tuple[str, ...]
    only_before: tuple[str, ...]
    only_after: tuple[str, ...]
    remark: str

    def text(self) -> str:
        """Return the result in sentences."""
        shares = f"{100 * self.before:.0f} % right before, {100 * self.after:.0f} % after"
        rows = [f"{len(self.names)} students sat both tests: {shares}."]
        rows.append(
            f"Normalised gain {self.gain:.2f}; 95 % sure to be between {self.low:.2f} and "
            f"{self.high:.2f} in classes of such students."
        )
        for left, which in ((self.only_before, "first"), (self.only_after, "second")):
            if left:
                rows.append(f"Left out, with the {which} test only: {', '.join(left)}.")
        return "\n".join([*rows, *filter(None, [self.remark])])


def normalised(before: np.ndarray, after: np.ndarray, guess: float | None = None) -> float:
    """Return the gain of boolean arrays (students, questions), True where right.

    guess: None for Hake's ratio; or the probability of a right guess, if it is known and nothing is
    forgotten. NaN if nothing was wrong before.
    """
    return float(_ratio(_counts(before, after), guess))


def gain(
    before: Mapping[str, np.ndarray], after: Mapping[str, np.ndarray], guess: float | None = None
) -> Gain:
    """Return the gain of those who are in both mappings from a name to a list of True and False.

    guess: as for `normalised`. Raises ValueError for fewer than two students in both, lists of
    different lengths, a guess outside [0, 1), and if nothing was wrong before.
    """
    names = tuple(name for name in before if name in after)
    if len(names) < 2:
        raise ValueError(f"{len(names)} students sat both tests: at least 2 are needed")
    if len({len(sheet[name]) for sheet in (before, after) for name in names}) > 1:
        raise ValueError("before and after have sheets of different lengths: the same are needed")
    if guess is not None and not scalar("guess", guess, low=0.0) < 1.0:
        raise refusal("guess", guess, "a probability below 1")
    first, second = (np.array([sheet[name] for name in names], bool) for sheet in (before, after))
    if first.all():
        raise ValueError("all answers were right before: there was nothing to gain")
    counts = _counts(first, second)
    drawn = np.random.default_rng(_SEED).integers(len(names), size=(_RESAMPLED, len(names)))
    ratios = _ratio(counts[:, drawn].sum(axis=2)[:, :, None], guess)
    low, high = np.nanquantile(ratios, (0.025, 0.975))
    shares = first.mean(axis=0), second.mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        gained = np.where(shares[0] < 1.0, (shares[1] - shares[0]) / (1.0 - shares[0]), np.nan)
    return Gain(
        float(_ratio(counts, guess)),
        float(low),
        float(high),
        float(first.mean()),
        float(second.mean()),
        np.column_stack([*shares, gained]),
        names,
        tuple(name for name in before if name not in after),
        tuple(name for name in after if name not in before),
        _remark(counts.sum(axis=1), len(names), guess),
    )


def _counts(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """For each student: how many were wrong before, wrong after, gained."""
    return np.array([(~before).sum(1), (~after).sum(1), (after & ~before).sum(1)])


def _ratio(counts: np.ndarray, guess: float | None) -> np.ndarray:
    """The gain of counts summed over their second axis."""
    wrong_before, wrong_after, gained = counts.sum(axis=-1) if counts.ndim == 2 else counts[..., 0]
    could = wrong_before if guess is None else gained + (1.0 - guess) * wrong_after
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(could > 0, 1.0 - wrong_after / could, np.nan)


def _remark(counts: np.ndarray, students: int, guess: float | None) -> str:
    if students < _FEW:
        return f"With fewer than {_FEW} students the interval is too narrow."
    wrong_before, wrong_after, gained = counts
    lost = wrong_after - (wrong_before - gained)  # right before, wrong after
    if guess is None or not wrong_after:
        return ""
    spread = math.sqrt(guess * (1.0 - guess) * wrong_after)
    if abs(lost - guess * wrong_after) <= 2.5 * spread:
        return ""
    share = f"{100 * lost / wrong_after:.0f} % of what is wrong after was right before"
    return f"{share}, not {100 * guess:.0f} %: trust the gain without a guess instead."
