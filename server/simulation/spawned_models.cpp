#include "server/simulation/spawned_models.hpp"

#include <algorithm>
#include <stdexcept>

#include "server/core/random.hpp"
#include "server/core/text.hpp"
#include "server/parsing/world/read_world.hpp"

namespace cohort {
namespace {

bool is_text(const std::string& name_or_text) { return name_or_text.find_first_of("<:\n{") != std::string::npos; }

}  // namespace

std::size_t SpawnedModels::find_or_add(const std::string& name_or_text) {
  const auto& models = experiment_.world.models;
  const auto named = std::ranges::find(models, name_or_text, &description::Model::name);
  if (named != models.end()) return static_cast<std::size_t>(named - models.begin());
  if (!is_text(name_or_text)) {
    constexpr std::size_t longest_name = 255;
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
    if (name_or_text.empty() || name_or_text.size() > longest_name || std::ranges::any_of(name_or_text, is_control))
      throw std::invalid_argument("expected the name of one of the world's models, or a text in SDF, URDF or YAML");
    std::vector<std::string> names;
    names.reserve(models.size());
    for (const description::Model& model : models) names.push_back(model.name);
    throw std::invalid_argument("the world has no model '" + name_or_text + "'" + suggestion(name_or_text, names) +
                                " (or give its text, in SDF, URDF or YAML)");
  }
  const auto known = std::ranges::find(texts_, name_or_text, &Text::text);
  if (known == texts_.end()) {
    add(name_or_text);
    return models.size() - 1;
  }
  return described_ + static_cast<std::size_t>(known - texts_.begin());
}

void SpawnedModels::add(const std::string& text) {
  const std::size_t materials = experiment_.world.materials.size();
  try {
    parsing::add_model(text, experiment_.inputs, experiment_.world);
  } catch (const description::InputError& error) {
    std::string flaws;
    for (const description::Problem& problem : error.problems())
      flaws += (flaws.empty() ? "" : "; ") + (problem.line > 0 ? "line " + std::to_string(problem.line) + ": " : "") +
               (problem.element.empty() ? "" : problem.element + ": ") + problem.message;
    throw std::invalid_argument("the text of the model: " + flaws);
  }
  texts_.push_back({text, materials});
}

void SpawnedModels::shrink(std::size_t count) {
  while (texts_.size() > count) {
    experiment_.world.models.pop_back();
    experiment_.world.materials.resize(texts_.back().materials_before);
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
      add(text);
    } catch (const std::invalid_argument& error) {
      throw SnapshotError(std::string("the snapshot has a model that cannot be read: ") + error.what());
    }
  }
}

}  // namespace cohort
