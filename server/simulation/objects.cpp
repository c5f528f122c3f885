// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/objects.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/core/random.hpp"
#include "server/core/state_visitors.hpp"
#include "server/description/fingerprint.hpp"
#include "server/simulation/action_error.hpp"

namespace cohort {

std::uint64_t ticks_of(std::chrono::nanoseconds time, std::chrono::nanoseconds step) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(1, (time + step - std::chrono::nanoseconds(1)) / step));
}

Objects::Objects(SharedExperiment& experiment, physics::World& world, const Objects* like)
    : experiment_(experiment),
      world_(world),
      described_(static_cast<std::uint32_t>(experiment->world.instances.size())),
      by_name_(like != nullptr ? like->by_name_ : std::make_shared<ByName>()),
      history_ticks_(ticks_of(experiment->history.every, experiment->world.step)),
      histories_(experiment->history.objects.size()) {
  present_.reserve(described_);
  for (const description::Instance& instance : experiment->world.instances) {
    if (like == nullptr) by_name_->emplace(instance.name, present_.size());
    present_.push_back(instance.is_present ? 1 : 0);
  }
}

void Objects::add_instance(description::Instance instance, BodyId body) {
  by_name_->emplace(instance.name, present_.size());
  present_.push_back(1);
  slots_.push_back(world_.slot_of(body));
  added_hash_.add(hash_name(instance.name));
  added_hash_.add(description::fingerprint(experiment_->world.models[instance.model]));
  experiment_.edit().world.instances.push_back(std::move(instance));
}

std::optional<std::uint32_t> Objects::find(const std::string& name) const {
  const auto found = by_name_->find(name);
  return found == by_name_->end() ? std::nullopt : std::optional(found->second);
}

void Objects::set_present(std::uint32_t object, bool present) {
  if (is_present(object) == present) return;
  present_[object] = present ? 1 : 0;
  if (is_gone(object)) gone_hash_ += hash_of_gone(object);
  world_.set_present(BodyId{object}, present);
}

std::uint64_t Objects::hash_of_gone(std::uint32_t object) {
  StateHash hash;
  hash.add(std::uint64_t{object});
  return hash.value();
}

std::uint32_t Objects::add(const std::string& name, std::size_t model, const Pose& X_WM) {
  if (find(name)) throw ActionError(ActionFault::name_not_unique, "another object has the name '" + name + "'");
  if (size() - described_ == most_added)
    throw ActionError(ActionFault::too_many_objects,
                      "at most " + std::to_string(most_added) + " objects can be added in one run");
  experiment_.edit();
  const BodyId body = world_.add_body(model, X_WM);
  add_instance({name, model, X_WM}, body);
  return body.value;
}

void Objects::record(std::uint64_t tick) {
  if (tick % history_ticks_ != 0) return;
  for (std::size_t i = 0; i < histories_.size(); ++i) {
    const auto object = static_cast<std::uint32_t>(experiment_->history.objects[i]);
    if (!is_present(object)) continue;
    if (histories_[i].size() == experiment_->history.length) histories_[i].pop_front();
    histories_[i].push_back({tick, world_.link_pose(BodyId{object}, LinkId{0})});
  }
}

const std::deque<PastPose>& Objects::history(std::uint32_t object) const {
  static const std::deque<PastPose> nothing;
  const std::vector<std::size_t>& asked_for = experiment_->history.objects;
  const auto place = std::lower_bound(asked_for.begin(), asked_for.end(), object);
  if (place == asked_for.end() || *place != object) return nothing;
  return histories_[static_cast<std::size_t>(place - asked_for.begin())];
}

// Unchanged members add nothing else to the hash.
void Objects::hash(StateHash& hash) const {
  const std::vector<description::Instance>& instances = experiment_->world.instances;
  for (std::uint32_t object = 0; object < described_; ++object)
    if (is_present(object) != instances[object].is_present)
      hash.add(static_cast<std::uint64_t>(object) << 1 | static_cast<std::uint64_t>(is_present(object)));
  if (size() > described_) {
    hash.add(added_hash_.value());
    hash.add(gone_hash_);
  }
  for (const std::deque<PastPose>& history : histories_)
    for (const PastPose& past : history) {
      hash.add(past.tick);
      visit_pose(past.X_WL, [&](const double& number) { hash.add(number); });
    }
}

void Objects::save_added(SnapshotWriter& writer) const {
  writer.add_count(described_);
  writer.add_count(size() - described_);
  for (std::uint32_t object = described_; object < size(); ++object) {
    const description::Instance& instance = experiment_->world.instances[object];
    writer.add_count(instance.name.size());
    writer.add_all(instance.name.data(), instance.name.size());
    writer.add_count(instance.model);
    visit_pose(instance.X_WM, [&](const double& number) { writer.add(number); });
    writer.add(slots_[object - described_]);
    writer.add(is_gone(object));
  }
}

std::vector<Objects::Added> Objects::read_added(SnapshotReader& reader) const {
  reader.expect_count(described_, "models in the world");
  std::vector<Added> all;
  constexpr std::size_t least_bytes = 1;
  const std::size_t count = reader.read_count(least_bytes);
  if (count > most_added) throw SnapshotError("snapshot: too many objects");
  for (std::size_t left = count; left > 0; --left) {
    Added& added = all.emplace_back();
    description::Instance& instance = added.instance;
    instance.name.resize(reader.read_count(least_bytes));
    reader.read_all(instance.name.data(), instance.name.size());
    std::uint64_t model = 0;
    reader.read(model);
    instance.model = static_cast<std::size_t>(model);
    restore_pose(reader, instance.X_WM);
    if (instance.model >= experiment_->world.models.size()) throw SnapshotError("snapshot: unknown model");
    added.slot = size() + static_cast<std::uint32_t>(all.size()) - 1;  // in layouts before slots
    if (reader.layout() < SnapshotLayout::with_slots) continue;
    reader.read(added.slot);
    reader.read(added.is_gone);
  }
  return all;
}

void Objects::restore_added(const Added& added) {
  try {
    experiment_.edit();
    add_instance(added.instance, world_.add_body(added.instance.model, added.instance.X_WM, added.slot));
  } catch (const std::invalid_argument& error) {
    throw SnapshotError("snapshot: invalid object: " + std::string(error.what()));
  }
}

void Objects::save(SnapshotWriter& writer) const {
  writer.add_count(present_.size());
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
  reader.expect_count(present_.size(), "objects");
  reader.read_all(present_.data(), present_.size());
  gone_hash_ = 0;
  for (std::uint32_t object = described_; object < size(); ++object)
    if (is_gone(object)) gone_hash_ += hash_of_gone(object);
  for (std::deque<PastPose>& history : histories_) {
    history.resize(reader.read_count(sizeof(PastPose)));
    for (PastPose& past : history) {
      reader.read(past.tick);
      restore_pose(reader, past.X_WL);
    }
  }
}

}  // namespace cohort
