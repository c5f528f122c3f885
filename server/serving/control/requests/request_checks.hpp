// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "idl/wire/control_messages.hpp"

namespace cohort::session {

/// Returns a fault of a request that is visible without the world; empty if there is none.
std::string what_is_wrong(const wire::Request& request);

}  // namespace cohort::session
