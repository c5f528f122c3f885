#include "server/parsing/model/not_supported.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "server/core/text.hpp"
#include "server/parsing/model/read_model.hpp"
#include "server/parsing/plugins/gazebo_plugins.hpp"

namespace cohort::parsing {
namespace {

struct Unsupported {
  std::string_view parent;
  std::string_view element;
  const char* remark = "";
};

// Elements of SDF 1.9. One with a value is passed over where the value is SDF's default.
constexpr Unsupported unsupported[] = {
    {"world", "actor"},
    {"world", "state"},
    {"world", "population", "; use <cohort:population>"},
    {"model", "gripper"},
    {"link", "gravity", "; gravity acts on every link"},
    {"link", "self_collide", "; <self_collide> of the model is for all of its links"},
    {"link", "kinematic"},
    {"link", "velocity_decay"},
    {"link", "projector"},
    {"link", "battery"},
    {"link", "audio_sink"},
    {"link", "audio_source"},
    {"joint", "physics"},
    {"limit", "effort", "; the effort of a motor is the <cohort:max_effort> of its <cohort:velocity_motor>"},
    {"limit", "velocity", "; the velocity of a motor is the <cohort:max_velocity> of its <cohort:velocity_motor>"},
    {"limit", "stiffness", "; joint limits are rigid"},
    {"limit", "dissipation", "; joint limits are rigid"},
    {"friction", "torsional"},
    {"bullet", "friction", "; friction is <friction><ode><mu>"},
    {"bullet", "friction2", "; friction is <friction><ode><mu>"},
    {"bullet", "fdir1", "; friction is the same in every direction"},
    {"ode", "fdir1", "; friction is the same in every direction"},
    {"ode", "slip1"},
    {"ode", "slip2"},
    {"bounce", "threshold"},
    {"contact", "collide_without_contact"},
    {"contact", "collide_bitmask", "; everything collides with everything"},
    {"contact", "category_bitmask", "; everything collides with everything"},
    {"contact", "ode", "; contacts are rigid"},
    {"contact", "bullet", "; contacts are rigid"},
    {"surface", "soft_contact"},
    {"mesh", "submesh", "; all of the mesh is read"},
};

// What is looked into; all else is of no consequence or read elsewhere.
constexpr std::string_view containers[] = {"link",  "joint",     "axis",    "axis2",    "dynamics",
                                           "limit", "collision", "surface", "bounce",   "friction",
                                           "ode",   "bullet",    "contact", "geometry", "mesh"};

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

// Friction is the same in every direction: a second coefficient matters only where it differs from the first.
bool is_second_friction(const sdf::ElementPtr& element) {
  if (element->GetName() != "mu2" || !element->GetParent()) return false;
  const sdf::ElementPtr first = element->GetParent()->FindElement("mu");
  return element->Get<double>() != (first ? first->Get<double>() : 1.0);
}

// The effort or velocity of a joint's <limit> that a plugin's motor has.
bool is_limit_of_plugin(const sdf::ElementPtr& element) {
  if (element->GetName() != "effort" && element->GetName() != "velocity") return false;
  sdf::ElementPtr joint = element;
  while (joint && joint->GetName() != "joint") joint = joint->GetParent();
  return joint && is_named_by_plugin(joint);
}

}  // namespace

void warn_of_unsupported(const sdf::ElementPtr& element, const SdfReport& report) {
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (!child->GetExplicitlySetInFile()) continue;
    if (child->GetName() == "sensor" && !is_sensor(child))
      report.warning(child, "a sensor of the type '" + child->Get<std::string>("type") + "' in a <" +
                                element->GetName() + "> is not supported and is ignored");
    if (is_second_friction(child))
      report.warning(child, "<mu2> is not supported and is ignored; friction is the same in every direction");
    if (child->GetName() == "plugin") warn_of_unknown_plugin(child, report);
    if (child->GetName() == "sensor") warn_of_unsupported(child, report);
    if (is_limit_of_plugin(child)) continue;
    for (const Unsupported& entry : unsupported)
      if (entry.parent == element->GetName() && entry.element == child->GetName() && !has_default_value(child))
        report.warning(child, "<" + child->GetName() + "> is not supported and is ignored" + entry.remark);
    if (is_container(child->GetName())) warn_of_unsupported(child, report);
  }
}

}  // namespace cohort::parsing
