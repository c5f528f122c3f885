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
#include "server/simulation/breakable_joints.hpp"
#include "server/simulation/objects.hpp"
#include "server/simulation/robots.hpp"
#include "server/simulation/schedule.hpp"
#include "server/simulation/shared_experiment.hpp"
#include "server/simulation/spawned_models.hpp"

namespace cohort {

/// Robot-ticks in which a robot touched something, since the run began.
struct TouchCounts {
  std::uint64_t robot_ticks = 0;  ///< robots times ticks
  std::uint64_t obstacles = 0;    ///< touched something that is neither a robot nor a plane
  std::uint64_t robots = 0;       ///< touched another robot
};

/// What became of an action.
struct ActionResult {
  bool is_done = false;
  std::string text;  ///< a sentence: what was done, or why it cannot be
};

/// What a program does when robots do something. `value`: of the action in the step that has just ended, from 0 to 1
/// and without a unit; above 0.5 the robot acts.
using ActionHandler = std::function<void(std::uint32_t robot, double value)>;

/// One world, advancing tick by tick. Between calls it stands at a boundary: the state of tick() is complete, and the
/// observations of the robots due at this tick are there. No network, no wall clock; every result is a function of the
/// experiment and of the commands, for any number of threads. One thread calls it.
class Simulation {
 public:
  /// Builds the world, of a copy of the experiment, and senses tick 0. Throws std::invalid_argument for a world that
  /// cannot be simulated.
  Simulation(const description::Experiment& experiment, unsigned threads);
  /// Builds the world again with another seed, on one thread, and each object of the experiment at `X_WM[object]`. Has
  /// the same bits as one of the same experiment with that seed and those poses, and shares with `like` what is the
  /// same in both: nothing can be added to either as long as both live. Throws std::invalid_argument also if there is
  /// not one pose for each object, or if objects or models have been added to `like`.
  Simulation(const Simulation& like, std::uint64_t seed, std::span<const Pose> X_WM);
  ~Simulation();

  std::uint64_t tick() const { return tick_; }
  /// Simulated time: tick() * step.
  std::chrono::nanoseconds time() const { return experiment_->world.step * static_cast<std::int64_t>(tick_); }

  std::uint32_t robot_count() const { return robots_.size(); }
  const std::string& robot_name(std::uint32_t robot) const { return robots_.name(robot); }
  std::span<const RobotKind> kinds() const { return robots_.kinds(); }
  std::uint32_t kind_of(std::uint32_t robot) const { return robots_.kind_of(robot); }
  const description::Policy& policy(std::uint32_t robot) const { return robots_.policy(robot); }
  /// Its body in `world()`, which is its index among `objects()`.
  BodyId body_of(std::uint32_t robot) const { return robots_.body_of(robot); }
  /// Whether the robot is in the world: an event of the experiment may bring it later, or take it out.
  bool is_present(std::uint32_t robot) const { return robots_.is_present(robot); }
  /// Whether the robot is asked at this tick, if it is in the world then.
  bool is_due(std::uint32_t robot, std::uint64_t tick) const { return robots_.is_due(robot, tick); }

  /// As of the last tick at which the robot was due.
  std::span<const double> observation(std::uint32_t robot) const { return robots_.observation(robot); }

  /// Nothing if `values` may act on `robot`.
  std::optional<CommandFault> check_command(std::uint32_t robot, std::span<const double> values) const {
    return robots_.check_command(robot, values);
  }
  /// For programs that embed a simulation: from now on `step` calls `handler`, on its own thread, at the boundary after
  /// the step and before the events. It does so for every robot in the world that has an action of this name
  /// (docs/devices.md, `cohort:action`), in the order of the robots; several handlers in the order of their coming. A
  /// handler may call `act` and add handlers. It must depend on nothing but the simulation, or runs are no longer the
  /// same; what it keeps itself is no part of a snapshot. What it throws comes out of `step`, and the simulation must
  /// not be used after that. Throws std::invalid_argument if no robot has such an action.
  void on_action(const std::string& name, ActionHandler handler);

