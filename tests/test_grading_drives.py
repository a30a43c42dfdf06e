"""The checks of the simulation loop and of the other map: other right answers pass, and what is no answer gets a clear hint."""

import cmath
import math

import numpy as np
import pytest

import wmrlib as wmr
from wmrbook.grading import Hint, drives


def drive(start, goal, law, dt, duration, *, step=None, sees=lambda *polar: polar, radius=0.05):
    """With complex numbers, wrapped headings and lists, and without anything of wmrlib's."""
    step = step or (
        lambda place, heading, v, omega: (
            place + v * cmath.exp(1j * heading) * dt,
            heading + omega * dt,
        )
    )
    place, heading, x, y, headings = (
        complex(start.x, start.y),
        start.heading,
        [start.x],
        [start.y],
        [start.heading],
    )
    for _ in range(int(duration / dt + 0.5)):
        line = complex(goal.x, goal.y) - place
        if abs(line) <= radius:
            break
        alpha, theta = (
            cmath.phase(line * cmath.exp(-1j * each)) for each in (heading, goal.heading)
        )
        place, heading = step(place, heading, *law(*sees(abs(line), alpha, theta)))
        heading = math.remainder(heading, 2 * math.pi)
        x.append(place.real)
        y.append(place.imag)
        headings.append(heading)
    return x, y, headings


def with_step(step):
    """A drive with another step: step(place, heading, v, omega, dt)."""
    return lambda start, goal, law, dt, duration: drive(
        start, goal, law, dt, duration, step=lambda *each: step(*each, dt)
    )


def with_eyes(sees):
    return lambda *each: drive(*each, sees=sees)


def with_x_north(x, y, heading):
    """By the direction in which the robot looks; the heading comes back in (-pi, pi]."""
    east, north = math.cos(heading), math.sin(heading)
    return np.array([y, x, math.atan2(east, north)])


def test_other_forms_pass():
    for check in (drives.drive_known, drives.drive_arrives, drives.drive_obeys):
        assert check(drive)
    for check in (drives.axes_known, drives.axes_properties):
        assert check(with_x_north)


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (with_step(lambda p, a, v, w, dt: (p + v * cmath.exp(1j * a), a + w)), "takes a second"),
        (
            with_step(lambda p, a, v, w, dt: (p + v * cmath.exp(1j * a) * dt, a - w * dt)),
            "turns the wrong way",
        ),
        (
            with_step(lambda p, a, v, w, dt: (p + v * cmath.exp(1j * a) * dt, a)),
            "the wrong heading",
        ),
        (
            with_step(lambda p, a, v, w, dt: (p - v * cmath.exp(1j * a) * dt, a + w * dt)),
            "the wrong place",
        ),
        (with_eyes(lambda rho, alpha, theta: (rho, theta, alpha)), "in the wrong order"),
        (with_eyes(lambda rho, alpha, theta: (rho, alpha, -theta)), "something other than"),
        (with_eyes(lambda rho, alpha, theta: (-rho, alpha, theta)), "stops with ValueError: rho ="),
        (lambda start, *each: drive(start, *each)[:2], "three lists"),
        (lambda start, *each: None, "three lists"),
        (lambda start, *each: start, "three lists"),
        (
            lambda start, *each: ([start.x, 10**400], [start.y, 0], [start.heading, 0]),
            "three lists",
        ),
        (lambda start, *each: np.array(drive(start, *each)) * (1 + 0j), "three lists"),
        (lambda start, *each: np.array(drive(start, *each)).astype(str), "three lists"),
        (lambda start, *each: ([], [], []), "three lists"),
        (
            lambda start, *each: [
                part[:n] for part, n in zip(drive(start, *each), (5, 5, 4), strict=True)
            ],
            "three lists",
        ),
        (
            lambda start, *each: [
                part[:n] for part, n in zip(drive(start, *each), (4, 5, 5), strict=True)
            ],
            "three lists",
        ),
        (lambda start, *each: [[part] for part in drive(start, *each)], "three lists"),
        (
            lambda start, goal, law, dt, duration: ([start.x], [start.y], [start.heading]),
            "never asked",
        ),
        (
            lambda start, *each: drive(start, *each, radius=0.5),
            "before the goal; 0.05 m are asked for",
        ),
        (lambda start, *each: drive(start._replace(x=1.0), *each), "has to be the start"),
        (lambda start, *each: [[*part, math.nan] for part in drive(start, *each)], "not finite"),
    ],
)
def test_drive_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        drives.drive_known(answer)


def test_an_arc_is_not_eulers_step():
    def arc(place, heading, v, omega, dt):
        x, y, new = wmr.advance(wmr.Pose(place.real, place.imag, heading), v, omega, dt)
        return complex(x, y), new

    with pytest.raises(Hint, match="this step is an arc"):
        drives.drive_known(with_step(arc))


def test_drive_refuses_simulate():
    def answer(start, goal, law, dt, duration):
        run = wmr.simulate(start, goal, wmr.Gains(0.3, 2.0, 1.5), method="euler", dt=dt)
        return run.x, run.y, run.heading

    with pytest.raises(
        Hint,
        match=r"uses `wmr.simulate` of wmrlib; of it only `Pose`, `polar_error`, `wrap_angle` may be used",
    ):
        drives.drive_known(answer)


def test_drive_may_look_through_the_module():
    def answer(start, goal, law, dt, duration):
        run = [start]
        while (seen := wmr.polar_error(run[-1], goal)).rho > 0.05 and len(run) <= round(
            duration / dt
        ):
            (x, y, heading), (v, omega) = run[-1], law(*seen)
            run.append(
                wmr.Pose(
                    x + v * math.cos(heading) * dt,
                    y + v * math.sin(heading) * dt,
                    heading + omega * dt,
                )
            )
        return zip(*run, strict=True)

    for check in (drives.drive_known, drives.drive_arrives, drives.drive_obeys):
        assert check(answer)


def test_a_drive_that_does_not_park():
    with pytest.raises(Hint, match="at the right place"):
        drives.drive_arrives(with_eyes(lambda rho, alpha, theta: (rho, alpha, 0.0)))
    with pytest.raises(Hint, match="m away"):
        drives.drive_arrives(lambda start, *each: ([start.x], [start.y], [start.heading]))


@pytest.mark.parametrize(
    ("answer", "hint"),
    [
        (
            lambda start, goal, law, dt, duration: drive(
                start, goal, lambda *_: (0.5, 0.5), dt, duration
            ),
            "is the law that is passed in",
        ),
        (
            lambda start, goal, law, dt, duration: drive(start, goal, law, dt, duration - dt),
            "33 poses",
        ),
        (lambda *each: drive(*each, radius=-1.0), "has arrived, and needs no step"),
    ],
)
def test_obeying_hints(answer, hint):
    with pytest.raises(Hint, match=hint):
        drives.drive_obeys(answer)


@pytest.mark.parametrize(
    ("check", "answer", "hint"),
    [
        (drives.axes_known, lambda x, y, h: (x, y, h), "as they were"),
        (drives.axes_known, lambda x, y, h: (y, x, 0.0), "the heading is wrong"),
        (drives.axes_known, lambda x, y, h: (-y, x, h), "the place is wrong"),
        (drives.axes_properties, lambda x, y, h: (y, -x, h), "done twice"),
        (
            drives.axes_properties,
            lambda x, y, h: (x, y, h),
            "a left bend must look like a right bend",
        ),
        (drives.axes_properties, lambda x, y, h: (y, x, -h), "does not do so on the other"),
    ],
)
def test_axes_hints(check, answer, hint):
    with pytest.raises(Hint, match=hint):
        check(answer)
