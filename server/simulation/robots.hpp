// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/actuation/actuator.hpp"
#include "server/core/channel.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/experiment.hpp"
#include "server/sensing/readings/signal_chain.hpp"
#include "server/sensing/sensor.hpp"
#include "server/simulation/objects.hpp"

namespace cohort {

/// The robots of one model: their observation and command channels.
struct RobotKind {
  std::string model;
  std::vector<Channel> observation;
  std::vector<Channel> command;
  std::size_t observation_size = 0;  ///< number of float64 values
  std::size_t command_size = 0;
  std::size_t index = 0;  ///< index of the model in World::models
};

/// The reason why a command is invalid.
struct CommandFault {
  enum class Reason { wrong_size, not_finite, out_of_range };
  Reason reason;
  std::string channel;  ///< empty for wrong_size
  std::string text;     ///< a sentence with the found and the expected value
};

/// The robots of a world, by id: their sensors and observations, their actuators and commands. Independent of the kinds
/// of sensors and actuators. For one thread, except `hash`, which any thread may call between changes.
class Robots {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// The objects that sensors and actuators use. They must outlive the robots.
  struct Surroundings {
    const description::Experiment& experiment;
    std::uint64_t seed;  ///< seed of the run
    physics::World& world;
    emission::Emitters& emitters;
    gripping::Grippers& grippers;
    gripping::DetachableJoints& detachable_joints;
    actuation::UserActions& actions;
    const Objects& objects;
    WorkerPool& workers;
  };
  /// Adds the robots of the experiment. `like`: the robots of another world of the same experiment, to share common
  /// data with, or null.
  explicit Robots(const Surroundings& around, const Robots* like = nullptr);

  /// Adds the next robot of the experiment's world. It must already be in the world and in a team, and its body must
  /// have been added to all other `Surroundings`. It has not received a frame yet.
  void add();
  /// Frees the devices of a robot whose body was released.
  void release(std::uint32_t robot);
  std::uint32_t size() const { return static_cast<std::uint32_t>(robots_.size()); }
  const std::string& name(std::uint32_t robot) const { return around_.experiment.world.robot(robot).name; }
  std::span<const RobotKind> kinds() const { return kinds_->described; }
  std::uint32_t kind_of(std::uint32_t robot) const { return robots_[robot].kind; }
  /// Returns the team's index in the experiment.
  std::uint32_t team_of(std::uint32_t robot) const { return robots_[robot].team; }
  const description::Policy& policy(std::uint32_t robot) const { return robots_[robot].policy; }
  BodyId body_of(std::uint32_t robot) const { return robots_[robot].body; }
  /// Returns `none` if the body is not a robot's.
  std::uint32_t of_body(BodyId body) const { return body.value < of_body_.size() ? of_body_[body.value] : none; }
  bool is_present(std::uint32_t robot) const { return around_.objects.is_present(robots_[robot].body.value); }
  /// Returns true if the robot was removed for good: it has no devices, and its observation and command are empty.
  bool is_released(std::uint32_t robot) const {
    return around_.world.slot_of(robots_[robot].body) == physics::World::released;
  }
  /// Returns the robots that are not released, ascending.
  std::span<const std::uint32_t> kept() const { return kept_; }
  bool is_due(std::uint32_t robot, std::uint64_t tick) const;

  std::optional<CommandFault> check_command(std::uint32_t robot, std::span<const double> values) const;
  bool set_command(std::uint32_t robot, std::span<const double> values);
  bool set_neutral_command(std::uint32_t robot);
  std::span<const double> command(std::uint32_t robot) const { return robots_[robot].command; }
  /// Applies all commands, in the order of the robots. A robot that a sensor disables has its neutral command from now
  /// on.
  void actuate();

  /// Updates the observations of all due robots in the world, after `Emitters::update`. May be called again at the same
  /// tick after a change from outside.
  void sense(std::uint64_t tick);
  std::span<const double> observation(std::uint32_t robot) const;
  /// Returns the tick at which a value of the observation at `tick` was measured; nothing before the first report.
  /// `place`: the index of the value. The robot must be due at the tick, and in the world since tick 0.
  std::optional<std::uint64_t> measurement_at(std::uint32_t robot, std::size_t place, std::uint64_t tick) const;

  /// Adds the observation, command and internal state of one robot to the hash.
  void hash(std::uint32_t robot, StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  struct SensorOfRobot {
    std::unique_ptr<sensing::Sensor> sensor;
    sensing::SignalChain signal_chain;
    std::size_t size = 0;  // number of observed values
  };
  struct ActuatorOfRobot {
    std::unique_ptr<actuation::Actuator> actuator;
    std::size_t size = 0;  // number of commanded values
  };
  struct Robot {
    std::uint32_t kind = 0;
    BodyId body;
    std::uint32_t team = 0;
    description::Policy policy;
    std::vector<SensorOfRobot> sensors;
    std::vector<ActuatorOfRobot> actuators;
    std::size_t observation_offset = 0;
    std::vector<double> command;  // the command that acts now
  };
  struct Place {
    std::uint32_t robot = 0;
    std::size_t sensor = 0;
  };

  struct KindParts {
    std::vector<std::shared_ptr<const sensing::SignalPlan>> signal_plans;  // by sensor
    std::vector<std::size_t> sensor_sizes;
    std::vector<std::size_t> actuator_sizes;
    std::vector<double> neutral;  // command
  };
  struct Kinds {
    std::vector<RobotKind> described;
    std::vector<KindParts> parts;
    std::vector<std::uint32_t> of_model;  // `none` for a model without robots so far
  };
  struct DevicesOfRobot {  // in the order of the model
    std::vector<std::pair<std::unique_ptr<sensing::Sensor>, const description::Device*>> sensors;
    std::vector<std::unique_ptr<actuation::Actuator>> actuators;
  };

  DevicesOfRobot make_devices(const Robot& robot);
  std::uint32_t find_or_add_kind(std::size_t model, const DevicesOfRobot& devices);
  CommandFault wrong_size(std::uint32_t robot, std::size_t size) const;
  CommandFault unfit(std::uint32_t robot, const Channel& channel, double value) const;
  void update_shared_views(std::uint64_t tick);
  std::size_t add_observation(std::uint32_t slot, std::size_t size);

  Surroundings around_;
  sensing::SharedViews views_;
  std::vector<Place> sharing_views_;
  std::shared_ptr<const Kinds> kinds_;  // shared by worlds of one experiment
  std::size_t described_;               // number of robots at the start
  std::vector<Robot> robots_;
  std::vector<std::uint32_t> kept_;
  std::vector<std::uint32_t> of_body_;
  std::vector<double> observations_;
  std::vector<std::size_t> observation_offsets_;  // by slot of the body
  std::vector<std::vector<double>> scratch_;      // by worker
};

}  // namespace cohort
