#pragma once

#include <deque>
#include <optional>
#include <string>

#include "client_sdk/include/cohort/cohort.h"
#include "client_sdk/include/cohort/controller.hpp"

/// What stands behind the handles of cohort.h.

struct CohortStart {
  explicit CohortStart(const cohort::Start& its_start);

  const cohort::Start& start;
  CohortStartInfo info;
  // These two change under a const handle, as a C callback gets it.
  mutable std::optional<std::string> mistake;  ///< the first one
  mutable std::deque<std::string> texts;       ///< that were given out
};

struct CohortObservation {
  const cohort::Observation& observation;
};

struct CohortCommand {
  cohort::Command& command;
};

struct CohortStateWriter {
  cohort::StateWriter& writer;
};

struct CohortStateReader {
  cohort::StateReader& reader;
  std::optional<std::string> mistake{};  ///< the first one
};

namespace cohort {

/// This thread's, for `cohort_last_error`.
std::string& last_error();

}  // namespace cohort
