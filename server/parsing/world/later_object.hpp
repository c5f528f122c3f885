#pragma once

#include <string>

#include "server/core/pose.hpp"
#include "server/description/input_error.hpp"
#include "server/parsing/parsing.hpp"

namespace cohort::parsing {

/// An object that an event of an experiment brings into the world.
struct LaterObject {
  std::string uri;  ///< of its model
  std::string name;
  Pose X_WM;
  Problem where;               ///< of the event, without a message
  bool is_model_only = false;  ///< the event makes new objects of the model; there is none in the description
};

}  // namespace cohort::parsing
