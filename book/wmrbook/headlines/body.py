"""Headlines of chapters 8 and 14: what a body adds to a drive, and where a robot looks."""

from __future__ import annotations

import math

import numpy as np

import wmrlib as wmr
from wmrbook.headlines import ROUND, headline
from wmrbook.headlines.field import AXES, GENTLE
from wmrbook.headlines.sampled import MATCHED
from wmrlib import estimation, paper

DEAD = 0.1  # m/s
DRIVES = {"axis": AXES, "heading": ROUND, "dt": (0.02, 0.1), "acceleration": (1.0, 5.0)}
STALLS = "With the gentle and with the matched gains the robot does not get to 5 cm"
LOOKS = "Every design then looks where it should, even $h = 0$"
DOCKED = "and no gate objects"


def driven(axis, heading, dt, acceleration, gains, **more):
    """The outdoor drive from any heading, by wheels with a dead band."""
    case = paper.outdoor(x_axis=axis)
    wheels = wmr.Wheels(0.5, max_speed=2.0, acceleration=acceleration, dead_band=DEAD)
    wheels = wheels._replace(min_speed=more.pop("min_speed", 0.0))
    how = {"dt": dt, "duration": 200.0, "wheels": wheels} | more
    return wmr.simulate(case.start._replace(heading=heading), case.goal, gains, **how)


@headline("08", STALLS, gains=[GENTLE, MATCHED], **DRIVES)
def stalled(gains, axis, heading, dt, acceleration):
    run = driven(axis, heading, dt, acceleration, gains)
    stall = -math.log1p(-DEAD / gains.v_max) / gains.k_rho  # (8.9)
    return not wmr.arrival(run).arrived and 0.85 * stall < run.rho[-1] < 1.05 * stall


@headline("08", LOOKS, h=(0.0, 4.0), k_rho=[0.05, 0.2], **DRIVES | {"dt": (0.02, 0.05)})
def turned(h, k_rho, axis, heading, dt, acceleration):
    gains, turn = GENTLE._replace(h=h, k_rho=k_rho), wmr.LastTurn(tolerance=0.03, min_rate=0.5)
    more = {"min_speed": 0.11, "last_turn": turn, "arrival_radius": 0.2}
    end = wmr.arrival(driven(axis, heading, dt, acceleration, gains, **more))
    return end.arrived and abs(end.heading_error) <= turn.tolerance


@headline("14", DOCKED, at_most=0.03, arm=(0.2, 1.0), bias=(0.02, 0.17), sigma=(0.01, 0.05))
def aside(arm, bias, sigma):
    now = estimation.start(wmr.Pose(0.0, 0.0, 0.0), 1.0, 0.2)
    worst = 0.0
    for _ in range(300):
        now = estimation.use_position(now, arm, 0.0, sigma, ahead=arm)
        now = estimation.use_heading(now, bias, math.radians(1.0))
        worst = max(worst, now.surprise)
    assert worst < estimation.GATE_1  # "no gate objects"
    return float(np.abs(now.pose.y / arm + math.sin(bias)) / math.sin(bias))
