"""The robot in one page: from two GPS points to a parked robot, in plain Python.

Run it with `python robot_in_one_page.py`, change a gain, and run it again. It needs nothing
besides Python. Lengths are in metres, times in seconds and angles in radians, x points east
and y north, and a heading is counted counter-clockwise from east.
"""

import math

EARTH_RADIUS = 6_371_000.0  # m


def haversine_distance(lat1, lon1, lat2, lon2):
    """The distance in metres between two points in degrees, along the sphere."""
    north, east = math.radians(lat2 - lat1), math.radians(lon2 - lon1)
    cosines = math.cos(math.radians(lat1)) * math.cos(math.radians(lat2))
    e = math.sin(north / 2) ** 2 + cosines * math.sin(east / 2) ** 2
    return EARTH_RADIUS * 2 * math.atan2(math.sqrt(e), math.sqrt(1 - e))


def local_position(lat1, lon1, lat2, lon2):
    """The second point as (x, y), seen from the first: our flat map in metres."""
    # For `ahead` books write cos(phi1) sin(phi2) - sin(phi1) cos(phi2) cos(east). Between
    # near points that is a small difference of large numbers. Our line is the same
    # expression, rearranged so that no digits are lost.
    phi1, phi2 = math.radians(lat1), math.radians(lat2)
    north, east = math.radians(lat2 - lat1), math.radians(lon2 - lon1)
    right = math.cos(phi2) * math.sin(east)
    ahead = math.sin(north) + 2 * math.sin(phi1) * math.cos(phi2) * math.sin(east / 2) ** 2
    bearing = math.atan2(right, ahead)  # clockwise from north, as on a compass
    distance = haversine_distance(lat1, lon1, lat2, lon2)
    return distance * math.sin(bearing), distance * math.cos(bearing)


def wrap(angle):
    """The same direction between -pi and pi: a turn by 350 deg is one of 10 deg back."""
    return math.remainder(angle, 2 * math.pi)


def sinc(angle):
    """sin(angle)/angle, which tends to 1 where the formula would divide zero by zero."""
    return math.sin(angle) / angle if angle else 1.0


def polar_error(pose, goal):
    """How far away the goal is, and the angles of the line of sight to it."""
    (x, y, heading), (goal_x, goal_y, goal_heading) = pose, goal
    line_of_sight = math.atan2(goal_y - y, goal_x - x)
    rho = math.hypot(goal_x - x, goal_y - y)
    alpha = wrap(line_of_sight - heading)  # 0: the robot faces its goal
    theta = wrap(line_of_sight - goal_heading)  # 0: it is on the line of approach
    return rho, alpha, theta


def control_law(rho, alpha, theta, gains):
    """The speed and the turning rate that lead to the goal and to its heading."""
    k_rho, k_alpha, h, v_max = gains
    # Full speed far away, slower near the goal, backwards if the goal lies behind.
    v = v_max * (1 - math.exp(-k_rho * rho)) * math.cos(alpha)
    # The first term turns the robot to its goal, the second bends the path towards the line
    # of approach. Chapter 4 derives them from the wish that the error never rises.
    omega = k_alpha * alpha + v / rho * sinc(alpha) * (alpha + h * theta)
    return v, omega


def arc_step(pose, v, omega, dt):
    """The pose after dt seconds of constant v and omega: the end of an arc."""
    x, y, heading = pose
    chord = v * dt * sinc(omega * dt / 2)  # from one end of the arc to the other
    halfway = heading + omega * dt / 2  # the direction of the chord
    x, y = x + chord * math.cos(halfway), y + chord * math.sin(halfway)
    return x, y, wrap(heading + omega * dt)


def drive(start, goal, gains, dt=0.1, duration=60.0, arrival_radius=0.05):
    """The poses of the robot, one every dt seconds, until it arrives or the time is up."""
    # A real controller too looks only so often, and holds its command until the next look.
    poses = [start]
    for _ in range(int(duration / dt + 1e-9)):  # 0.3/0.1 is a little less than 3
        rho, alpha, theta = polar_error(poses[-1], goal)
        if rho <= arrival_radius:  # so the law never divides by a rho of 0
            break
        v, omega = control_law(rho, alpha, theta, gains)
        poses.append(arc_step(poses[-1], v, omega, dt))
    return poses


if __name__ == "__main__":
    points = 33.273572, 44.373160, 33.274087, 44.373264  # the paper's: lat, lon, lat, lon
    start = 0.0, 0.0, 2 * math.pi / 5
    goal = *local_position(*points), -math.pi / 3
    gains = 0.2, 2.0, 2.0, 4.0  # k_rho in 1/m, k_alpha in 1/s, h, v_max in m/s
    poses = drive(start, goal, gains)
    rho = polar_error(poses[-1], goal)[0]
    error = math.degrees(wrap(poses[-1][2] - goal[2]))
    print(f"The goal is {haversine_distance(*points):.2f} m away.")
    print(f"After {0.1 * (len(poses) - 1):.1f} s the robot is {rho:.3f} m from it,")
    print(f"and faces {error:.1f} deg away from the goal's heading.")
