// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "server/actuation/user_actions.hpp"
#include "server/core/worker_pool.hpp"
#include "server/description/experiment.hpp"
#include "server/emission/emitters.hpp"
#include "server/gripping/grippers.hpp"
#include "server/physics/world/physics_world.hpp"
#include "server/simulation/action.hpp"
#include "server/simulation/action_error.hpp"
#include "server/simulation/breakable_joints.hpp"
#include "server/simulation/objects.hpp"
#include "server/simulation/robots.hpp"
#include "server/simulation/schedule.hpp"
#include "server/simulation/shared_experiment.hpp"
#include "server/simulation/spawned_models.hpp"

namespace cohort {

/// Numbers of robot-ticks with contacts, since the start of the run.
struct TouchCounts {
  std::uint64_t robot_ticks = 0;  ///< number of robots times number of ticks
  std::uint64_t obstacles = 0;    ///< in contact with something that is neither a robot nor a plane
  std::uint64_t robots = 0;       ///< in contact with another robot
};

/// The result of an action.
struct ActionResult {
  bool is_done = false;
  std::string text;                        ///< a sentence: what was done, or why it cannot be done
  ActionFault fault = ActionFault::other;  ///< why it cannot be done
};

/// A program's reaction to an action of robots. `value`: the action's command in the last step, from 0 to 1,
/// dimensionless; above 0.5 the robot acts.
using ActionHandler = std::function<void(std::uint32_t robot, double value)>;

/// One world that advances tick by tick. Between calls it is at a boundary: the state of tick() is complete, and the
/// observations of the robots due at this tick are available. It uses no network and no wall clock. Every result is a
/// function of the experiment and of the commands, for any number of threads. For one calling thread.
class Simulation {
 public:
  /// Builds the world from a copy of the experiment, and senses tick 0. Throws std::invalid_argument for a world that
  /// cannot be simulated.
  Simulation(const description::Experiment& experiment, unsigned threads);
  /// Builds the same world with another seed, on one thread, with each object of the experiment at `X_WM[object]`. The
  /// result has the same bits as one of the experiment with that seed and those poses. It shares common data with
  /// `like`, so nothing can be added to either while both exist. Throws std::invalid_argument also if there is not one
  /// pose for each object, or if objects or models have been added to `like`.
  Simulation(const Simulation& like, std::uint64_t seed, std::span<const Pose> X_WM);
  ~Simulation();

  std::uint64_t tick() const { return tick_; }
  /// Returns the simulated time: tick() * step.
  std::chrono::nanoseconds time() const { return experiment_->world.step * static_cast<std::int64_t>(tick_); }

  std::uint32_t robot_count() const { return robots_.size(); }
  const std::string& robot_name(std::uint32_t robot) const { return robots_.name(robot); }
  std::span<const RobotKind> kinds() const { return robots_.kinds(); }
  std::uint32_t kind_of(std::uint32_t robot) const { return robots_.kind_of(robot); }
  const description::Policy& policy(std::uint32_t robot) const { return robots_.policy(robot); }
  /// Returns the robot's body in `world()`, which is its index in `objects()`.
  BodyId body_of(std::uint32_t robot) const { return robots_.body_of(robot); }
  /// Returns true if the robot is in the world: an event of the experiment may add or remove it.
  bool is_present(std::uint32_t robot) const { return robots_.is_present(robot); }
  /// Returns true if the robot receives a frame at this tick, provided that it is in the world then.
  bool is_due(std::uint32_t robot, std::uint64_t tick) const { return robots_.is_due(robot, tick); }

  /// Returns the observation of the last tick at which the robot was due.
  std::span<const double> observation(std::uint32_t robot) const { return robots_.observation(robot); }
  /// Returns the tick at which a value of the current observation of a robot that is due was measured; nothing before
  /// the first report of its sensor. `place`: the index of the value. The robot must be in the world since tick 0.
  std::optional<std::uint64_t> measurement_at(std::uint32_t robot, std::size_t place) const {
    return robots_.measurement_at(robot, place, tick());
  }

  /// Returns why `values` are not a valid command of `robot`; nothing if they are valid.
  std::optional<CommandFault> check_command(std::uint32_t robot, std::span<const double> values) const {
    return robots_.check_command(robot, values);
  }
  /// Registers a handler, for programs that embed a simulation. From now on `step` calls it on its own thread, at the
  /// boundary after the step and before the events. It is called for every robot in the world that has an action of
  /// this name (docs/reference, `cohort:action`), in an order that depends only on the state. Several handlers are
  /// called in the order of their registration. A handler may call `act` and add handlers. It must depend only on the
  /// simulation, or runs are not reproducible; its own data is not part of a snapshot. Its exceptions pass through
  /// `step`, and the simulation must not be used afterwards. Throws std::invalid_argument if no robot has such an
  /// action.
  void on_action(const std::string& name, ActionHandler handler);

  /// Sets the robot's command from this tick on, until the next call. `values` must have passed `check_command`. Until
  /// the first call every channel has its neutral value. Returns true if the bits of the command changed.
  bool set_command(std::uint32_t robot, std::span<const double> values) {
    return note_if(robots_.set_command(robot, values));
  }
  /// Sets every channel to its neutral value. Returns true if the bits of the command changed.
  bool set_neutral_command(std::uint32_t robot) { return note_if(robots_.set_neutral_command(robot)); }
  /// Returns the command that acts in the next step, unless the robot is disabled by then, for example by an empty
  /// battery.
  std::span<const double> command(std::uint32_t robot) const { return robots_.command(robot); }

