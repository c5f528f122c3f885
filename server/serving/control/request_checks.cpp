#include "server/serving/control/request_checks.hpp"

#include <algorithm>
#include <cmath>

namespace cohort::session {

using wire::Operation;
using wire::SimulationState;

std::string what_is_wrong(const wire::Request& request) {
  constexpr std::size_t longest_name = 1024;
  constexpr std::uint64_t most_steps = std::uint64_t{1} << 62;
  const auto finite = [](std::initializer_list<double> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
  };
  const auto finite_vector = [&](const wire::Vector3& v) { return finite({v.x, v.y, v.z}); };
  if (wire::name_of(request.operation).empty())
    return "there is no operation " + std::to_string(static_cast<std::uint32_t>(request.operation));
  for (const std::string* name : {&request.filter, &request.entity, &request.link})
    if (name->size() > longest_name)
      return "a name of " + std::to_string(name->size()) + " bytes is longer than " + std::to_string(longest_name);
  if (request.operation == Operation::step_simulation && (request.steps == 0 || request.steps > most_steps))
    return "expected at least 1 step, and at most 2^62, not " + std::to_string(request.steps);
  if (request.operation == Operation::set_speed && !(request.speed >= 0.0 && request.speed <= 1e9))
    return "expected a speed from 0 (as fast as it goes) to 1e9, not " + std::to_string(request.speed);
  if (request.operation == Operation::set_simulation_state && request.state > SimulationState::quitting)
    return "there is no state " + std::to_string(static_cast<std::uint32_t>(request.state)) +
           " to set: 0 stopped, 1 playing, 2 paused, 3 quitting";
  const wire::Quaternion& q = request.pose.orientation;
  const bool numbers_fit = finite_vector(request.pose.position) && finite({q.x, q.y, q.z, q.w}) &&
                           finite_vector(request.twist.linear) && finite_vector(request.twist.angular) &&
                           finite_vector(request.force) && finite_vector(request.torque) &&
                           finite_vector(request.color) && finite({request.intensity});
  return numbers_fit ? std::string() : "a number is not finite";
}

}  // namespace cohort::session
