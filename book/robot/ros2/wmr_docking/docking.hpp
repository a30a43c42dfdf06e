// The law for Nav2's docking server: its two commands, on wmr_law.h alone.
//
// The methods have the names and arguments of opennav_docking::Controller, whose place a plug-in is
// to take (navigation2#6469). That interface is not settled yet: the class that derives from it,
// and its pluginlib line, are still to be written around this one.
#ifndef WMR_DOCKING_HPP
#define WMR_DOCKING_HPP

#include <algorithm>
#include <cmath>

#include "geometry_msgs/msg/pose.hpp"
#include "geometry_msgs/msg/twist.hpp"
#include "wmr_law.h"

namespace wmr_docking {

struct Limits {
  double track_width, max_speed, min_speed;   // m, m/s, m/s
  double gain, min_rate, max_rate, max_accel;  // of a turn on the spot: 1/s, rad/s, rad/s^2
};

class Law {
 public:
  Law(wmr_gains gains, Limits limits) : gains_(gains), limits_(limits) {}

  // To a dock seen from the robot, in base_link; false, and a stop, if the pose is no number.
  bool computeVelocityCommand(const geometry_msgs::msg::Pose& pose, geometry_msgs::msg::Twist& cmd,
                              bool /* is_docking */, bool backward = false) const {
    const auto& q = pose.orientation;
    const double yaw = std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
    // A robot that reverses is one that faces the other way, to a dock that does so too.
    const double sign = backward ? -1 : 1;
    const wmr_pose here = {0, 0, 0}, dock = {sign * pose.position.x, sign * pose.position.y, yaw};
    const wmr_polar error = wmr_polar_error(here, dock);
    wmr_twist twist = wmr_law(error, gains_);
    cmd = geometry_msgs::msg::Twist();
    if (twist.status) return false;
    const double hurry = wmr_hurry(twist.v, error.alpha, limits_.min_speed);
    twist.v *= hurry, twist.omega *= hurry;
    const double fastest = wmr_fastest_wheel(twist.v, twist.omega, limits_.track_width);
    const double scale = wmr_saturation_scale(limits_.max_speed, fastest);
    cmd.linear.x = sign * scale * twist.v;
    cmd.angular.z = scale * twist.omega;
    return true;
  }

  // A turn on the spot by an angle, in periods of dt seconds.
  geometry_msgs::msg::Twist computeRotateToHeadingCommand(
      const double& angle, const geometry_msgs::msg::Twist& now, const double& dt) const {
    geometry_msgs::msg::Twist cmd;
    const double rate = wmr_turn_rate(angle, limits_.gain, limits_.min_rate, limits_.max_rate);
    const double reach = limits_.max_accel * dt;
    cmd.angular.z = std::clamp(rate, now.angular.z - reach, now.angular.z + reach);
    return cmd;
  }

 private:
  wmr_gains gains_;
  Limits limits_;
};

}  // namespace wmr_docking

#endif
