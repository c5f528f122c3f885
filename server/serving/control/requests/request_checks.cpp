// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/requests/request_checks.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace cohort::session {
namespace {

constexpr std::uint64_t most_steps = std::uint64_t{1} << 62;

constexpr const char* not_finite = "a number is not finite";

bool is_finite(const wire::Vector3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool is_finite(const wire::Pose& pose) {
  const wire::Quaternion& q = pose.orientation;
  return is_finite(pose.position) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) &&
         std::isfinite(q.w);
}
bool is_finite(const wire::Twist& twist) { return is_finite(twist.linear) && is_finite(twist.angular); }

std::string what_is_wrong_with(const wire::UnknownOperation& operation) {
  return "unknown operation " + std::to_string(operation.number);
}
std::string what_is_wrong_with(const wire::SetSimulationState& operation) {
  if (operation.state <= wire::SimulationState::quitting) return {};
  return "invalid state " + std::to_string(static_cast<std::uint32_t>(operation.state)) +
         ", expected 0 (stopped), 1 (playing), 2 (paused) or 3 (quitting)";
}
std::string what_is_wrong_with(const wire::StepSimulation& operation) {
  if (operation.steps > 0 && operation.steps <= most_steps) return {};
  return "expected 1 to 2^62 steps, not " + std::to_string(operation.steps);
}
std::string what_is_wrong_with(const wire::AdvanceTime& operation) {
  if (operation.steps <= most_steps) return {};
  return "expected at most 2^62 steps, not " + std::to_string(operation.steps);
}
std::string what_is_wrong_with(const wire::SetSpeed& operation) {
  if (operation.speed >= 0.0 && operation.speed <= 1e9) return {};
  return "expected a speed from 0 (as fast as possible) to 1e9, not " + std::to_string(operation.speed);
}
std::string what_is_wrong_with(const wire::SetEntityState& operation) {
  if (!operation.pose && !operation.twist) return "expected a pose, a twist or both";
  const bool fits =
      (!operation.pose || is_finite(*operation.pose)) && (!operation.twist || is_finite(*operation.twist));
  return fits ? "" : not_finite;
}
std::string what_is_wrong_with(const wire::SpawnEntity& operation) {
  return is_finite(operation.pose) ? "" : not_finite;
}
std::string what_is_wrong_with(const wire::SetLight& operation) {
  const bool fits =
      std::isfinite(operation.intensity.value_or(0.0)) && is_finite(operation.color.value_or(wire::Vector3{}));
  return fits ? "" : not_finite;
}
std::string what_is_wrong_with(const wire::ApplyForce& operation) {
  return is_finite(operation.force) && is_finite(operation.torque) ? "" : not_finite;
}

template <class One>
std::string complaint_about(const One& operation) {
  constexpr std::size_t longest_name = 1024;
  std::string wrong;
  wire::for_each_name(operation, [&](const std::string& name) {
    if (name.size() > longest_name)
      wrong = "a name has " + std::to_string(name.size()) + " bytes; the maximum is " + std::to_string(longest_name);
  });
  if constexpr (requires { what_is_wrong_with(operation); })
    if (wrong.empty()) wrong = what_is_wrong_with(operation);
  return wrong;
}

}  // namespace

std::string what_is_wrong(const wire::Request& request) {
  return std::visit([](const auto& operation) { return complaint_about(operation); }, request.operation);
}

}  // namespace cohort::session
