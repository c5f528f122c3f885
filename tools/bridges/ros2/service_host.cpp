// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/ros2/service_host.hpp"

#include <poll.h>

#include <array>
#include <utility>

namespace cohort::ros2 {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

constexpr auto longest_wait = 5s;  // for a client that can receive the reply
constexpr std::size_t most_waiting = 1000;
constexpr auto looked_every = 500ms;  // at replies that are too old

}  // namespace

ServiceHost::ServiceHost(RosParticipant& participant, RosGraph& graph, std::span<const OfferedService> services,
                         ServiceHelper::Options helper, const std::atomic<bool>& stop)
    : services_(services), helper_(std::move(helper), services, stop) {
  if (const auto its_participant = helper_.participant()) graph.leave_out(*its_participant);
  // After the helper's: a client on Fast DDS that sees these takes the service for available.
  for (std::size_t i = 0; i < services.size(); ++i)
    cyclone_.push_back(std::make_unique<CycloneService>(participant, inbox_, services[i], i));
  thread_ = std::thread([this] { run(); });
}

ServiceHost::~ServiceHost() {
  is_over_ = true;
  inbox_.wake();
  thread_.join();
}

void ServiceHost::announce(GidFormat format) {
  format_ = format;
  is_to_announce_ = true;
  inbox_.wake();
}

void ServiceHost::wait_for_request(std::chrono::milliseconds at_most) const {
  const auto deadline = SteadyClock::now() + at_most;
  while (is_busy_ && SteadyClock::now() < deadline) std::this_thread::sleep_for(5ms);
}

void ServiceHost::run() {
  while (!is_over_) {
    std::array<pollfd, 2> ready{pollfd{inbox_.descriptor(), POLLIN, 0}, pollfd{helper_.descriptor(), POLLIN, 0}};
    ::poll(ready.data(), ready.size(), static_cast<int>(looked_every / 1ms));
    inbox_.clear();
    is_busy_ = true;
    if (is_to_announce_.exchange(false)) helper_.announce(format_);
    answer_cyclone();
    answer_helper();
    send_waiting();
    is_busy_ = false;
  }
}

std::optional<messages::Bytes> ServiceHost::reply_to(std::size_t service, messages::ByteView request) {
  try {
    return services_[service].answer(request);
  } catch (const messages::CdrError&) {
    return {};  // malformed request: no reply
  }
}

void ServiceHost::answer_cyclone() {
  for (const RosInbox::Message& message : inbox_.take()) {
    if (is_over_) return;
    CycloneService& service = *cyclone_[message.input];
    auto request = service.request(message);
    if (!request) continue;
    if (auto reply = reply_to(message.input, request->request))
      waiting_.push_back({service, std::move(*request), std::move(*reply), SteadyClock::now() + longest_wait});
    send_waiting();
  }
}

void ServiceHost::answer_helper() {
  while (const auto request = helper_.request()) {
    if (is_over_) return;
    const auto bytes = std::as_bytes(std::span(request->request));
    if (request->service >= services_.size()) continue;
    if (const auto reply = reply_to(request->service, bytes)) helper_.reply(*request, *reply);
  }
}

void ServiceHost::send_waiting() {
  const auto now = SteadyClock::now();
  std::erase_if(waiting_, [&](const Waiting& each) {
    if (!each.service.is_there(each.to.client)) return now > each.until;
    each.service.reply(each.to, each.reply);
    return true;
  });
  if (waiting_.size() > most_waiting) waiting_.pop_front();
}

}  // namespace cohort::ros2
