#include "server/parsing/sdf/sdf_values.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "server/core/text.hpp"

namespace cohort::parsing {
namespace {

// Returns the number of numbers in a value of this type; 0 for types that are not numeric. libsdformat counts those of
// a pose, which depend on its attributes.
std::size_t numbers_in(std::string_view type) {
  if (type == "double" || type == "float" || type == "int" || type == "unsigned int") return 1;
  if (type == "vector2d") return 2;
  if (type == "vector3") return 3;
  return 0;
}

bool is_simulated(const std::string& name) {
  constexpr std::string_view ignored[] = {"visual", "light",      "sensor",    "plugin",           "scene",
                                          "gui",    "atmosphere", "actor",     "particle_emitter", "state",
                                          "audio",  "road",       "projector", "population"};
  return std::find(std::begin(ignored), std::end(ignored), name) == std::end(ignored) &&
         name.find(':') == std::string::npos;
}

bool is_hexadecimal(std::string_view text) {
  return (text.starts_with("0x") || text.starts_with("0X")) && text.size() > 2 &&
         text.find_first_not_of("0123456789abcdefABCDEF", 2) == std::string_view::npos;
}

void check_value(const sdf::ElementPtr& element, const SdfReport& report) {
  const sdf::ParamPtr value = element->GetValue();
  const std::string& type = value->GetTypeName();
  const std::size_t count = numbers_in(type);
  if (count == 0 && type != "pose") return;
  if (!value->GetSet()) {
    // A pose may have only attributes.
    if (type != "pose") report.problem(element, "expected a number");
    return;
  }
  const std::string text = value->GetAsString();
  const std::vector<std::string_view> parts = words(text);
  for (const std::string_view part : parts) {
    if (type == "unsigned int" && is_hexadecimal(part)) continue;
    const std::optional<double> number = parse_real(part);
    // A limit may be infinite.
    const bool valid = number && (std::isfinite(*number) || (std::isinf(*number) && count == 1));
    if (!valid) {
      report.problem(element, "'" + std::string(part) + "' is not a number");
      return;
    }
  }
  if (count > 0 && parts.size() != count)
    report.problem(element, "expected " + std::to_string(count) + " numbers, not '" + text + "'");
}

// Tolerance for the rounding errors of normalisation.
bool is_unit(double squared_norm) { return std::abs(squared_norm - 1.0) < 1e-14; }

}  // namespace

Eigen::Vector3d to_eigen(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

Pose to_pose(const ignition::math::Pose3d& X) {
  return {to_eigen(X.Pos()), Eigen::Quaterniond(X.Rot().W(), X.Rot().X(), X.Rot().Y(), X.Rot().Z()).normalized()};
}

Pose written_pose(const ignition::math::Pose3d& X, const sdf::ElementPtr& posed) {
  const sdf::ElementPtr element = find(posed, {"pose"});
  const sdf::ParamPtr format = element ? element->GetAttribute("rotation_format") : nullptr;
  return written_pose(X, format && format->GetAsString() == "quat_xyzw");
}

Pose written_pose(const ignition::math::Pose3d& X, bool is_quaternion) {
  Pose pose = to_pose(X);
  if (!is_quaternion) return pose;
  const Eigen::Quaterniond written(X.Rot().W(), X.Rot().X(), X.Rot().Y(), X.Rot().Z());
  if (is_unit(written.squaredNorm())) pose.orientation = written;
  return pose;
}

std::optional<Eigen::Vector3d> written_unit_vector(const sdf::ElementPtr& element) {
  if (!element) return std::nullopt;
  const Eigen::Vector3d written = to_eigen(element->Get<ignition::math::Vector3d>());
  return is_unit(written.squaredNorm()) ? std::optional(written) : std::nullopt;
}

sdf::ElementPtr find(sdf::ElementPtr element, std::initializer_list<const char*> path) {
  for (const char* const name : path) {
    if (!element) return nullptr;
    element = element->FindElement(name);
  }
  return element;
}

bool is_written(const sdf::ElementPtr& element) {
  return element && element->GetValue() && element->GetValue()->GetSet();
}

std::string written_text(const sdf::ElementPtr& element) {
  if (!element->GetValue()) return "";
  bool is_foreign = element->GetName().find(':') != std::string::npos;
  for (sdf::ElementPtr around = element->GetParent(); around && !is_foreign; around = around->GetParent())
    is_foreign = around->GetName() == "plugin";
  return is_foreign || element->GetValue()->GetSet() ? element->GetValue()->GetAsString() : "";
}

void check_numbers(const sdf::ElementPtr& element, const SdfReport& report) {
  if (element->GetExplicitlySetInFile() && element->GetValue()) check_value(element, report);
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement())
    if (is_simulated(child->GetName())) check_numbers(child, report);
}

}  // namespace cohort::parsing
