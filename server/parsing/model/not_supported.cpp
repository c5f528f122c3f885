// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/model/not_supported.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "server/parsing/model/model_places.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

// Returns whether a second friction coefficient has no effect because there is no direction: then friction is the same
// in every direction. It matters only if it differs from the first.
bool is_second_friction_without_direction(const Element* element) {
  const bool is_ode = element->name() == "mu2";
  if ((!is_ode && element->name() != "friction2") || element->parent()->child("fdir1") != nullptr) return false;
  const Element* const first = element->parent()->child(is_ode ? "mu" : "friction");
  return element->real() != (first != nullptr ? first->real() : 1.0);
}

// Returns whether the element of <bullet> is replaced by one of <ode> beside it.
bool is_bullets_beside_ode(const Element* element) {
  constexpr std::string_view names[] = {"friction", "friction2", "fdir1", "kp", "kd"};
  const Element* const parent = element->parent();
  return parent != nullptr && parent->name() == "bullet" && parent->parent()->child("ode") != nullptr &&
         std::ranges::find(names, element->name()) != std::end(names) &&
         (element->rule() == nullptr || !is_standard(element->rule()->value, element->text()));
}

}  // namespace

void warn_of_unsupported(const Element* element, const SdfReport& report) {
  for (const Element* const child : element->children()) {
    if (child->name() == "sensor" && !is_sensor(child))
      report.warning(child, "a sensor of the type '" + child->attribute("type") + "' in a <" + element->name() +
                                "> is not supported and is ignored");
    if (is_bullets_beside_ode(child))
      report.warning(child, "<" + child->name() + "> is ignored; the values of <ode> apply");
    else if (is_second_friction_without_direction(child))
      report.warning(child,
                     "<" + child->name() + "> is ignored; without <fdir1> friction is the same in every direction");
    if (child->name() == "plugin") warn_of_unknown_plugin(child, report);
    if (child->name() != "plugin" && child->name() != "model") warn_of_unsupported(child, report);
  }
}

}  // namespace cohort::parsing
