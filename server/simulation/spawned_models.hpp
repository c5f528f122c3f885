#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/experiment.hpp"

namespace cohort {

/// The models that a running world was given as text, behind those of its description. The texts are part of its state:
/// a snapshot brings them along.
class SpawnedModels {
 public:
  /// Adds to the models and materials of `experiment`, which must outlive this. Files that a text names are those that
  /// the experiment was read from.
  explicit SpawnedModels(description::Experiment& experiment)
      : experiment_(experiment), described_(experiment.world.models.size()) {}

  /// The index of the model of this name, or of the one that a text in SDF, URDF or YAML describes, which is new the
  /// first time. Throws std::invalid_argument with all that is wrong with it.
  std::size_t find_or_add(const std::string& name_or_text);
  std::size_t size() const { return texts_.size(); }
  /// As if no more than the first `count` texts had come.
  void shrink(std::size_t count);

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  struct Text {
    std::string text;
    std::size_t materials_before = 0;
  };
  void add(const std::string& text);

  description::Experiment& experiment_;
  std::size_t described_;
  std::vector<Text> texts_;
};

}  // namespace cohort
