// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/control/control_client.hpp"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "client_sdk/src/network_clock.hpp"
#include "client_sdk/src/this_process.hpp"
#include "idl/text/printable.hpp"

namespace cohort {
namespace {

using Clock = NetworkClock;
using namespace std::chrono_literals;

constexpr auto look_interval = 10ms;
constexpr std::chrono::milliseconds first_interval{50};  // until a request is sent again
constexpr std::chrono::milliseconds longest_interval{1000};

std::optional<wire::Identity> identity_of(const ControlOptions& options) {
  if (options.secure.empty()) return std::nullopt;
  wire::Identity identity = wire::read_identity(options.secure);
  if (!identity.may_control && identity.role != wire::Role::observer)
    throw wire::WireError("the identity in " + options.secure +
                          " can neither control nor observe a run. Create one that can control with 'cohort security "
                          "add DIR NAME --robots none,control', or use the observers' identity");
  return identity;
}

// Make texts from a server safe to print.
void clean(wire::EntityName& name) { name.entity = printable(name.entity); }
void clean(wire::EntityNames& names) {
  for (std::string& entity : names.entities) entity = printable(entity);
}
void clean(wire::EntityState& state) { state.entity = printable(state.entity); }
void clean(wire::SimulationStatus& status) {
  status.experiment = printable(status.experiment);
  for (std::string& robot : status.awaited) robot = printable(robot);
  for (wire::ControllerStatus& controller : status.controllers) controller.label = printable(controller.label);
}
wire::Reply cleaned(wire::Reply reply) {
  reply.error_message = printable(reply.error_message, std::string::npos, Lines::kept);
  std::visit(
      [](auto& returned) {
        if constexpr (requires { clean(returned); }) clean(returned);
      },
      reply.returned);
  return reply;
}

}  // namespace

struct ControlClient::State {
  explicit State(const ControlOptions& options)
      : label(options.label + " (process " + std::to_string(::getpid()) + " on " + host_name() + ")"),
        participant(wire::Participant::client(options.domain, options.server, identity_of(options))),
        replies(participant, {[this](const wire::Reply& reply, const wire::Sender&) { receive(reply); }, nullptr},
                wire::partition_of(id), static_cast<int>(wire::requests_under_way)),
        requests(participant) {}

  // Called on a DDS thread.
  void receive(const wire::Reply& reply) {
    if (reply.client != id) return;
    {
      const std::lock_guard lock(mutex);
      if (awaited != reply.number) return;  // a repetition
      received = cleaned(reply);
    }
    wake.notify_one();
  }

  bool sees_server() {
    const bool there = requests.matched() > 0;
    if (there) seen_at = Clock::now();
    return there;
  }

  const std::uint64_t id = random_id();
  const std::string label;
  std::uint64_t next_number = 1;
  std::optional<Clock::time_point> seen_at;  // when a server was last seen

  std::mutex mutex;
  std::condition_variable wake;
  std::uint64_t awaited = 0;
  std::optional<wire::Reply> received;

  wire::Participant participant;
  wire::Reader<wire::Reply> replies;
  wire::Writer<wire::Request> requests;
};

ControlClient::ControlClient(const ControlOptions& options) : state_(std::make_unique<State>(options)) {}
ControlClient::~ControlClient() = default;

wire::Participant& ControlClient::participant() { return state_->participant; }

bool ControlClient::sees_server() const { return state_->sees_server(); }

bool ControlClient::server_is_gone() const {
  return state_->seen_at && !state_->sees_server() && Clock::now() - *state_->seen_at > server_may_be_away;
}

bool ControlClient::wait_for_server(std::chrono::milliseconds at_most, const std::atomic<bool>& stop) {
  const WaitsByNetworkClock real_time;
  const auto until = Clock::now() + at_most;
  while (!state_->sees_server()) {
    if (stop || Clock::now() > until) return false;
    std::this_thread::sleep_for(look_interval);
  }
  return true;
}

std::optional<wire::Reply> ControlClient::ask(wire::Operation operation, std::chrono::milliseconds at_most,
                                              const std::atomic<bool>& stop) {
  State& state = *state_;
  const WaitsByNetworkClock real_time;
  const auto begin = Clock::now();
  const auto is_late = [&] { return Clock::now() - begin > at_most; };
  const wire::Request request{
      .client = state.id, .number = state.next_number++, .label = state.label, .operation = std::move(operation)};
  {
    const std::lock_guard lock(state.mutex);
    state.awaited = request.number;
    state.received.reset();
  }
  Clock::time_point ask_at = begin;
  std::chrono::milliseconds interval = first_interval;
  while (!stop && !is_late() && !server_is_gone()) {
    // Data written before there is a reader is lost.
    if (state.sees_server() && Clock::now() >= ask_at) {
      state.requests.write(request);
      ask_at = Clock::now() + interval;
      interval = std::min(longest_interval, interval + interval / 2);
    }
    std::unique_lock lock(state.mutex);
    if (state.wake.wait_for(lock, look_interval, [&] { return state.received.has_value(); }))
      return std::exchange(state.received, std::nullopt);
  }
  return std::nullopt;
}

ControlClient attach(const ControlOptions& options) {
  try {
    return ControlClient(options);
  } catch (const wire::WireError& error) {
    throw ControlError(error.what(), ControlResult::no_attachment);
  }
}

}  // namespace cohort
