#pragma once

#include <span>

#include "client_sdk/include/cohort/control.hpp"
#include "idl/messages/run_history.hpp"
#include "idl/wire/control_messages.hpp"

/// Values of the public headers as the protocol has them, and back.
namespace cohort {

ControlReply reply_from_wire(const wire::Reply& reply);
SimulationStatus status_from_wire(const wire::Reply& reply, const wire::SimulationStatus& status);
/// `result` is another one than ok. Some numbers mean another thing for each operation.
ControlResult from_wire(wire::ResultCode result, wire::OperationCode operation);

}  // namespace cohort