  /// Actuates in the order of the robots, steps the world to the next boundary and senses there. A body whose state is
  /// no longer finite is quarantined; in a `strict` world std::runtime_error is thrown, which names it. The events of
  /// the new boundary happen before the robots sense. An event that cannot be carried out also throws
  /// std::runtime_error.
  void step();
  /// Returns a sentence for each event of this boundary: broken joints, then actions with a handler, then events.
  const std::vector<std::string>& happened() const { return happened_; }
  /// Returns a description of the first stop condition of the experiment that is met; nothing if none is.
  const std::optional<std::string>& stop_reason() const { return schedule_.stop_reason(); }

  /// Carries out an action from outside, between steps. The action follows the events and the check of the stop
  /// conditions of this boundary, and precedes all frames. The due robots sense once more, so that they observe the
  /// changed world at this tick; noise and the memory of sensors are as if they had sensed once. Returns a sentence for
  /// the log. Throws std::invalid_argument with the reason, without any change, if it cannot be done. The result is
  /// part of the state, and depends only on the state and the action.
  std::string act(const Action& action);
  /// Carries out actions in order, with one sensing after all of them.
  std::vector<ActionResult> act(std::span<const Action> actions);

  /// Returns the experiment with the added models, objects and robots. A simulation that was built like another returns
  /// the seed and the poses of the other.
  const description::Experiment& experiment() const { return *experiment_; }
  const description::World& description() const { return experiment_->world; }
  /// Returns all objects of the world by their scoped names; an object's index is that of its body in `world()`.
  const Objects& objects() const { return objects_; }
  /// Returns X_WL, the pose of the object's root link in the world.
  Pose object_pose(std::uint32_t object) const { return world_->link_pose(BodyId{object}, LinkId{0}); }
  /// Returns a sentence for each body that the last step quarantined, with its name.
  const std::vector<std::string>& quarantined() const { return quarantined_; }

  /// Returns all state that determines the rest of the run from this boundary on, for `restore` in any process. Bytes
  /// are little-endian; the format is that of this version of Cohort.
  std::vector<std::byte> save() const;
  /// Restores a simulation of the same experiment. Call it right after the construction. Models that were added as text
  /// are read first, with `Experiment::read_model`. Throws SnapshotError if the snapshot is of another experiment or
  /// version, or incomplete; this object must not be used afterwards.
  void restore(std::span<const std::byte> snapshot);

  /// Returns a hash of this boundary: all state that determines the rest of the run, and the observations. Costs
  /// nothing if nothing has changed since the last call.
  std::uint64_t state_hash() const;

  Pose robot_pose(std::uint32_t robot) const { return object_pose(body_of(robot).value); }
  const physics::World& world() const { return *world_; }
  const emission::Emitters& emitters() const { return emitters_; }
  const gripping::Grippers& grippers() const { return grippers_; }
  const BreakableJoints& breakable_joints() const { return breakable_joints_; }
  const TouchCounts& touches() const { return touches_; }
  const physics::Convergence& convergence() const { return world_->convergence(); }

 private:
  // `X_WM`: the poses for make_world.
  Simulation(SharedExperiment experiment, std::uint64_t seed, std::span<const Pose> X_WM, unsigned threads,
             const Simulation* like);
  const SharedExperiment& shared_with_one_at(std::span<const Pose> X_WM) const;
  // To be called before or right after each change of hashed state.
  void note_change() { state_hash_.reset(); }
  bool note_if(bool has_changed) {
    if (has_changed) note_change();
    return has_changed;
  }
  std::uint64_t computed_state_hash() const;
  std::string act_unsensed(const Action& action);
  std::string spawn_object(const SpawnObject& spawn);
  std::string spawn_by(const description::Spawner& spawner, const std::string& name);
  std::string add_new(const SpawnObject& spawn, std::size_t model);
  void add_object(const std::string& name, std::size_t model, const Pose& X_WM, std::size_t team);
  void sense();
  void count_touches();
  void name_quarantined();
  void handle_actions();
  void begin_tick();
  void note_bodies();
  void enrol(std::uint32_t object, std::size_t team);
  void release(std::uint32_t object);
  void save_added(SnapshotWriter& writer) const;
  void restore_added(SnapshotReader& reader);

  SharedExperiment experiment_;  // including additions
  std::uint64_t seed_;
  mutable WorkerPool workers_;
  std::unique_ptr<physics::World> world_;
  BreakableJoints breakable_joints_;
  emission::Emitters emitters_;
  gripping::Grippers grippers_;
  gripping::DetachableJoints detachable_joints_;
  actuation::UserActions actions_;
  Objects objects_;
  Robots robots_;
  Schedule schedule_;
  SpawnedModels spawned_models_;
  std::vector<char> is_ground_;  // by body
  std::uint64_t tick_ = 0;
  TouchCounts touches_;
  std::vector<std::string> quarantined_;
  std::vector<std::string> happened_;
  std::list<std::pair<std::string, ActionHandler>> handlers_;  // a list, as a handler may add one
  mutable std::vector<std::uint64_t> body_hashes_;
  mutable std::optional<std::uint64_t> state_hash_;
};

}  // namespace cohort
