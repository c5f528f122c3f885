// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "server/core/names.hpp"

namespace cohort {

/// The reason why an action cannot be carried out.
enum class ActionFault {
  other,
  object_not_found,
  light_not_found,  ///< also if its object is not in the world
  link_not_found,
  immovable,    ///< the object is static, or fixed to the world
  quarantined,  ///< the object has left the world, or its state is no longer finite
  invalid_pose,
  invalid_value,  ///< a number is not finite or out of range
  // Reasons for new objects only:
  name_invalid,
  name_not_unique,
  unknown_model,
  unsupported_model,  ///< the physics of this world cannot simulate the model, or not at this pose
  invalid_team,
  too_many_objects,
};

/// The error that an action cannot be carried out.
class ActionError : public std::invalid_argument {
 public:
  ActionError(ActionFault why, const std::string& text) : std::invalid_argument(text), fault(why) {}
  ActionFault fault;
};

/// Like `check_name`, but throws ActionError.
inline void check_name(const std::string& name, const std::string& what, ActionFault fault) try {
  check_name(name, what);
} catch (const std::invalid_argument& error) {
  throw ActionError(fault, error.what());
}

}  // namespace cohort
