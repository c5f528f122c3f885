#pragma once

#include "idl/wire/control_messages.hpp"
#include "tools/view/source.hpp"

namespace cohort::view {

/// Translates requests of viewers into operations of a server. Throws std::invalid_argument, with a sentence, if what
/// it asks makes no sense.
wire::Operation operation_of(const ViewRequest& asked);

}  // namespace cohort::view
