// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/simulation.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "idl/include/cohort/version.h"
#include "server/core/hash.hpp"
#include "server/core/random.hpp"
#include "server/core/snapshot.hpp"
#include "server/core/tick_stage.hpp"
#include "server/physics/make_world.hpp"
#include "server/simulation/action_events.hpp"
#include "server/simulation/build_identity.hpp"

namespace cohort {
namespace {

constexpr std::size_t bodies_a_chunk = 64;
// The first bytes of a snapshot, by layout.
constexpr std::uint64_t snapshot_marks[] = {0x746f6873'74726f68u, 0x32746f68'74726f68u, 0x33746f68'74726f68u};

}  // namespace

Simulation::Simulation(const description::Experiment& experiment, unsigned threads)
    : Simulation(SharedExperiment(experiment), experiment.seed, {}, threads, nullptr) {}

Simulation::Simulation(const Simulation& like, std::uint64_t seed, std::span<const Pose> X_WM)
    : Simulation(like.shared_with_one_at(X_WM), seed, X_WM, 1, &like) {}

Simulation::Simulation(SharedExperiment experiment, std::uint64_t seed, std::span<const Pose> X_WM, unsigned threads,
                       const Simulation* like)
    : experiment_(std::move(experiment)),
      seed_(seed),
      workers_(threads),
      world_(physics::make_world(experiment_->world, workers_, like != nullptr ? like->world_.get() : nullptr, X_WM)),
      breakable_joints_(experiment_->world, *world_),
      emitters_(experiment_->world, *world_),
      grippers_(experiment_->world, *world_),
      detachable_joints_(experiment_->world, *world_),
      actions_(experiment_->world, *world_),
      objects_(experiment_, *world_, like != nullptr ? &like->objects_ : nullptr),
      robots_({*experiment_, seed_, *world_, emitters_, grippers_, detachable_joints_, actions_, objects_, workers_},
              like != nullptr ? &like->robots_ : nullptr),
      schedule_(*experiment_, *world_, objects_, emitters_, actions_,
                [this](const auto& spawner, const std::string& name) { return spawn_by(spawner, name); }),
      spawned_models_(experiment_) {
  note_bodies();
  begin_tick();
  sense();
}

Simulation::~Simulation() = default;

const SharedExperiment& Simulation::shared_with_one_at(std::span<const Pose> X_WM) const {
  if (objects_.size() != objects_.described() || spawned_models_.size() > 0)
    throw std::invalid_argument("this world cannot be rebuilt, as objects have been added to it");
  if (X_WM.size() != objects_.size())
    throw std::invalid_argument("got " + std::to_string(X_WM.size()) + " poses, expected one for each of the " +
                                std::to_string(objects_.size()) + " objects of the experiment");
  return experiment_;
}

void Simulation::step() {
  note_change();
  StageMarks stages;
  stages.enter("actuators");
  robots_.actuate();
  schedule_.push(tick_);
  stages.enter("physics");
  world_->step();
  ++tick_;
  stages.enter("events");
  name_quarantined();
  count_touches();
  happened_ = breakable_joints_.broken();
  actions_.finish_step();
  handle_actions();
  begin_tick();
  stages.enter("sensors");
  sense();
}

void Simulation::on_action(const std::string& name, ActionHandler handler) {
  const auto all = actions_.all();
  if (std::none_of(all.begin(), all.end(), [&](const auto& action) { return action.name == name; }))
    throw std::invalid_argument("no robot has an action '" + name + "'");
  handlers_.emplace_back(name, std::move(handler));
}

void Simulation::handle_actions() {
  if (handlers_.empty()) return;
  const auto all = actions_.all();
  // A copy, as a handler may spawn and remove robots.
  for (const actuation::ActionOfRobot& action : std::vector(all.begin(), all.end())) {
    bool is_handled = false;
    for (const auto& [name, handler] : handlers_) {  // a handler may add one
      if (name != action.name || !world_->is_active(action.body)) continue;
      handler(action.robot.value, action.value);
      is_handled = true;
    }
    if (is_handled && action.begins) happened_.push_back(action.name + " of '" + robot_name(action.robot.value) + "'");
  }
}

void Simulation::begin_tick() {
  const std::vector<std::string> events = schedule_.begin_tick(tick_);
  happened_.insert(happened_.end(), events.begin(), events.end());
  objects_.record(tick_);
  schedule_.check_stops();
}

void Simulation::add_object(const std::string& name, std::size_t model, const Pose& X_WM, std::size_t team) {
  enrol(objects_.add(name, model, X_WM), team);
  note_bodies();
}

// Registers a new object with everything that knows bodies and robots.
void Simulation::enrol(std::uint32_t object, std::size_t team) {
  description::World& world = experiment_.edit().world;
  const description::Model& model = world.models[world.instances[object].model];
  const BodyId body{object};
  emitters_.add_body(body, model);
  grippers_.add_body(body, model);
  detachable_joints_.add_body(body, model);
  if (!model.is_robot()) return;
  const auto robot = static_cast<std::uint32_t>(world.robots.size());
  world.robots.push_back(object);
  experiment_.edit().teams[team].robots.push_back(robot);
  actions_.add_robot(RobotId{robot}, body, model);
  robots_.add();
}

// Updates everything that depends on the number of bodies.
void Simulation::note_bodies() {
  body_hashes_.resize(world_->body_count());
  const geometry::Scene& scene = world_->scene();
  is_ground_.resize(world_->body_count(), 0);
  for (std::uint32_t solid = 0; solid < scene.size(); ++solid)
    if (geometry::is_ground(scene.solid(solid).shape())) is_ground_[scene.solid(solid).body.value] = 1;
}

void Simulation::name_quarantined() {
  quarantined_.clear();
  for (const physics::Quarantine& event : world_->quarantined()) {
    const bool broke = event.reason == physics::Quarantine::Reason::not_finite;
    quarantined_.push_back("'" + objects_.name(event.body.value) +
                           (broke ? "': its state is no longer finite" : "' has left the world"));
  }
  if (experiment_->world.physics.strict && !quarantined_.empty()) throw std::runtime_error(quarantined_[0]);
}

void Simulation::sense() {
  note_change();
  emitters_.update(workers_);
  robots_.sense(tick_);
}

void Simulation::count_touches() {
  std::vector<char> touches_obstacle(robots_.size(), 0);
  std::vector<char> touches_robot(robots_.size(), 0);
  const auto note = [&](BodyId body, BodyId other) {
    const std::uint32_t robot = robots_.of_body(body);
    if (robot == Robots::none || is_ground_[other.value]) return;
    (robots_.of_body(other) == Robots::none ? touches_obstacle : touches_robot)[robot] = 1;
  };
  for (const physics::Contact& contact : world_->contacts()) {
    note(contact.body_a, contact.body_b);
    note(contact.body_b, contact.body_a);
  }
  for (const std::uint32_t robot : robots_.kept()) {
    if (is_present(robot)) ++touches_.robot_ticks;
    touches_.obstacles += static_cast<std::uint64_t>(touches_obstacle[robot]);
    touches_.robots += static_cast<std::uint64_t>(touches_robot[robot]);
  }
}

std::string Simulation::act(const Action& action) {
  StageMarks stages;
  stages.enter("requests of clients");
  std::string done = act_unsensed(action);
  sense();
  return done;
}

std::vector<ActionResult> Simulation::act(std::span<const Action> actions) {
  StageMarks stages;
  stages.enter("requests of clients");
  std::vector<ActionResult> results;
  results.reserve(actions.size());
  bool is_changed = false;
  for (const Action& action : actions) {
    try {
      results.push_back({true, act_unsensed(action)});
      is_changed = true;
    } catch (const ActionError& error) {
      results.push_back({false, error.what(), error.fault});
    } catch (const std::invalid_argument& error) {
      results.push_back({false, error.what()});
    }
  }
  if (is_changed) sense();
  return results;
}

std::string Simulation::act_unsensed(const Action& action) {
  note_change();
  if (const auto* const spawn = std::get_if<SpawnObject>(&action)) return spawn_object(*spawn);
  const description::Event event = event_of(action, {experiment_->world, *world_, objects_});
  std::string done = schedule_.act_from_outside(event, tick_);
  const auto object = static_cast<std::uint32_t>(event.object);
  if (objects_.is_gone(object)) release(object);
  return done;
}

// Frees what an object needed that never comes back.
void Simulation::release(std::uint32_t object) {
  const BodyId body{object};
  world_->release_body(body);
  if (const std::uint32_t robot = robots_.of_body(body); robot != Robots::none) robots_.release(robot);
}

std::string Simulation::spawn_object(const SpawnObject& spawn) {
  const std::size_t models_before = spawned_models_.size();
  try {
    return add_new(spawn, spawned_models_.find_or_add(spawn.model));
  } catch (const ActionError&) {
    spawned_models_.shrink(models_before);
    throw;
  } catch (const std::invalid_argument& error) {
    spawned_models_.shrink(models_before);
    throw ActionError(ActionFault::unsupported_model, error.what());
  }
}

// The position depends only on the seed and the name.
std::string Simulation::spawn_by(const description::Spawner& spawner, const std::string& name) {
  const RandomStream random(seed_, name, "spawn");
  Pose X_WM = spawner.X_WM;
  X_WM.position.x() += spawner.area.x() * (random.uniform(0, 0) - 0.5);
  X_WM.position.y() += spawner.area.y() * (random.uniform(0, 1) - 0.5);
  return add_new({.name = name, .model = {}, .X_WM = X_WM, .team = spawner.team}, spawner.model);
}

std::string Simulation::add_new(const SpawnObject& spawn, std::size_t model) {
  const Pose X_WM = checked_pose(spawn.X_WM);
  const description::Model& described = experiment_->world.models.at(model);
  const std::optional<std::size_t> team = team_of_new(spawn, model, *experiment_);
  const std::string name = name_of_new(spawn, described.name, objects_);
  add_object(name, model, X_WM, team.value_or(0));
  return "spawn '" + name + "' of model '" + described.name + "'" +
         (team ? " in team '" + experiment_->teams[*team].name + "'" : "");
}

std::vector<std::byte> Simulation::save() const {
  SnapshotWriter writer;
  writer.add(std::end(snapshot_marks)[-1]);
  writer.add(hash_name(COHORT_VERSION));
  writer.add(seed_);
  writer.add(static_cast<std::uint64_t>(experiment_->world.step.count()));
  writer.add(tick_);
  spawned_models_.save(writer);
  save_added(writer);
  world_->save(writer);
  objects_.save(writer);
  schedule_.save(writer);
  emitters_.save(writer);
  grippers_.save(writer);
  detachable_joints_.save(writer);
  actions_.save(writer);
  robots_.save(writer);
  writer.add(touches_.robot_ticks);
  writer.add(touches_.obstacles);
  writer.add(touches_.robots);
  return writer.bytes();
}

void Simulation::restore(std::span<const std::byte> snapshot) {
  note_change();
  SnapshotReader reader(snapshot);
  std::uint64_t mark = 0;
  reader.read(mark);
  const auto layout = std::ranges::find(snapshot_marks, mark);
  if (layout == std::end(snapshot_marks)) throw SnapshotError("this is not a snapshot");
  reader.set_layout(static_cast<SnapshotLayout>(layout - std::begin(snapshot_marks)));
  std::uint64_t version = 0;
  reader.read(version);
  if (std::ranges::find(versions_of_snapshots(), version, hash_name) == versions_of_snapshots().end())
    throw SnapshotError("the snapshot was saved by a version of Cohort whose snapshots version " COHORT_VERSION
                        " cannot read");
  reader.expect_count(seed_, "as its seed");
  reader.expect_count(static_cast<std::size_t>(experiment_->world.step.count()), "ns as its time step");
  reader.read(tick_);
  if (tick_ > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / experiment_->world.step.count()))
    throw SnapshotError("snapshot: the tick is out of range");
  spawned_models_.restore(reader);
  restore_added(reader);
  world_->restore(reader);
  objects_.restore(reader);
  schedule_.restore(reader, tick_);
  emitters_.restore(reader);
  emitters_.update(workers_);
  grippers_.restore(reader);
  detachable_joints_.restore(reader);
  actions_.restore(reader);
  robots_.restore(reader);
  reader.read(touches_.robot_ticks);
  reader.read(touches_.obstacles);
  reader.read(touches_.robots);
  if (!reader.is_at_end()) throw SnapshotError("the snapshot has extra bytes at its end");
}

void Simulation::save_added(SnapshotWriter& writer) const {
  objects_.save_added(writer);
  for (std::uint32_t object = objects_.described(); object < objects_.size(); ++object)
    if (const std::uint32_t robot = robots_.of_body(BodyId{object}); robot != Robots::none)
      writer.add(robots_.team_of(robot));
}

void Simulation::restore_added(SnapshotReader& reader) {
  const std::vector<Objects::Added> all = objects_.read_added(reader);
  for (const Objects::Added& added : all) {
    std::uint32_t team = 0;
    if (experiment_->world.models[added.instance.model].is_robot()) {
      reader.read(team);
      if (team >= experiment_->teams.size()) throw SnapshotError("snapshot: unknown team of a robot");
    }
    const std::uint32_t object = objects_.size();
    objects_.restore_added(added);
    enrol(object, team);
    if (!added.is_gone) continue;
    objects_.set_present(object, false);
    release(object);
  }
  note_bodies();
}

std::uint64_t Simulation::state_hash() const {
  if (!state_hash_) state_hash_ = computed_state_hash();
  return *state_hash_;
}

std::uint64_t Simulation::computed_state_hash() const {
  workers_.for_each_chunk(body_hashes_.size(), bodies_a_chunk, [&](std::size_t begin, std::size_t end, unsigned) {
    for (std::size_t body = begin; body < end; ++body) {
      body_hashes_[body] = 0;
      if (world_->slot_of(BodyId{body}) == physics::World::released) continue;
      StateHash hash;
      world_->hash_body(BodyId{body}, hash);
      if (const std::uint32_t robot = robots_.of_body(BodyId{body}); robot != Robots::none) robots_.hash(robot, hash);
      body_hashes_[body] = hash.value();
    }
  });
  StateHash hash;
  hash.add(tick_);
  for (const std::uint64_t body_hash : body_hashes_) hash.add(body_hash);
  world_->hash_contacts(hash);
  objects_.hash(hash);
  schedule_.hash(hash);
  emitters_.hash(hash);
  grippers_.hash(hash);
  detachable_joints_.hash(hash);
  actions_.hash(hash);
  spawned_models_.hash(hash);
  return hash.value();
}

}  // namespace cohort
