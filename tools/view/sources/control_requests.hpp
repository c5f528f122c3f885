// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/wire/control_messages.hpp"
#include "tools/view/source.hpp"

namespace cohort::view {

/// Converts a viewer's request to an operation of a server. Throws std::invalid_argument, with a message to the user,
/// if the request is invalid.
wire::Operation operation_of(const ViewRequest& asked);

}  // namespace cohort::view
