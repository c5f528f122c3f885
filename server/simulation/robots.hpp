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

/// Robots of one model: what they observe and how they are commanded.
struct RobotKind {
  std::string model;
  std::vector<Channel> observation;
  std::vector<Channel> command;
  std::size_t observation_size = 0;  ///< float64 values
  std::size_t command_size = 0;
};

/// Why a command cannot act.
struct CommandFault {
  enum class Reason { wrong_size, not_finite, out_of_range };
  Reason reason;
  std::string channel;  ///< empty for wrong_size
  std::string text;     ///< a sentence that says what was found and what was expected
};

/// The robots of a world, by their ids: their sensors and what these observe, their actuators and what commands them.
/// Knows no kind of either. One thread calls it, but for `hash`, which may be called from any between changes.
class Robots {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// What robots sense and act on; all of it must outlive them.
  struct Surroundings {
    const description::Experiment& experiment;
    std::uint64_t seed;  ///< of the run
    physics::World& world;
    emission::Emitters& emitters;
    gripping::Grippers& grippers;
    gripping::DetachableJoints& detachable_joints;
    actuation::UserActions& actions;
    const Objects& objects;
    WorkerPool& workers;
  };
  /// Those of the experiment. `like`: of another world of it, with which they share what is the same; null: none.
  explicit Robots(const Surroundings& around, const Robots* like = nullptr);

  /// The next robot of the experiment's world, which has come to it and to one of its teams, and which all others that
  /// know of bodies were told of. Nobody has asked it yet.
  void add();
  std::uint32_t size() const { return static_cast<std::uint32_t>(robots_.size()); }
  const std::string& name(std::uint32_t robot) const { return around_.experiment.world.robot(robot).name; }
  std::span<const RobotKind> kinds() const { return kinds_->described; }
  std::uint32_t kind_of(std::uint32_t robot) const { return robots_[robot].kind; }
  /// By its index in the experiment.
  std::uint32_t team_of(std::uint32_t robot) const { return robots_[robot].team; }
  const description::Policy& policy(std::uint32_t robot) const { return robots_[robot].policy; }
  BodyId body_of(std::uint32_t robot) const { return robots_[robot].body; }
  /// `none` of a body that is no robot's.
  std::uint32_t of_body(BodyId body) const { return body.value < of_body_.size() ? of_body_[body.value] : none; }
  bool is_present(std::uint32_t robot) const { return around_.objects.is_present(robots_[robot].body.value); }
  bool is_due(std::uint32_t robot, std::uint64_t tick) const;

  std::optional<CommandFault> check_command(std::uint32_t robot, std::span<const double> values) const;
  bool set_command(std::uint32_t robot, std::span<const double> values);
  bool set_neutral_command(std::uint32_t robot);
  std::span<const double> command(std::uint32_t robot) const { return robots_[robot].command; }
  /// All do what they are commanded, in their order; one that a sensor disables has its neutral command from now on.
  void actuate();

  /// All that are in the world and due observe this tick; after `Emitters::update`. Again at the same tick, if
  /// something has been changed from outside.
  void sense(std::uint64_t tick);
  std::span<const double> observation(std::uint32_t robot) const;

  /// What one robot observes, is commanded and remembers.
  void hash(std::uint32_t robot, StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  struct SensorOfRobot {
    std::unique_ptr<sensing::Sensor> sensor;
    sensing::SignalChain signal_chain;
    std::size_t size = 0;  // of what it observes
  };
  struct ActuatorOfRobot {
    std::unique_ptr<actuation::Actuator> actuator;
    std::size_t size = 0;  // of its command
  };
  struct Robot {
    std::uint32_t kind = 0;
    BodyId body;
    std::uint32_t team = 0;
    description::Policy policy;
    std::vector<SensorOfRobot> sensors;
    std::vector<ActuatorOfRobot> actuators;
    std::size_t observation_offset = 0;
    std::vector<double> command;  // that acts now
  };
  struct Place {
    std::uint32_t robot = 0;
    std::size_t sensor = 0;
  };

  struct KindParts {
    std::vector<std::shared_ptr<const sensing::SignalPlan>> signal_plans;  // of each sensor
    std::vector<std::size_t> sensor_sizes;
    std::vector<std::size_t> actuator_sizes;
    std::vector<double> neutral;  // command
  };
  struct Kinds {
    std::vector<RobotKind> described;
    std::vector<KindParts> parts;
    std::vector<std::uint32_t> of_model;  // `none`: of a model without a robot so far
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

  Surroundings around_;
  sensing::SharedViews views_;
  std::vector<Place> sharing_views_;
  std::shared_ptr<const Kinds> kinds_;  // shared by worlds of one experiment
  std::size_t described_;               // robots that there were at first
  std::vector<Robot> robots_;
  std::vector<std::uint32_t> of_body_;
  std::vector<double> observations_;
  std::vector<std::vector<double>> scratch_;  // of each worker
};

}  // namespace cohort
