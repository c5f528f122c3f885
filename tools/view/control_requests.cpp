#include "tools/view/control_requests.hpp"

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

wire::Vector3 vector_in(const Wish& wish) {
  if (wish.numbers.size() < 2 || wish.numbers.size() > 3)
    throw std::invalid_argument("'" + wish.operation + "' needs x, y and perhaps z");
  return {wish.numbers[0], wish.numbers[1], wish.numbers.size() > 2 ? wish.numbers[2] : 0.0};
}

// Upright, with its heading about the vertical.
wire::Pose pose_in(const Wish& wish) {
  if (wish.numbers.size() < 2 || wish.numbers.size() > 4)
    throw std::invalid_argument("'" + wish.operation + "' needs x, y, perhaps z, and perhaps a heading");
  std::array<double, 4> numbers{};
  std::ranges::copy(wish.numbers, numbers.begin());
  wire::Pose pose;
  pose.position = {numbers[0], numbers[1], numbers[2]};
  pose.orientation = {0.0, 0.0, std::sin(0.5 * numbers[3]), std::cos(0.5 * numbers[3])};
  return pose;
}

Request of_object(Operation operation, const Wish& wish) {
  if (wish.name.empty()) throw std::invalid_argument("'" + wish.operation + "' needs the name of an object");
  Request request = of(operation);
  request.entity = wish.name;
  return request;
}

Request step(const Wish& wish) {
  constexpr double most = 1e9;
  if (!(wish.number >= 1.0 && wish.number <= most))
    throw std::invalid_argument("a running world steps ahead, by one tick or more");
  Request request = of(Operation::step_simulation);
  request.steps = static_cast<std::uint64_t>(wish.number);
  return request;
}

Request speed(const Wish& wish) {
  if (!(wish.number >= 0.0) || !std::isfinite(wish.number))
    throw std::invalid_argument("a speed is above 0, or 0 for as fast as it goes");
  Request request = of(Operation::set_speed);
  request.speed = wish.number;
  return request;
}

Request spawn(const Wish& wish) {
  Request request = of_object(Operation::spawn_entity, wish);
  request.uri = wish.text;
  request.set_pose = true;
  request.pose = pose_in(wish);
  return request;
}

Request move(const Wish& wish) {
  Request request = of_object(Operation::set_entity_state, wish);
  request.set_pose = true;
  request.pose = pose_in(wish);
  return request;
}

Request light(const Wish& wish) {
  Request request = of_object(Operation::set_light, wish);
  request.on = wish.number != 0.0;
  return request;
}

Request push(const Wish& wish) {
  constexpr std::int64_t tenth_of_a_second = 100'000'000;
  Request request = of_object(Operation::apply_force, wish);
  request.force = vector_in(wish);
  request.duration_ns = tenth_of_a_second;
  return request;
}

struct Word {
  const char* name;
  Request (*request)(const Wish&);
};
constexpr std::array words = {
    Word{"play", [](const Wish&) { return to_state(SimulationState::playing); }},
    Word{"pause", [](const Wish&) { return to_state(SimulationState::paused); }},
    Word{"step", step},
    Word{"speed", speed},
    Word{"reset", [](const Wish&) { return of(Operation::reset_simulation); }},
    Word{"spawn", spawn},
    Word{"remove", [](const Wish& wish) { return of_object(Operation::delete_entity, wish); }},
    Word{"move", move},
    Word{"light", light},
    Word{"push", push},
};

}  // namespace

Request request_of(const Wish& wish) {
  const auto* const found = std::ranges::find_if(words, [&](const Word& word) { return wish.operation == word.name; });
  if (found == words.end()) throw std::invalid_argument("'" + wish.operation + "' is nothing that a server can do");
  return found->request(wish);
}

}  // namespace cohort::view
