// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>

#include "client_sdk/include/cohort/cohort.h"
#include "client_sdk/include/cohort/controller.hpp"

/// Definitions of the handles of cohort.h.

struct CohortStart {
  explicit CohortStart(const cohort::Start& its_start);

  const cohort::Start& start;
  CohortStartInfo info;
  // These two are mutable because C callbacks get a const handle.
  mutable std::optional<std::string> mistake;  ///< the first error
  mutable std::deque<std::string> texts;       ///< storage of the strings that C functions return
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
  std::optional<std::string> mistake{};  ///< the first error
};

namespace cohort {

/// Returns this thread's text for `cohort_last_error`.
std::string& last_error();

}  // namespace cohort
