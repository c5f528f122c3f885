// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "idl/include/cohort/types.hpp"
#include "idl/messages/experiment_files.hpp"
#include "server/description/kept_files.hpp"

namespace cohort::messages {

/// Returns the message with the files, the seed and the duration of a run.
ExperimentFiles experiment_files(const description::KeptFiles& kept, std::uint64_t seed,
                                 std::chrono::nanoseconds duration);

/// Returns the files of a run's experiment for `parsing::read_experiment`. Throws std::invalid_argument if they have no
/// experiment, a path that is not absolute, or are not sorted.
description::KeptFiles kept_files(cohort::ExperimentFiles files);

}  // namespace cohort::messages
