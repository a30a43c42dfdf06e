"""The results of a run: its samples, its outcome and its summary."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any, NamedTuple

import numpy as np

from wmrlib.checks import Real, instance, reals, refusal, same_shape, scalar
from wmrlib.elementary import elementwise, sinc
from wmrlib.gains import Gains, KanayamaGains, LinearGains
from wmrlib.kinematics import Pose, wrap_angle
from wmrlib.laws import LAWS, law_name, lyapunov_value
from wmrlib.motion import polar_from_pose
from wmrlib.records import record

METHODS = ("arc", "euler", "continuous")
MOST_SAMPLES = 10_000_000


class Outcome(Enum):
    """The outcome of a run; its value is a phrase to show.

    ARRIVED, TIMED_OUT or DIVERGED; of `track`, COMPLETED or DIVERGED.

    Examples
    --------
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> run = wmr.simulate(start, goal, gains, duration=5.0)
    >>> print(run.outcome is wmr.Outcome.ARRIVED, run.outcome.value, sep=": ")
    False: did not arrive within the duration
    """

    ARRIVED = "arrived within the arrival radius"
    TIMED_OUT = "did not arrive within the duration"
    DIVERGED = "left the range of numbers"
    COMPLETED = "followed the reference to the end"


# The outcomes as numbers, as compiled loops return them; the last is for a run of too many steps.
OUTCOMES = tuple(Outcome)
ARRIVED, TIMED_OUT, DIVERGED, COMPLETED, UNFINISHED = range(len(OUTCOMES) + 1)


class ReadOnly:
    """A frozen dataclass whose arrays can't be written to, in copies and pickles too."""

    __slots__: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        _protect(self._values())

    def __reduce__(self) -> tuple:
        return type(self), self._values()

    def _values(self) -> tuple:
        return tuple([getattr(self, name) for name in self.__slots__])


def _protect(values: tuple) -> None:
    for value in values:
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        elif isinstance(value, tuple):
            _protect(value)


