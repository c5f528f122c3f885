// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

namespace cohort::ros2 {
namespace {

const ChannelInfo* channel_of(const std::vector<ChannelInfo>& channels, const std::string& name) {
  const auto found = std::ranges::find(channels, name, &ChannelInfo::name);
  return found == channels.end() ? nullptr : &*found;
}

// The radius of the first round collision of a link; 0 if it has none.
double radius_of(const description::Link& link) {
  for (const description::Collision& collision : link.collisions) {
    const double radius = std::visit(
        [](const auto& shape) {
          if constexpr (requires { shape.radius; })
            return static_cast<double>(shape.radius);
          else
            return 0.0;
        },
        collision.shape);
    if (radius > 0.0) return radius;
  }
  return 0.0;
}

// The variance of an encoder's positions among themselves: a constant bias cancels out.
double variance_of_positions(const description::Readout& readout) {
  const int index = description::noise_on(readout, "position", 0);
  if (index < 0) return 0.0;
  description::Noise noise = readout.noises[static_cast<std::size_t>(index)];
  noise.bias_deviation = 0.0;
  return variance_of(noise);
}

}  // namespace

// Looks through the devices of one model.
class DriveFinder {
 public:
  DriveFinder(const description::Model& model, const Start& robot) : model_(model), robot_(robot) {}

  void operator()(const description::DifferentialDrive& drive) {
    add_body_drive(drive.name);
    add_sides(drive.left_joints, drive.right_joints, drive.wheel_radius, drive.wheel_separation);
  }
  void operator()(const description::AckermannDrive& drive) {
    add_body_drive(drive.name);
    add_sides(drive.left_joints, drive.right_joints, drive.wheel_radius, drive.wheel_separation);
  }
  void operator()(const description::TrackedDrive& drive) { add_body_drive(drive.name); }
  void operator()(const description::TreelDrive& drive) {
    for (const double side : {1.0, -1.0}) {
      const std::string name = drive.name + (side > 0 ? "/left/" : "/right/");
      const double y = side * drive.half_gauge;
      add_driven(name + "velocity", 1.0, -y);
    }
    for (const description::Device& device : model_.devices)
      if (const auto* encoder = std::get_if<description::TreelEncoder>(&device))
        for (const double side : {1.0, -1.0})
          add_measured(encoder->name + (side > 0 ? "/left/position" : "/right/position"), 1.0, side * drive.half_gauge,
                       variance_of_positions(encoder->readout));
  }
  void operator()(const description::VelocityMotor& motor) {
    const description::Joint& joint = model_.joints[motor.joint];
    const description::Link& wheel = model_.links[joint.child];
    const double radius = radius_of(wheel);
    const Pose X_MJ = wheel.X_ML * joint.X_LJ;
    const Eigen::Vector3d axis = (model_.links[0].X_ML.inverse() * X_MJ).orientation * joint.axis.direction;
    // A wheel turns about the body's y axis; the joint's axis may point either way.
    constexpr double least_cosine = 0.99;
    if (radius <= 0.0 || joint.type != description::JointType::revolute || std::abs(axis.y()) < least_cosine) return;
    const double y = (model_.links[0].X_ML.inverse() * X_MJ).position.y();
    wheels_.push_back({motor.joint, motor.name + "/0/velocity", std::copysign(radius, axis.y()), y});
  }
  template <class Other>
  void operator()(const Other&) {}

  void add_named(const description::Ros2Drive& options) {
    for (const bool is_left : {true, false})
      for (const std::string& name : is_left ? options.left : options.right) {
        if (channel_of(robot_.command_channels, name) == nullptr)
          throw std::runtime_error("'ros2: drive' names the channel '" + name + "', which robots of the model '" +
                                   model_.name + "' do not have");
        const double y = (is_left ? 0.5 : -0.5) * options.wheel_separation;
        add_driven(name, 1.0 / options.wheel_radius, -y / options.wheel_radius);
        for (const description::Device& device : model_.devices)
          if (const auto* motor = std::get_if<description::VelocityMotor>(&device);
              motor != nullptr && motor->name + "/0/velocity" == name)
            add_encoders(motor->joint, options.wheel_radius, y);
      }
  }

  std::optional<Drive> take() {
    if (drive_.driven_.empty()) use_wheels();
    if (drive_.driven_.empty()) return std::nullopt;
    // The turn of a robot whose encoders are all on one line cannot be told.
    const auto differs = [&](const Drive::Measured& each) { return each.y != drive_.measured_.front().y; };
    if (std::ranges::none_of(drive_.measured_, differs)) drive_.measured_.clear();
    return std::move(drive_);
  }

 private:
  struct Wheel {
    std::size_t joint = 0;
    std::string command;
    double radius = 0.0;  // negative: turns backwards
    double y = 0.0;
  };

  void use_wheels() {
    const auto is_left = [](const Wheel& wheel) { return wheel.y > 0.0; };
    const auto is_right = [](const Wheel& wheel) { return wheel.y < 0.0; };
    if (std::ranges::none_of(wheels_, is_left) || std::ranges::none_of(wheels_, is_right)) return;
    for (const Wheel& wheel : wheels_) {
      add_driven(wheel.command, 1.0 / wheel.radius, -wheel.y / wheel.radius);
      add_encoders(wheel.joint, wheel.radius, wheel.y);
    }
  }

