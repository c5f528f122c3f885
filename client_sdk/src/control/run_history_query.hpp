// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "idl/include/cohort/types.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort {

/// Requests all events since a revision part by part; `ask` returns the reply to a successful GetHistory. Throws
/// ControlError (`bad_reply`) if a reply has no history.
RunHistory query_history(std::uint64_t since, const std::function<wire::Reply(const wire::GetHistory&)>& ask);

}  // namespace cohort
