#pragma once

#include <optional>

#include "idl/control_messages.hpp"
#include "tools/view/source.hpp"

namespace cohort::view {

/// What a server is asked for a wish. Throws std::invalid_argument, with a sentence, if the wish makes no sense.
wire::Request request_of(const Wish& wish);

}  // namespace cohort::view
