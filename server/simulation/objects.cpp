#include "server/simulation/objects.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/core/random.hpp"
#include "server/core/state_visitors.hpp"

namespace cohort {

std::uint64_t ticks_of(std::chrono::nanoseconds time, std::chrono::nanoseconds step) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(1, (time + step - std::chrono::nanoseconds(1)) / step));
}

Objects::Objects(const description::Experiment& experiment, physics::World& world)
    : experiment_(experiment),
      world_(world),
      history_ticks_(ticks_of(experiment.history.every, experiment.world.step)),
      histories_(experiment.history.objects.size()) {
  for (const description::Instance& instance : experiment.world.instances) {
    names_.push_back(instance.name);
    present_.push_back(instance.is_present ? 1 : 0);
  }
}

std::optional<std::uint32_t> Objects::find(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - names_.begin());
}

std::vector<std::uint32_t> Objects::in_scope(const std::string& scope) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t object = 0; object < size(); ++object)
    if (scope.empty() || names_[object].starts_with(scope + "/")) found.push_back(object);
  return found;
}

void Objects::set_present(std::uint32_t object, bool present) {
  if (is_present(object) == present) return;
  present_[object] = present ? 1 : 0;
  if (present)
    world_.put_back_body(object);
  else
    world_.remove_body(object);
}

std::uint32_t Objects::add(const std::string& name, std::size_t model, const Pose& X_WM) {
  if (find(name)) throw std::invalid_argument("another object has the name '" + name + "'");
  if (experiment_.world.models[model].is_robot())
    throw std::invalid_argument(
        "a robot comes into the world by an event of the experiment, which says who controls it");
  const std::uint32_t body = world_.add_body(model, X_WM);
  names_.push_back(name);
  present_.push_back(1);
  return body;
}

void Objects::record(std::uint64_t tick) {
  if (tick % history_ticks_ != 0) return;
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    const auto object = static_cast<std::uint32_t>(experiment_.history.objects[i]);
    if (!is_present(object)) continue;
    if (histories_[i].size() == experiment_.history.length) histories_[i].pop_front();
    histories_[i].push_back({tick, world_.link_pose(object, 0)});
  }
}

const std::deque<PastPose>& Objects::history(std::uint32_t object) const {
  static const std::deque<PastPose> nothing;
  const std::vector<std::size_t>& asked_for = experiment_.history.objects;
  const auto place = std::lower_bound(asked_for.begin(), asked_for.end(), object);
  if (place == asked_for.end() || *place != object) return nothing;
  return histories_[static_cast<std::size_t>(place - asked_for.begin())];
}

// What is as the description says adds nothing.
void Objects::hash(StateHash& hash) const {
  const std::vector<description::Instance>& instances = experiment_.world.instances;
  for (std::uint32_t object = 0; object < size(); ++object) {
    const bool is_known = object < instances.size();
    if (!is_known) {
      hash.add(hash_name(names_[object]));
      hash.add(static_cast<std::uint64_t>(world_.model_of(object)));
    }
    if (is_present(object) != (!is_known || instances[object].is_present))
      hash.add(static_cast<std::uint64_t>(object) << 1 | static_cast<std::uint64_t>(is_present(object)));
  }
  for (const std::deque<PastPose>& history : histories_)
    for (const PastPose& past : history) {
      hash.add(past.tick);
      visit_pose(past.X_WL, [&](const double& number) { hash.add(number); });
    }
}

void Objects::save(SnapshotWriter& writer) const {
  writer.add_count(names_.size());
  for (std::size_t object = experiment_.world.instances.size(); object < names_.size(); ++object) {
    writer.add_count(names_[object].size());
    writer.add_all(names_[object].data(), names_[object].size());
  }
  writer.add_all(present_.data(), present_.size());
  for (const std::deque<PastPose>& history : histories_) {
    writer.add_count(history.size());
    for (const PastPose& past : history) {
      writer.add(past.tick);
      visit_pose(past.X_WL, [&](const double& number) { writer.add(number); });
    }
  }
}

void Objects::restore(SnapshotReader& reader) {
  reader.expect_count(world_.body_count(), "objects");
  while (names_.size() < world_.body_count()) {
    std::string name(reader.read_count(1), ' ');
    reader.read_all(name.data(), name.size());
    names_.push_back(std::move(name));
  }
  present_.resize(names_.size());
  reader.read_all(present_.data(), present_.size());
  for (std::deque<PastPose>& history : histories_) {
    history.resize(reader.read_count(sizeof(PastPose)));
    for (PastPose& past : history) {
      reader.read(past.tick);
      restore_pose(reader, past.X_WL);
    }
  }
}

}  // namespace cohort
