// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

#include "idl/messages/experiment_files.hpp"
#include "server/description/kept_files.hpp"

namespace cohort::messages {

/// Returns the message with the files, the seed and the duration of a run.
ExperimentFiles experiment_files(const description::KeptFiles& kept, std::uint64_t seed,
                                 std::chrono::nanoseconds duration);

/// Returns the files in a message, for `parsing::read_experiment`. Throws CdrError if the message has no experiment, a
/// path that is not absolute, or unsorted files.
description::KeptFiles kept_files(const ExperimentFiles& message);

}  // namespace cohort::messages
