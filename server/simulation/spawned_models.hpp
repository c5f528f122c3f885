// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/core/hash.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/experiment.hpp"
#include "server/simulation/action.hpp"
#include "server/simulation/shared_experiment.hpp"

namespace cohort {

/// The models that were added to a running world as text, after those of its description. The texts are part of its
/// state, and of snapshots.
class SpawnedModels {
 public:
  /// Adds to the models and materials of `experiment`, which must outlive this object.
  explicit SpawnedModels(SharedExperiment& experiment)
      : experiment_(experiment), described_(experiment->world.models.size()) {}

  /// Returns the index of the model; adds a parsed model that is new. Throws ActionError if the world has no model of
  /// that name.
  std::size_t find_or_add(const ModelChoice& choice);
  std::size_t size() const { return texts_.size(); }
  /// Removes all but the first `count` texts.
  void shrink(std::size_t count);

  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  /// Reads the texts again with `Experiment::read_model`.
  void restore(SnapshotReader& reader);

 private:
  struct Text {
    std::string text;
    std::size_t materials_before = 0;
  };
  std::size_t find(const std::string& name) const;
  std::size_t find_or_add(const description::ParsedModel& parsed);
  void add(const description::ParsedModel& parsed);

  SharedExperiment& experiment_;
  std::size_t described_;
  std::vector<Text> texts_;
};

}  // namespace cohort
