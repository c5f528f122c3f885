// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "client_sdk/hosting/c_handles.hpp"
#include "client_sdk/include/cohort/client.hpp"

namespace cohort {
namespace {

CohortEnd end_of(ClientEnd end) {
  switch (end) {
    case ClientEnd::finished: return cohort_end_finished;
    case ClientEnd::refused: return cohort_end_refused;
    case ClientEnd::superseded: return cohort_end_superseded;
    case ClientEnd::failed: return cohort_end_failed;
    case ClientEnd::server_lost: return cohort_end_server_lost;
    case ClientEnd::interrupted: break;
  }
  return cohort_end_interrupted;
}

ClientOptions options_of(const CohortOptions* given) {
  ClientOptions options;
  options.name = "controller";
  take_environment(options);
  if (given == nullptr) return options;
  options.domain = given->domain;
  if (given->server != nullptr) options.server = given->server;
  if (given->name != nullptr) options.name = given->name;
  if (given->secure != nullptr) options.secure = given->secure;
  if (given->robots != nullptr) options.robots = split_selectors(given->robots);
  if (options.robots.empty())
    throw std::invalid_argument("the option 'robots' is empty; expected at least one selector");
  return options;
}

}  // namespace
}  // namespace cohort

// Splits the events of a Client, which are for all robots, into one event per robot.
struct CohortClient {
 public:
  explicit CohortClient(const cohort::ClientOptions& options) : client_(options) {}

  const cohort::Client& client() const { return client_; }
  void remember() { remembers_ = true; }
  CohortStateWriter* state_to_save() { return is_under_way_ && to_save_ ? &*to_save_ : nullptr; }
  CohortStateReader* state_to_load() { return is_under_way_ && to_load_ ? &*to_load_ : nullptr; }

  const cohort::DrivenRobot* find(std::uint32_t id) const {
    const auto robot = std::ranges::find(robots_, id, [](const auto& each) { return each.start.robot; });
    return robot == robots_.end() ? nullptr : &*robot;
  }

  // Answers the event of one robot, and with the last robot the event itself.
  void answer() {
    if (!std::exchange(is_under_way_, false)) return;
    if (start_ && start_->mistake) {
      const cohort::Start& start = start_->start;
      fail("the controller of robot '" + start.name + "' failed in start at tick " + std::to_string(start.tick) + ": " +
           *start_->mistake);
    } else if (to_load_ && to_load_->mistake) {
      fail("robot " + std::to_string(given_.robot) + ": its saved state cannot be read: " + *to_load_->mistake);
    } else if (++next_robot_ == robot_count()) {
      client_.answer();
      event_.reset();
    }
  }

  void fail(const std::string& why) {
    is_under_way_ = false;
    client_.fail(why);
    event_.reset();
  }

  // Returns the next event; waits without limit if `at_most` is empty.
  CohortEvent next(std::optional<std::chrono::milliseconds> at_most) {
    answer();
    while (!event_) {
      event_ = at_most ? client_.next(*at_most) : client_.next();
      if (!event_) {
        given_ = {};
        given_.kind = cohort_event_none;
        return given_;
      }
      next_robot_ = 0;
      if (robot_count() == 0) pass_over();
    }
    start_.reset();
    to_save_.reset();
    to_load_.reset();
    given_ = {};
    std::visit([this](const auto& event) { give(event); }, *event_);
    is_under_way_ = given_.kind != cohort_event_end;
    return given_;
  }

