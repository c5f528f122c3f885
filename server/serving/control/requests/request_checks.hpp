#pragma once

#include <string>

#include "idl/wire/control_messages.hpp"

namespace cohort::session {

/// What is wrong with a request that can be seen without the world; empty if nothing is.
std::string what_is_wrong(const wire::Request& request);

}  // namespace cohort::session
