"""Printed by python -m wmrrobot from wmrrobot.sensing: change that."""

import math

from wmrlib.compilation import formula


@formula
def moved_rows(heading, gyro_bias, wheel_scale, v, omega, gyro, share, dt):
    """d(x, y, heading) by the state's five entries, the speed and the turning rate"""
    part0 = omega*share
    part1 = part0*wheel_scale
    part2 = share - 1.0
    part3 = (0.5)*dt*(part1 - part2*(gyro - gyro_bias)) + heading
    part4 = math.sin(part3)
    part5 = dt*part4
    part6 = part5*v
    part7 = (0.5)*dt*dt*v
    part8 = part7*wheel_scale
    part9 = part4*part8
    part10 = math.cos(part3)
    part11 = part1*part7
    part12 = dt*part10
    part13 = part10*part8
    return (
        1.0,
        0.0,
        -part6*wheel_scale,
        -part2*part9,
        dt*part10*v - part11*part4,
        part12,
        -part9,
        0.0,
        1.0,
        part12*v*wheel_scale,
        part13*part2,
        part10*part11 + part6,
        part5,
        part13,
        0.0,
        0.0,
        1.0,
        dt*part2,
        dt*part0,
        0.0,
        dt,
    )


@formula
def antenna_rows(heading, ahead, left):
    """d(east, north) of the antenna by the state's five entries"""
    part0 = math.sin(heading)
    part1 = math.cos(heading)
    return (
        1.0,
        0.0,
        -ahead*part0 - left*part1,
        0.0,
        0.0,
        0.0,
        1.0,
        ahead*part1 - left*part0,
        0.0,
        0.0,
    )
