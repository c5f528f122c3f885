// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/attachment.hpp"
#include "client_sdk/src/claims.hpp"
#include "client_sdk/src/hand_over.hpp"
#include "client_sdk/src/loop_host.hpp"
#include "idl/text/standard_streams.hpp"

namespace cohort {
namespace {

// Returns the error of a program that has read some parameters of a robot and left out others.
std::optional<std::string> problem_of_parameters(const LeaseStart& lease) {
  for (const DrivenRobot& robot : lease.robots) {
    if (robot.start.parameters.none_was_asked_for()) continue;
    try {
      robot.start.parameters.check_all_were_asked_for();
    } catch (const ParameterError& error) {
      return "the controller of robot '" + robot.start.name + "' failed in start at tick " +
             std::to_string(robot.start.tick) + ": " + error.what();
    }
  }
  return std::nullopt;
}

}  // namespace

struct Client::State {
  explicit State(const ClientOptions& given)
      : options(given), host(given.name.empty() ? "client" : given.name, hand_over) {
    options.name = host.name();
    options.tell = [this, tell_user = given.tell](Severity severity, const std::string& text) {
      if (tell_user)
        tell_user(severity, text);
      else if (severity != Severity::info)
        print_message(options.name + ": " + text);
      if (severity != Severity::error) return;
      const std::lock_guard lock(mutex);
      why = text;
    };
    thread = std::thread([this] { run(); });
  }

  // Acts like `HandOver::take`, and keeps a start for `answer`.
  std::optional<ClientEvent> take(std::optional<std::chrono::steady_clock::time_point> deadline) {
    std::optional<ClientEvent> event = hand_over.take(deadline);
    if (const auto* lease = event ? std::get_if<LeaseStart>(&*event) : nullptr) unanswered_start = *lease;
    return event;
  }

  void answer() {
    const std::optional<LeaseStart> lease = std::exchange(unanswered_start, std::nullopt);
    if (const auto problem = lease ? problem_of_parameters(*lease) : std::nullopt)
      hand_over.fail(*problem);
    else
      hand_over.answer();
  }

  void run() noexcept {
    ClientEnd end = ClientEnd::failed;
    try {
      end = run_client(host, options.name, options, stop, &watch, &claims);
    } catch (const std::exception& error) {
      options.tell(Severity::error, error.what());
    }
    const std::lock_guard lock(mutex);
    hand_over.end({end, std::exchange(why, {})});
  }

  ClientOptions options;
  std::atomic<bool> stop{false};
  RunWatch watch;
  Claims claims;
  HandOver hand_over;
  LoopHost host;
  std::optional<LeaseStart> unanswered_start;  // the current event
  std::mutex mutex;
  std::string why;  // guarded by `mutex`
  std::thread thread;
};

Client::Client(const ClientOptions& options) : state_(std::make_unique<State>(options)) {}

Client::~Client() {
  state_->stop = true;
  state_->hand_over.leave();
  state_->thread.join();
}

ClientEvent Client::next() {
  answer();
  return *state_->take(std::nullopt);
}

std::optional<ClientEvent> Client::next(std::chrono::milliseconds at_most) {
  answer();
  return state_->take(std::chrono::steady_clock::now() + at_most);
}

void Client::claim(std::vector<std::string> robots) { state_->claims.set(std::move(robots)); }
void Client::answer() { state_->answer(); }
void Client::leave_unanswered() { state_->hand_over.leave_unanswered(); }
void Client::fail(const std::string& why) {
  state_->unanswered_start.reset();
  state_->hand_over.fail(why);
}
bool Client::is_over() const { return state_->watch.is_over(); }
int Client::descriptor() const { return state_->hand_over.descriptor(); }

}  // namespace cohort
