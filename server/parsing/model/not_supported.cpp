#include "server/parsing/model/not_supported.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/model/model_places.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"

namespace cohort::parsing {
namespace {

struct Unsupported {
  std::string_view parent;
  std::string_view element;
  const char* remark = "";
};

// Elements of SDF 1.9 that are not supported. An entry with a value is ignored where it has that value, the default of
// SDF.
constexpr Unsupported unsupported[] = {
    {"world", "actor"},
    {"world", "state"},
    {"world", "population", "; use <cohort:population>"},
    {"model", "gripper"},
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
    {"mesh", "submesh", "; the whole mesh is read"},
};

// Elements whose children are checked; all others have no effect or are read elsewhere.
constexpr std::string_view containers[] = {"link",      "joint",   "axis",     "axis2",    "dynamics", "limit",
                                           "collision", "surface", "bounce",   "friction", "ode",      "bullet",
                                           "torsional", "contact", "geometry", "mesh"};

bool is_container(std::string_view name) { return std::ranges::find(containers, name) != std::end(containers); }

bool has_default_value(const sdf::ElementPtr& element) {
  const sdf::ParamPtr value = element->GetValue();
  if (!value) return false;
  if (value->GetTypeName() == "bool") {
    bool set = false;
    bool by_default = false;
    return value->Get(set) && value->GetDefault(by_default) && set == by_default;
  }
  const std::string text = value->GetAsString();
  const std::string by_default = value->GetDefaultAsString();
  const std::optional<double> number = parse_real(text);
  return number ? number == parse_real(by_default) : text == by_default;
}

// Returns whether a second friction coefficient has no effect because there is no direction: then friction is the same
// in every direction. It matters only if it differs from the first.
bool is_second_friction_without_direction(const sdf::ElementPtr& element) {
  const bool is_ode = element->GetName() == "mu2";
  if ((!is_ode && element->GetName() != "friction2") || element->GetParent()->FindElement("fdir1")) return false;
  const sdf::ElementPtr first = element->GetParent()->FindElement(is_ode ? "mu" : "friction");
  return element->Get<double>() != (first ? first->Get<double>() : 1.0);
}

// Returns whether the element of <bullet> is replaced by one of <ode> beside it.
bool is_bullets_beside_ode(const sdf::ElementPtr& element) {
  constexpr std::string_view names[] = {"friction", "friction2", "fdir1", "kp", "kd"};
  const sdf::ElementPtr parent = element->GetParent();
  return parent && parent->GetName() == "bullet" && parent->GetParent()->FindElement("ode") &&
         std::ranges::find(names, element->GetName()) != std::end(names) && !has_default_value(element);
}

}  // namespace

void warn_of_unsupported(const sdf::ElementPtr& element, const SdfReport& report) {
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (!child->GetExplicitlySetInFile()) continue;
    if (child->GetName() == "sensor" && !is_sensor(child))
      report.warning(child, "a sensor of the type '" + child->Get<std::string>("type") + "' in a <" +
                                element->GetName() + "> is not supported and is ignored");
    if (is_bullets_beside_ode(child))
      report.warning(child, "<" + child->GetName() + "> is ignored; the values of <ode> apply");
    else if (is_second_friction_without_direction(child))
      report.warning(child,
                     "<" + child->GetName() + "> is ignored; without <fdir1> friction is the same in every direction");
    if (child->GetName() == "plugin") warn_of_unknown_plugin(child, report);
    if (child->GetName() == "sensor") warn_of_unsupported(child, report);
    for (const Unsupported& entry : unsupported)
      if (entry.parent == element->GetName() && entry.element == child->GetName() && !has_default_value(child))
        report.warning(child, "<" + child->GetName() + "> is not supported and is ignored" + entry.remark);
    if (is_container(child->GetName())) warn_of_unsupported(child, report);
  }
}

}  // namespace cohort::parsing
