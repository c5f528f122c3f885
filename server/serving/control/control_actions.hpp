#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "idl/wire/control_messages.hpp"
#include "server/run/run_monitor.hpp"
#include "server/serving/control/model_texts.hpp"

/// Requests that change the world: Simulation::act.
namespace cohort::session {

bool is_action(const wire::Request& request);
/// The text of the model that a request brings, which has to be read before it is done; null: none.
const std::string* text_of_model(const wire::Request& request);
inline ModelTexts::Key key_of(const wire::Request& request) { return {request.client, request.number}; }

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

/// Does these actions at once, since the robots sense again after them. `texts` has read those of the requests. First
/// the outcomes of those that are refused without a look at the world, then the others', each in the order of the
/// requests.
std::vector<ActionOutcome> act(Simulation& simulation, std::span<const wire::Request> requests,
                               const ModelTexts& texts);

}  // namespace cohort::session
