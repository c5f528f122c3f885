// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "idl/wire/control_messages.hpp"
#include "server/run/run_monitor.hpp"
#include "server/serving/control/model_texts.hpp"

/// Requests that change the world through Simulation::act.
namespace cohort::session {

bool is_action(const wire::Request& request);
/// Returns the model text in a request, which must be read before the request is carried out; null if there is none.
const std::string* text_of_model(const wire::Request& request);
inline ModelTexts::Key key_of(const wire::Request& request) { return {request.client, request.number}; }

/// The outcome of a request.
struct ActionOutcome {
  const wire::Request* request = nullptr;
  wire::ResultCode result = wire::ResultCode::ok;
  std::string text{};
  std::string entity{};  ///< the object that was changed, or the name of the spawned one
  struct Done {
    std::string text;
    std::vector<std::byte> action;  ///< ControlEvent::action
  };
  std::vector<Done> done{};
};

/// Carries out these requests together, so that the robots sense only once after them. `texts` must have read the texts
/// of the requests. Returns first the outcomes of requests that are refused regardless of the world, then the others,
/// each in the order of the requests.
std::vector<ActionOutcome> act(Simulation& simulation, std::span<const wire::Request> requests,
                               const ModelTexts& texts);

}  // namespace cohort::session
