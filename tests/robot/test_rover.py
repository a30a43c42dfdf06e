"""The rover obeys mechanics, becomes the kinematic robot without its mass, and is as stored."""

import math

import numpy as np
import pytest

pytest.importorskip("mujoco", reason='the rover needs mujoco: pip install ".[robot]"')
import mujoco
import rover as robot

import wmrlib as wmr
from wmrbook.rover_model import GRAVITY, PAGE_DRIVE, PAGE_GAINS, Rover, stored

HOME = wmr.Pose(0.0, 0.0, 0.0)
# No mass to speak of, a grip without end, and motors that obey at once.
WEIGHTLESS = Rover(0.1, 0.1, 10.0, dry=0.0, servo=2.0, torque=1e3, acceleration=1e3, wheel=0.01)


def gap(rover, goal=PAGE_DRIVE[1]):
    """How far its path leads from the kinematic one [m], and its heading at the end [deg]."""
    at = robot.drive(rover, PAGE_GAINS, PAGE_DRIVE[0], goal, duration=20.0)
    run = robot.ideal(PAGE_GAINS, PAGE_DRIVE[0], goal)
    ends = (at["rho"], at["heading"]), (run.rho, run.heading)
    own, ideal = (robot.off_deg(*end, goal) for end in ends)
    return robot.apart(at, run), math.inf if own is None else abs(own - ideal)


def total(rover, pose=HOME):
    world = robot.World(rover, pose)
    return world, float(np.sum(world.model.body_mass))


def test_without_its_mass_it_drives_as_the_theorem_says():
    far, off = gap(WEIGHTLESS)
    assert far < 0.01
    assert off < 0.5
    assert gap(Rover())[0] > 2.0 * far
    assert gap(Rover(load=40.0))[0] > gap(Rover())[0]


@pytest.mark.parametrize("slope", [0.0, 10.0])
def test_at_rest_the_ground_carries_its_weight(slope):
    world, mass = total(Rover(slope_deg=slope, downhill_deg=-90.0))
    for _ in range(20):
        world.roll(0.0, 0.0)
    loads = world.sample(HOME)[2:]
    assert sum(loads) == pytest.approx(mass * GRAVITY * math.cos(math.radians(slope)), rel=1e-3)
    # moments about the line of travel, and about the axle
    height = world.data.subtree_com[1][2]
    lean = (loads[1] - loads[0]) * 0.25 / (mass * GRAVITY * math.sin(math.radians(slope)) or 1.0)
    assert lean == pytest.approx(height if slope else 0.0, abs=0.01)
    behind = -world.data.subtree_com[1][0]
    assert loads[2] / sum(loads) == pytest.approx(behind / 0.4, rel=0.03)


def test_in_a_turn_the_outer_wheel_takes_what_the_inner_one_loses():
    world, mass = total(Rover())
    for k in range(200):
        world.roll(2.0, min(0.5, max(0.0, 0.01 * (k - 60))))
    ahead, _, left, right, _ = world.sample(world.pose)
    sideways = ahead * world.data.qvel[5]
    height = world.data.subtree_com[1][2]
    # the castor stands a little aside then, and the wheels are gyroscopes
    assert (right - left) * 0.25 == pytest.approx(mass * sideways * height, rel=0.1)


def test_what_rolls_downhill_without_motors_keeps_its_energy():
    world, _ = total(Rover(slope_deg=5.0, dry=0.0))
    flags = mujoco.mjtDisableBit.mjDSBL_ACTUATION, mujoco.mjtEnableBit.mjENBL_ENERGY
    world.model.opt.disableflags |= int(flags[0])
    world.model.opt.enableflags |= int(flags[1])
    world.model.dof_damping[:] = 0.0  # the castor's bearings
    energies = []
    for _ in range(40):
        world.roll(0.0, 0.0)
        energies.append(world.data.energy.copy())
    kinetic = energies[-1][1] - energies[0][1]
    assert kinetic > 20.0  # J
    assert abs(np.sum(energies[-1]) - np.sum(energies[0])) < 0.01 * kinetic


@pytest.mark.parametrize("row", stored()["stalls"])
def test_dry_motors_stall_where_their_dead_band_says(row):
    assert row["rest"] == pytest.approx(row["predicted"], abs=1.5e-3)
    if row["dry"] == 1.0:
        assert robot.stalls_at(1.0)["rest"] == pytest.approx(row["rest"], abs=5e-4)


def test_what_is_stored_is_driven_again():
    found = stored()
    at = robot.drive(Rover(), PAGE_GAINS, *PAGE_DRIVE)
    again = np.transpose([at[name][::20] for name in ("x", "y", "heading")])
    np.testing.assert_allclose(again, found["page"], atol=2e-3)
    rows = {(it["gains"], it["ground"], len(it)): it for it in found["drives"][::-1]}
    for gains, ground in ((robot.GENTLE, "wet grass"), (robot.PAPERS, "concrete")):
        row = robot.measured(gains, ground, "level", {})
        kept = rows[gains, ground, len(row)]
        for name in ("time", "apart", "slip_deg"):
            assert row[name] == pytest.approx(kept[name], rel=0.05, abs=0.1), name
    line = found["kappas"].index(2.5)
    for pace, ground, errors in found["windows"]:
        own = np.array(robot.window(pace, ground, 2.5), dtype=float)[:, 0]
        kept = np.array(errors[line], dtype=float)[:, 0]
        parked = [np.count_nonzero(abs(each) < 5) for each in (own, kept)]
        assert parked[0] == pytest.approx(parked[1], abs=1)


def test_half_the_time_step_says_the_same_where_nothing_slides():
    drives = stored()["drives"]
    fine = [it for it in drives if "timestep" in it and it["gains"] != robot.PAPERS]
    assert len(fine) == 4
    for row in fine:
        same = {name: row[name] for name in ("gains", "ground", "slope")}.items()
        coarse = next(it for it in drives if same <= it.items())
        assert "timestep" not in coarse
        assert coarse["off_deg"] == pytest.approx(row["off_deg"], abs=0.15)
        assert coarse["apart"] == pytest.approx(row["apart"], abs=0.05)
