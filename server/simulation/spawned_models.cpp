// SPDX-License-Identifier: Apache-2.0
#include "server/simulation/spawned_models.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/core/names.hpp"
#include "server/core/random.hpp"
#include "server/core/text.hpp"
#include "server/simulation/action_error.hpp"

namespace cohort {
namespace {

std::uint32_t find_or_append(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  const auto index = static_cast<std::uint32_t>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return index;
}

}  // namespace

std::size_t SpawnedModels::find_or_add(const ModelChoice& choice) {
  if (const auto* const name = std::get_if<std::string>(&choice)) return find(*name);
  const auto& parsed = std::get<description::ParsedModelPtr>(choice);
  if (parsed == nullptr) throw ActionError(ActionFault::unknown_model, "expected a model");
  return find_or_add(*parsed);
}

std::size_t SpawnedModels::find(const std::string& name) const {
  const auto& models = experiment_->world.models;
  if (name.empty())
    throw ActionError(ActionFault::unknown_model, "expected the name of one of the world's models, or a model");
  check_name(name, "the name of the model", ActionFault::unknown_model);
  const auto named = std::ranges::find(models, name, &description::Model::name);
  if (named != models.end()) return static_cast<std::size_t>(named - models.begin());
  std::vector<std::string> names;
  names.reserve(models.size());
  for (const description::Model& model : models) names.push_back(model.name);
  throw ActionError(ActionFault::unknown_model, "the world has no model '" + name + "'" + suggestion(name, names));
}

std::size_t SpawnedModels::find_or_add(const description::ParsedModel& parsed) {
  const auto known = std::ranges::find(texts_, parsed.text, &Text::text);
  if (known != texts_.end()) return described_ + static_cast<std::size_t>(known - texts_.begin());
  check_utf8(parsed.text, "the text of the model");
  add(parsed);
  return experiment_->world.models.size() - 1;
}

// New names of materials are added in their order.
void SpawnedModels::add(const description::ParsedModel& parsed) {
  description::World& world = experiment_.edit().world;
  texts_.push_back({parsed.text, world.materials.size()});
  std::vector<std::uint32_t> in_world;
  for (const std::string& material : parsed.materials) in_world.push_back(find_or_append(world.materials, material));
  description::Model model = parsed.model;
  for (description::Link& link : model.links)
    for (description::Collision& collision : link.collisions)
      collision.surface.material = in_world.at(collision.surface.material);
  world.models.push_back(std::move(model));
  const auto before_seed_warnings = world.warnings.end() - static_cast<std::ptrdiff_t>(world.seed_warnings);
  world.warnings.insert(before_seed_warnings, parsed.warnings.begin(), parsed.warnings.end());
}

void SpawnedModels::shrink(std::size_t count) {
  while (texts_.size() > count) {
    description::World& world = experiment_.edit().world;
    world.models.pop_back();
    world.materials.resize(texts_.back().materials_before);
    texts_.pop_back();
  }
}

void SpawnedModels::hash(StateHash& hash) const {
  for (const Text& each : texts_) hash.add(hash_name(each.text));
}

void SpawnedModels::save(SnapshotWriter& writer) const {
  writer.add_count(texts_.size());
  for (const Text& each : texts_) {
    writer.add_count(each.text.size());
    writer.add_all(each.text.data(), each.text.size());
  }
}

void SpawnedModels::restore(SnapshotReader& reader) {
  for (std::size_t left = reader.read_count(sizeof(std::uint64_t)); left > 0; --left) {
    std::string text(reader.read_count(1), ' ');
    reader.read_all(text.data(), text.size());
    try {
      if (!experiment_->read_model) throw std::invalid_argument("this experiment does not accept models as text");
      add(*experiment_->read_model(text));
    } catch (const std::invalid_argument& error) {
      throw SnapshotError(std::string("snapshot: invalid model: ") + error.what());
    }
  }
}

}  // namespace cohort
