// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "server/core/pose.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// An object that an event of an experiment adds to the world.
struct LaterObject {
  std::string uri;  ///< URI of its model
  std::string name;
  Pose X_WM;
  Problem where;               ///< position of the event, without a message
  bool is_model_only = false;  ///< the event creates new objects of the model; the description has none
};

}  // namespace cohort::parsing
