#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "idl/wire/control_messages.hpp"
#include "server/run/run_monitor.hpp"

/// Requests that change the world: Simulation::act.
namespace cohort::session {

bool is_action(const wire::Request& request);

/// What came of a request.
struct ActionOutcome {
  const wire::Request* request = nullptr;
  wire::ResultCode result = wire::ResultCode::ok;
  std::string text{};
  std::string entity{};  ///< that it was done to; of one that was spawned, its name
  struct Done {
    std::string text;
    std::vector<std::byte> action;  ///< ControlEvent::action
  };
  std::vector<Done> done{};
};

/// Does these actions at once, since the robots sense again after them. First the outcomes of those that are refused
/// without a look at the world, then the others', each in the order of the requests.
std::vector<ActionOutcome> act(Simulation& simulation, std::span<const wire::Request> requests);

}  // namespace cohort::session
