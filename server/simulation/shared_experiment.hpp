// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <utility>

#include "server/description/experiment.hpp"

namespace cohort {

/// The experiment of a simulation. Simulations that are constructed from another one share its experiment, which then
/// cannot be changed.
class SharedExperiment {
 public:
  explicit SharedExperiment(description::Experiment experiment)
      : experiment_(std::make_shared<description::Experiment>(std::move(experiment))) {}

  const description::Experiment& operator*() const { return *experiment_; }
  const description::Experiment* operator->() const { return experiment_.get(); }
  /// Returns the experiment for adding models, objects and robots. Throws std::invalid_argument while other simulations
  /// share it.
  description::Experiment& edit() {
    if (experiment_.use_count() > 1)
      throw std::invalid_argument("objects cannot be added to a world that shares its experiment with other worlds");
    return *experiment_;
  }

 private:
  std::shared_ptr<description::Experiment> experiment_;
};

}  // namespace cohort
