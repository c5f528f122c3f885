#include "tools/view/sources/control_requests.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace cohort::view {
namespace {

using wire::Operation;
using wire::Request;
using wire::SimulationState;

Request of(Operation operation) {
  Request request;
  request.operation = operation;
  return request;
}

Request to_state(SimulationState state) {
  Request request = of(Operation::set_simulation_state);
  request.state = state;
  return request;
}

wire::Vector3 vector_in(const ViewRequest& asked) {
  if (asked.numbers.size() < 2 || asked.numbers.size() > 3)
    throw std::invalid_argument("'" + asked.operation + "' needs x, y and perhaps z");
  return {asked.numbers[0], asked.numbers[1], asked.numbers.size() > 2 ? asked.numbers[2] : 0.0};
}

// Upright, with its heading about the vertical.
wire::Pose pose_in(const ViewRequest& asked) {
  if (asked.numbers.size() < 2 || asked.numbers.size() > 4)
    throw std::invalid_argument("'" + asked.operation + "' needs x, y, perhaps z, and perhaps a heading");
  std::array<double, 4> numbers{};
  std::ranges::copy(asked.numbers, numbers.begin());
  wire::Pose pose;
  pose.position = {numbers[0], numbers[1], numbers[2]};
  pose.orientation = {0.0, 0.0, std::sin(0.5 * numbers[3]), std::cos(0.5 * numbers[3])};
  return pose;
}

Request of_object(Operation operation, const ViewRequest& asked) {
  if (asked.name.empty()) throw std::invalid_argument("'" + asked.operation + "' needs the name of an object");
  Request request = of(operation);
  request.entity = asked.name;
  return request;
}

Request step(const ViewRequest& asked) {
  constexpr double most = 1e9;
  if (!(asked.number >= 1.0 && asked.number <= most))
    throw std::invalid_argument("a running world steps ahead, by one tick or more");
  Request request = of(Operation::step_simulation);
  request.steps = static_cast<std::uint64_t>(asked.number);
  return request;
}

Request speed(const ViewRequest& asked) {
  if (!(asked.number >= 0.0) || !std::isfinite(asked.number))
    throw std::invalid_argument("a speed is above 0, or 0 for as fast as it goes");
  Request request = of(Operation::set_speed);
  request.speed = asked.number;
  return request;
}

Request spawn(const ViewRequest& asked) {
  Request request = of_object(Operation::spawn_entity, asked);
  request.uri = asked.text;
  request.set_pose = true;
  request.pose = pose_in(asked);
  return request;
}

Request move(const ViewRequest& asked) {
  Request request = of_object(Operation::set_entity_state, asked);
  request.set_pose = true;
  request.pose = pose_in(asked);
  return request;
}

Request light(const ViewRequest& asked) {
  Request request = of_object(Operation::set_light, asked);
  request.on = asked.number != 0.0;
  return request;
}

Request push(const ViewRequest& asked) {
  constexpr std::int64_t tenth_of_a_second = 100'000'000;
  Request request = of_object(Operation::apply_force, asked);
  request.force = vector_in(asked);
  request.duration_ns = tenth_of_a_second;
  return request;
}

struct ViewOperation {
  const char* name;
  Request (*request)(const ViewRequest&);
};
constexpr std::array view_operations = {
    ViewOperation{"play", [](const ViewRequest&) { return to_state(SimulationState::playing); }},
    ViewOperation{"pause", [](const ViewRequest&) { return to_state(SimulationState::paused); }},
    ViewOperation{"step", step},
    ViewOperation{"speed", speed},
    ViewOperation{"reset", [](const ViewRequest&) { return of(Operation::reset_simulation); }},
    ViewOperation{"spawn", spawn},
    ViewOperation{"remove", [](const ViewRequest& asked) { return of_object(Operation::delete_entity, asked); }},
    ViewOperation{"move", move},
    ViewOperation{"light", light},
    ViewOperation{"push", push},
};

}  // namespace

Request request_of(const ViewRequest& asked) {
  const auto* const found =
      std::ranges::find_if(view_operations, [&](const ViewOperation& each) { return asked.operation == each.name; });
  if (found == view_operations.end())
    throw std::invalid_argument("'" + asked.operation + "' is nothing that a server can do");
  return found->request(asked);
}

}  // namespace cohort::view