  void add_body_drive(const std::string& name) {
    add_driven(name + "/0/linear", 1.0, 0.0);
    add_driven(name + "/0/angular", 0.0, 1.0);
  }
  void add_driven(const std::string& name, double per_linear, double per_angular) {
    if (const ChannelInfo* channel = channel_of(robot_.command_channels, name))
      drive_.driven_.push_back({channel->offset, per_linear, per_angular, channel->lower, channel->upper});
  }
  void add_sides(const std::vector<std::size_t>& left, const std::vector<std::size_t>& right, double radius,
                 double separation) {
    for (const std::size_t joint : left) add_encoders(joint, radius, 0.5 * separation);
    for (const std::size_t joint : right) add_encoders(joint, radius, -0.5 * separation);
  }
  void add_encoders(std::size_t joint, double radius, double y) {
    for (const description::Device& device : model_.devices)
      if (const auto* encoder = std::get_if<description::JointEncoder>(&device);
          encoder != nullptr && encoder->joint == joint)
        add_measured(encoder->name + "/0/position", radius, y, variance_of_positions(encoder->readout));
  }
  void add_measured(const std::string& name, double scale, double y, double variance) {
    if (const ChannelInfo* channel = channel_of(robot_.observation_channels, name))
      drive_.measured_.push_back({channel->offset, scale, y, scale * scale * variance, 0.0});
  }

  const description::Model& model_;
  const Start& robot_;
  Drive drive_;
  std::vector<Wheel> wheels_;
};

std::optional<Drive> Drive::of(const description::Model& model, const Start& robot,
                               const std::optional<description::Ros2Drive>& wheels) {
  DriveFinder finder(model, robot);
  if (wheels)
    finder.add_named(*wheels);
  else
    for (const description::Device& device : model.devices) std::visit(finder, device);
  return finder.take();
}

void Drive::command(const BodyVelocity& velocity, std::span<double> command) const {
  double factor = 1.0;
  for (const Driven& each : driven_) {
    const double value = each.per_linear * velocity.linear + each.per_angular * velocity.angular;
    if (value > each.upper && each.upper > 0.0) factor = std::min(factor, each.upper / value);
    if (value < each.lower && each.lower < 0.0) factor = std::min(factor, each.lower / value);
  }
  for (const Driven& each : driven_) {
    const double value = factor * (each.per_linear * velocity.linear + each.per_angular * velocity.angular);
    command[each.offset] = std::clamp(value, each.lower, each.upper);
  }
}

void Drive::restart() {
  motion_ = {};
  wander_.setZero();
  has_origin_ = false;
}

const PlanarMotion& Drive::measure(std::span<const double> observation, double seconds) {
  // Least squares for way = dx - dθ y over all wheels: of two they are the usual mean and difference.
  double count = 0.0, sum_y = 0.0, sum_yy = 0.0, sum_way = 0.0, sum_way_y = 0.0;
  for (Measured& each : measured_) {
    const double position = observation[each.offset];
    const double way = has_origin_ ? each.scale * (position - each.last) : 0.0;
    each.last = position;
    count += 1.0;
    sum_y += each.y;
    sum_yy += each.y * each.y;
    sum_way += way;
    sum_way_y += way * each.y;
  }
  const bool is_origin = !std::exchange(has_origin_, true);
  const double determinant = count * sum_yy - sum_y * sum_y;
  if (determinant <= 0.0) return motion_;
  const double dx = (sum_yy * sum_way - sum_y * sum_way_y) / determinant;
  const double turn = (sum_y * sum_way - count * sum_way_y) / determinant;
  // Along the chord of the arc, to second order in the turn.
  const double direction = motion_.heading + 0.5 * turn;
  ReadingVariance reading;
  for (const Measured& each : measured_) {
    const double per_way = (sum_yy - sum_y * each.y) / determinant;
    const double turn_per_way = (sum_y - count * each.y) / determinant;
    reading.linear += per_way * per_way * each.variance;
    reading.angular += turn_per_way * turn_per_way * each.variance;
  }
  motion_.x += dx * std::cos(direction);
  motion_.y += dx * std::sin(direction);
  motion_.heading += turn;
  motion_.velocity = seconds > 0.0 ? BodyVelocity{dx / seconds, turn / seconds} : BodyVelocity{};
  if (!is_origin) add_errors(reading, dx, direction, seconds);
  return motion_;
}

// The way and the heading are differences of two readings, the present one and that at the origin, whose errors are
// independent. An error of the heading at the origin turns the whole way about the origin. Errors of the headings in
// between move the robot aside at each step, independently.
void Drive::add_errors(const ReadingVariance& reading, double dx, double direction, double seconds) {
  const Eigen::Vector2d aside(-std::sin(direction), std::cos(direction));
  wander_ += dx * dx * reading.angular * aside * aside.transpose();
  const Eigen::Vector2d ahead(std::cos(motion_.heading), std::sin(motion_.heading));
  const Eigen::Vector2d turned(-motion_.y, motion_.x);
  const Eigen::Vector2d at_origin = Eigen::Vector2d::UnitX();
  motion_.covariance.topLeftCorner<2, 2>() =
      wander_ + reading.linear * (at_origin * at_origin.transpose() + ahead * ahead.transpose()) +
      reading.angular * turned * turned.transpose();
  motion_.covariance.topRightCorner<2, 1>() = reading.angular * turned;
  motion_.covariance.bottomLeftCorner<1, 2>() = reading.angular * turned.transpose();
  motion_.covariance(2, 2) = 2.0 * reading.angular;
  const double squared = seconds * seconds;
  motion_.variance =
      squared > 0.0 ? BodyVelocity{2.0 * reading.linear / squared, 2.0 * reading.angular / squared} : BodyVelocity{};
}

}  // namespace cohort::ros2
