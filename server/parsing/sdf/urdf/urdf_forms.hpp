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

/// An element of URDF, where it may stand, and its attributes.
struct UrdfForm {
  std::string_view parent;
  std::string_view name;
  std::vector<UrdfAttribute> attributes{};
};

/// What the reader of URDF knows of links and joints (http://wiki.ros.org/urdf/XML), but for what is only seen.
const std::vector<UrdfForm>& urdf_forms();

/// Returns the form of an element where it stands; nullptr if the reader does not know it there.
const UrdfForm* form_of(std::string_view parent, std::string_view name);

/// What is wrong with the value of an attribute, or nothing.
std::optional<std::string> what_is_wrong(const std::string& value, const UrdfAttribute& attribute);

}  // namespace cohort::parsing
