#include "server/parsing/model/not_supported.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/model/model_places.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"
#include "server/parsing/sdf/schema/value_text.hpp"

namespace cohort::parsing {
namespace {

struct Unsupported {
  std::string_view parent;
  std::string_view element;
  const char* remark = "";
};

// Elements of SDF that are not supported. An entry with a value is ignored where it has that value, the default of
// SDF.
constexpr Unsupported unsupported[] = {
    {"world", "actor"},
    {"world", "state"},
    {"world", "population", "; use <cohort:population>"},
    {"model", "gripper"},
    {"model", "model_state"},
    {"model", "namespace", "; topics have the name of the robot"},
    {"inertial", "fluid_added_mass"},
    {"link", "self_collide", "; <self_collide> of the model applies to all of its links"},
    {"link", "velocity_decay"},
    {"link", "projector"},
    {"link", "battery"},
    {"link", "audio_sink"},
    {"link", "audio_source"},
    {"joint", "physics"},
    {"torsional", "ode"},
    {"ode", "slip1"},
    {"ode", "slip2"},
    {"contact", "collide_without_contact"},
    {"ode", "soft_cfm", "; <kp> and <kd> define soft contacts"},
    {"ode", "soft_erp", "; <kp> and <kd> define soft contacts"},
    {"ode", "max_vel"},
    {"ode", "min_depth"},
    {"bullet", "soft_cfm", "; <kp> and <kd> define soft contacts"},
    {"bullet", "soft_erp", "; <kp> and <kd> define soft contacts"},
    {"bullet", "split_impulse"},
    {"bullet", "split_impulse_penetration_threshold"},
    {"surface", "soft_contact"},
};

// Elements whose children are checked; all others have no effect or are read elsewhere.
constexpr std::string_view containers[] = {"link",   "inertial",  "joint",   "axis",     "axis2",    "dynamics",
                                           "limit",  "collision", "surface", "bounce",   "friction", "ode",
                                           "bullet", "torsional", "contact", "geometry", "mesh"};

bool is_container(std::string_view name) { return std::ranges::find(containers, name) != std::end(containers); }

bool has_default_value(const Element* element) {
  const ElementRule* const rule = element->rule();
  if (rule == nullptr || rule->value.type == ValueType::none) return false;
  if (rule->value.type == ValueType::flag) return element->flag() == is_true(rule->value.standard);
  const std::optional<double> number = parse_real(element->text());
  return number ? number == parse_real(rule->value.standard) : element->text() == rule->value.standard;
}

// Returns whether a second friction coefficient has no effect because there is no direction: then friction is the same
// in every direction. It matters only if it differs from the first.
bool is_second_friction_without_direction(const Element* element) {
  const bool is_ode = element->name() == "mu2";
  if ((!is_ode && element->name() != "friction2") || element->parent()->child("fdir1")) return false;
  const Element* const first = element->parent()->child(is_ode ? "mu" : "friction");
  return element->real() != (first ? first->real() : 1.0);
}

// Returns whether the element of <bullet> is replaced by one of <ode> beside it.
bool is_bullets_beside_ode(const Element* element) {
  constexpr std::string_view names[] = {"friction", "friction2", "fdir1", "kp", "kd"};
  const Element* const parent = element->parent();
  return parent && parent->name() == "bullet" && parent->parent()->child("ode") &&
         std::ranges::find(names, element->name()) != std::end(names) && !has_default_value(element);
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
    if (child->name() == "sensor") warn_of_unsupported(child, report);
    for (const Unsupported& entry : unsupported)
      if (entry.parent == element->name() && entry.element == child->name() && !has_default_value(child))
        report.warning(child, "<" + child->name() + "> is not supported and is ignored" + entry.remark);
    if (is_container(child->name())) warn_of_unsupported(child, report);
  }
}

}  // namespace cohort::parsing