  /// From this tick on the robot does this, until told otherwise. `values` must have passed `check_command`. Until the
  /// first call every channel has its neutral value. Whether its bits are others than those that stood before.
  bool set_command(std::uint32_t robot, std::span<const double> values) {
    return note_if(robots_.set_command(robot, values));
  }
  /// The same with every channel's neutral value.
  bool set_neutral_command(std::uint32_t robot) { return note_if(robots_.set_neutral_command(robot)); }
  /// That acts in the next step, unless the robot is disabled by then, as by an empty battery.
  std::span<const double> command(std::uint32_t robot) const { return robots_.command(robot); }

  /// Actuates in the order of the robots, steps the world to the next boundary and senses there. A body whose state
  /// breaks is quarantined; in a `strict` world std::runtime_error is thrown, which names it. The events of the new
  /// boundary happen before the robots sense; one that cannot be done throws std::runtime_error too.
  void step();
  /// What happened at this boundary, a sentence for each: what broke, then actions that have a handler, then events.
  const std::vector<std::string>& happened() const { return happened_; }
  /// Says which stop condition of the experiment holds, as soon as one does.
  const std::optional<std::string>& stop_reason() const { return schedule_.stop_reason(); }

  /// Does what a person or a program asks for, now: after the events of this boundary and what stops a run was looked
  /// at, and before any robot is asked. The robots that are due sense once more, so that what they observe at this tick
  /// is the world as it is then; noise, and what sensors remember, is as if they had sensed once. Between steps.
  /// Returns a sentence for the log. Throws std::invalid_argument, with a sentence that says why, if it cannot be done;
  /// nothing is changed then. What is done is part of the state, and depends on nothing but the state and the action.
  std::string act(const Action& action);
  /// One after the other, with one sensing after all of them.
  std::vector<ActionResult> act(std::span<const Action> actions);

  /// Returns the experiment with the models, objects and robots that have come since. A simulation that was built like
  /// another returns the seed and the poses of that one.
  const description::Experiment& experiment() const { return *experiment_; }
  const description::World& description() const { return experiment_->world; }
  /// Everything in the world by its scoped name; an object's index is that of its body in `world()`.
  const Objects& objects() const { return objects_; }
  /// Returns the pose of its root link, X_WL.
  Pose object_pose(std::uint32_t object) const { return world_->link_pose(BodyId{object}, LinkId{0}); }
  /// What the last step took out of the world: a sentence for each body, with its name.
  const std::vector<std::string>& quarantined() const { return quarantined_; }

  /// Everything that decides how the run goes on from this boundary, for `restore` in this process or another. Bytes
  /// are little-endian; the format is that of this version of Cohort.
  std::vector<std::byte> save() const;
  /// Of a simulation of the same experiment, right after the construction of this one. Models that came to it as text
  /// are read first, by `Experiment::read_model`. Throws SnapshotError if the
  /// snapshot is of something else, cut short, or of another version; this is then not to be used.
  void restore(std::span<const std::byte> snapshot);

  /// Of this boundary: everything that decides how the run goes on, and the observations. Costs nothing if nothing has
  /// changed since it was asked for last.
  std::uint64_t state_hash() const;

  Pose robot_pose(std::uint32_t robot) const { return object_pose(body_of(robot).value); }  ///< of its root link, X_WL
  const physics::World& world() const { return *world_; }
  const emission::Emitters& emitters() const { return emitters_; }
  const gripping::Grippers& grippers() const { return grippers_; }
  const BreakableJoints& breakable_joints() const { return breakable_joints_; }
  const TouchCounts& touches() const { return touches_; }

 private:
  // `X_WM`: as make_world has them.
  Simulation(SharedExperiment experiment, std::uint64_t seed, std::span<const Pose> X_WM, unsigned threads,
             const Simulation* like);
  const SharedExperiment& shared_with_one_at(std::span<const Pose> X_WM) const;
  // Whatever is part of the state hash is about to change, or has just done so.
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
  void save_added(SnapshotWriter& writer) const;
  void restore_added(SnapshotReader& reader);

  SharedExperiment experiment_;  // with what has come since
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
  std::uint32_t solids_noted_ = 0;
  std::uint64_t tick_ = 0;
  TouchCounts touches_;
  std::vector<std::string> quarantined_;
  std::vector<std::string> happened_;
  std::list<std::pair<std::string, ActionHandler>> handlers_;  // a handler may add one
  mutable std::vector<std::uint64_t> body_hashes_;
  mutable std::optional<std::uint64_t> state_hash_;
};

}  // namespace cohort
