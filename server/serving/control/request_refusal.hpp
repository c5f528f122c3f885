// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "idl/wire/control_messages.hpp"

namespace cohort::session {

/// The error that a request cannot be carried out, with the result for its client.
class RequestRefusal : public std::runtime_error {
 public:
  RequestRefusal(wire::ResultCode why, const std::string& text) : std::runtime_error(text), result(why) {}
  wire::ResultCode result;
};

}  // namespace cohort::session
