// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/robots/command_topics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "idl/dds/ros2/ros_names.hpp"
#include "idl/messages/ros_navigation_messages.hpp"
#include "idl/messages/ros_std_messages.hpp"
#include "idl/messages/ros_type_hash.hpp"
#include "idl/text/printable.hpp"
#include "server/messages/command_messages.hpp"
#include "tools/bridges/ros2/robots/publications.hpp"
#include "tools/bridges/ros2/robots/trajectory.hpp"

namespace cohort::ros2 {
namespace {

namespace ros = messages::ros;

template <messages::RosMessage Message, class Take>
CommandTopic::Type type_of(Take take) {
  return {Message::type, messages::type_hash<Message>(),
          [take = std::move(take)](messages::CdrReader& reader, std::span<double> command) {
            return take(reader.get<Message>(), command);
          }};
}

void expect_finite(std::span<const double> values) {
  if (!std::ranges::all_of(values, [](double each) { return std::isfinite(each); }))
    throw std::invalid_argument("a value is not finite");
}

Stamp drive_by(const Drive& drive, const ros::Twist& twist, std::span<double> command) {
  expect_finite(std::vector<double>{twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y,
                                    twist.angular.z});
  drive.command({twist.linear.x, twist.angular.z}, command);
  return std::nullopt;
}

std::vector<CommandTopic::Type> velocity_types(const Drive& drive) {
  return {type_of<ros::Twist>(
              [&drive](const ros::Twist& twist, std::span<double> command) { return drive_by(drive, twist, command); }),
          type_of<ros::TwistStamped>([&drive](const ros::TwistStamped& message, std::span<double> command) -> Stamp {
            drive_by(drive, message.twist, command);
            return ros::nanoseconds(message.header.stamp);
          })};
}

// A command channel of a motor, and the joint that it moves.
struct MotorChannel {
  std::string joint;
  std::size_t offset = 0;
  double lower = 0.0;
  double upper = 0.0;
};

// As the forward command controllers of ros2_control have it: a value for each joint, in the order of the list.
CommandTopic::Type values_of(std::vector<MotorChannel> motors) {
  return type_of<ros::Float64MultiArray>(
      [motors = std::move(motors)](const ros::Float64MultiArray& message, std::span<double> command) -> Stamp {
        if (message.data.size() != motors.size())
          throw std::invalid_argument("it has " + std::to_string(message.data.size()) + " values; expected " +
                                      std::to_string(motors.size()) + ", one for each motor");
        expect_finite(message.data);
        for (std::size_t i = 0; i < motors.size(); ++i)
          command[motors[i].offset] = std::clamp(message.data[i], motors[i].lower, motors[i].upper);
        return std::nullopt;
      });
}

// Finds the motors of one model, by what they take.
struct Motors {
  Motors(const description::Model& its_model, const Start& its_robot) : model(its_model), robot(its_robot) {}

  void operator()(const description::PositionMotor& motor) {
    add(position, motor.name + "/0/position", model.joints[motor.joint].name);
  }
  void operator()(const description::VelocityMotor& motor) {
    add(velocity, motor.name + "/0/velocity", model.joints[motor.joint].name);
  }
  void operator()(const description::EffortMotor& motor) {
    add(effort, motor.name + "/0/effort", model.joints[motor.joint].name);
  }
  void operator()(const description::Rotor& rotor) { add(rotors, rotor.name + "/0/velocity", rotor.name); }
  template <class Other>
  void operator()(const Other&) {}

  void add(std::vector<MotorChannel>& to, const std::string& channel, const std::string& joint) const {
    const auto found = std::ranges::find(robot.command_channels, channel, &ChannelInfo::name);
    if (found != robot.command_channels.end()) to.push_back({joint, found->offset, found->lower, found->upper});
  }

