// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/schedule.hpp"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "server/core/overloaded.hpp"

namespace cohort {
Schedule::Schedule(const description::Experiment& experiment, physics::World& world, Objects& objects,
                   emission::Emitters& emitters, const actuation::UserActions& actions, Spawn spawn)
    : experiment_(experiment),
      world_(world),
      objects_(objects),
      emitters_(emitters),
      actions_(actions),
      spawn_(std::move(spawn)),
      boundaries_held_(experiment.stops.size(), 0),
      spawned_(experiment.spawners.size(), 0) {
  for (const description::Event& event : experiment.events) {
    event_ticks_.push_back(event.time.count() == 0 ? 0 : ticks_of(event.time, experiment.world.step));
    // At 0 s it could not be restored: a snapshot is restored into a simulation that has only the objects of the
    // description.
    if (event_ticks_.back() == 0 && std::holds_alternative<description::SpawnNew>(event.effect))
      throw std::invalid_argument("an event cannot spawn at 0 s: expected a later time");
  }
  for (const description::Instance& instance : experiment.world.instances)
    stages_.push_back(instance.is_present ? Stage::came : Stage::to_come);
  for (const description::Reaction& reaction : experiment.reactions)
    force_ends_.resize(force_ends_.size() + reaction.events.size(), 0);
}

std::vector<std::string> Schedule::begin_tick(std::uint64_t tick) {
  std::erase_if(pushes_, [&](const Push& push) { return push.end <= tick; });
  std::vector<std::string> happened;
  for (; next_event_ < event_ticks_.size() && event_ticks_[next_event_] <= tick; ++next_event_)
    happened.push_back(act(experiment_.events[next_event_]));
  react(tick, happened);
  return happened;
}

void Schedule::react(std::uint64_t tick, std::vector<std::string>& happened) {
  std::size_t first_event = 0;
  for (const description::Reaction& reaction : experiment_.reactions) {
    if (const std::string actors = who_begins(reaction); !actors.empty()) {
      for (std::size_t i = 0; i < reaction.events.size(); ++i) {
        const description::Event& event = reaction.events[i];
        happened.push_back(reaction.action + " of " + actors + ": " + act(event));
        if (const auto* const force = std::get_if<description::ApplyForce>(&event.effect))
          force_ends_[first_event + i] = tick + ticks_of(force->duration, experiment_.world.step);
      }
    }
    first_event += reaction.events.size();
  }
}

// Returns the first robot that begins the action, and the number of others; empty if there is none.
std::string Schedule::who_begins(const description::Reaction& reaction) const {
  std::string text;
  std::size_t others = 0;
  for (const actuation::ActionOfRobot& action : actions_.all()) {
    if (!action.begins || action.name != reaction.action ||
        !std::binary_search(reaction.robots.begin(), reaction.robots.end(), action.robot.value))
      continue;
    if (text.empty())
      text = "'" + objects_.name(action.body.value) + "'";
    else
      ++others;
  }
  return others == 0 ? text : text + " and " + std::to_string(others) + " more";
}

// Events on an object that is added or removed later or earlier have no effect.
std::optional<std::string> Schedule::why_not(const description::Event& event) const {
  const auto* const presence = std::get_if<description::SetPresence>(&event.effect);
  const bool comes_first = presence != nullptr && presence->once && presence->present;
  if (std::find(removed_.begin(), removed_.end(), event.object) != removed_.end()) return "it has been removed";
  switch (stages_[event.object]) {
    case Stage::to_come: return comes_first ? std::nullopt : std::optional("it has not been added");
    case Stage::came: return comes_first ? std::optional("it has already been added") : std::nullopt;
    case Stage::gone: return "it has been removed";
  }
  return std::nullopt;
}

// Numbers increase, and skip names that were ever used.
std::string Schedule::spawn_new(const description::SpawnNew& spawn) {
  const description::Spawner& spawner = experiment_.spawners.at(spawn.spawner);
  std::uint64_t& spawned = spawned_[spawn.spawner];
  if (spawned >= spawner.most)
    return "spawn '" + spawner.name + "' does nothing: it has already spawned " + std::to_string(spawned) +
           " objects, which is its limit";
  std::string name;
  std::uint64_t number = spawned;
  do {
    name = spawner.name + "_" + std::to_string(++number);
  } while (objects_.find(name));
  try {
    std::string text = spawn_(spawner, name);
    ++spawned;
    return text;
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error("spawn '" + name + "': " + error.what());
  }
}

std::string Schedule::act(const description::Event& event) {
  if (const auto* const spawn = std::get_if<description::SpawnNew>(&event.effect)) return spawn_new(*spawn);
  const auto object = static_cast<std::uint32_t>(event.object);
  std::string text = event.kind + " '" + objects_.name(object) + "'";
  if (const std::optional<std::string> reason = why_not(event)) return text + " does nothing: " + *reason;
  try {
    apply(event);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(text + ": " + error.what());
  }
  const auto* const presence = std::get_if<description::SetPresence>(&event.effect);
  if (presence != nullptr && presence->once) stages_[object] = presence->present ? Stage::came : Stage::gone;
  return text;
}

std::string Schedule::act_from_outside(const description::Event& event, std::uint64_t tick) {
  apply(event);
  const auto object = static_cast<std::uint32_t>(event.object);
  if (std::holds_alternative<description::SetPresence>(event.effect) && object < stages_.size())
    removed_.push_back(object);
  if (const auto* const force = std::get_if<description::ApplyForce>(&event.effect))
    pushes_.push_back({object, *force, tick + ticks_of(force->duration, experiment_.world.step)});
  return event.kind + " '" + objects_.name(object) + "'";
}

void Schedule::apply(const description::Event& event) {
  const auto object = static_cast<std::uint32_t>(event.object);
  std::visit(Overloaded{
                 [&](const description::SetPresence& presence) { objects_.set_present(object, presence.present); },
                 [&](const description::PlaceAt& place) { world_.place_body(BodyId{object}, place.X_WM); },
                 [&](const description::SetVelocity& velocity) {
                   if (world_.is_active(BodyId{object}))
                     world_.set_root_twist(BodyId{object}, {velocity.angular_W, velocity.linear_W});
                 },
                 [](const description::ApplyForce&) {},  // acts in the following steps
                 [&](const description::SetEmitters& set) {
                   for (const std::size_t emitter : set.emitters) emitters_.change(BodyId{object}, emitter, set.change);
                 },
                 [](const description::SpawnNew&) {
                   throw std::logic_error("a new object is not an event of an existing one");
                 },
             },
             event.effect);
}

void Schedule::push(std::uint64_t tick) {
  const auto push_for = [&](const description::Event& event, auto&& end) {
    const auto* const force = std::get_if<description::ApplyForce>(&event.effect);
    const auto object = static_cast<std::uint32_t>(event.object);
    if (force != nullptr && world_.is_active(BodyId{object}) && tick < end(*force))
      world_.push_body(BodyId{object}, LinkId{force->link}, {force->force_W, force->torque_W});
  };
  for (std::size_t i = 0; i < next_event_; ++i)
    push_for(experiment_.events[i], [&](const description::ApplyForce& force) {
      return event_ticks_[i] + ticks_of(force.duration, experiment_.world.step);
    });
  for (const Push& push : pushes_)
    if (world_.is_active(BodyId{push.object}))
      world_.push_body(BodyId{push.object}, LinkId{push.force.link}, {push.force.force_W, push.force.torque_W});
  std::size_t i = 0;
  for (const description::Reaction& reaction : experiment_.reactions)
    for (const description::Event& event : reaction.events) {
      push_for(event, [&](const description::ApplyForce&) { return force_ends_[i]; });
      ++i;
    }
}

void Schedule::check_stops() {
  for (std::size_t i = 0; i < boundaries_held_.size() && !stop_reason_; ++i) {
    const description::StopCondition& condition = experiment_.stops[i];
    const std::optional<std::string> reason = why_it_holds(condition);
    boundaries_held_[i] = reason ? boundaries_held_[i] + 1 : 0;
    const std::uint64_t needed =
        condition.holds_for.count() == 0 ? 0 : ticks_of(condition.holds_for, experiment_.world.step);
    if (boundaries_held_[i] > needed) stop_reason_ = condition.name + ": " + *reason;
  }
}

std::optional<std::string> Schedule::why_it_holds(const description::StopCondition& condition) const {
  std::vector<std::uint32_t> present;
  for (const std::size_t object : condition.objects)
    if (objects_.is_present(static_cast<std::uint32_t>(object))) present.push_back(static_cast<std::uint32_t>(object));
  const auto first = [&](const auto& holds) -> std::optional<std::string> {
    const auto found = std::find_if(present.begin(), present.end(), holds);
    if (found == present.end()) return std::nullopt;
    return "'" + objects_.name(*found) + "'";
  };
  const auto all = [&](const auto& holds) -> std::optional<std::string> {
    if (present.empty() || !std::all_of(present.begin(), present.end(), holds)) return std::nullopt;
    return std::to_string(present.size()) + (present.size() == 1 ? " object" : " objects");
  };
  const auto place = [&](std::uint32_t object) -> Eigen::Vector2d {
    return world_.link_pose(BodyId{object}, LinkId{0}).position.head<2>();
  };
  return std::visit(
      Overloaded{
          [&](const description::AllInside& inside) {
            return all([&](std::uint32_t object) {
              const Eigen::Vector2d point = place(object);
              return (point.array() >= inside.lower.array()).all() && (point.array() <= inside.upper.array()).all();
            });
          },
          [&](const description::OneBeyond& line) {
            return first([&](std::uint32_t object) { return line.direction.dot(place(object) - line.point) > 0.0; });
          },
          [&](const description::AllAtRest& rest) {
            return all([&](std::uint32_t object) {
              const physics::Twist twist = world_.link_twist(BodyId{object}, LinkId{0});
              return twist.linear_W.norm() < rest.speed && twist.angular_W.norm() < rest.turn_rate;
            });
          },
          [&](const description::OneQuarantined&) {
            return first([&](std::uint32_t object) { return objects_.is_quarantined(object); });
          },
      },
      condition.what);
}

template <class Self, class Visit>
void Schedule::visit_outside(Self& self, Visit&& visit) {
  for (auto& push : self.pushes_) {
    visit(push.object);
    visit(push.force.link);
    for (int i = 0; i < 3; ++i) visit(push.force.force_W[i]);
    for (int i = 0; i < 3; ++i) visit(push.force.torque_W[i]);
    visit(push.end);
  }
  for (auto& object : self.removed_) visit(object);
}

void Schedule::hash(StateHash& hash) const {
  visit_outside(*this, [&]<class Number>(Number number) {
    if constexpr (std::is_same_v<Number, double>)
      hash.add(number);
    else
      hash.add(static_cast<std::uint64_t>(number));
  });
  for (const std::uint64_t held : boundaries_held_) hash.add(held);
  for (const std::uint64_t spawned : spawned_) hash.add(spawned);
  if (experiment_.reactions.empty()) return;  // everything else follows from the tick
  for (const Stage stage : stages_) hash.add(static_cast<std::uint64_t>(stage));
  for (const std::uint64_t end : force_ends_) hash.add(end);
}

void Schedule::save(SnapshotWriter& writer) const {
  writer.add_count(boundaries_held_.size());
  writer.add_all(boundaries_held_.data(), boundaries_held_.size());
  const std::string reason = stop_reason_.value_or("");
  writer.add_count(reason.size());
  writer.add_all(reason.data(), reason.size());
  writer.add_count(stages_.size());
  writer.add_all(stages_.data(), stages_.size());
  writer.add_count(force_ends_.size());
  writer.add_all(force_ends_.data(), force_ends_.size());
  writer.add_count(pushes_.size());
  writer.add_count(removed_.size());
  visit_outside(*this, [&](const auto& number) { writer.add(number); });
  if (spawned_.empty()) return;  // as in snapshots of builds without spawners
  writer.add_count(spawned_.size());
  writer.add_all(spawned_.data(), spawned_.size());
}

void Schedule::restore(SnapshotReader& reader, std::uint64_t tick) {
  reader.expect_count(boundaries_held_.size(), "stop conditions");
  reader.read_all(boundaries_held_.data(), boundaries_held_.size());
  std::string reason(reader.read_count(1), ' ');
  reader.read_all(reason.data(), reason.size());
  stop_reason_.reset();
  if (!reason.empty()) stop_reason_ = std::move(reason);
  reader.expect_count(stages_.size(), "objects in the world");
  reader.read_all(stages_.data(), stages_.size());
  reader.expect_count(force_ends_.size(), "events of actions");
  reader.read_all(force_ends_.data(), force_ends_.size());
  pushes_.assign(reader.read_count(sizeof(std::uint64_t)), {});
  removed_.assign(reader.read_count(sizeof(std::uint32_t)), 0);
  visit_outside(*this, [&](auto& number) { reader.read(number); });
  if (!spawned_.empty()) {
    reader.expect_count(spawned_.size(), "spawners");
    reader.read_all(spawned_.data(), spawned_.size());
  }
  for (std::size_t spawner = 0; spawner < spawned_.size(); ++spawner)
    if (spawned_[spawner] > experiment_.spawners[spawner].most)
      throw SnapshotError("snapshot: an event has spawned more objects than its limit");
  for (const Stage stage : stages_)
    if (stage > Stage::gone) throw SnapshotError("snapshot: invalid object state");
  for (const std::uint32_t object : removed_)
    if (object >= objects_.size()) throw SnapshotError("snapshot: unknown removed object");
  for (const Push& push : pushes_) {
    if (!push.force.force_W.allFinite() || !push.force.torque_W.allFinite())
      throw SnapshotError("snapshot: a force or torque is not finite");
    if (push.object >= objects_.size()) throw SnapshotError("snapshot: a force on an unknown object");
    const description::Model& model = experiment_.world.models[world_.model_of(BodyId{push.object})];
    if (model.is_static || push.force.link >= model.links.size())
      throw SnapshotError("snapshot: a force on a static body");
  }
  next_event_ =
      static_cast<std::size_t>(std::upper_bound(event_ticks_.begin(), event_ticks_.end(), tick) - event_ticks_.begin());
}

}  // namespace cohort
