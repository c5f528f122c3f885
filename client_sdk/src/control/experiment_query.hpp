// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "idl/include/cohort/types.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort {

/// Requests the files of the run's experiment part by part; `ask` returns the reply to a successful GetExperiment.
/// `read_experiment` accepts `messages::kept_files` of the result, on any machine. Throws ControlError (`bad_reply`) if
/// the data is not a valid message.
ExperimentFiles query_experiment(const std::function<wire::Reply(const wire::GetExperiment&)>& ask);

}  // namespace cohort
