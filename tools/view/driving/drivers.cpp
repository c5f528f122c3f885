// SPDX-License-Identifier: Apache-2.0
#include "tools/view/driving/drivers.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cohort::view {
namespace {

// A selector (docs/protocol.md) may be of several robots.
bool is_name(const std::string& name) {
  return !name.empty() && name != "all" && name.find('*') == std::string::npos &&
         name.find_first_not_of("0123456789.") != std::string::npos;
}

}  // namespace

void Drivers::drive(const ViewRequest& request, std::function<void(const Answer&)> answer) {
  Answer told;
  {
    const std::lock_guard lock(mutex_);
    forget_the_gone();
    auto found = driven_.find(request.name);
    const bool is_claim = request.numbers.empty();
    if (is_claim && found != driven_.end() && found->second.driver->has_ended()) {
      driven_.erase(found);
      found = driven_.end();
    }
    if (found == driven_.end()) {
      if (!is_claim)
        told = {false, "this page does not drive '" + request.name + "': claim it with 'drive' without numbers"};
      else if (!is_name(request.name))
        told = {false, "'drive' requires the full name of one robot, such as explorers/sbot_7"};
      else if (driven_.size() + leaving_.size() >= most)
        told = {false, "one view can drive at most " + std::to_string(most) + " robots"};
      else
        return claim(request, std::move(answer));
    } else if (found->second.driver->has_ended()) {
      told = {false, found->second.driver->why()};
      driven_.erase(found);
    } else {
      told = tell(request, found->second);
    }
  }
  answer(told);
}

Answer Drivers::tell(const ViewRequest& request, Driven& driven) {
  const auto now = HeldCommand::Clock::now();
  Driver& driver = *driven.driver;
  if (driven.visitor != request.visitor) {
    const bool may_take = request.numbers.empty() && driver.has_begun();
    if (!may_take || driver.command().silence(now) < longest_silence)
      return {false, "another page drives " + request.name};
    driven.visitor = request.visitor;
  }
  if (!driver.has_begun()) return {false, "the robot is still being claimed"};
  try {
    driver.command().give(request.numbers, now);
  } catch (const std::invalid_argument& error) {
    return {false, error.what()};
  }
  return {true, "drives " + request.name};
}

void Drivers::claim(const ViewRequest& request, std::function<void(const Answer&)> answer) {
  ClientOptions client;
  client.server = options_.server;
  client.domain = options_.domain;
  client.secure = options_.secure;
  client.robots = {request.name};
  client.name = "view";
  std::shared_future<void> after;
  for (const Leaving& before : leaving_)
    if (before.robot == request.name) after = before.driver->end();
  auto driver = std::make_unique<Driver>(std::move(client), std::move(answer), std::move(after));
  driver->command().give({}, HeldCommand::Clock::now());
  driven_[request.name] = {request.visitor, std::move(driver)};
}

Answer Drivers::release(const ViewRequest& request) {
  const std::lock_guard lock(mutex_);
  forget_the_gone();
  const auto found = driven_.find(request.name);
  if (found == driven_.end() || found->second.visitor != request.visitor)
    return {false, "this page does not drive '" + request.name + "'"};
  release_at(found);
  return {true, "released " + request.name};
}

void Drivers::leave(std::uint64_t visitor) {
  const std::lock_guard lock(mutex_);
  for (auto each = driven_.begin(); each != driven_.end();) {
    const auto next = std::next(each);
    if (each->second.visitor == visitor) release_at(each);
    each = next;
  }
  forget_the_gone();
}

void Drivers::release_at(std::map<std::string, Driven>::iterator place) {
  place->second.driver->leave();
  leaving_.push_back({place->first, std::move(place->second.driver)});
  driven_.erase(place);
}

void Drivers::forget_the_gone() {
  std::erase_if(leaving_, [](const Leaving& each) { return each.driver->has_ended(); });
}

}  // namespace cohort::view
