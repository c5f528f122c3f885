#pragma once

#include <memory>
#include <stdexcept>
#include <utility>

#include "server/description/experiment.hpp"

namespace cohort {

/// The experiment of a simulation. Simulations that are built like each other share it: then it stays as it is.
class SharedExperiment {
 public:
  explicit SharedExperiment(description::Experiment experiment)
      : experiment_(std::make_shared<description::Experiment>(std::move(experiment))) {}

  const description::Experiment& operator*() const { return *experiment_; }
  const description::Experiment* operator->() const { return experiment_.get(); }
  /// To be added to: models, objects, robots. Throws std::invalid_argument while
  /// other simulations share it.
  description::Experiment& edit() {
    if (experiment_.use_count() > 1)
      throw std::invalid_argument("nothing can be added to a world that shares its experiment with other worlds");
    return *experiment_;
  }

 private:
  std::shared_ptr<description::Experiment> experiment_;
};

}  // namespace cohort
