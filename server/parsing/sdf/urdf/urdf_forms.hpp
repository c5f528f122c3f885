// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cohort::parsing {

/// An attribute of an element of URDF.
struct UrdfAttribute {
  std::string_view name;
  std::size_t numbers = 0;  ///< 0: a text
  bool required = false;
  bool positive = false;
};

/// An element of URDF with its parent and its attributes.
struct UrdfForm {
  std::string_view parent;
  std::string_view name;
  std::vector<UrdfAttribute> attributes{};
  bool has_effect = true;  ///< otherwise it is ignored with a warning
};

/// Returns the elements of URDF (http://wiki.ros.org/urdf/XML).
const std::vector<UrdfForm>& urdf_forms();

/// Returns the form of an element in its parent; nullptr if it is unknown there.
const UrdfForm* form_of(std::string_view parent, std::string_view name);

/// Returns the problem of an attribute's value; nothing if it is valid.
std::optional<std::string> what_is_wrong(const std::string& value, const UrdfAttribute& attribute);

}  // namespace cohort::parsing