  const description::Model& model;
  const Start& robot;
  std::vector<MotorChannel> position, velocity, effort, rotors;
};

CommandTopic trajectory_topic(const std::string& name, const std::vector<MotorChannel>& motors) {
  std::vector<Trajectory::Target> targets;
  for (const MotorChannel& motor : motors) targets.push_back({motor.joint, motor.offset});
  const auto trajectory = std::make_shared<Trajectory>(std::move(targets));
  CommandTopic::Motion motion;
  motion.advance = [trajectory](std::chrono::nanoseconds time, std::span<double> command) {
    trajectory->advance(time, command);
  };
  motion.end = [trajectory] { trajectory->end(); };
  const auto begin = [trajectory](const ros::JointTrajectory& message, std::span<double> command) -> Stamp {
    trajectory->begin(message, command);
    return std::nullopt;
  };
  return {name, {type_of<ros::JointTrajectory>(begin)}, std::move(motion)};
}

}  // namespace

CommandTopic::CommandTopic(std::string name, std::vector<Type> types, Motion motion)
    : name_(std::move(name)), types_(std::move(types)), motion_(std::move(motion)) {}

void CommandTopic::open(RosParticipant& participant, std::function<void(const Received&)> received,
                        std::function<void()> matched) {
  received_ = std::move(received);
  matched_ = std::move(matched);
  read(participant);
}

void CommandTopic::read(RosParticipant& participant) {
  reader_.reset();  // a participant has one type for each topic
  const Type& type = types_[type_];
  reader_.emplace(participant, topic_endpoint(name_, type.name, type.hash, {is_reliable_, false, 10}), received_,
                  matched_);
}

bool CommandTopic::follow(RosParticipant& participant, const std::vector<RosEndpoint>& writers) {
  if (!participants().empty()) return false;
  for (const RosEndpoint& writer : writers) {
    const auto type =
        std::ranges::find_if(types_, [&](const Type& each) { return dds_type(each.name) == writer.type; });
    if (type == types_.end()) continue;
    const auto index = static_cast<std::size_t>(type - types_.begin());
    if (index == type_ && writer.is_reliable == is_reliable_) return false;  // DDS is about to match them
    type_ = index;
    is_reliable_ = writer.is_reliable;
    read(participant);
    return true;
  }
  return false;
}

std::string CommandTopic::why_not(const RosEndpoint& writer) const {
  std::string expected;
  for (const Type& type : types_) {
    if (dds_type(type.name) == writer.type) return {};
    expected += (expected.empty() ? "" : " or ") + type.name;
  }
  return "is a " + printable(ros_type(writer.type)) + "; expected a " + expected;
}

Stamp CommandTopic::take(std::span<const std::byte> message, std::span<double> command) const {
  messages::CdrReader reader(message);
  return types_[type_].take(reader, command);
}

std::vector<CommandTopic> command_topics(const description::Model& model, const DrivenRobot& robot,
                                         const RobotSettings& settings, const Drive* drive) {
  std::vector<CommandTopic> topics;
  const auto add = [&](const std::string& name, const auto& make) {
    if (const std::optional<std::string> topic = name_of_topic(settings, name)) topics.push_back(make(*topic));
  };
  if (drive != nullptr)
    add("cmd_vel", [&](const std::string& name) { return CommandTopic(name, velocity_types(*drive)); });
  Motors motors(model, robot.start);
  for (const description::Device& device : model.devices) std::visit(motors, device);
  const auto add_values = [&](const std::string& name, const std::vector<MotorChannel>& of) {
    if (!of.empty()) add(name, [&](const std::string& topic) { return CommandTopic(topic, {values_of(of)}); });
  };
  if (!motors.position.empty())
    add("joint_trajectory_controller/joint_trajectory",
        [&](const std::string& name) { return trajectory_topic(name, motors.position); });
  add_values("position_controller/commands", motors.position);
  add_values("velocity_controller/commands", motors.velocity);
  add_values("effort_controller/commands", motors.effort);
  add_values("rotor_controller/commands", motors.rotors);
  for (messages::CommandMessage& message : messages::command_messages(model, channels_of(robot.start.command_channels)))
    add(message.name, [&](const std::string& name) {
      return CommandTopic(
          name, {{message.type, messages::type_hash(message.definition),
                  [read = std::move(message.read)](messages::CdrReader& reader, std::span<double> command) -> Stamp {
                    read(reader, command);
                    return std::nullopt;
                  }}});
    });
  return topics;
}

}  // namespace cohort::ros2
