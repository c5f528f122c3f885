// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/messages/run_history.hpp"
#include "idl/wire/control_messages.hpp"

/// Conversions of values between the public headers and the protocol.
namespace cohort {

/// Converts the reply to a request that has been done.
ControlReply reply_from_wire(const wire::Reply& reply);
SimulationStatus status_from_wire(const wire::Reply& reply, const wire::SimulationStatus& status);
/// Converts a `result` other than ok. The meaning of some numbers depends on the operation.
ControlResult from_wire(wire::ResultCode result, wire::OperationCode operation);

}  // namespace cohort