@dataclass(frozen=True, eq=False, slots=True)
class Trajectory(ReadOnly):
    """One run, sample by sample, and how it ended.

    Attributes
    ----------
    t : array, s; like the other arrays of the same length, it can't be written to
    x, y, heading : arrays, m and rad in (-pi, pi], the robot's pose
    rho, alpha, theta : arrays, m and rad, the polar error
    v, omega : arrays, m/s and rad/s, the twist from the sample on: what the law, or the last turn,
        commands within the wheel limits; with wheels that are not ideal, what they make of it
    outcome : Outcome
    goal : Pose, of arrays if it moves
    gains, law, method : as passed in; None, None and "poses" where `of_poses` made the run
    peak_omega, path_length : float, rad/s and m, see Arrival; between the samples too

    Examples
    --------
    >>> import wmrlib as wmr
    >>> start, goal, gains, _ = wmr.paper.outdoor()
    >>> run = wmr.simulate(start, goal, gains)
    >>> late = run.t > 10.0  # the samples after 10 s
    >>> print(f"{run.rho[late].max():.1f} m to go, at {run.v[late].max():.1f} m/s at most")
    17.9 m to go, at 4.0 m/s at most
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    rho: np.ndarray
    alpha: np.ndarray
    theta: np.ndarray
    v: np.ndarray
    omega: np.ndarray
    outcome: Outcome
    goal: Pose
    gains: Gains | KanayamaGains | LinearGains | Any
    law: str | Callable | None
    method: str
    peak_omega: float
    path_length: float

    @classmethod
    def of(cls, t, record, outcome, peak, length, *setting) -> Trajectory:
        """The run of a loop's samples, one a column, its outcome's code and its sums.

        :meta private:
        """
        return cls(*(t, *record, OUTCOMES[outcome], *setting, peak, length))

    @classmethod
    def of_poses(
        cls, t: Any, x: Any, y: Any, heading: Any, goal: Pose, *, arrival_radius: float = 0.05
    ) -> Trajectory:
        """A run of your own: from a log, a robot or another program.

        What it lacks follows from the poses: the polar error to the goal, and the twist that leads
        from each pose to the next along an arc, omega = wrap(heading' - heading)/dt and
        v = ahead/(dt sinc(omega dt/2)), where `ahead` is how far the next pose lies in the arc's
        mean direction, negative backwards. The last sample has the twist 0. The path length is
        that of the arcs through all poses. The run has arrived if its last pose is within the
        arrival radius, so end a log where the robot has parked.

        Parameters
        ----------
        t : array, s, rising; the run's times count from the first of them
        x, y, heading : numbers or arrays of the same length, m and rad
        goal : Pose, m and rad; of arrays of that length if it moves
        arrival_radius : float, m

        Returns
        -------
        Trajectory

        Raises
        ------
        ValueError : mismatched lengths, no sample, times that don't rise, NaN

        Examples
        --------
        >>> import wmrlib as wmr
        >>> goal = wmr.Pose(2.0, 0.0, 0.0)
        >>> run = wmr.Trajectory.of_poses([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], 0.0, 0.0, goal)
        >>> print(run.v, wmr.arrival(run).path_length)
        [1. 1. 0.] 2.0
        """
        instance("goal", goal, Pose)
        ends = {f"goal.{name}": value for name, value in goal._asdict().items()}
        times, *poses = reals(t=t, x=x, y=y, heading=heading, **ends)
        times = np.array(times, ndmin=1)
        if times.ndim > 1 or not times.size or not (np.diff(times) > 0.0).all():
            raise refusal("t", t, "a row of times, each later than the one before,")
        if same_shape(t=times, x=x, y=y, heading=heading, **ends) != times.shape:
            raise refusal("x", x, f"one number, or one for each of {times.size} times,")
        begin = np.array([np.broadcast_to(row, times.shape) for row in poses[:3]])
        begin[2] = wrap_angle(begin[2])
        dt, (east, north, turn) = np.diff(times), np.diff(begin)
        half = 0.5 * np.asarray(wrap_angle(turn))
        ahead = np.cos(begin[2, :-1] + half) * east + np.sin(begin[2, :-1] + half) * north
        twist = np.zeros((2, times.size))
        twist[:, :-1] = ahead / (dt * sinc(half)), 2.0 * half / dt
        polar = elementwise(polar_from_pose, *begin, *poses[3:])
        near = polar[0][-1] <= scalar("arrival_radius", arrival_radius, low=0.0)
        peak, length = np.abs(twist[1]).max(), np.sum(np.hypot(east, north) / sinc(half))
        sums = float(peak), float(length), Pose(*poses[3:]), None, None, "poses"
        since = times - times[0]
        return cls.of(since, [*begin, *polar, *twist], ARRIVED if near else TIMED_OUT, *sums)

    def __len__(self) -> int:
        return self.t.size

    def __repr__(self) -> str:
        end = "no sample"
        if len(self):
            end = f"{self.rho[-1]:.4g} m from the goal after {self.t[-1]:.4g} s"
        origin = f"{law_name(self.law)} law, {self.method}" if self.law else "poses given"
        size = f"{origin}, {len(self)} samples"
        return f"<Trajectory: {size}, {end}: {self.outcome.value}>"

    @property
    def V(self) -> np.ndarray:  # noqa: N802 (as in (18))
        """The law's Lyapunov function at each sample, (18) with L = 1 m^2 (no unit) or its own.

        "graceful" has one of its own, in rad^2, and so have the laws for a moving goal:
        "kanayama" in m^2, and "linear" in m^2 plus rad^2, half the squared error. For a law of
        your own, and for poses that were given, it is (18) with h of the gains, or with h = 1
        where they have none.
        """
        polar = self.rho, self.alpha, self.theta
        with np.errstate(over="ignore"):  # on its way out of the range of numbers
            if isinstance(self.law, str):
                return LAWS[self.law].value(*polar, self.gains)
            return lyapunov_value(*polar, getattr(self.gains, "h", 1.0), 1.0)

    @property
    def x_error(self) -> np.ndarray:
        """goal.x - x, m."""
        return self.goal.x - self.x

    @property
    def y_error(self) -> np.ndarray:
        """goal.y - y, m."""
        return self.goal.y - self.y

    @property
    def heading_error(self) -> np.ndarray:
        """Heading error theta - alpha = heading - goal.heading, rad in (-pi, pi]."""
        return np.asarray(wrap_angle(self.theta - self.alpha))


@record
class Arrival(NamedTuple):
    """The summary of a run: its arrival, effort and final error; numbers, or arrays for many runs.

    Attributes
    ----------
    arrived : bool or array, whether the robot came within the arrival radius, and ended its last
        turn if it has one; with a receiver, by the pose that it measures
    time : s, infinite if it did not arrive
    heading_error : rad, heading - goal.heading at the last sample
    peak_omega : rad/s, the largest |omega|
    path_length : m, driving backwards included
    distance : m, to the goal at the last sample
    """

    arrived: bool | np.ndarray
    time: Real
    heading_error: Real
    peak_omega: Real
    path_length: Real
    distance: Real


@record
class Trajectories(NamedTuple):
    """Many runs sample by sample, NaN after each run's end.

    With "continuous", which may arrive between two samples, the last one is the one before or at
    the arrival, and alpha and theta never jump.

    Attributes
    ----------
    t : array, s
    x, y, heading, rho, alpha, theta, v, omega : arrays of the sweep's shape with a last axis as
        long as `t`, in the units of Trajectory
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    rho: np.ndarray
    alpha: np.ndarray
    theta: np.ndarray
    v: np.ndarray
    omega: np.ndarray


def with_samples(name: str, run: Trajectory) -> Trajectory:
    """Return the run if it has a sample; otherwise raise ValueError."""
    if not len(instance(name, run, Trajectory)):
        raise ValueError(f"{name} has no sample: the run left the range of numbers at its start")
    return run


def single_pose(name: str, pose: Pose) -> Pose:
    """Return the pose if its fields are numbers; otherwise raise ValueError."""
    for field, value in zip(Pose._fields, instance(name, pose, Pose), strict=True):
        if type(value) is not float:
            raise refusal(f"{name}.{field}", value, "one number", "; sweep takes arrays")
    return pose


def checked_hysteresis(hysteresis: float, method: str) -> float:
    """The hysteresis, if it is one of the method's; otherwise raise ValueError."""
    checked = scalar("hysteresis", hysteresis, low=0.0)
    if checked and method == "continuous":
        needed = "0, or method 'arc' or 'euler',"
        raise refusal("hysteresis", checked, needed, ": with 'continuous' theta never jumps")
    return checked


def sample_count(dt: float, duration: float) -> int:
    """Return how many samples a run has, both ends included; raise ValueError as `simulate`."""
    whole, step = scalar("duration", duration, above=0.0), scalar("dt", dt, above=0.0)
    steps = whole / step
    if step > whole:
        raise refusal("dt", dt, f"at most the duration, {whole:g},")
    if steps > MOST_SAMPLES:
        raise refusal("duration", duration, f"at most {MOST_SAMPLES:,} steps of dt = {step:g}")
    return int(steps + 1e-9) + 1  # tenths are not exact