 private:
  void give(const cohort::LeaseStart& lease) {
    robots_ = lease.robots;
    start_.emplace(lease.robots[next_robot_].start);
    given_.kind = cohort_event_start;
    given_.robot = start_->start.robot;
    given_.start = &*start_;
  }
  void give(const cohort::Frame& frame) {
    cohort::FrameRobot& robot = frame.robots[next_robot_];
    observation_.emplace(CohortObservation{robot.observation});
    command_.emplace(CohortCommand{robot.command});
    given_.kind = cohort_event_observation;
    given_.robot = robot.robot->start.robot;
    given_.observation = &*observation_;
    given_.command = &*command_;
  }
  void give(const cohort::SaveState& save) {
    to_save_.emplace(CohortStateWriter{*save.state});
    given_.kind = cohort_event_save;
    given_.robot = save.robot->start.robot;
  }
  void give(const cohort::LoadState& load) {
    to_load_.emplace(CohortStateReader{*load.state});
    given_.kind = cohort_event_load;
    given_.robot = load.robot->start.robot;
  }
  void give(const cohort::ClientEnded& ended) {
    cohort::last_error() = ended.why;
    given_.kind = cohort_event_end;
    given_.end = cohort::end_of(ended.end);
    event_.reset();  // the client returns it again
  }

  // Returns the number of C events for the current event.
  std::size_t robot_count() const {
    if (const auto* lease = std::get_if<cohort::LeaseStart>(&*event_)) return lease->robots.size();
    if (const auto* frame = std::get_if<cohort::Frame>(&*event_)) return frame->robots.size();
    return remembers_ || std::holds_alternative<cohort::ClientEnded>(*event_) ? 1 : 0;
  }

  // Skips an event without robots, or of a state that the loop does not handle.
  void pass_over() {
    if (const auto* save = std::get_if<cohort::SaveState>(&*event_)) save->state->leave_out();
    client_.answer();
    event_.reset();
  }

  cohort::Client client_;
  bool remembers_ = false;
  std::span<const cohort::DrivenRobot> robots_;  // robots of the lease
  std::optional<cohort::ClientEvent> event_;     // not yet answered
  std::size_t next_robot_ = 0;                   // robot of the next C event
  CohortEvent given_{};                          // the last one
  bool is_under_way_ = false;                    // it is not answered
  std::optional<CohortStart> start_;
  std::optional<CohortObservation> observation_;
  std::optional<CohortCommand> command_;
  std::optional<CohortStateWriter> to_save_;
  std::optional<CohortStateReader> to_load_;
};

CohortClient* cohort_connect(const CohortOptions* options) {
  try {
    return new CohortClient(cohort::options_of(options));
  } catch (const std::exception& error) {
    cohort::last_error() = error.what();
    return nullptr;
  }
}

CohortEventKind cohort_next(CohortClient* client, CohortEvent* event) {
  *event = client->next(std::nullopt);
  return event->kind;
}

CohortEventKind cohort_next_within(CohortClient* client, CohortEvent* event, int milliseconds) {
  *event = client->next(std::chrono::milliseconds(std::max(milliseconds, 0)));
  return event->kind;
}

void cohort_answer(CohortClient* client) { client->answer(); }

int cohort_descriptor(const CohortClient* client) { return client->client().descriptor(); }

bool cohort_is_over(const CohortClient* client) { return client->client().is_over(); }

bool cohort_policy(const CohortClient* client, uint32_t robot, CohortPolicy* policy) {
  const cohort::DrivenRobot* const driven = client->find(robot);
  if (driven == nullptr) {
    cohort::last_error() = "this client does not drive robot " + std::to_string(robot);
    return false;
  }
  *policy = {driven->policy.waits, driven->policy.period, driven->policy.phase, driven->policy.delay};
  return true;
}

void cohort_remember(CohortClient* client) { client->remember(); }

CohortStateWriter* cohort_state_to_save(CohortClient* client) { return client->state_to_save(); }

CohortStateReader* cohort_state_to_load(CohortClient* client) { return client->state_to_load(); }

void cohort_give_up(CohortClient* client, const char* why) { client->fail(why); }

void cohort_close(CohortClient* client) { delete client; }

int cohort_run_controller(const CohortPlugin* plugin, int argc, char** argv) {
  return cohort::run_controller(*reinterpret_cast<const cohort::Plugin*>(plugin), argc, argv);
}
